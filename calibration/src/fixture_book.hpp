// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_FIXTURE_BOOK_HPP_
#define KOMPONO_CALIBRATION_SRC_FIXTURE_BOOK_HPP_

#include "columns.hpp"
#include "table.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kompono/calibration/measurements.hpp"

namespace kompono::calibration {

/// The numbers of one row before they become a measurement.
struct RowCells {
  const TableRow* row;
  std::vector<std::optional<double>> value;  ///< mm or rad; none where the cell is empty or wrong
  [[nodiscard]] bool Empty(int column) const {
    return column < 0 || row->cells[static_cast<std::size_t>(column)].text.empty();
  }
};

/// Targets, centres, planes and sheets that the rows of a file name. One that no row gives numbers
/// for is unknown.
class FixtureBook {
 public:
  FixtureBook(const Columns& columns, Complaints& complaints)
      : columns_(columns), complaints_(complaints) {}

  /// Finds or adds what the row names; false after a complaint.
  bool Read(const RowCells& cells, Measurement* measurement);
  [[nodiscard]] std::vector<Fixture> Take() { return std::move(fixtures_); }

 private:
  /// Index of the row's fixture of this kind, -1 if it has none, -2 after a complaint.
  int Find(const RowCells& cells, FixtureKind kind);
  [[nodiscard]] std::optional<Fixture> Numbers(const RowCells& cells, FixtureKind kind) const;

  const Columns& columns_;
  Complaints& complaints_;
  std::vector<Fixture> fixtures_;
  std::map<std::pair<FixtureKind, std::string>, int> index_;
};

/// Start values of unknown centres, planes and sheets from where the nominal machine stands at the
/// readings. Rows at whose readings it has no pose do not take part.
void GuessUnknownFixtures(const kinematics::Machine& machine, MeasurementSet* set);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_FIXTURE_BOOK_HPP_
