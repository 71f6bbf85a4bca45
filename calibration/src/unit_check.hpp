// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_UNIT_CHECK_HPP_
#define KOMPONO_CALIBRATION_SRC_UNIT_CHECK_HPP_

#include "columns.hpp"
#include "table.hpp"

#include "kompono/calibration/measurements.hpp"

namespace kompono::calibration {

/// Compares with the nominal machine: when the median error becomes more than 100 times smaller
/// after all lengths, all readings or all rotations are multiplied by a factor that a wrong unit
/// would explain, that is an error (E0415).
void CheckUnits(const kinematics::Machine& machine,
                const MeasurementSet& set,
                const TableRow& header,
                const Columns& columns,
                Complaints& complaints);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_UNIT_CHECK_HPP_
