// SPDX-License-Identifier: Apache-2.0
#include "column_check.hpp"
#include "columns.hpp"
#include "fixture_book.hpp"
#include "klipper_import.hpp"
#include "numbers.hpp"
#include "residuals.hpp"
#include "table.hpp"
#include "unit_check.hpp"
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/klipper_delta.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::calibration {
namespace {

const std::vector<std::string>& KindNames() {
  static const std::vector<std::string> names{
      "height", "distance", "position", "pose", "ball_bar", "plane", "hole", "relative"};
  return names;
}

std::optional<MeasurementKind> KindOf(std::string_view name) {
  for (const MeasurementKind kind : {MeasurementKind::kHeight,
                                     MeasurementKind::kDistance,
                                     MeasurementKind::kPosition,
                                     MeasurementKind::kPose,
                                     MeasurementKind::kBallBar,
                                     MeasurementKind::kPlane,
                                     MeasurementKind::kHole,
                                     MeasurementKind::kRelative}) {
    if (Name(kind) == name) return kind;
  }
  return std::nullopt;
}

class RowReader {
 public:
  RowReader(const Columns& columns,
            const Table& table,
            const kinematics::Machine& machine,
            Complaints& complaints)
      : columns_(columns),
        table_(table),
        drives_(static_cast<int>(machine.drives().size())),
        order_(machine.layout().rotation_order),
        complaints_(complaints),
        book_(columns, complaints) {}

  [[nodiscard]] std::vector<Fixture> TakeFixtures() { return book_.Take(); }

  std::optional<Measurement> Read(const TableRow& row) {
    if (row.cells.size() != columns_.columns.size()) {
      complaints_.Add(
          Severity::kError,
          codes::kRagged.code,
          row.begin,
          row.end,
          fmt::format(
              "the row has {} cells, the header {}", row.cells.size(), columns_.columns.size()),
          "empty cells need their separators too");
      return std::nullopt;
    }
    good_ = true;
    const RowCells cells = ReadCells(row);
    Measurement measurement;
    measurement.line = row.line;
    const std::optional<MeasurementKind> kind = KindOfRow(cells);
    ReadReadings(cells, kind, measurement);
    if (kind) {
      measurement.kind = *kind;
      ReadMeasured(cells, measurement);
      good_ = book_.Read(cells, &measurement) && good_;
    }
    if (kind) ReadApproach(cells, &measurement);
    ReadSigmas(cells, measurement);
    ReadHeldOut(cells, measurement);
    if (!good_) return std::nullopt;
    return measurement;
  }

 private:
  RowCells ReadCells(const TableRow& row) {
    RowCells cells{&row, std::vector<std::optional<double>>(row.cells.size())};
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const Column& column = columns_.columns[i];
      const bool number = column.role != Role::kIgnored && column.role != Role::kKind &&
                          column.role != Role::kHeldOut && column.role != Role::kApproach &&
                          column.role != Role::kFixtureName;
      if (!number || row.cells[i].text.empty()) continue;
      cells.value[i] = NumberOf(row.cells[i], complaints_);
      if (cells.value[i]) {
        *cells.value[i] *= column.to_internal;
      } else {
        good_ = false;
      }
    }
    return cells;
  }

  std::optional<MeasurementKind> KindOfRow(const RowCells& cells) {
    const int column = columns_.Find(Role::kKind);
    if (!cells.Empty(column)) {
      const Cell& cell = cells.row->cells[static_cast<std::size_t>(column)];
      const std::optional<MeasurementKind> kind = KindOf(cell.text);
      if (!kind) {
        complaints_.Error(codes::kUnknownKind.code,
                          cell,
                          fmt::format("unknown kind of measurement '{}'", cell.text),
                          DidYouMean(cell.text, KindNames()));
        good_ = false;
      }
      return kind;
    }
    return GuessKind(cells);
  }

  /// What the filled cells leave no doubt about.
  std::optional<MeasurementKind> GuessKind(const RowCells& cells) {
    const bool value = Filled(cells, Role::kValue);
    const bool second = Filled(cells, Role::kSecondReading);
    const bool position = Filled(cells, Role::kPosition);
    const bool turned = Filled(cells, Role::kRotationVector) || Filled(cells, Role::kAngle);
    if (value && !position && !turned) {
      if (HasFixture(cells, FixtureKind::kCentre, Role::kCentre)) return MeasurementKind::kBallBar;
      if (HasFixture(cells, FixtureKind::kPlane, Role::kPlaneNormal)) {
        return MeasurementKind::kPlane;
      }
      return second ? MeasurementKind::kDistance : MeasurementKind::kHeight;
    }
    if (position && !value && second && turned) return MeasurementKind::kRelative;
    if (position && !value && !second) {
      if (HasFixture(cells, FixtureKind::kSheet, Role::kIgnored)) return MeasurementKind::kHole;
      return turned ? MeasurementKind::kPose : MeasurementKind::kPosition;
    }
    Refuse(cells,
           codes::kUnclearKind.code,
           value || position ? "the row may be of more than one kind"
                             : "the row does not tell what was measured",
           value || position
               ? "name it in a column 'kind': height, distance, position, pose, ball_bar, plane, "
                 "hole or relative"
               : "fill value_mm (height, distance) or x_mm, y_mm, z_mm (position, pose)");
    return std::nullopt;
  }

  [[nodiscard]] bool HasFixture(const RowCells& cells, FixtureKind kind, Role numbers) const {
    return !cells.Empty(columns_.Find(Role::kFixtureName, static_cast<int>(kind))) ||
           (numbers != Role::kIgnored && Filled(cells, numbers));
  }

  [[nodiscard]] bool Filled(const RowCells& cells, Role role) const {
    for (std::size_t i = 0; i < columns_.columns.size(); ++i) {
      if (columns_.columns[i].role == role && !cells.row->cells[i].text.empty()) return true;
    }
    return false;
  }

  void Refuse(const RowCells& cells, std::string code, std::string message, std::string help = "") {
    complaints_.Add(Severity::kError,
                    std::move(code),
                    cells.row->begin,
                    cells.row->end,
                    std::move(message),
                    std::move(help));
    good_ = false;
  }

  /// The cell's number; complains if the row's kind needs it and it is not there.
  double Needed(const RowCells& cells, Role role, int index, std::string_view what) {
    const int column = columns_.Find(role, index);
    if (cells.Empty(column)) {
      if (column < 0) {
        Refuse(cells, codes::kMissingValue.code, fmt::format("a {} and no column for it", what));
      } else {
        const Cell& cell = cells.row->cells[static_cast<std::size_t>(column)];
        complaints_.Error(codes::kMissingValue.code,
                          cell,
                          fmt::format("'{}' is empty, but the row is a {}",
                                      table_.header.cells[static_cast<std::size_t>(column)].text,
                                      what));
      }
      good_ = false;
      return 0.0;
    }
    return cells.value[static_cast<std::size_t>(column)].value_or(0.0);
  }

  void ReadReadings(const RowCells& cells,
                    std::optional<MeasurementKind> kind,
                    Measurement& measurement) {
    measurement.readings.resize(drives_);
    for (int i = 0; i < drives_; ++i) {
      if (columns_.Find(Role::kReading, i) < 0) return;  // the header's complaint says it all
      measurement.readings[i] = Needed(cells, Role::kReading, i, "measurement");
    }
    if (kind != MeasurementKind::kDistance && kind != MeasurementKind::kRelative) return;
    if (!columns_.Has(Role::kSecondReading)) {
      Refuse(cells,
             codes::kMissingValue.code,
             kind == MeasurementKind::kRelative
                 ? "a relative pose needs the readings at its second pose"
                 : "a distance needs the readings at its second point",
             "add columns second.<drive>_mm");
      return;
    }
    measurement.second_readings.resize(drives_);
    for (int i = 0; i < drives_; ++i) {
      if (columns_.Find(Role::kSecondReading, i) < 0) return;
      measurement.second_readings[i] = Needed(cells, Role::kSecondReading, i, Name(*kind));
    }
  }

  void ReadMeasured(const RowCells& cells, Measurement& measurement) {
    const std::string_view what = Name(measurement.kind);
    switch (measurement.kind) {
      case MeasurementKind::kHeight:
      case MeasurementKind::kDistance:
      case MeasurementKind::kBallBar:
      case MeasurementKind::kPlane: {
        measurement.value_mm = Needed(cells, Role::kValue, 0, what);
        const bool is_distance = measurement.kind == MeasurementKind::kDistance ||
                                 measurement.kind == MeasurementKind::kBallBar;
        if (is_distance && measurement.value_mm < 0.0) {
          complaints_.Error(codes::kOutOfRange.code,
                            CellOf(cells, Role::kValue),
                            "a distance cannot be negative");
          good_ = false;
        }
        return;
      }
      case MeasurementKind::kPosition:
      case MeasurementKind::kHole:
        ReadPosition(cells, measurement);
        return;
      case MeasurementKind::kPose:
      case MeasurementKind::kRelative:
        for (int i = 0; i < 3; ++i) {
          measurement.position_mm[static_cast<std::size_t>(i)] =
              Needed(cells, Role::kPosition, i, what);
        }
        ReadOrientation(cells, measurement);
        return;
    }
  }

  void ReadPosition(const RowCells& cells, Measurement& measurement) {
    for (int i = 0; i < 3; ++i) {
      const int column = columns_.Find(Role::kPosition, i);
      if (cells.Empty(column)) continue;
      measurement.position_mm[static_cast<std::size_t>(i)] =
          cells.value[static_cast<std::size_t>(column)];
    }
    if (!Filled(cells, Role::kPosition)) {
      Refuse(cells, codes::kMissingValue.code, "a position needs at least one of x_mm, y_mm, z_mm");
    }
  }

  void ReadOrientation(const RowCells& cells, Measurement& measurement) {
    const bool vector = Filled(cells, Role::kRotationVector);
    const bool angles = Filled(cells, Role::kAngle);
    if (vector == angles) {
      Refuse(cells,
             codes::kMissingValue.code,
             vector ? "the row gives its orientation twice" : "a pose needs an orientation",
             "fill either rx_rad, ry_rad, rz_rad or a_deg, b_deg, c_deg");
      return;
    }
    const Role role = vector ? Role::kRotationVector : Role::kAngle;
    Eigen::Vector3d numbers;
    for (int i = 0; i < 3; ++i) numbers[i] = Needed(cells, role, i, "pose");
    if (vector) {
      constexpr double kFullTurn = 2.0 * std::numbers::pi;
      if (numbers.norm() > kFullTurn) {
        complaints_.Error(
            codes::kWrongScale.code,
            CellOf(cells, role),
            "the rotation vector is longer than a full turn, as if it were in degrees",
            "give it in radians, or call the columns rx_deg, ry_deg, rz_deg");
        good_ = false;
      }
      measurement.R_WT = RotationFromVector(numbers);
    } else {
      kinematics::PoseNumbers pose;
      for (std::size_t i = 0; i < 3; ++i) {
        pose.value[i + 3] = numbers[static_cast<Eigen::Index>(i)];
      }
      measurement.R_WT = kinematics::PoseFromNumbers(pose, order_).R;
    }
  }

  void ReadSigmas(const RowCells& cells, Measurement& measurement) {
    measurement.sigma_mm = Sigma(cells, Role::kSigmaLength);
    measurement.sigma_rad = Sigma(cells, Role::kSigmaAngle);
  }

  std::optional<double> Sigma(const RowCells& cells, Role role) {
    const int column = columns_.Find(role);
    if (cells.Empty(column)) return std::nullopt;
    const std::optional<double> sigma = cells.value[static_cast<std::size_t>(column)];
    if (sigma && *sigma <= 0.0) {
      complaints_.Error(codes::kOutOfRange.code,
                        CellOf(cells, role),
                        "a standard deviation must be greater than 0",
                        "leave the cell empty if it is not known");
      good_ = false;
    }
    return sigma;
  }

  void ReadHeldOut(const RowCells& cells, Measurement& measurement) {
    const int column = columns_.Find(Role::kHeldOut);
    if (cells.Empty(column)) return;
    const Cell& cell = CellOf(cells, Role::kHeldOut);
    if (cell.text == "1" || cell.text == "yes" || cell.text == "true") {
      measurement.held_out = true;
    } else if (cell.text != "0" && cell.text != "no" && cell.text != "false") {
      complaints_.Error(codes::kNotYesOrNo.code,
                        cell,
                        fmt::format("'{}' is neither yes nor no", cell.text),
                        "write 1 for a row that is kept out of the fit, else 0 or nothing");
      good_ = false;
    }
  }

  /// "+X", "-C"; also with the sign behind.
  void ReadApproach(const RowCells& cells, Measurement* measurement) {
    const int column = columns_.Find(Role::kApproach);
    if (cells.Empty(column)) return;
    const Cell& cell = CellOf(cells, Role::kApproach);
    const auto refuse = [&](std::string message, std::string help) {
      complaints_.Error(codes::kBadApproach.code, cell, std::move(message), std::move(help));
      good_ = false;
    };
    constexpr std::string_view kAxes = "XYZABC";
    const std::string_view text = cell.text;
    const std::size_t sign = text.find_first_of("+-");
    const std::size_t axis = text.find_first_of(kAxes);
    if (text.size() != 2 || sign == std::string_view::npos || axis == std::string_view::npos) {
      refuse(fmt::format("'{}' is no direction of approach", text),
             "write +X or -X for a position approached along X of the datum, likewise Y, Z and the "
             "turns A, B, C; nothing where it does not matter");
      return;
    }
    const Approach approach{.axis = text[axis], .positive = text[sign] == '+'};
    const MeasurementKind kind = measurement->kind;
    const bool measured =
        approach.rotary()
            ? kind == MeasurementKind::kPose
            : (kind == MeasurementKind::kHeight && approach.axis == 'Z') ||
                  ((kind == MeasurementKind::kPosition || kind == MeasurementKind::kPose) &&
                   measurement->position_mm[static_cast<std::size_t>(approach.component())]);
    if (!measured) {
      refuse(
          fmt::format("the row was approached along {} and does not measure {}",
                      approach.axis,
                      approach.rotary() ? "an orientation"
                                        : fmt::format("{}", static_cast<char>(approach.axis + 32))),
          "leave the cell empty, or fill the axis' column");
      return;
    }
    measurement->approach = approach;
  }

  [[nodiscard]] const Cell& CellOf(const RowCells& cells, Role role) const {
    return cells.row->cells[static_cast<std::size_t>(columns_.Find(role))];
  }

  const Columns& columns_;
  const Table& table_;
  int drives_;
  layout::RotationOrder order_;
  Complaints& complaints_;
  FixtureBook book_;
  bool good_ = true;
};

/// A row typed twice counts twice in the fit without anybody wanting it.
void WarnOfRepeatedRows(std::string_view text,
                        const Table& table,
                        const Columns& columns,
                        Complaints& complaints) {
  std::map<std::string_view, int> seen;
  const int approach = columns.Find(Role::kApproach);
  for (const TableRow& row : table.rows) {
    // Approached again on purpose; a coarse instrument says the same.
    const bool on_purpose = approach >= 0 &&
                            static_cast<std::size_t>(approach) < row.cells.size() &&
                            !row.cells[static_cast<std::size_t>(approach)].text.empty();
    if (on_purpose) continue;
    const std::string_view whole = text.substr(row.begin, row.end - row.begin);
    const auto [first, is_new] = seen.emplace(whole, row.line);
    if (is_new) continue;
    complaints.Add(Severity::kWarning,
                   codes::kRepeatedRow.code,
                   row.begin,
                   row.end,
                   fmt::format("the row is the same as line {}", first->second),
                   "it counts twice; remove it unless it was really measured twice");
  }
}

}  // namespace

std::string_view Name(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::kHeight:
      return "height";
    case MeasurementKind::kDistance:
      return "distance";
    case MeasurementKind::kPosition:
      return "position";
    case MeasurementKind::kBallBar:
      return "ball_bar";
    case MeasurementKind::kPlane:
      return "plane";
    case MeasurementKind::kHole:
      return "hole";
    case MeasurementKind::kRelative:
      return "relative";
    case MeasurementKind::kPose:
      break;
  }
  return "pose";
}

std::size_t MeasurementSet::Count(bool held_out) const {
  std::size_t count = 0;
  for (const Measurement& measurement : measurements) {
    count += measurement.held_out == held_out ? 1 : 0;
  }
  return count;
}

Parsed<MeasurementSet> ParseMeasurements(std::string_view text,
                                         std::string_view file,
                                         const kinematics::Machine& machine,
                                         const ReadOptions& options,
                                         Diagnostics* notes) {
  if (Diagnostics refused = JudgeText(text, file); !refused.empty()) {
    return tl::unexpected(std::move(refused));
  }
  if (IsKlipperDelta(text)) return ImportKlipperDelta(text, file, machine, notes);
  Complaints complaints(text, file);
  const Table table = SplitTable(text);
  MeasurementSet set{.file = std::string(file), .text = std::string(text)};
  if (table.header.cells.empty() || table.rows.empty()) {
    complaints.ErrorWithoutPlace(
        codes::kNoRows.code,
        table.header.cells.empty() ? "the file is empty" : "the file has a header and no rows",
        "a header line with the columns' names, then one line for each measurement");
    return tl::unexpected(complaints.Take());
  }
  const Columns columns = UnderstandHeader(table.header, machine, complaints);
  if (!columns.Has(Role::kValue) && !columns.Has(Role::kPosition)) {
    complaints.Add(Severity::kError,
                   codes::kMissingColumn.code,
                   table.header.begin,
                   table.header.end,
                   "no column for what was measured",
                   "value_mm for heights and distances; x_mm, y_mm, z_mm for positions and poses");
  }
  if (!complaints.HasErrors()) {
    RowReader reader(columns, table, machine, complaints);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      std::optional<Measurement> measurement = reader.Read(table.rows[i]);
      if (!measurement) continue;
      measurement->row = static_cast<int>(i) + 1;
      set.measurements.push_back(std::move(*measurement));
    }
    set.fixtures = reader.TakeFixtures();
    GuessUnknownFixtures(machine, &set);
    WarnOfRepeatedRows(text, table, columns, complaints);
  }
  if (!complaints.HasErrors() && options.check_units) {
    CheckUnits(machine, set, table.header, columns, complaints);
    if (!complaints.HasErrors()) {
      CheckColumns(machine, set, table.header, columns, options.keep_slips, complaints);
    }
  }
  const bool refused = complaints.HasErrors();
  Diagnostics said = complaints.Take();
  if (refused) return tl::unexpected(std::move(said));
  if (notes != nullptr) notes->insert(notes->end(), said.begin(), said.end());
  return set;
}

Parsed<MeasurementSet> ReadMeasurements(const std::filesystem::path& file,
                                        const kinematics::Machine& machine,
                                        const ReadOptions& options,
                                        Diagnostics* notes) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf())) {
    const bool empty = stream.is_open() && std::filesystem::is_regular_file(file);
    return tl::unexpected(Diagnostics{
        {.code = empty ? codes::kNoRows.code : codes::kCannotRead.code,
         .file = file.string(),
         .message = empty ? "the file is empty" : "cannot read the measurement file",
         .help = empty ? "a header line with the columns' names, then one line for each measurement"
                       : ""}});
  }
  return ParseMeasurements(text.str(), file.string(), machine, options, notes);
}

}  // namespace kompono::calibration
