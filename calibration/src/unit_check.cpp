// SPDX-License-Identifier: Apache-2.0
#include "unit_check.hpp"

#include "residuals.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace kompono::calibration {
namespace {

constexpr std::size_t kMostRows = 60;   ///< enough for a median
constexpr double kSuspicious_mm = 1.0;  ///< smaller errors are not a matter of units
constexpr double kSuspicious_rad = 0.05;
constexpr double kGain = 100.0;

/// Factors on what the file says.
struct Factors {
  double lengths = 1.0;
  double readings = 1.0;
  double rotations = 1.0;
};

struct MedianError {
  double mm = std::numeric_limits<double>::infinity();
  double rad = std::numeric_limits<double>::infinity();
};

double Median(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void ScaleReadings(const kinematics::Machine& machine, double factor, Eigen::VectorXd* readings) {
  for (Eigen::Index i = 0; i < readings->size(); ++i) {
    if (!machine.drives()[static_cast<std::size_t>(i)].rotary) (*readings)[i] *= factor;
  }
}

MedianError ErrorWith(const kinematics::Machine& machine,
                      const MeasurementSet& set,
                      const Factors& factors) {
  std::vector<double> lengths;
  std::vector<double> angles;
  const Eigen::VectorXd theta = machine.nominal();
  const Eigen::VectorXd home = machine.home();
  const std::size_t stride = std::max<std::size_t>(1, set.measurements.size() / kMostRows);
  for (std::size_t i = 0; i < set.measurements.size(); i += stride) {
    Measurement measurement = set.measurements[i];
    ScaleReadings(machine, factors.readings, &measurement.readings);
    ScaleReadings(machine, factors.readings, &measurement.second_readings);
    measurement.value_mm *= factors.lengths;
    for (std::optional<double>& component : measurement.position_mm) {
      if (component) *component *= factors.lengths;
    }
    if (factors.rotations != 1.0) {
      measurement.R_WT = RotationFromVector(factors.rotations * RotationVector(measurement.R_WT));
    }
    const RowModel row(machine, measurement, 1.0, 1.0);
    const RowModel::Prediction prediction = row.Predict(theta, false);
    const double infinity = std::numeric_limits<double>::infinity();
    lengths.push_back(prediction.ok() ? row.Errors(prediction).LengthNorm() : infinity);
    if (measurement.kind == MeasurementKind::kPose) {
      angles.push_back(prediction.ok() ? row.Errors(prediction).AngleNorm() : infinity);
    }
  }
  return {Median(lengths), Median(angles)};
}

bool FarBetter(double before, double after, double suspicious) {
  return before > suspicious && std::isfinite(after) && after * kGain < before;
}

std::string Before(double error_mm) {
  return std::isfinite(error_mm) ? fmt::format("{:.4g} mm", error_mm)
                                 : std::string("readings without a pose");
}

struct Suspect {
  Factors factors;
  Role role;
  std::string what;
};

}  // namespace

void CheckUnits(const kinematics::Machine& machine,
                const MeasurementSet& set,
                const TableRow& header,
                const Columns& columns,
                Complaints& complaints) {
  if (set.measurements.empty()) return;
  const MedianError before = ErrorWith(machine, set, {});
  const auto complain = [&](Role role, std::string message, std::string help) {
    const int column = columns.Find(role);
    const Cell& cell = header.cells[static_cast<std::size_t>(std::max(0, column))];
    complaints.Error("E0415", cell, std::move(message), std::move(help));
  };
  if (before.mm > kSuspicious_mm) {
    const Role lengths = columns.Has(Role::kPosition) ? Role::kPosition : Role::kValue;
    const std::array<Suspect, 4> suspects{
        Suspect{{.lengths = 1e3}, lengths, "the measured lengths are in metres"},
        Suspect{{.lengths = 1e-3}, lengths, "the measured lengths are in micrometres"},
        Suspect{{.readings = 1e3}, Role::kReading, "the drive readings are in metres"},
        Suspect{{.readings = 1e-3}, Role::kReading, "the drive readings are in micrometres"}};
    for (const Suspect& suspect : suspects) {
      const MedianError after = ErrorWith(machine, set, suspect.factors);
      if (!FarBetter(before.mm, after.mm, kSuspicious_mm)) continue;
      const double factor = suspect.factors.lengths * suspect.factors.readings;
      complain(suspect.role,
               fmt::format("it looks as if {}: the median error against the nominal machine is {}, "
                           "and {:.4g} mm after a factor of {:g}",
                           suspect.what,
                           Before(before.mm),
                           after.mm,
                           factor),
               "give all lengths in millimetres, or switch the check of units off");
      return;
    }
  }
  if (before.rad > kSuspicious_rad && std::isfinite(before.rad) &&
      columns.Has(Role::kRotationVector)) {
    const double factor = std::numbers::pi / 180.0;
    const MedianError after = ErrorWith(machine, set, {.rotations = factor});
    if (after.rad * kGain < before.rad) {
      complain(Role::kRotationVector,
               "it looks as if the rotation vectors are in degrees",
               "give them in radians, or call the columns rx_deg, ry_deg, rz_deg");
    }
  }
}

}  // namespace kompono::calibration
