// SPDX-License-Identifier: Apache-2.0
#include "unit_check.hpp"

#include "residuals.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr std::size_t kMostRows = 60;  ///< enough for a median
constexpr double kSuspiciousMm = 1.0;  ///< smaller errors are not a matter of units
constexpr double kSuspiciousRad = 0.05;
constexpr double kGain = 100.0;
constexpr double kNoPoseMm = 1000.0;  ///< what readings without a pose count as

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

/// Values of the set's fixtures.
Eigen::VectorXd FixturesOf(const MeasurementSet& set) {
  Eigen::VectorXd values(3 * static_cast<Eigen::Index>(set.fixtures.size()));
  Eigen::Index at = 0;
  for (const Fixture& fixture : set.fixtures) {
    for (const double value : fixture.value) values[at++] = value;
  }
  return values;
}

struct Sample {
  const Measurement* measurement;
  RowModel::Prediction prediction;
};

/// What the nominal machine says of some rows when linear readings are multiplied by `factor`.
/// Stops when more than half of them have no pose, for then nothing can be said.
std::vector<Sample> Predict(const kinematics::Machine& machine,
                            const MeasurementSet& set,
                            double factor) {
  std::vector<Sample> samples;
  const Eigen::VectorXd theta = machine.nominal();
  const std::size_t stride = set.measurements.size() / kMostRows + 1;
  const std::size_t rows = (set.measurements.size() + stride - 1) / stride;
  std::size_t failed = 0;
  for (std::size_t i = 0; i < set.measurements.size() && 2 * failed <= rows; i += stride) {
    Measurement scaled = set.measurements[i];
    ScaleReadings(machine, factor, &scaled.readings);
    ScaleReadings(machine, factor, &scaled.second_readings);
    const RowModel row(machine, scaled, 1.0, 1.0);
    samples.push_back({&set.measurements[i], row.Predict(theta, false)});
    failed += samples.back().prediction.ok() ? 0 : 1;
  }
  if (2 * failed > rows) samples.clear();
  return samples;
}

MedianError ErrorOf(const MeasurementSet& set,
                    const std::vector<Sample>& samples,
                    double lengths,
                    double rotations) {
  const Eigen::VectorXd values = FixturesOf(set);
  const FixtureValues fixtures{.fixtures = &set.fixtures, .value = values.data()};
  std::vector<double> errors;
  std::vector<double> angles;
  for (const Sample& sample : samples) {
    Measurement measurement = *sample.measurement;
    measurement.value_mm *= lengths;
    for (std::optional<double>& component : measurement.position_mm) {
      if (component) *component *= lengths;
    }
    if (rotations != 1.0) {
      measurement.R_WT = RotationFromVector(rotations * RotationVector(measurement.R_WT));
    }
    const bool ok = sample.prediction.ok();
    const double infinity = std::numeric_limits<double>::infinity();
    const RowErrors error = ErrorsOf(
        measurement, sample.prediction.first.X_WT, sample.prediction.second.X_WT, fixtures);
    errors.push_back(ok ? error.LengthNorm() : infinity);
    if (HasRotation(measurement.kind)) {
      angles.push_back(ok ? error.AngleNorm() : infinity);
    }
  }
  return {Median(errors), Median(angles)};
}

/// A unit that would take most readings out of the drives' ranges is no explanation.
bool WithinLimits(const kinematics::Machine& machine, const MeasurementSet& set, double factor) {
  std::size_t outside = 0;
  for (const Measurement& measurement : set.measurements) {
    for (std::size_t i = 0; i < machine.drives().size(); ++i) {
      const kinematics::Drive& drive = machine.drives()[i];
      const double reading =
          measurement.readings[static_cast<Eigen::Index>(i)] * (drive.rotary ? 1.0 : factor);
      if (reading >= drive.lower.value_or(reading) && reading <= drive.upper.value_or(reading)) {
        continue;
      }
      ++outside;
      break;
    }
  }
  return 2 * outside <= set.measurements.size();
}

/// The columns whose unit is doubted, and the factor that would make them millimetres.
struct Suspect {
  bool readings;
  double factor;
  std::string_view unit;
};

class UnitCheck {
 public:
  UnitCheck(const kinematics::Machine& machine,
            const MeasurementSet& set,
            const TableRow& header,
            const Columns& columns,
            Complaints& complaints)
      : machine_(machine), set_(set), header_(header), columns_(columns), complaints_(complaints) {}

  void Run() {
    const std::vector<Sample> samples = Predict(machine_, set_, 1.0);
    const MedianError before = ErrorOf(set_, samples, 1.0, 1.0);
    if (before.mm > kSuspiciousMm && DoubtLengths(samples, before.mm)) return;
    DoubtRotations(samples, before.rad);
  }

 private:
  bool DoubtLengths(const std::vector<Sample>& samples, double before_mm) {
    const double to_beat_mm = std::isfinite(before_mm) ? before_mm : kNoPoseMm;
    constexpr std::array<Suspect, 4> kSuspects{Suspect{false, 1e3, "metres"},
                                               Suspect{true, 1e3, "metres"},
                                               Suspect{false, 1e-3, "micrometres"},
                                               Suspect{true, 1e-3, "micrometres"}};
    for (const Suspect& suspect : kSuspects) {
      if (suspect.readings && !WithinLimits(machine_, set_, suspect.factor)) continue;
      const MedianError after =
          suspect.readings ? ErrorOf(set_, Predict(machine_, set_, suspect.factor), 1.0, 1.0)
                           : ErrorOf(set_, samples, suspect.factor, 1.0);
      if (!std::isfinite(after.mm) || after.mm * kGain > to_beat_mm) continue;
      const Role lengths = columns_.Has(Role::kPosition) ? Role::kPosition : Role::kValue;
      Complain(suspect.readings ? Role::kReading : lengths,
               fmt::format("it looks as if the {} are in {}: the median error against the nominal "
                           "machine is {}, and {:.4g} mm after a factor of {:g}",
                           suspect.readings ? "drive readings" : "measured lengths",
                           suspect.unit,
                           std::isfinite(before_mm) ? fmt::format("{:.4g} mm", before_mm)
                                                    : std::string("not to be had"),
                           after.mm,
                           suspect.factor),
               "give all lengths in millimetres, or switch the check of units off");
      return true;
    }
    return false;
  }

  void DoubtRotations(const std::vector<Sample>& samples, double before_rad) {
    if (!std::isfinite(before_rad) || before_rad < kSuspiciousRad ||
        !columns_.Has(Role::kRotationVector)) {
      return;
    }
    const MedianError after = ErrorOf(set_, samples, 1.0, std::numbers::pi / 180.0);
    if (after.rad * kGain > before_rad) return;
    Complain(Role::kRotationVector,
             "it looks as if the rotation vectors are in degrees",
             "give them in radians, or call the columns rx_deg, ry_deg, rz_deg");
  }

  void Complain(Role role, std::string message, std::string help) {
    std::size_t column = 0;
    while (column + 1 < columns_.columns.size() && columns_.columns[column].role != role) ++column;
    complaints_.Error(
        codes::kWrongScale.code, header_.cells[column], std::move(message), std::move(help));
  }

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  const TableRow& header_;
  const Columns& columns_;
  Complaints& complaints_;
};

}  // namespace

void CheckUnits(const kinematics::Machine& machine,
                const MeasurementSet& set,
                const TableRow& header,
                const Columns& columns,
                Complaints& complaints) {
  if (set.measurements.empty()) return;
  UnitCheck(machine, set, header, columns, complaints).Run();
}

}  // namespace kompono::calibration
