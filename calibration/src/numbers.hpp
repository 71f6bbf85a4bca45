// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_NUMBERS_HPP_
#define KOMPONO_CALIBRATION_SRC_NUMBERS_HPP_

#include "table.hpp"
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

namespace kompono::calibration {

/// The cell's number, whatever the locale; complains if it is none or not finite.
[[nodiscard]] inline std::optional<double> NumberOf(const Cell& cell, Complaints& complaints) {
  std::string_view text = cell.text;
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc::result_out_of_range || (error == std::errc() && !std::isfinite(number))) {
    complaints.Error("E0409", cell, fmt::format("'{}' is not a finite number", cell.text));
    return std::nullopt;
  }
  if (error != std::errc() || end != text.data() + text.size()) {
    const bool comma = text.find(',') != std::string_view::npos;
    complaints.Error("E0408",
                     cell,
                     fmt::format("'{}' is not a number", cell.text),
                     comma ? "write decimals with a point" : "");
    return std::nullopt;
  }
  return number;
}

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_NUMBERS_HPP_
