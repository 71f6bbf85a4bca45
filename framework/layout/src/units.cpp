// SPDX-License-Identifier: Apache-2.0
#include "units.hpp"

#include "shape.hpp"

#include <string_view>

namespace kompono::layout {
namespace {

/// 0 for a word that is no unit.
double LengthFactor(std::string_view unit) {
  if (unit == "m") return 1000.0;
  if (unit == "um") return 0.001;
  if (unit == "in") return 25.4;
  return unit == "mm" ? 1.0 : 0.0;
}

}  // namespace

Units UnitsOf(const toml::table& file) {
  Units units;
  const toml::table* table = TableAt(file, "units");
  if (table == nullptr) return units;
  const auto length = TextAt(*table, "length");
  if (length && LengthFactor(*length) > 0.0) {
    units.length = LengthFactor(*length);
    units.length_name = *length;
  }
  if (TextAt(*table, "angle") == "rad") {
    units.angle = 1.0;
    units.angle_name = "rad";
  }
  return units;
}

}  // namespace kompono::layout
