// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPORTING_MECHANISM_PARTS_HPP_
#define KOMPONO_EXPORTING_MECHANISM_PARTS_HPP_

#include <optional>
#include <string>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// The bodies of one mechanism, told apart by how the points of its skeleton move.
namespace kompono::exporting {

/// What carries a point.
struct PointPart {
  enum class Carrier {
    kBase,
    kDrive,     ///< a carriage or crank: moves with one drive alone
    kPlatform,  ///< fixed to the platform
    kRing,      ///< circles round a point of the platform
  } carrier = Carrier::kBase;
  int drive = -1;
  Vector3<double> p_B = Vector3<double>::Zero();         ///< at home, in the mechanism's base
  Vector3<double> by_drive = Vector3<double>::Zero();    ///< carriage or crank: velocity per drive
  int ring = -1;                                         ///< the platform's point it circles round
  Vector3<double> ring_axis = Vector3<double>::UnitZ();  ///< in the platform
};

struct StrutPart {
  int from = 0, to = 0;  ///< points; `from` is on the base, a carriage or a crank
  int drive = -1;        ///< a pod: this drive is its length; -1: of constant length
  /// In the base; set where the strut stays in a plane and has to, on a hinge square to it.
  std::optional<Vector3<double>> hinge;
};

struct CrankPart {
  int hinge = 0, end = 0;  ///< points
  int drive = 0;
};

/// A tube of the platform in a cardan joint on the base: it swings about two axes that cross in the
/// joint, slides through it, and lets the platform turn about no third axis.
struct TubePart {
  int collar = 0;            ///< the base point in which it swings
  Vector3<double> first_B;   ///< the cardan's axis on the base
  Vector3<double> second_P;  ///< and the one on the platform's side
  Vector3<double> along_P;   ///< the tube's direction, in the platform
};

struct MechanismParts {
  const kinematics::Machine::BlockView* view = nullptr;
  Pose<double> X_BP;          ///< platform at home
  kinematics::VectorXd x, q;  ///< home
  std::vector<PointPart> points;
  std::vector<StrutPart> struts;
  std::vector<CrankPart> cranks;
  std::optional<TubePart> tube;
  bool free_platform = false;  ///< all six freedoms, the struts alone hold it
};

/// E0712 as in mjcf.hpp.
[[nodiscard]] Parsed<MechanismParts> PartsOf(const kinematics::Machine& machine,
                                             const kinematics::Machine::BlockView& view,
                                             const kinematics::VectorXd& theta);

}  // namespace kompono::exporting

#endif  // KOMPONO_EXPORTING_MECHANISM_PARTS_HPP_
