// SPDX-License-Identifier: Apache-2.0
#include "residuals.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "kompono/calibration/measurements.hpp"

namespace kompono::calibration {
namespace {

/// Which columns a set needs.
struct Needed {
  bool value = false, position = false, rotation = false, second = false;
  bool sigma_mm = false, sigma_rad = false, held_out = false, approach = false;
  std::array<bool, 4> fixture{};  ///< by kind
};

/// Kinds that measure one length.
bool IsSingle(MeasurementKind kind) {
  return kind == MeasurementKind::kHeight || kind == MeasurementKind::kDistance ||
         kind == MeasurementKind::kBallBar || kind == MeasurementKind::kPlane;
}

Needed ColumnsOf(const MeasurementSet& set) {
  Needed needed;
  for (const Measurement& m : set.measurements) {
    const bool single = IsSingle(m.kind);
    needed.value |= single;
    needed.position |= !single;
    needed.rotation |= HasRotation(m.kind);
    needed.second |= m.second_readings.size() > 0;
    needed.sigma_mm |= m.sigma_mm.has_value();
    needed.sigma_rad |= m.sigma_rad.has_value();
    needed.held_out |= m.held_out;
    needed.approach |= m.approach.has_value();
    for (const int index : {m.target, m.fixture}) {
      if (index < 0) continue;
      needed.fixture[static_cast<std::size_t>(set.fixtures[static_cast<std::size_t>(index)].kind)] =
          true;
    }
  }
  return needed;
}

/// The shortest text that reads back to the same number.
std::string Exact(double number) {
  return fmt::format("{}", number);
}
std::string Exact(const std::optional<double>& number) {
  return number ? Exact(*number) : std::string();
}

class Writer {
 public:
  Writer(const MeasurementSet& set, const kinematics::Machine& machine)
      : set_(set), drives_(machine.drives()), needed_(ColumnsOf(set)) {}

  std::string Header() {
    std::string line = "kind";
    if (needed_.value) line += ",value_mm";
    if (needed_.position) line += ",x_mm,y_mm,z_mm";
    if (needed_.rotation) line += ",rx_rad,ry_rad,rz_rad";
    if (needed_.sigma_mm) line += ",sigma_mm";
    if (needed_.sigma_rad) line += ",sigma_rad";
    if (needed_.held_out) line += ",held_out";
    if (needed_.approach) line += ",approach";
    if (Needs(FixtureKind::kTarget)) line += ",target,target_x_mm,target_y_mm,target_z_mm";
    if (Needs(FixtureKind::kCentre)) line += ",centre,centre_x_mm,centre_y_mm,centre_z_mm";
    if (Needs(FixtureKind::kPlane)) line += ",plane,plane_nx,plane_ny,plane_nz,plane_offset_mm";
    if (Needs(FixtureKind::kSheet)) line += ",sheet";
    for (const kinematics::Drive& drive : drives_) line += "," + ColumnOf(drive);
    for (const kinematics::Drive& drive : drives_) {
      if (needed_.second) line += ",second." + ColumnOf(drive);
    }
    return line + "\n";
  }

  std::string Row(const Measurement& m) {
    std::string line(Name(m.kind));
    const bool single = IsSingle(m.kind);
    if (needed_.value) line += "," + (single ? Exact(m.value_mm) : std::string());
    if (needed_.position) {
      for (const std::optional<double>& component : m.position_mm) line += "," + Exact(component);
    }
    if (needed_.rotation) {
      const Eigen::Vector3d rotation = RotationVector(m.R_WT);
      for (const double number : rotation) {
        line += "," + (HasRotation(m.kind) ? Exact(number) : std::string());
      }
    }
    if (needed_.sigma_mm) line += "," + Exact(m.sigma_mm);
    if (needed_.sigma_rad) line += "," + Exact(m.sigma_rad);
    if (needed_.held_out) line += m.held_out ? ",1" : ",0";
    if (needed_.approach) {
      line += m.approach ? fmt::format(",{}{}", m.approach->positive ? '+' : '-', m.approach->axis)
                         : ",";
    }
    line += FixtureCells(m, FixtureKind::kTarget) + FixtureCells(m, FixtureKind::kCentre) +
            FixtureCells(m, FixtureKind::kPlane) + FixtureCells(m, FixtureKind::kSheet);
    line += Readings(m.readings);
    if (needed_.second) {
      line += m.second_readings.size() > 0 ? Readings(m.second_readings)
                                           : std::string(drives_.size(), ',');
    }
    return line + "\n";
  }

 private:
  [[nodiscard]] bool Needs(FixtureKind kind) const {
    return needed_.fixture[static_cast<std::size_t>(kind)];
  }

  /// Name and, of a known one, numbers.
  [[nodiscard]] std::string FixtureCells(const Measurement& m, FixtureKind kind) const {
    if (!Needs(kind)) return {};
    const int index = kind == FixtureKind::kTarget ? m.target : m.fixture;
    const bool plane = kind == FixtureKind::kPlane;
    const std::size_t cells = kind == FixtureKind::kSheet ? 1 : plane ? 5 : 4;
    if (index < 0 || set_.fixtures[static_cast<std::size_t>(index)].kind != kind) {
      return std::string(cells, ',');
    }
    const Fixture& fixture = set_.fixtures[static_cast<std::size_t>(index)];
    std::string text = "," + fixture.name;
    if (!fixture.known) return text + std::string(cells - 1, ',');
    if (plane) {
      for (const double component : fixture.normal) text += "," + Exact(component);
      return text + "," + Exact(fixture.value[2]);
    }
    for (std::size_t i = 0; cells > 1 && i < 3; ++i) text += "," + Exact(fixture.value[i]);
    return text;
  }

  /// An axis called z would be taken for the measured z.
  static std::string ColumnOf(const kinematics::Drive& drive) {
    const bool may_be_mistaken = drive.name.find('.') == std::string::npos &&
                                 !std::isupper(static_cast<unsigned char>(drive.name.front()));
    return fmt::format(
        "{}{}_{}", may_be_mistaken ? "drive." : "", drive.name, drive.rotary ? "rad" : "mm");
  }

  static std::string Readings(const Eigen::VectorXd& readings) {
    std::string text;
    for (const double reading : readings) text += "," + Exact(reading);
    return text;
  }

  const MeasurementSet& set_;
  const std::vector<kinematics::Drive>& drives_;
  Needed needed_;
};

}  // namespace

std::string WriteMeasurements(const MeasurementSet& set,
                              const kinematics::Machine& machine,
                              const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) {
    std::string line = comment;
    std::replace(line.begin(), line.end(), '\n', ' ');
    text += "# " + line + "\n";
  }
  Writer writer(set, machine);
  text += writer.Header();
  for (const Measurement& measurement : set.measurements) text += writer.Row(measurement);
  return text;
}

}  // namespace kompono::calibration
