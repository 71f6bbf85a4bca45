// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_LOCKED_SUSPECTS_HPP_
#define KOMPONO_CALIBRATION_SRC_LOCKED_SUSPECTS_HPP_

#include "pose_rows.hpp"
#include "selection.hpp"

namespace kompono::calibration {

/// Which numbers that were not free would explain the errors left at `theta`, by the derivatives
/// there: a score test, what the free numbers explain taken out. `rows`: of the set, those fitted.
[[nodiscard]] LockedSuspects SuspectLocked(const kinematics::Machine& machine,
                                           const MeasurementSet& set,
                                           const std::vector<std::size_t>& rows,
                                           const Selection& selection,
                                           const Eigen::VectorXd& theta,
                                           const RowNoise& noise);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_LOCKED_SUSPECTS_HPP_
