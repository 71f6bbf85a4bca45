// SPDX-License-Identifier: Apache-2.0
#include "columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::calibration {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

struct SplitName {
  std::string base;
  std::string unit;  ///< empty: none was written
};

/// "x_mm" -> x, mm. Units that are not read are recognised too, so that they can be refused by
/// name.
SplitName SplitUnit(std::string_view name) {
  constexpr std::array<std::string_view, 12> kUnits{
      "mm", "deg", "rad", "m", "cm", "um", "µm", "in", "inch", "mrad", "grad", "urad"};
  const std::size_t at = name.rfind('_');
  if (at != std::string_view::npos &&
      std::find(kUnits.begin(), kUnits.end(), name.substr(at + 1)) != kUnits.end()) {
    return {std::string(name.substr(0, at)), std::string(name.substr(at + 1))};
  }
  return {std::string(name), ""};
}

std::string ShortName(std::string_view drive) {
  return std::string(drive.substr(drive.rfind('.') + 1));
}

/// Names of the drives as columns may call them: in full, and short where only one has that name.
std::map<std::string, int> DriveNames(const std::vector<kinematics::Drive>& drives) {
  std::map<std::string, int> names;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const std::string last = ShortName(drives[i].name);
    const bool unique = std::count_if(drives.begin(), drives.end(), [&last](const auto& drive) {
                          return ShortName(drive.name) == last;
                        }) == 1;
    if (unique) names.emplace(last, static_cast<int>(i));
    names.emplace("drive." + drives[i].name, static_cast<int>(i));
  }
  for (std::size_t i = 0; i < drives.size(); ++i) names[drives[i].name] = static_cast<int>(i);
  return names;
}

bool MayBeIgnored(std::string_view name) {
  return name.starts_with("cmd_") || name == "comment" || name == "name" || name == "time" ||
         name == "row";
}

class HeaderReader {
 public:
  HeaderReader(const kinematics::Machine& machine, Complaints& complaints)
      : drives_(machine.drives()), names_(DriveNames(machine.drives())), complaints_(complaints) {}

  Columns Read(const TableRow& header) {
    Columns result;
    for (const Cell& cell : header.cells) {
      result.columns.push_back(Understand(cell));
      RefuseRepeated(result, cell);
    }
    NoteIgnored(header);
    ComplainOfMissingDrives(result, header);
    return result;
  }

 private:
  Column Understand(const Cell& cell) {
    const std::string_view name = cell.text;
    if (name.empty()) {
      complaints_.Error(codes::kUnknownColumn.code,
                        cell,
                        "a column without a name",
                        "name it, or take away the separator at the end of the lines");
      return {};
    }
    if (name == "kind") return {Role::kKind};
    if (name == "held_out") return {Role::kHeldOut};
    if (name == "approach") return {Role::kApproach};
    if (MayBeIgnored(name)) {
      ignored_.emplace_back(name);
      if (!first_ignored_) first_ignored_ = cell;
      return {};
    }
    for (const FixtureKind kind :
         {FixtureKind::kTarget, FixtureKind::kCentre, FixtureKind::kPlane, FixtureKind::kSheet}) {
      if (name == Name(kind)) return {Role::kFixtureName, static_cast<int>(kind)};
    }
    const bool second = name.starts_with("second.");
    const SplitName split = SplitUnit(second ? name.substr(7) : name);
    if (!second) {
      if (const std::optional<Column> measured = Measured(cell, split)) return *measured;
    }
    if (const auto drive = names_.find(split.base); drive != names_.end()) {
      return Reading(cell, split, drive->second, second);
    }
    complaints_.Error(codes::kUnknownColumn.code,
                      cell,
                      fmt::format("unknown column '{}'", name),
                      DidYouMean(name, KnownColumns()));
    return {};
  }

  std::optional<Column> Measured(const Cell& cell, const SplitName& split) {
    constexpr std::array<std::string_view, 3> kPosition{"x", "y", "z"};
    constexpr std::array<std::string_view, 3> kRotation{"rx", "ry", "rz"};
    constexpr std::array<std::string_view, 3> kAngles{"a", "b", "c"};
    constexpr std::array<std::string_view, 3> kTarget{"target_x", "target_y", "target_z"};
    constexpr std::array<std::string_view, 3> kCentre{"centre_x", "centre_y", "centre_z"};
    constexpr std::array<std::string_view, 3> kNormal{"plane_nx", "plane_ny", "plane_nz"};
    if (split.base == "plane_offset") return Length(cell, split, {Role::kPlaneOffset});
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (split.base == kTarget[at]) return Length(cell, split, {Role::kTarget, i});
      if (split.base == kCentre[at]) return Length(cell, split, {Role::kCentre, i});
      if (cell.text == kNormal[at]) return Column{Role::kPlaneNormal, i};
      if (split.base == kPosition[at]) return Length(cell, split, {Role::kPosition, i});
      if (split.base == kRotation[at]) return Angle(cell, split, {Role::kRotationVector, i}, "rad");
      if (split.base == kAngles[at]) return Angle(cell, split, {Role::kAngle, i}, "deg");
    }
    if (split.base == "value") return Length(cell, split, {Role::kValue});
    if (split.base != "sigma") return std::nullopt;
    if (split.unit == "rad" || split.unit == "deg") {
      return Angle(cell, split, {Role::kSigmaAngle}, "rad");
    }
    return Length(cell, split, {Role::kSigmaLength});
  }

  Column Length(const Cell& cell, const SplitName& split, Column column) {
    if (split.unit != "mm") ComplainOfUnit(cell, split, "a length", "mm");
    return column;
  }

  Column Angle(const Cell& cell, const SplitName& split, Column column, std::string_view usual) {
    if (split.unit == "deg") column.to_internal = kRadPerDeg;
    if (split.unit != "deg" && split.unit != "rad") {
      ComplainOfUnit(cell, split, "an angle", usual);
    }
    return column;
  }

  /// Short linear drives may go without a unit, as controllers write them.
  Column Reading(const Cell& cell, const SplitName& split, int drive, bool second) {
    const Column column{second ? Role::kSecondReading : Role::kReading, drive};
    if (drives_[static_cast<std::size_t>(drive)].rotary) return Angle(cell, split, column, "deg");
    return split.unit.empty() ? column : Length(cell, split, column);
  }

  void ComplainOfUnit(const Cell& cell,
                      const SplitName& split,
                      std::string_view quantity,
                      std::string_view usual) {
    const std::string message =
        split.unit.empty()
            ? fmt::format("column '{}' does not tell its unit", cell.text)
            : fmt::format(
                  "column '{}' is {} and cannot be in '{}'", cell.text, quantity, split.unit);
    complaints_.Error(codes::kUnit.code,
                      cell,
                      message,
                      fmt::format("write '{}{}_{}' and give the numbers in {}",
                                  cell.text.starts_with("second.") ? "second." : "",
                                  split.base,
                                  usual,
                                  usual == "mm"    ? "millimetres"
                                  : usual == "deg" ? "degrees"
                                                   : "radians"));
  }

  void RefuseRepeated(const Columns& result, const Cell& cell) {
    const Column& last = result.columns.back();
    if (last.role == Role::kIgnored) return;
    const auto same = [&last](const Column& other) {
      return other.role == last.role && other.index == last.index;
    };
    if (std::count_if(result.columns.begin(), result.columns.end(), same) > 1) {
      complaints_.Error(
          codes::kRepeatedColumn.code,
          cell,
          fmt::format("column '{}' gives again what an earlier column gives", cell.text),
          "remove one of them");
    }
  }

  void NoteIgnored(const TableRow& header) {
    if (!first_ignored_) return;
    complaints_.Add(Severity::kNote,
                    codes::kIgnoredColumns.code,
                    first_ignored_->begin,
                    first_ignored_->end,
                    fmt::format("{} of {} columns are not used: {}",
                                ignored_.size(),
                                header.cells.size(),
                                fmt::join(ignored_, ", ")));
  }

  void ComplainOfMissingDrives(const Columns& result, const TableRow& header) {
    for (const Role role : {Role::kReading, Role::kSecondReading}) {
      if (role == Role::kSecondReading && !result.Has(role)) continue;
      std::vector<std::string> missing;
      for (std::size_t i = 0; i < drives_.size(); ++i) {
        if (result.Find(role, static_cast<int>(i)) >= 0) continue;
        missing.push_back(fmt::format("{}{}_{}",
                                      role == Role::kSecondReading ? "second." : "",
                                      drives_[i].name,
                                      drives_[i].rotary ? "deg" : "mm"));
      }
      if (missing.empty()) continue;
      complaints_.Add(Severity::kError,
                      codes::kMissingColumn.code,
                      header.begin,
                      header.end,
                      fmt::format("no column for {} of the {} drives: {}",
                                  missing.size(),
                                  drives_.size(),
                                  fmt::join(missing, ", ")),
                      "every row needs the readings of all drives at which it was measured");
    }
  }

  [[nodiscard]] std::vector<std::string> KnownColumns() const {
    std::vector<std::string> known{
        "kind",        "value_mm",        "x_mm",        "y_mm",     "z_mm",
        "rx_rad",      "ry_rad",          "rz_rad",      "a_deg",    "b_deg",
        "c_deg",       "sigma_mm",        "sigma_rad",   "held_out", "target",
        "target_x_mm", "target_y_mm",     "target_z_mm", "centre",   "centre_x_mm",
        "centre_y_mm", "centre_z_mm",     "plane",       "plane_nx", "plane_ny",
        "plane_nz",    "plane_offset_mm", "sheet",       "approach"};
    for (const auto& [name, drive] : names_) {
      if (name.starts_with("drive.")) continue;
      const std::string unit = drives_[static_cast<std::size_t>(drive)].rotary ? "_deg" : "_mm";
      known.push_back(name + unit);
      known.push_back(fmt::format("second.{}{}", name, unit));
    }
    return known;
  }

  const std::vector<kinematics::Drive>& drives_;
  std::map<std::string, int> names_;
  Complaints& complaints_;
  std::vector<std::string> ignored_;
  std::optional<Cell> first_ignored_;
};

}  // namespace

int Columns::Count(Role role) const {
  return static_cast<int>(std::count_if(
      columns.begin(), columns.end(), [role](const Column& c) { return c.role == role; }));
}

int Columns::Find(Role role, int index) const {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].role == role && columns[i].index == index) return static_cast<int>(i);
  }
  return -1;
}

Columns UnderstandHeader(const TableRow& header,
                         const kinematics::Machine& machine,
                         Complaints& complaints) {
  return HeaderReader(machine, complaints).Read(header);
}

}  // namespace kompono::calibration
