// SPDX-License-Identifier: Apache-2.0
#include "klipper_import.hpp"

#include "numbers.hpp"
#include "table.hpp"
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/klipper_delta.hpp"

namespace kompono::calibration {
namespace {

constexpr std::array<std::string_view, 8> kHeader{
    "kind", "value_mm", "s1_a_mm", "s1_b_mm", "s1_c_mm", "s2_a_mm", "s2_b_mm", "s2_c_mm"};

/// Numbers of cells [first, first + 3).
std::optional<Eigen::VectorXd> Travels(const TableRow& row,
                                       std::size_t first,
                                       Complaints& complaints) {
  Eigen::VectorXd travels(3);
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = NumberOf(row.cells[first + i], complaints);
    good = good && number;
    travels[static_cast<Eigen::Index>(i)] = number.value_or(0.0);
  }
  return good ? std::optional(travels) : std::nullopt;
}

std::optional<Measurement> ReadRow(const TableRow& row, Complaints& complaints) {
  if (row.cells.size() != kHeader.size()) {
    complaints.Add(
        Severity::kError,
        codes::kRagged.code,
        row.begin,
        row.end,
        fmt::format("the row has {} cells, the header {}", row.cells.size(), kHeader.size()),
        "empty cells need their separators too");
    return std::nullopt;
  }
  const Cell& kind = row.cells[0];
  Measurement measurement;
  measurement.line = row.line;
  if (kind.text == "distance") {
    measurement.kind = MeasurementKind::kDistance;
  } else if (kind.text == "height") {
    measurement.kind = MeasurementKind::kHeight;
  } else {
    complaints.Error(codes::kUnknownKind.code,
                     kind,
                     fmt::format("unknown kind of measurement '{}'", kind.text),
                     "known are: height, distance");
    return std::nullopt;
  }
  const std::optional<double> value = NumberOf(row.cells[1], complaints);
  const std::optional<Eigen::VectorXd> first = Travels(row, 2, complaints);
  std::optional<Eigen::VectorXd> second = Eigen::VectorXd();
  if (measurement.kind == MeasurementKind::kDistance) second = Travels(row, 5, complaints);
  if (!value || !first || !second) return std::nullopt;
  measurement.value_mm = *value;
  measurement.readings = *first;
  measurement.second_readings = *second;
  return measurement;
}

void GiveWeights(MeasurementSet* set) {
  double heights = 0.0;
  double distances = 0.0;
  for (const Measurement& m : set->measurements) {
    (m.kind == MeasurementKind::kHeight ? heights : distances) += 1.0;
  }
  const double height_weight = distances > 0.0 && heights > 0.0 ? distances / (0.5 * heights) : 1.0;
  for (Measurement& m : set->measurements) {
    m.sigma_mm = m.kind == MeasurementKind::kHeight ? 1.0 / std::sqrt(height_weight) : 1.0;
  }
  set->relative_weights = true;
}

/// What Klipper itself fits: without distances the arms stay.
std::vector<std::string> FreeOf(const MeasurementSet& set, const std::string& block) {
  std::vector<std::string> free{
      block + ".radius", block + ".azimuth[1]", block + ".azimuth[2]", block + ".*.zero"};
  for (const Measurement& m : set.measurements) {
    if (m.kind != MeasurementKind::kDistance) continue;
    free.push_back(block + ".strut[*]");
    break;
  }
  return free;
}

}  // namespace

bool IsKlipperDelta(std::string_view text) {
  const Table table = SplitTable(text);
  if (table.header.cells.size() != kHeader.size()) return false;
  for (std::size_t i = 0; i < kHeader.size(); ++i) {
    if (table.header.cells[i].text != kHeader[i]) return false;
  }
  return true;
}

Parsed<MeasurementSet> ImportKlipperDelta(std::string_view text,
                                          std::string_view file,
                                          const kinematics::Machine& machine,
                                          Diagnostics* notes) {
  Complaints complaints(text, file);
  MeasurementSet set{.file = std::string(file), .text = std::string(text)};
  set.origin = "klipper_delta";
  const Table table = SplitTable(text);
  if (machine.drives().size() != 3) {
    complaints.Add(Severity::kError,
                   codes::kNotThreeTowers.code,
                   table.header.begin,
                   table.header.end,
                   fmt::format("Klipper's delta runs have three towers, the machine has {} drives",
                               machine.drives().size()),
                   "take a layout with a linear_delta");
    return tl::unexpected(complaints.Take());
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    std::optional<Measurement> measurement = ReadRow(table.rows[i], complaints);
    if (!measurement) continue;
    measurement->row = static_cast<int>(i) + 1;
    set.measurements.push_back(std::move(*measurement));
  }
  if (table.rows.empty()) {
    complaints.ErrorWithoutPlace(codes::kNoRows.code, "the file has a header and no rows");
  }
  if (complaints.HasErrors()) return tl::unexpected(complaints.Take());
  GiveWeights(&set);
  const std::string& drive = machine.drives().front().name;
  set.suggested_free = FreeOf(set, drive.substr(0, drive.find('.')));
  if (notes != nullptr) {
    notes->push_back({.severity = Severity::kNote,
                      .code = codes::kKlipperRun.code,
                      .file = std::string(file),
                      .message = "a delta run of Klipper: readings are travels down from the "
                                 "end-stops, weights are Klipper's own"});
  }
  return set;
}

}  // namespace kompono::calibration
