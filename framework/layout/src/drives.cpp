// SPDX-License-Identifier: Apache-2.0
#include "reader.hpp"
#include "shape.hpp"

namespace kompono::layout {

Drive ReadDrive(const toml::table& table, bool rotary, const Units& units) {
  const double unit = units.Of(rotary);
  const auto scaled = [&table](std::string_view key, double factor) -> std::optional<double> {
    const auto value = NumberAt(table, key);
    return value ? std::optional(*value * factor) : std::nullopt;
  };
  Drive drive;
  if (const auto range = IntervalOf(table.get("range"))) {
    drive.lower = (*range)[0] * unit;
    drive.upper = (*range)[1] * unit;
  }
  drive.speed = scaled("speed", unit / kSecondsPerMinute);
  drive.acceleration = scaled("acceleration", unit);
  drive.stiffness = scaled("stiffness", kStiffnessFactor);
  drive.zero = scaled("zero", unit).value_or(0.0);
  drive.sign = SignOf(table.get("direction")).value_or(1);
  return drive;
}

}  // namespace kompono::layout
