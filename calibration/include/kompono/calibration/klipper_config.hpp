// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_KLIPPER_CONFIG_HPP_
#define KOMPONO_CALIBRATION_KLIPPER_CONFIG_HPP_

#include <string>
#include <string_view>

#include "kompono/calibration/klipper_delta.hpp"
#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::calibration {

/// What a printer.cfg of Klipper says of a linear delta.
struct KlipperConfig {
  KlipperGeometry geometry;
  int heights = 0, distances = 0;
  std::string run_csv;  ///< its probings as a delta run (IsKlipperDelta); empty if it has none
};

/// Reads [printer], [stepper_a] to [stepper_c] and [delta_calibrate], also where SAVE_CONFIG has
/// put them ("#*# "; what stands there counts more). Probed positions are steps of the motors
/// down from the end-stops and become mm with rotation_distance, microsteps, full steps and gears,
/// or the older step_distance.
/// E0465 for what is missing, of the wrong form, or no delta.
[[nodiscard]] Parsed<KlipperConfig> ReadKlipperConfig(std::string_view text, std::string_view file);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_KLIPPER_CONFIG_HPP_
