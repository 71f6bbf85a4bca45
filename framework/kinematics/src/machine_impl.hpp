// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_KINEMATICS_MACHINE_IMPL_HPP_
#define KOMPONO_KINEMATICS_MACHINE_IMPL_HPP_

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "kompono/kinematics/machine.hpp"

namespace kompono::kinematics {

using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A mechanism with the places of its numbers in θ, z and the readings.
struct MechanismModel {
  std::shared_ptr<const plugin::Mechanism> code;
  const plugin::ModuleDescription* description = nullptr;
  int block = 0;  ///< in the layout
  std::vector<double> modes;
  int theta_module = 0;  ///< first number in θ of the module's parameters
  int theta_mount = 0;
  int theta_zero = 0;
  int first_drive = -1;         ///< in the machine's readings; -1: not on this chain
  std::vector<int> coordinate;  ///< per local coordinate its index in z; empty: not on this chain
};

struct AxisModel {
  int axis = 0;         ///< in the layout
  int theta_frame = 0;  ///< position, rotation
  int theta_zero = 0;
  int drive = -1;
  int coordinate = -1;  ///< -1: not positioned, or not on this chain
};

struct EndModel {
  std::shared_ptr<const plugin::Unit> code;  ///< null: a bare frame
  int end = 0;                               ///< in the layout
  int station = 0;
  int theta_module = 0;
  int parameter_count = 0;
  int theta_mount = 0;
};

/// One factor of X_WT.
struct Factor {
  enum class Kind { kMechanism, kAxis, kEnd, kOpenBase } kind = Kind::kAxis;
  int index = 0;         ///< into mechanisms, axes or ends
  bool inverse = false;  ///< on the workpiece side
};

/// Everything that all chains of a layout share.
struct Model {
  layout::Layout layout;
  std::vector<plugin::ModuleDescription> descriptions;  ///< one per block
  std::vector<MechanismModel> mechanisms;
  std::vector<AxisModel> axes;
  std::vector<EndModel> ends;
  int theta_open_base = 0;
  std::vector<Parameter> parameters;
};

struct Machine::Impl {
  std::shared_ptr<const Model> model;
  // Of this chain; the same order as in the model, with the places in z and readings filled in.
  std::vector<MechanismModel> mechanisms;
  std::vector<AxisModel> axes;
  std::vector<Factor> factors;  ///< from W to T
  std::vector<Coordinate> coordinates;
  std::vector<Drive> drives;

  [[nodiscard]] const layout::Layout& layout() const { return model->layout; }
};

/// A value of a mechanism with derivatives; matrices that are not asked for stay empty.
struct Evaluation {
  plugin::Status status = plugin::Status::kOk;
  VectorXd values;
  MatrixXd by_coordinates, by_drives, by_parameters;
};
struct Wanted {
  bool by_coordinates = false, by_drives = false, by_parameters = false;
};
[[nodiscard]] Evaluation Evaluate(const MechanismModel& mechanism,
                                  plugin::Quantity quantity,
                                  const VectorXd& x,
                                  const VectorXd& q,
                                  const VectorXd& theta,
                                  Wanted wanted);

/// x of a mechanism from its drive coordinates: closed form, or followed from the start.
struct MechanismSolution {
  SolveStatus status = SolveStatus::kNoConvergence;
  std::string message;
  VectorXd x;
  int iterations = 0;
  double residual = 0.0;  ///< mm
};
[[nodiscard]] MechanismSolution SolveMechanism(const Machine::Impl& impl,
                                               const MechanismModel& mechanism,
                                               const VectorXd& q,
                                               const VectorXd& theta,
                                               const VectorXd& x_start);

/// A mechanism followed from many starts at once; refused ones are not numbers. One column per
/// start.
struct Followed {
  plugin::Status status = plugin::Status::kOk;
  MatrixXd x;
};
[[nodiscard]] Followed FollowFrom(const MechanismModel& mechanism,
                                  const VectorXd& q,
                                  const VectorXd& theta,
                                  const MatrixXd& x_starts);

/// Limits of a mechanism's own coordinates, infinite where the layout has none; both empty when it
/// has none at all.
struct LocalLimits {
  std::vector<double> lower, upper;
};
[[nodiscard]] LocalLimits LimitsOf(const Machine::Impl& impl, const MechanismModel& mechanism);

/// Whether the loops close at x with each leg on the side its mode says.
[[nodiscard]] bool ClosesOnItsModes(const MechanismModel& mechanism,
                                    const VectorXd& x,
                                    const VectorXd& q,
                                    const VectorXd& theta);

/// A with its rows scaled by their length, rotary columns by the mechanism's size, so that its
/// entries are pure numbers.
struct ScaledJacobian {
  MatrixXd A, B;
  VectorXd row_scale;      ///< closure units per mm
  double length_mm = 1.0;  ///< what a radian counts
};
[[nodiscard]] ScaledJacobian ScaleJacobians(const MechanismModel& mechanism,
                                            const MatrixXd& A,
                                            const MatrixXd& B);

[[nodiscard]] VectorXd LocalCoordinates(const Machine::Impl& impl,
                                        const MechanismModel& mechanism,
                                        const VectorXd& z);
[[nodiscard]] const layout::Block& BlockOf(const Machine::Impl& impl,
                                           const MechanismModel& mechanism);
[[nodiscard]] VectorXd DriveCoordinates(const Machine::Impl& impl,
                                        const MechanismModel& mechanism,
                                        const VectorXd& readings,
                                        const VectorXd& theta);

/// The coordinates of the plain axes from their readings.
void SetAxes(const Machine::Impl& impl,
             const VectorXd& readings,
             const VectorXd& theta,
             VectorXd& z);

[[nodiscard]] Pose<double> PlacementPose(const VectorXd& theta, int first);

/// X_WT with its twists by z and θ; see PoseDerivatives.
[[nodiscard]] Pose<double> ChainPose(const Machine::Impl& impl,
                                     const VectorXd& z,
                                     const VectorXd& theta,
                                     PoseDerivatives* derivatives);

}  // namespace kompono::kinematics

#endif  // KOMPONO_KINEMATICS_MACHINE_IMPL_HPP_
