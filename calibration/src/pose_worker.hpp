// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_POSE_WORKER_HPP_
#define KOMPONO_CALIBRATION_SRC_POSE_WORKER_HPP_

#include "pose_rows.hpp"

#include <vector>

#include <Eigen/Core>

namespace kompono::calibration {

/// Linearises rows one after the other; one for each thread.
class PoseWorker {
 public:
  PoseWorker(const kinematics::Machine& machine,
             const MeasurementSet& set,
             const std::vector<int>& free,
             const Eigen::VectorXd& drive_variance);

  void SetGeometry(const Eigen::VectorXd& theta);
  void set_number(std::size_t number) { number_ = number; }
  [[nodiscard]] std::size_t number() const { return number_; }

  /// Coordinates that belong to the row's readings, on the branch of the machine's home.
  kinematics::SolveStatus FindStart(const Eigen::VectorXd& theta,
                                    const Eigen::VectorXd* neighbour,
                                    PoseRow* row);

  /// Eliminates the row's coordinates. `moved`: expect them to be off, so that derivatives by the
  /// geometry are not worth computing at first.
  [[nodiscard]] bool Linearise(PoseRow* row, bool with_derivatives, bool moved);

  // Of the last row: ρ and its derivatives, both divided by the deviations; errors in their units.
  [[nodiscard]] const Eigen::VectorXd& rho() const { return rho_; }
  [[nodiscard]] const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  [[nodiscard]] const RowErrors& errors() const { return errors_; }

  /// d tool twist / d free at the row's (first) coordinates with its readings kept.
  [[nodiscard]] bool ToolByParameters(PoseRow* row,
                                      Eigen::Matrix<double, 6, Eigen::Dynamic>* twists);

  /// d tool twist / d readings, of the last call of the above.
  [[nodiscard]] const Eigen::Matrix<double, 6, Eigen::Dynamic>& tool_by_readings() const {
    return first_.by_readings;
  }

 private:
  using Depth = kinematics::Linearisation::Depth;
  using Twist = Eigen::Matrix<double, 6, 1>;

  /// What one set of readings gives, coordinates eliminated.
  struct Side {
    Pose<double> X_linear;  ///< where the derivatives were taken
    Pose<double> X_WT;      ///< at coordinates that meet the readings to first order
    Eigen::Matrix<double, 6, Eigen::Dynamic> by_readings;    ///< V_z Q_z⁻¹
    Eigen::Matrix<double, 6, Eigen::Dynamic> by_parameters;  ///< readings kept
  };

  /// Newton on the drives; at the end `linear_` stands at z, which meets the readings but for c_.
  [[nodiscard]] bool Settle(const Eigen::VectorXd& readings, Depth first, Eigen::VectorXd* z);
  [[nodiscard]] bool Evaluate(const Eigen::VectorXd& readings,
                              bool with_derivatives,
                              bool moved,
                              Eigen::VectorXd* z,
                              Side* side);
  void Differentiate(const Measurement& measurement, const RowMaps& maps);
  void Whiten(const PoseRow& row, const RowMaps& maps, bool with_derivatives);
  /// Coordinates at which the tool stands where a full pose was measured.
  [[nodiscard]] bool AimAt(const Measurement& measurement, Eigen::VectorXd* z);
  [[nodiscard]] double DriveNorm(const Eigen::VectorXd& c) const;
  [[nodiscard]] bool OnTheBranchOfHome() const;

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  kinematics::Linearisation linear_;  ///< by the machine's own free numbers
  std::vector<int> of_fixtures_;      ///< free numbers of fixtures, counted from the first one
  Eigen::VectorXd fixture_values_;
  Eigen::VectorXd drive_variance_;
  Eigen::VectorXd drive_length_;  ///< mm per unit of a reading
  bool drives_are_exact_ = true;
  std::size_t number_ = 0;
  int home_sign_ = 0;
  Eigen::VectorXd c_, trial_, step_;
  Eigen::MatrixXd q_by_z_inverse_;
  Side first_, second_;
  RowErrors errors_;
  Eigen::VectorXd rho_;
  Eigen::MatrixXd jacobian_;
};

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_POSE_WORKER_HPP_
