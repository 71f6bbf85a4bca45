// SPDX-License-Identifier: Apache-2.0
// What an identification costs: a hexapod's 42 numbers from full poses, per pose, against the same
// from a thousand poses.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <span>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/calibration/simulation.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/linearisation.hpp"
#include "kompono/kinematics/machine.hpp"
#include "kompono/layout/layout.hpp"
#include "kompono/plugin/registry.hpp"

namespace {

using kompono::kinematics::Linearisation;
using kompono::kinematics::Machine;

constexpr double kSigmaMm = 0.005;
constexpr double kSigmaRad = 5e-6;

template <class T>
T Good(kompono::Parsed<T> parsed) {
  if (!parsed) {
    std::fputs(kompono::RenderAll(parsed.error(), {}).c_str(), stderr);
    std::exit(1);
  }
  return std::move(*parsed);
}

const Machine& Hexapod() {
  static const Machine machine = [] {
    const std::filesystem::path folder =
        std::filesystem::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins";
    static const auto registry = kompono::plugin::Registry::Discover(std::span(&folder, 1));
    const auto file =
        std::filesystem::path(KOMPONO_SOURCE_DIR) / "layouts/machines/hexapod_reference.toml";
    return Good(Machine::Build(Good(kompono::layout::ReadLayout(file, registry)), registry));
  }();
  return machine;
}

kompono::calibration::MeasurementSet Poses(std::size_t count) {
  const Machine& machine = Hexapod();
  std::mt19937_64 random(count);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  Linearisation linear(machine, {});
  linear.SetGeometry(kompono::calibration::ManufacturedGeometry(machine, 2, 5.0));
  kompono::calibration::MeasurementSet set;
  while (set.measurements.size() < count) {
    Eigen::VectorXd z = machine.home();
    for (int i = 0; i < 6; ++i) z[i] += (i < 3 ? 120.0 : 0.26) * uniform(random);
    if (!linear.At(z, Linearisation::Depth::kValues)) continue;
    kompono::calibration::Measurement m{.kind = kompono::calibration::MeasurementKind::kPose,
                                        .readings = linear.readings()};
    for (int i = 0; i < 3; ++i) {
      m.position_mm[static_cast<std::size_t>(i)] = linear.X_WT().p[i] + kSigmaMm * normal(random);
    }
    m.R_WT =
        kompono::RotationXYZ(
            kSigmaRad * normal(random), kSigmaRad * normal(random), kSigmaRad * normal(random)) *
        linear.X_WT().R;
    m.sigma_mm = kSigmaMm;
    m.sigma_rad = kSigmaRad;
    m.row = static_cast<int>(set.measurements.size()) + 1;
    set.measurements.push_back(std::move(m));
  }
  return set;
}

void Identify(benchmark::State& state, std::size_t count) {
  const kompono::calibration::MeasurementSet set = Poses(count);
  for (auto _ : state) {
    const auto report = kompono::calibration::Identify(Hexapod(), set);
    if (!report.ok()) state.SkipWithError("the identification failed");
    benchmark::DoNotOptimize(report.cost_after);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

BENCHMARK_CAPTURE(Identify, baseline, 1000)
    ->Name("identify/baseline")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Identify, of_60, 60)->Name("identify/60_poses")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Identify, of_10000, 10000)
    ->Name("identify/10000_poses")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Identify, of_100000, 100000)
    ->Name("identify/100000_poses")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
