// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_POSE_ROWS_HPP_
#define KOMPONO_CALIBRATION_SRC_POSE_ROWS_HPP_

#include "residuals.hpp"

#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
#include "kompono/kinematics/linearisation.hpp"
#include "kompono/kinematics/machine.hpp"

/// The errors-in-variables form of an identification: besides the geometry every row has unknown
/// coordinates z (two sets for rows with two readings). The instrument saw X_WT(z, θ), the scales
/// of the drives saw q(z, θ); what both leave is weighted by their deviations, and z is eliminated
/// row by row (Schur complement), so that time and memory grow with the number of rows and no more.
///
/// Elimination at (z, θ) with G = M V_z Q_z⁻¹ (M maps the tool's twist to the instrument's numbers,
/// V_z and Q_z are the derivatives of tool and drives by z), c = q(z, θ) - q measured and e the
/// instrument's error: what remains is ρ = e - G c with derivative M V_θ - G Q_θ and covariance
/// Σ_instrument + G Σ_drives Gᵀ. Drives without deviation are met exactly.
namespace kompono::calibration {

/// Σ over the rows at one geometry.
struct NormalEquations {
  bool ok = true;               ///< false: some row has no pose
  double cost = 0.0;            ///< 1/2 Σ w |ρ|²
  Eigen::MatrixXd H;            ///< Jᵀ w J by the free numbers (mm, rad); upper triangle
  Eigen::VectorXd g;            ///< Jᵀ w ρ
  std::vector<double> squares;  ///< |ρ|² of every row, without its weight
};

struct RowNoise {
  double default_sigma_mm = 0.01;
  double default_sigma_rad = 1e-5;
  double drive_sigma_mm = 0.0;
  double drive_sigma_rad = 0.0;
};

/// One row of the file with its deviations and its unknown coordinates.
struct PoseRow {
  const Measurement* measurement = nullptr;
  double sigma_mm = 0.0, sigma_rad = 0.0;
  Eigen::VectorXd z, z_second;  ///< the latter for rows with two readings
};

class PoseWorker;

class PoseRows {
 public:
  /// `free`: ascending indices into θ, behind whose own numbers those of the set's fixtures stand.
  /// Rows keep pointers to the set's measurements.
  PoseRows(const kinematics::Machine& machine,
           const MeasurementSet& set,
           std::vector<int> free,
           const RowNoise& noise);
  ~PoseRows();
  PoseRows(const PoseRows&) = delete;
  PoseRows& operator=(const PoseRows&) = delete;

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const Measurement& measurement(std::size_t k) const {
    return *rows_[k].measurement;
  }

  /// Looks for coordinates that belong to the readings at θ. Returns one status per row.
  std::vector<kinematics::SolveStatus> Start(const Eigen::VectorXd& theta);

  /// Over `chosen` rows, weighted by `weights` (one per row of the set; empty: all 1).
  [[nodiscard]] NormalEquations Assemble(const Eigen::VectorXd& theta,
                                         const std::vector<std::size_t>& chosen,
                                         const std::vector<double>& weights,
                                         bool with_derivatives);
  /// Whitened derivatives of the chosen rows, columns multiplied by `scale`, reduced to a triangle
  /// of at most `free` rows with the same JᵀJ (weights as above).
  [[nodiscard]] Eigen::MatrixXd Triangle(const Eigen::VectorXd& theta,
                                         const std::vector<std::size_t>& chosen,
                                         const std::vector<double>& weights,
                                         const Eigen::VectorXd& scale);

  /// Errors of one row at θ, in its own units and divided by the deviations.
  struct Judged {
    bool ok = false;
    RowErrors errors;
    double whitened_square = 0.0;
  };
  [[nodiscard]] std::vector<Judged> Judge(const Eigen::VectorXd& theta);

  /// d tool twist / d free at the k-th row's (first) coordinates with its readings kept.
  [[nodiscard]] bool ToolByParameters(const Eigen::VectorXd& theta,
                                      std::size_t k,
                                      Eigen::Matrix<double, 6, Eigen::Dynamic>* twists);
  /// Coordinates of the k-th row's (first) readings, as last found.
  [[nodiscard]] const Eigen::VectorXd& coordinates(std::size_t k) const { return rows_[k].z; }
  [[nodiscard]] const Eigen::VectorXd& second_coordinates(std::size_t k) const {
    return rows_[k].z_second;
  }

 private:
  void ForEachChunk(const Eigen::VectorXd& theta,
                    std::size_t count,
                    const std::function<void(PoseWorker&, std::size_t, std::size_t)>& work);

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  std::vector<int> free_;
  RowNoise noise_;
  Eigen::VectorXd drive_variance_;
  std::vector<PoseRow> rows_;
  Eigen::VectorXd last_theta_;
  std::vector<std::unique_ptr<PoseWorker>> workers_;
};

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_POSE_ROWS_HPP_
