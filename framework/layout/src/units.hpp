// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_UNITS_HPP_
#define KOMPONO_LAYOUT_UNITS_HPP_

#include <numbers>
#include <string>

#include <toml++/toml.h>

namespace kompono::layout {

/// Units of a file's numbers: factors to millimetres and radians, and the names for messages.
struct Units {
  double length = 1.0;
  double angle = std::numbers::pi / 180.0;
  std::string length_name = "mm";
  std::string angle_name = "deg";

  [[nodiscard]] double Of(bool rotary) const { return rotary ? angle : length; }
  [[nodiscard]] const std::string& NameOf(bool rotary) const {
    return rotary ? angle_name : length_name;
  }
};

/// What the file's `units` say; defaults for what they do not.
[[nodiscard]] Units UnitsOf(const toml::table& file);

inline constexpr double kSecondsPerMinute = 60.0;
/// N/µm to N/mm, and N·m/rad to N·mm/rad.
inline constexpr double kStiffnessFactor = 1000.0;

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_UNITS_HPP_
