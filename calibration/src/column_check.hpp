// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_COLUMN_CHECK_HPP_
#define KOMPONO_CALIBRATION_SRC_COLUMN_CHECK_HPP_

#include "columns.hpp"
#include "table.hpp"

#include "kompono/calibration/measurements.hpp"

namespace kompono::calibration {

/// Compares a set with the nominal machine column by column and complains of what a change of
/// columns would explain: swapped columns (E0423), a negated one (E0426), one in another unit
/// (E0415). Rows that only a slip explains are refused (E0473) unless `keep_slips`; those far from
/// what the others suggest are named (W0427), and rows with the same readings whose measurements
/// differ (W0428).
void CheckColumns(const kinematics::Machine& machine,
                  const MeasurementSet& set,
                  const TableRow& header,
                  const Columns& columns,
                  bool keep_slips,
                  Complaints& complaints);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_COLUMN_CHECK_HPP_
