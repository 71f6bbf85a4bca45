// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_INTERFACES_HPP_
#define KOMPONO_PLUGIN_INTERFACES_HPP_

#include <cstddef>
#include <cstdint>
#include <span>

#include "kompono/scalar/expression_node.h"

#define KOMPONO_CONTRACT_API __attribute__((visibility("default")))

/// The frozen C++ interfaces of contract 1. Plugin authors do not implement these by hand: they
/// derive from the bases in kompono/sdk, which make every instantiation from one set of templates.
///
/// All functions are const and noexcept and may be called from several threads at once: a module
/// keeps no state between calls, its geometry comes in with every call. Lengths are millimetres,
/// angles radians.
namespace kompono::plugin {

enum class Status : std::int32_t {
  kOk = 0,
  kUnsupported =
      1,  ///< the module does not offer this quantity (say, no closed-form forward kinematics)
  kBadSize = 2,    ///< a span has the wrong length
  kException = 3,  ///< the author's code threw; nothing can be said about the outputs
};

/// What a mechanism can be asked for. Numbers never change their meaning.
enum class Quantity : std::int32_t {
  kPlatform =
      0,        ///< x -> pose of the platform in the mechanism's base, 12 numbers: rows of [R | p]
  kDrives = 1,  ///< x -> drive positions; not a number where a drive cannot reach
  kReach = 2,  ///< x -> per drive a margin in mm² (or rad²): negative = out of reach by that much
  kClosure = 3,      ///< x, q -> loop residuals, zero on the mechanism
  kSkeleton = 4,     ///< x, q -> named points in the base frame, 3 numbers each
  kCoordinates = 5,  ///< q -> x in closed form
  kHome = 6,         ///< θ -> a pose well inside the work zone, start of iterations
};

struct MechanismShape {
  std::int32_t coordinates = 0;
  std::int32_t drives = 0;
  std::int32_t parameters = 0;  ///< numbers, a point counts three
  std::int32_t modes = 0;
  std::int32_t closures = 0;
  std::int32_t points = 0;
};

/// How many numbers a quantity has.
[[nodiscard]] constexpr std::size_t RowsOf(const MechanismShape& shape, Quantity quantity) {
  switch (quantity) {
    case Quantity::kPlatform:
      return 12;
    case Quantity::kDrives:
    case Quantity::kReach:
      return static_cast<std::size_t>(shape.drives);
    case Quantity::kClosure:
      return static_cast<std::size_t>(shape.closures);
    case Quantity::kSkeleton:
      return 3 * static_cast<std::size_t>(shape.points);
    case Quantity::kCoordinates:
    case Quantity::kHome:
      return static_cast<std::size_t>(shape.coordinates);
  }
  return 0;
}

/// Where a mechanism is evaluated. Spans that a quantity does not read may be empty.
struct MechanismState {
  std::span<const double> coordinates;  ///< x: mm, rad
  std::span<const double> drives;       ///< q: mm, rad
  std::span<const double> parameters;   ///< θ: mm, rad, in the order of the sidecar
  std::span<const double> modes;        ///< assembly modes, each +1 or -1
};

/// Where the answer goes. Derivatives are row-major, one row per value; an empty span is not
/// computed.
struct MechanismValues {
  std::span<double> values;
  std::span<double> by_coordinates;
  std::span<double> by_drives;
  std::span<double> by_parameters;
};

/// Many poses at once, structure of arrays: `coordinates[i][k]` is coordinate i of pose k.
struct MechanismBatch {
  std::size_t count = 0;
  const double* const* coordinates = nullptr;  ///< may be null for quantities that do not read x
  const double* const* drives = nullptr;       ///< may be null for quantities that do not read q
  std::span<const double> parameters;
  std::span<const double> modes;
  double* const* values = nullptr;  ///< values[i][k]: value i at pose k
};

/// What a forward solution is worth. Numbers never change their meaning.
enum class ForwardOutcome : std::int32_t {
  kProven = 0,           ///< the pose on the assembly mode of the start
  kBlocked = 1,          ///< det A vanishes on the way, or the drives do not fit one another
  kOtherMode = 2,        ///< the loops close, but with a leg on its other side (type 1 crossed)
  kStartOutOfReach = 3,  ///< the start itself is no pose of the mechanism
  kAmbiguous = 4,  ///< beyond a near singularity another pose, nearer than the start and within the
                   ///< limits, has the same drives
};

/// Forward kinematics of many poses: from `starts`, poses on the wanted assembly mode, to the poses
/// with the given drives. What cannot be proven to lie on the start's assembly mode is refused: its
/// coordinates are not numbers.
struct MechanismForward {
  std::size_t count = 0;
  const double* const* drives = nullptr;  ///< drives[i][k]
  const double* const* starts = nullptr;  ///< starts[i][k]; null: `start` for all
  std::span<const double> start;
  std::span<const double> parameters;
  std::span<const double> modes;
  std::span<const double> lower;  ///< limits of the coordinates, or empty
  std::span<const double> upper;
  double* const* coordinates = nullptr;  ///< may be the same as `starts`
  ForwardOutcome* outcomes = nullptr;    ///< one per pose
  double* reached = nullptr;  ///< per pose the part of the way that was proven, 0 to 1; may be null
  std::int32_t* iterations = nullptr;  ///< per pose the matrices factored; may be null
};

/// Receives a recorded formula. Variables are numbered x, then q, then θ, then modes. `roots` are
/// the values (then, if asked for, their derivatives by x, row-major).
struct FormulaReceiver {
  void* context = nullptr;
  void (*take)(void* context,
               const KomponoExpressionNode* nodes,
               std::size_t node_count,
               const std::int32_t* roots,
               std::size_t root_count) = nullptr;
};

/// "kompono.mechanism/1"
class KOMPONO_CONTRACT_API Mechanism {
 public:
  Mechanism() = default;
  Mechanism(const Mechanism&) = delete;
  Mechanism& operator=(const Mechanism&) = delete;
  virtual ~Mechanism();

  [[nodiscard]] virtual MechanismShape Shape() const noexcept = 0;
  [[nodiscard]] virtual Status Evaluate(Quantity quantity,
                                        const MechanismState& state,
                                        const MechanismValues& values) const noexcept = 0;
  [[nodiscard]] virtual Status EvaluateBatch(Quantity quantity,
                                             const MechanismBatch& batch) const noexcept = 0;
  [[nodiscard]] virtual Status Record(Quantity quantity,
                                      bool with_derivatives,
                                      const FormulaReceiver& receiver) const noexcept = 0;
  /// kUnsupported where the loops are not as many as the coordinates.
  [[nodiscard]] virtual Status Forward(const MechanismForward& batch) const noexcept = 0;
};

struct UnitShape {
  std::int32_t parameters = 0;
  std::int32_t stations =
      0;  ///< places with a pose: a spindle nose, each pocket of a turret, a jet's stand-off point
  std::int32_t states = 0;  ///< discrete positions (index of a turret); 1 if the unit does not move
};

/// "kompono.unit/1": a spindle, turret, jet head or holder; gives stations with poses.
class KOMPONO_CONTRACT_API Unit {
 public:
  Unit() = default;
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;
  virtual ~Unit();

  [[nodiscard]] virtual UnitShape Shape() const noexcept = 0;
  /// Pose of `station` in the unit's base, 12 numbers: rows of [R | p], at the discrete state
  /// `state`.
  [[nodiscard]] virtual Status StationPose(std::int32_t station,
                                           std::int32_t state,
                                           std::span<const double> parameters,
                                           std::span<double> pose,
                                           std::span<double> pose_by_parameters) const noexcept = 0;
};

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_INTERFACES_HPP_
