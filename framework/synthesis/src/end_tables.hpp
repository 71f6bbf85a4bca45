// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_END_TABLES_HPP_
#define KOMPONO_SYNTHESIS_END_TABLES_HPP_

#include <array>
#include <string>

#include <toml++/toml.h>

#include "kompono/geometry/pose.hpp"
#include "kompono/synthesis/study.hpp"

namespace kompono::synthesis {

/// The tables of an end, each with a heading of its own, so that they may stand behind others.
[[nodiscard]] std::string TablesText(const toml::table& tables);

/// The tables of an end whose carrier's frame is turned: X_CE = R * X_E for mounts of units and
/// blocks and for axes. A leaf that has no table gets one.
[[nodiscard]] std::string TurnedTables(const EndChoice& end, const Matrix3<double>& R);

/// Angles a b c of Rx(a) Ry(b) Rz(c), rad.
[[nodiscard]] std::array<double, 3> AnglesOf(const Matrix3<double>& R);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_END_TABLES_HPP_
