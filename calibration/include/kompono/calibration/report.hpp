// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_REPORT_HPP_
#define KOMPONO_CALIBRATION_REPORT_HPP_

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

#include "kompono/calibration/identification.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"
#include "kompono/plugin/registry.hpp"

/// What a report looks like to people and to programs, and the calibrated layout.
namespace kompono::calibration {

struct TextOptions {
  bool residuals = false;  ///< a line for every row
};

/// Aligned tables; errors and deviations of angles in degrees, lengths in mm, small ones in µm.
[[nodiscard]] std::string RenderText(const CalibrationReport& report,
                                     const TextOptions& options = {});

/// Everything; lengths in mm and angles in deg, the unit in every name.
[[nodiscard]] nlohmann::json ToJson(const CalibrationReport& report);

/// The machine's layout file with the identified numbers in it and their deviations in its
/// [calibrated] table. `source`: what they were found from. Refuses a report that is not ok().
[[nodiscard]] Parsed<std::string> CalibratedLayout(const kinematics::Machine& machine,
                                                   const plugin::Registry& registry,
                                                   const CalibrationReport& report,
                                                   std::string_view source);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_REPORT_HPP_
