// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_NULL_WORDS_HPP_
#define KOMPONO_CALIBRATION_SRC_NULL_WORDS_HPP_

#include "residuals.hpp"

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/identification.hpp"

namespace kompono::calibration {

/// Says of a change of θ without effect on the measurements which parameters it mixes up and which
/// further measurement would see it. The latter is computed, not guessed: does the change move the
/// tool in components that were not measured, or at other readings?
class NullWords {
 public:
  /// `parameters`: of θ, the fixtures' behind the machine's own.
  NullWords(const kinematics::Machine& machine,
            const std::vector<kinematics::Parameter>& parameters,
            const std::vector<RowModel*>& rows,
            const Eigen::VectorXd& theta);

  [[nodiscard]] NullDirection Describe(const Eigen::VectorXd& change) const;

 private:
  /// Largest motion of the tool in v and ω relative to what its parts move.
  struct Motion {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    Eigen::Vector3d w = Eigen::Vector3d::Zero();
    double v_parts = 0.0, w_parts = 0.0;
    void Add(const kinematics::MeasuredPose& pose, const Eigen::VectorXd& change);
    [[nodiscard]] bool Moves(int axis) const;
    [[nodiscard]] bool Turns() const;
    [[nodiscard]] bool Any() const { return Moves(0) || Moves(1) || Moves(2) || Turns(); }
  };

  /// The change without parts that hardly move the tool beside the others.
  [[nodiscard]] Eigen::VectorXd Essential(const Eigen::VectorXd& change) const;
  [[nodiscard]] std::string Remedy(const Eigen::VectorXd& change) const;
  [[nodiscard]] Motion MotionAt(const std::vector<kinematics::MeasuredPose>& poses,
                                const Eigen::VectorXd& change) const;
  /// Poses of some rows with the chosen drives moved a little.
  [[nodiscard]] std::vector<kinematics::MeasuredPose> Shifted(
      const std::vector<bool>& drives) const;
  void FindStillDrives();

  const kinematics::Machine& machine_;
  const std::vector<kinematics::Parameter>& parameters_;
  const std::vector<RowModel*>& rows_;
  const Eigen::VectorXd& theta_;
  std::vector<kinematics::MeasuredPose> poses_;  ///< at the measured readings
  struct StillDrive {
    std::string name;
    std::vector<kinematics::MeasuredPose> moved;
  };
  std::vector<StillDrive> still_;                    ///< drives with the same reading in all rows
  std::vector<kinematics::MeasuredPose> elsewhere_;  ///< with all drives moved
};

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_NULL_WORDS_HPP_
