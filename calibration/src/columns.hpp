// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_COLUMNS_HPP_
#define KOMPONO_CALIBRATION_SRC_COLUMNS_HPP_

#include "table.hpp"

#include <optional>
#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"

namespace kompono::calibration {

/// What a column of a measurement file holds.
enum class Role {
  kIgnored,
  kKind,
  kHeldOut,
  kApproach,
  kValue,
  kPosition,        ///< index 0..2
  kRotationVector,  ///< index 0..2
  kAngle,           ///< A, B, C: index 0..2
  kSigmaLength,
  kSigmaAngle,
  kReading,        ///< index of the drive
  kSecondReading,  ///< index of the drive
  kFixtureName,    ///< index: FixtureKind
  kTarget,         ///< index 0..2
  kCentre,         ///< index 0..2
  kPlaneNormal,    ///< index 0..2
  kPlaneOffset,
};

struct Column {
  Role role = Role::kIgnored;
  int index = 0;
  double to_internal = 1.0;  ///< factor to mm or rad
};

struct Columns {
  std::vector<Column> columns;  ///< as many as the header has cells
  [[nodiscard]] bool Has(Role role) const { return Count(role) > 0; }
  [[nodiscard]] int Count(Role role) const;
  /// Header position of a column, -1 if there is none.
  [[nodiscard]] int Find(Role role, int index = 0) const;
};

/// Understands the header; complains about what it cannot and about drives without a column.
[[nodiscard]] Columns UnderstandHeader(const TableRow& header,
                                       const kinematics::Machine& machine,
                                       Complaints& complaints);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_COLUMNS_HPP_
