// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_CROSS_VALIDATION_HPP_
#define KOMPONO_CALIBRATION_CROSS_VALIDATION_HPP_

#include <string>
#include <vector>

#include "kompono/calibration/identification.hpp"

namespace kompono::calibration {

/// RMS of one quantity over rows that took no part in the fit that predicts them. In-sample errors
/// are smaller than what a machine will show: these are not.
struct FoldedError {
  std::string quantity;
  bool angle = false;
  int count = 0;
  double rms_fitted = 0.0;    ///< of the fit to all rows
  double rms_held_out = 0.0;  ///< each row by the fit that did not see it
};

/// Fits `folds` times without every folds-th row. Rows that the file holds out stay out; rows that
/// are rejected in a fold do not count. Empty when a fold cannot be fitted.
[[nodiscard]] std::vector<FoldedError> CrossValidate(const kinematics::Machine& machine,
                                                     const MeasurementSet& set,
                                                     const IdentifyOptions& options,
                                                     int folds);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_CROSS_VALIDATION_HPP_
