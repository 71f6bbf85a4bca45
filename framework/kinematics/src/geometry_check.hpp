// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_KINEMATICS_GEOMETRY_CHECK_HPP_
#define KOMPONO_KINEMATICS_GEOMETRY_CHECK_HPP_

#include "machine_impl.hpp"

namespace kompono::kinematics {

/// Refuses numbers that make no mechanism although each of them alone is allowed: rails without
/// length, legs that are one and the same, struts that do not reach (E0703 … E0707). Asks the
/// modules at home and at some sixty poses round it, so that every plugin is judged, and measures
/// everything against the mechanism's own size.
void CheckGeometry(const Model& model, Diagnostics* complaints);

}  // namespace kompono::kinematics

#endif  // KOMPONO_KINEMATICS_GEOMETRY_CHECK_HPP_
