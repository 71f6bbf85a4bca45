// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_KINEMATICS_MACHINE_HPP_
#define KOMPONO_KINEMATICS_MACHINE_HPP_

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/geometry/pose.hpp"
#include "kompono/layout/layout.hpp"
#include "kompono/plugin/registry.hpp"

/// A machine one can ask: virtual coordinates <-> tool pose <-> drives.
///
/// The formula's letters are the virtual coordinates z. A machine is a serial product over the
/// letters from workpiece to tool; each mechanism turns its own letters into its drives. So the
/// inverse problem is pose -> z -> drive readings and the forward one drive readings -> z -> pose
/// (SO 21-25: r_02 = M''^-1 M' r_01).
///
/// A coordinate is the displacement of the block that carries it, seen from its carrier: on the
/// workpiece side a positive coordinate moves the workpiece, so that the tool moves the other way
/// relative to it.
///
/// Frames: W workpiece datum, T tool station. All functions take the geometry θ as an argument
/// (default: the layout's), so that one machine serves identification, error budgets and threads.
/// mm, rad, s, N.
namespace kompono::kinematics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Coordinate {
  std::string name;  ///< "Z" for a plain axis, "drive.X" for a mechanism's
  char letter = 'X';
  bool rotary = false;
  double home = 0.0;
  std::optional<double> lower, upper;
};

struct Drive {
  std::string name;  ///< "Z" for a plain axis, "drive.q1" for a mechanism's
  bool rotary = false;
  std::optional<double> lower, upper;  ///< of the reading
  std::optional<double> speed, acceleration, stiffness;
};

/// One number of the machine's geometry.
struct Parameter {
  std::string name;  ///< "struts.base[1].x", "struts.mount.a", "struts.q1.zero", "Z.position.x",
                     ///< "open_base.c", "tool.length"
  double nominal = 0.0;    ///< mm or rad
  double tolerance = 0.0;  ///< manufacturing tolerance, one standard deviation; 0 if none is known
  bool angle = false;
  bool identifiable =
      true;  ///< free in an identification unless the layout or the user says otherwise
};

/// The numbers of a pose of the tool in the workpiece: X Y Z in mm, A B C in rad.
struct PoseNumbers {
  std::array<double, 6> value{};
};
[[nodiscard]] Pose<double> PoseFromNumbers(const PoseNumbers& numbers, layout::RotationOrder order);
/// At B = ±90° A and C merge; A is then 0.
[[nodiscard]] PoseNumbers NumbersFromPose(const Pose<double>& X_WT, layout::RotationOrder order);

/// The given components of a wanted pose; the others are free, but every one that the machine can
/// control keeps the value it has at home.
struct PoseTarget {
  std::array<std::optional<double>, 6> component{};  ///< X Y Z A B C; mm, rad
  layout::RotationOrder order = layout::RotationOrder::kXYZ;
};

enum class SolveStatus {
  kConverged,
  kOutOfReach,  ///< a drive cannot reach; `reach` tells which and by how much
  kNoConvergence,
  kSingular,   ///< det A or det B vanished on the way
  kAmbiguous,  ///< two poses within the limits have these readings, and the start is near to
               ///< neither
  kOtherAssemblyMode,  ///< a solution was found, but on another branch than the start: not reported
                       ///< as right
  kOverdetermined,     ///< the machine has too few coordinates for the given components
};
[[nodiscard]] std::string_view Name(SolveStatus status);

/// What one mechanism says about a pose (Gosselin-Angeles with A ẋ = B q̇: type 1 det B = 0, type 2
/// det A = 0).
struct Singularity {
  std::string block;
  int type = 0;         ///< 0 regular, 1, 2, 3
  double margin = 1.0;  ///< smallest singular value of A and B, rows scaled by their leg, angles by
                        ///< the mechanism's size
  double margin_a = 1.0, margin_b = 1.0;
  double det_a = 0.0;  ///< of the scaled A; its sign tells the side of a type 2 singularity
};

/// A solver's story.
struct Solution {
  SolveStatus status = SolveStatus::kNoConvergence;
  std::string message;   ///< for people: what happened and what may help; empty when converged
  VectorXd coordinates;  ///< z
  VectorXd drives;       ///< readings
  VectorXd reach;  ///< per drive mm² or rad², negative by how much it is out of reach; +inf for
                   ///< plain axes
  Pose<double> X_WT;
  int iterations = 0;
  double residual = 0.0;  ///< largest error left: mm, rad
  [[nodiscard]] bool ok() const { return status == SolveStatus::kConverged; }
};

/// One way in which a machine can stand with given drive readings.
struct AssemblyMode {
  VectorXd coordinates;  ///< z
  Pose<double> X_WT;
  /// Per mechanism of the chain its modes, each +1 or -1, as a layout writes them; empty where the
  /// mechanism has none.
  std::vector<std::vector<double>> modes;
  std::vector<double> det_a;  ///< per mechanism, of the scaled A: its sign tells the sides apart
  bool as_laid_out = false;   ///< the one that Forward gives from home
};

struct AssemblyModes {
  std::vector<AssemblyMode> found;  ///< at most kMost of them, the one of the layout first
  /// Every mechanism has closed forms, so that these are all; else they were found from `starts`
  /// random starts, and there may be more.
  bool complete = false;
  int starts = 0;
  static constexpr std::size_t kMost = 1024;
};

/// Twists are (v, ω): velocity of the tool point and angular velocity, both in W. 6 rows.
struct PoseDerivatives {
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_coordinates;  ///< 6 x number of coordinates
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_parameters;   ///< 6 x number of parameters
};

/// The tool pose for given drive readings, with everything identification needs.
struct MeasuredPose {
  SolveStatus status = SolveStatus::kNoConvergence;
  VectorXd coordinates;
  Pose<double> X_WT;
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_readings;  ///< 6 x number of drives
  Eigen::Matrix<double, 6, Eigen::Dynamic>
      by_parameters;  ///< total, closures kept (implicit function theorem)
};

class Linearisation;

class Machine {
 public:
  /// Creates the modules of the layout. Complaints have the codes of the registry (E02xx) or E07xx.
  [[nodiscard]] static Parsed<Machine> Build(layout::Layout layout,
                                             const plugin::Registry& registry);

  [[nodiscard]] const layout::Layout& layout() const;
  [[nodiscard]] const std::vector<Coordinate>& coordinates() const;
  [[nodiscard]] const std::vector<Drive>& drives() const;
  [[nodiscard]] const std::vector<Parameter>& parameters() const;
  [[nodiscard]] VectorXd nominal() const;                         ///< θ of the layout
  [[nodiscard]] VectorXd home() const;                            ///< z
  [[nodiscard]] int FindCoordinate(std::string_view name) const;  ///< index or -1
  [[nodiscard]] int FindDrive(std::string_view name) const;
  [[nodiscard]] int FindParameter(std::string_view name) const;

  /// The same machine seen from another workpiece and tool of a forked formula ("part2", "tool1");
  /// empty = the first.
  [[nodiscard]] Parsed<Machine> Between(std::string_view part, std::string_view tool) const;

  /// Tool pose at virtual coordinates z.
  [[nodiscard]] Pose<double> ToolPose(const VectorXd& z,
                                      const VectorXd& theta,
                                      PoseDerivatives* derivatives = nullptr) const;

  /// Drive readings at z; not a number where out of reach. Optional ∂reading/∂z (drives x
  /// coordinates).
  void DrivesOf(const VectorXd& z,
                const VectorXd& theta,
                VectorXd* readings,
                VectorXd* reach = nullptr,
                MatrixXd* by_coordinates = nullptr) const;

  /// z for given readings: closed form where a mechanism has one, else followed from `start`;
  /// what cannot be proven to lie on the start's assembly mode is refused.
  [[nodiscard]] Solution CoordinatesOf(const VectorXd& readings,
                                       const VectorXd& theta,
                                       const VectorXd& start) const;

  /// Inverse problem: pose -> z -> readings. Where several settings give the pose, the one nearest
  /// to `start`; if that breaks reach or a range, others are tried.
  [[nodiscard]] Solution Inverse(const PoseTarget& target,
                                 const VectorXd& theta,
                                 const VectorXd& start) const;
  [[nodiscard]] Solution Inverse(const PoseTarget& target) const {
    return Inverse(target, nominal(), home());
  }

  /// Forward problem: readings -> z -> pose.
  [[nodiscard]] Solution Forward(const VectorXd& readings,
                                 const VectorXd& theta,
                                 const VectorXd& start) const;
  [[nodiscard]] Solution Forward(const VectorXd& readings) const {
    return Forward(readings, nominal(), home());
  }

  /// All ways in which the machine can stand with these readings.
  [[nodiscard]] AssemblyModes AllForward(const VectorXd& readings, const VectorXd& theta) const;

  /// Forward with sensitivities; the start decides the branch.
  [[nodiscard]] MeasuredPose Measure(const VectorXd& readings,
                                     const VectorXd& theta,
                                     const VectorXd& start,
                                     bool with_derivatives = true) const;

  /// One entry per mechanism.
  [[nodiscard]] std::vector<Singularity> Singularities(const VectorXd& z,
                                                       const VectorXd& theta) const;

  /// Drawing and tables: named points of every mechanism and its links, in the frame of the
  /// workpiece-side base.
  struct SkeletonPoint {
    std::string name;  ///< "drive.slider1"
    Eigen::Vector3d p_M;
  };
  struct SkeletonLink {
    std::string from, to, kind;
  };
  struct SkeletonView {
    std::vector<SkeletonPoint> points;
    std::vector<SkeletonLink> links;
  };
  [[nodiscard]] SkeletonView Skeleton(const VectorXd& z, const VectorXd& theta) const;

  /// Where the blocks of this chain stand, in the frame of the workpiece-side base M: first the
  /// tool side from the base outward, then the workpiece side. For drawing and capabilities.
  struct FrameView {
    enum class Kind { kAxis, kMechanism, kEnd } kind = Kind::kAxis;
    std::string name;  ///< of the axis, block or end
    bool workpiece_side = false;
    Pose<double> X_MC;  ///< where the block sits: axis frame, mechanism's or unit's base
    Pose<double> X_MF;  ///< what it carries: beyond the motion, platform, or station
    std::vector<Pose<double>> stations;  ///< of a unit: all that it has, as its state leaves them
  };
  [[nodiscard]] std::vector<FrameView> Frames(const VectorXd& z, const VectorXd& theta) const;

  /// The mechanisms on this chain with their code, for those who record formulas or count links.
  struct BlockView {
    const layout::Block* block = nullptr;
    const plugin::ModuleDescription* description = nullptr;
    const plugin::Mechanism* code = nullptr;
    std::vector<int> coordinates;  ///< per local coordinate of the module its index in z
    int first_drive = 0;           ///< in drives()
    int first_parameter = 0;       ///< of the module's own numbers, in parameters()
    std::vector<double> modes;
  };
  [[nodiscard]] std::vector<BlockView> blocks() const;

  struct Impl;

 private:
  friend class Linearisation;
  explicit Machine(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace kompono::kinematics

#endif  // KOMPONO_KINEMATICS_MACHINE_HPP_
