// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_RESIDUALS_HPP_
#define KOMPONO_CALIBRATION_SRC_RESIDUALS_HPP_

#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
#include "kompono/kinematics/machine.hpp"

/// What one row of a measurement file says about the geometry.
namespace kompono::calibration {

/// Predicted minus measured: first `lengths` numbers in mm, the others in rad.
struct RowErrors {
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> value;
  int lengths = 0;
  [[nodiscard]] double LengthNorm() const { return value.head(lengths).norm(); }
  [[nodiscard]] double AngleNorm() const { return value.tail(value.size() - lengths).norm(); }
};

/// The set's fixtures with the values they have now: three numbers for each.
struct FixtureValues {
  const std::vector<Fixture>* fixtures = nullptr;
  const double* value = nullptr;
};

/// Derivatives of RowErrors by the twists (v, ω) of the tool at the first and second readings and
/// by the three numbers of the row's target and fixture.
struct RowMaps {
  using Map = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, 6, 6>;
  using PointMap = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 6, 3>;
  Map first, second;         ///< second only for rows with two readings
  PointMap target, fixture;  ///< only for rows that have them
};

/// r x as a matrix.
[[nodiscard]] Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& r);
/// log(R): the rotation vector.
[[nodiscard]] Eigen::Vector3d RotationVector(const Eigen::Matrix3d& R);
[[nodiscard]] Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& rotation);
/// d log(exp(δ) exp(r)) / dδ at δ = 0, the inverse of SO(3)'s left Jacobian.
[[nodiscard]] Eigen::Matrix3d LeftJacobianInverse(const Eigen::Vector3d& r);

[[nodiscard]] RowErrors ErrorsOf(const Measurement& measurement,
                                 const Pose<double>& X_WT,
                                 const Pose<double>& X_WT_second,
                                 const FixtureValues& fixtures = {});
[[nodiscard]] RowMaps MapsOf(const Measurement& measurement,
                             const Pose<double>& X_WT,
                             const Pose<double>& X_WT_second,
                             const FixtureValues& fixtures = {});
/// Rows whose last three numbers are a rotation vector.
[[nodiscard]] bool HasRotation(MeasurementKind kind);

/// One row with its machine, its weights and the coordinates from which its forward problem starts.
class RowModel {
 public:
  struct Prediction {
    kinematics::MeasuredPose first, second;  ///< second only for rows with two readings
    [[nodiscard]] bool ok() const { return status() == kinematics::SolveStatus::kConverged; }
    [[nodiscard]] kinematics::SolveStatus status() const {
      return first.status != kinematics::SolveStatus::kConverged ? first.status : second.status;
    }
  };

  RowModel(const kinematics::Machine& machine,
           const Measurement& measurement,
           double default_sigma_mm,
           double default_sigma_rad);

  /// Looks for coordinates that belong to the readings: from home, from a neighbour's, and from the
  /// measured pose. The prediction tells why if none is found.
  Prediction FindStart(const Eigen::VectorXd& theta, const RowModel* neighbour);
  [[nodiscard]] Prediction Predict(const Eigen::VectorXd& theta, bool with_derivatives) const;
  /// The next predictions start here.
  void StartAt(const Eigen::VectorXd& z, const Eigen::VectorXd& z_second) {
    start_ = z;
    second_start_ = z_second;
  }
  /// The next predictions start where this one ended.
  void StartFrom(const Prediction& prediction);

  [[nodiscard]] const Measurement& measurement() const { return *measurement_; }
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  /// `fixtures`: of the set the row is in.
  [[nodiscard]] RowErrors Errors(const Prediction& prediction,
                                 const FixtureValues& fixtures = {}) const {
    return ErrorsOf(*measurement_, prediction.first.X_WT, prediction.second.X_WT, fixtures);
  }
  /// Errors divided by their standard deviations.
  [[nodiscard]] RowErrors Whitened(const Prediction& prediction,
                                   const FixtureValues& fixtures = {}) const;

 private:
  [[nodiscard]] double Weight(const RowErrors& errors, Eigen::Index i) const {
    return 1.0 / (i < errors.lengths ? sigma_mm_ : sigma_rad_);
  }

  const kinematics::Machine* machine_;
  const Measurement* measurement_;
  double sigma_mm_, sigma_rad_;
  int size_;
  Eigen::VectorXd start_, second_start_;
};

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_RESIDUALS_HPP_
