// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/simulation.hpp"

#include "residuals.hpp"
#include "selection.hpp"
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "kompono/calibration/codes.hpp"
#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::calibration {
namespace {

constexpr int kTriesPerPose = 1000;

Diagnostic Complaint(const kinematics::Machine& machine,
                     std::string code,
                     std::string message,
                     std::string help = "") {
  return {.code = std::move(code),
          .file = machine.layout().file.string(),
          .message = std::move(message),
          .help = std::move(help)};
}

/// Draws readings of poses that the machine can take.
class PoseSampler {
 public:
  PoseSampler(const kinematics::Machine& machine, const SimulateOptions& options)
      : machine_(machine), theta_(machine.nominal()), random_(options.seed) {
    for (const kinematics::Coordinate& coordinate : machine.coordinates()) {
      std::optional<std::array<double, 2>> range;
      if (coordinate.lower && coordinate.upper) {
        range = std::array<double, 2>{*coordinate.lower, *coordinate.upper};
      }
      const auto wanted = options.region.find(coordinate.name);
      if (wanted != options.region.end()) range = wanted->second;
      ranges_.push_back(range);
    }
  }

  [[nodiscard]] Diagnostics Complaints(const SimulateOptions& options) const {
    Diagnostics complaints;
    std::vector<std::string> names;
    for (const auto& coordinate : machine_.coordinates()) names.push_back(coordinate.name);
    for (const auto& [name, range] : options.region) {
      if (machine_.FindCoordinate(name) < 0) {
        complaints.push_back(Complaint(machine_,
                                       codes::kBadSimulation.code,
                                       fmt::format("the machine has no coordinate '{}'", name),
                                       DidYouMean(name, names)));
      } else if (!(range[0] <= range[1])) {
        complaints.push_back(Complaint(
            machine_,
            codes::kBadSimulation.code,
            fmt::format("the range of {} runs from {:g} down to {:g}", name, range[0], range[1])));
      }
    }
    std::vector<std::string> without;
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      if (!ranges_[i]) without.push_back(names[i]);
    }
    if (!without.empty() && !AllDrivesLimited()) {
      complaints.push_back(Complaint(
          machine_,
          codes::kNoRange.code,
          fmt::format("poses cannot be drawn: no range is known of {}", fmt::join(without, ", ")),
          "give the ranges in the layout or as a region"));
    }
    return complaints;
  }

  /// Readings of a pose inside the ranges and drive limits, by the nominal machine; none if a
  /// thousand tries were in vain.
  std::optional<Eigen::VectorXd> Draw() {
    const bool by_coordinates =
        std::all_of(ranges_.begin(), ranges_.end(), [](const auto& r) { return r.has_value(); });
    for (int tries = 0; tries < kTriesPerPose; ++tries) {
      std::optional<Eigen::VectorXd> readings = by_coordinates ? FromCoordinates() : FromReadings();
      if (readings) return readings;
    }
    return std::nullopt;
  }

  double Noise(double sigma) { return sigma > 0.0 ? sigma * normal_(random_) : 0.0; }

 private:
  [[nodiscard]] bool AllDrivesLimited() const {
    return std::all_of(machine_.drives().begin(), machine_.drives().end(), [](const auto& drive) {
      return drive.lower && drive.upper;
    });
  }

  double Uniform(double lower, double upper) { return lower + (upper - lower) * uniform_(random_); }

  std::optional<Eigen::VectorXd> FromCoordinates() {
    Eigen::VectorXd z(static_cast<Eigen::Index>(ranges_.size()));
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      z[static_cast<Eigen::Index>(i)] = Uniform((*ranges_[i])[0], (*ranges_[i])[1]);
    }
    Eigen::VectorXd readings;
    Eigen::VectorXd reach;
    machine_.DrivesOf(z, theta_, &readings, &reach);
    for (Eigen::Index i = 0; i < readings.size(); ++i) {
      const kinematics::Drive& drive = machine_.drives()[static_cast<std::size_t>(i)];
      if (!std::isfinite(readings[i]) || reach[i] < 0.0 ||
          readings[i] < drive.lower.value_or(readings[i]) ||
          readings[i] > drive.upper.value_or(readings[i])) {
        return std::nullopt;
      }
    }
    return readings;
  }

  std::optional<Eigen::VectorXd> FromReadings() {
    Eigen::VectorXd readings(static_cast<Eigen::Index>(machine_.drives().size()));
    for (std::size_t i = 0; i < machine_.drives().size(); ++i) {
      const kinematics::Drive& drive = machine_.drives()[i];
      readings[static_cast<Eigen::Index>(i)] = Uniform(*drive.lower, *drive.upper);
    }
    const kinematics::Solution solution = machine_.Forward(readings);
    if (!solution.ok()) return std::nullopt;
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      const double value = solution.coordinates[static_cast<Eigen::Index>(i)];
      if (ranges_[i] && (value < (*ranges_[i])[0] || value > (*ranges_[i])[1])) {
        return std::nullopt;
      }
    }
    return readings;
  }

  const kinematics::Machine& machine_;
  Eigen::VectorXd theta_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  std::normal_distribution<double> normal_;
  std::vector<std::optional<std::array<double, 2>>> ranges_;
};

bool TwoReadings(MeasurementKind kind) {
  return kind == MeasurementKind::kDistance || kind == MeasurementKind::kRelative;
}

/// What the instrument says of true poses: what an error-free row would be off from one that
/// measured nothing but zeros.
void ReadInstrument(const SimulateOptions& options,
                    double noise,
                    const Pose<double>& X_WT,
                    const Pose<double>& X_WT_second,
                    const FixtureValues& fixtures,
                    PoseSampler& sampler,
                    Measurement* measurement) {
  const double sigma_mm = options.sigma_mm * noise;
  const bool turned = HasRotation(options.kind);
  const bool point = turned || options.kind == MeasurementKind::kPosition ||
                     options.kind == MeasurementKind::kHole;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool in_plane = options.kind != MeasurementKind::kHole || k < 2;
    if (point && in_plane && (turned || options.components[k])) measurement->position_mm[k] = 0.0;
  }
  const RowErrors zero = ErrorsOf(*measurement, X_WT, X_WT_second, fixtures);
  int at = 0;
  for (std::optional<double>& component : measurement->position_mm) {
    if (component) component = zero.value[at++] + sampler.Noise(sigma_mm);
  }
  if (!point) {
    measurement->value_mm = zero.value[0] + sampler.Noise(sigma_mm);
    const bool is_distance =
        options.kind == MeasurementKind::kDistance || options.kind == MeasurementKind::kBallBar;
    if (is_distance) measurement->value_mm = std::max(0.0, measurement->value_mm);
  }
  if (!turned) return;
  Eigen::Vector3d turn;
  for (double& component : turn) component = sampler.Noise(options.sigma_rad * noise);
  const Eigen::Matrix3d R = options.kind == MeasurementKind::kRelative
                                ? Eigen::Matrix3d(X_WT.R.transpose() * X_WT_second.R)
                                : X_WT.R;
  measurement->R_WT = RotationFromVector(turn) * R;
}

/// Gives row `i` the next of the targets and of the other fixtures.
void AssignFixtures(const std::vector<Fixture>& fixtures, int i, Measurement* measurement) {
  std::vector<int> targets;
  std::vector<int> others;
  for (std::size_t k = 0; k < fixtures.size(); ++k) {
    (fixtures[k].kind == FixtureKind::kTarget ? targets : others).push_back(static_cast<int>(k));
  }
  const auto row = static_cast<std::size_t>(i);
  if (!targets.empty()) measurement->target = targets[row % targets.size()];
  // The turns differ, so that every target meets every centre.
  if (!others.empty()) {
    measurement->fixture = others[(row / std::max<std::size_t>(1, targets.size())) % others.size()];
  }
}

Diagnostics CheckSimulation(const kinematics::Machine& nominal,
                            const kinematics::Machine& truth,
                            const Eigen::VectorXd& theta_true,
                            const SimulateOptions& options) {
  Diagnostics complaints;
  bool same = nominal.drives().size() == truth.drives().size();
  for (std::size_t i = 0; same && i < nominal.drives().size(); ++i) {
    same = nominal.drives()[i].name == truth.drives()[i].name;
  }
  if (!same) {
    complaints.push_back(Complaint(
        truth, codes::kOtherDrives.code, "the true machine has other drives than the nominal one"));
  }
  if (static_cast<std::size_t>(theta_true.size()) != truth.parameters().size()) {
    complaints.push_back(Complaint(truth,
                                   codes::kBadSimulation.code,
                                   fmt::format("the true geometry has {} numbers, the machine {}",
                                               theta_true.size(),
                                               truth.parameters().size())));
  }
  const bool any_component =
      options.components[0] || options.components[1] || options.components[2];
  if (options.count < 1 || options.held_out < 0 || options.sigma_mm < 0.0 ||
      options.sigma_rad < 0.0 || !any_component) {
    complaints.push_back(Complaint(nominal,
                                   codes::kBadSimulation.code,
                                   "at least one row and one component have to be measured, and no "
                                   "deviation can be negative"));
  }
  return complaints;
}

}  // namespace

Parsed<MeasurementSet> Simulate(const kinematics::Machine& nominal,
                                const kinematics::Machine& truth,
                                const Eigen::VectorXd& theta_true,
                                const SimulateOptions& options) {
  Diagnostics complaints = CheckSimulation(nominal, truth, theta_true, options);
  PoseSampler sampler(nominal, options);
  for (Diagnostic& complaint : sampler.Complaints(options)) {
    complaints.push_back(std::move(complaint));
  }
  if (!complaints.empty()) return tl::unexpected(std::move(complaints));
  MeasurementSet set;
  set.fixtures = options.fixtures;
  const Eigen::VectorXd values =
      AllNominal(truth, set).tail(3 * static_cast<Eigen::Index>(set.fixtures.size()));
  const FixtureValues fixtures{.fixtures = &set.fixtures, .value = values.data()};
  const int wanted = options.count + options.held_out;
  const auto go = [&](Eigen::VectorXd* readings) {
    kinematics::Solution there;
    for (int tries = 0; tries < kTriesPerPose; ++tries) {
      const std::optional<Eigen::VectorXd> drawn = sampler.Draw();
      if (!drawn) break;
      *readings = *drawn;
      there = truth.Forward(*drawn, theta_true, truth.home());
      if (there.ok()) break;
    }
    return there;
  };
  for (int i = 0; i < wanted; ++i) {
    Measurement measurement;
    measurement.kind = options.kind;
    measurement.row = i + 1;
    measurement.held_out = i >= options.count;
    const kinematics::Solution first = go(&measurement.readings);
    kinematics::Solution second = first;
    if (TwoReadings(options.kind)) second = go(&measurement.second_readings);
    if (!first.ok() || !second.ok()) {
      return tl::unexpected(Diagnostics{Complaint(
          nominal,
          codes::kFewPoses.code,
          fmt::format(
              "only {} of {} poses were found inside the ranges and drive limits", i, wanted),
          "make the region smaller or the drives' ranges larger")});
    }
    const double noise = measurement.held_out && options.held_out_without_noise ? 0.0 : 1.0;
    AssignFixtures(options.fixtures, i, &measurement);
    ReadInstrument(options, noise, first.X_WT, second.X_WT, fixtures, sampler, &measurement);
    if (options.sigma_mm > 0.0) measurement.sigma_mm = options.sigma_mm;
    if (options.sigma_rad > 0.0 && HasRotation(options.kind)) {
      measurement.sigma_rad = options.sigma_rad;
    }
    set.measurements.push_back(std::move(measurement));
  }
  return set;
}

Parsed<Eigen::VectorXd> ChangedGeometry(const kinematics::Machine& machine,
                                        const std::map<std::string, double>& changes) {
  Eigen::VectorXd theta = machine.nominal();
  Diagnostics complaints;
  for (const auto& [pattern, change] : changes) {
    bool any = false;
    for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
      if (!NamesParameter(machine, pattern, machine.parameters()[i].name)) continue;
      theta[static_cast<Eigen::Index>(i)] += change;
      any = true;
    }
    if (!any) complaints.push_back(UnknownPattern(machine, pattern, "change"));
  }
  if (!complaints.empty()) return tl::unexpected(std::move(complaints));
  return theta;
}

Eigen::VectorXd ManufacturedGeometry(const kinematics::Machine& machine,
                                     std::uint64_t seed,
                                     double scale) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd theta = machine.nominal();
  for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
    const double deviate = normal(random);
    theta[static_cast<Eigen::Index>(i)] += scale * machine.parameters()[i].tolerance * deviate;
  }
  return theta;
}

}  // namespace kompono::calibration
