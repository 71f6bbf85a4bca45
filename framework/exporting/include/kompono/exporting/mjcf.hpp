// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPORTING_MJCF_HPP_
#define KOMPONO_EXPORTING_MJCF_HPP_

#include <string>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// Machines as models of the multibody program MuJoCo (MJCF): one of the few formats that have
/// closed loops.
namespace kompono::exporting {

/// The mechanisms of the machine at home, each in its own base: bodies for platform, carriages,
/// cranks and struts, joints between them, and a `connect` where a strut meets the platform.
/// Millimetres and radians; every body has unit mass.
///
/// What a point is follows from how it moves, not from its name: one that stands still is on the
/// base, one that moves with one drive alone is on a carriage (linear drive) or a crank (rotary
/// drive), one that is fixed to the platform is on it, and one that circles round a point of the
/// platform is on a ring. The platform has the joints of its letters, named "block.X" and so on, or
/// all six freedoms where it has six letters ("block.platform"), or those of a tube that swings and
/// slides in a cardan joint ("block.guide.first", ".second", ".slide"); drives are named like those
/// of the machine. Struts may turn about themselves, but one that ends on a ring is pinned to it.
///
/// E0712: a mechanism that cannot be told apart that way (struts that branch, a platform with
/// motions of its own).
[[nodiscard]] Parsed<std::string> Mjcf(const kinematics::Machine& machine,
                                       const kinematics::VectorXd& theta);

}  // namespace kompono::exporting

#endif  // KOMPONO_EXPORTING_MJCF_HPP_
