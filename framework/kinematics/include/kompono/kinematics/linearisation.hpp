// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_KINEMATICS_LINEARISATION_HPP_
#define KOMPONO_KINEMATICS_LINEARISATION_HPP_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "kompono/geometry/pose.hpp"
#include "kompono/kinematics/machine.hpp"

namespace kompono::kinematics {

/// Tool pose and drive readings of one machine at many coordinates, with derivatives by the
/// coordinates and by chosen numbers of the geometry. What does not depend on the coordinates is
/// computed once per geometry, and nothing is allocated per pose: for those who ask a hundred
/// thousand times (identification). Not shareable between threads; make one for each.
class Linearisation {
 public:
  enum class Depth { kValues, kByCoordinates, kByParameters };
  using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  /// `parameters`: indices into θ whose derivatives are wanted, in the order of the columns.
  Linearisation(const Machine& machine, std::vector<int> parameters);
  ~Linearisation();
  Linearisation(Linearisation&& other) noexcept;
  Linearisation& operator=(Linearisation&& other) noexcept;
  Linearisation(const Linearisation&) = delete;
  Linearisation& operator=(const Linearisation&) = delete;

  void SetGeometry(const VectorXd& theta);

  /// Evaluates at z. False where a drive is out of reach or a number is not finite; the results
  /// must not be used then.
  [[nodiscard]] bool At(const Eigen::Ref<const VectorXd>& z, Depth depth);

  /// The tool's pose and its derivatives by the coordinates only; readings keep what they were.
  [[nodiscard]] bool PoseAt(const Eigen::Ref<const VectorXd>& z);

  // Results of the last At(); derivatives as deep as was asked for.
  [[nodiscard]] const Pose<double>& X_WT() const;
  [[nodiscard]] const VectorXd& readings() const;
  [[nodiscard]] const Twists& pose_by_coordinates() const;        ///< (v, ω) in W
  [[nodiscard]] const Twists& pose_by_parameters() const;         ///< at fixed coordinates
  [[nodiscard]] const MatrixXd& readings_by_coordinates() const;  ///< drives x coordinates
  [[nodiscard]] const MatrixXd& readings_by_parameters() const;   ///< at fixed coordinates

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace kompono::kinematics

#endif  // KOMPONO_KINEMATICS_LINEARISATION_HPP_
