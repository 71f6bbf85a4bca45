// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_KLIPPER_IMPORT_HPP_
#define KOMPONO_CALIBRATION_SRC_KLIPPER_IMPORT_HPP_

#include "kompono/calibration/measurements.hpp"

namespace kompono::calibration {

/// Klipper's probe heights and distances with the weights of its own cost function: zw Σ(z-h)² +
/// Σ(d-d_measured)², zw = n_distances / (0.5 n_heights), 1 without distances.
[[nodiscard]] Parsed<MeasurementSet> ImportKlipperDelta(std::string_view text,
                                                        std::string_view file,
                                                        const kinematics::Machine& machine,
                                                        Diagnostics* notes);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_KLIPPER_IMPORT_HPP_
