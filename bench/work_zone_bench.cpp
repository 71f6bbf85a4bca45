// SPDX-License-Identifier: Apache-2.0
// The work zone of a hexapod, pose by pose: reach and ranges of six pods, hand-written for doubles
// in this file, against the analysis on one core and on two, through the plugin's batches.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "kompono/analysis/dexterity.hpp"
#include "kompono/analysis/pose_judge.hpp"
#include "kompono/layout/layout.hpp"

namespace {

using kompono::analysis::CountGrid;
using kompono::analysis::Limits;
using kompono::analysis::PoseCount;
using kompono::analysis::PoseJudge;
using kompono::analysis::Region;
using kompono::kinematics::Machine;

/// As one would write it for one machine: joints known, rotation taken once per pose.
struct PlainHexapod {
  std::array<std::array<double, 3>, 6> base{}, platform{};

  PlainHexapod() {
    const double third = std::acos(-0.5);
    const double half = 10.0 * third / 120.0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t end = 0; end < 2; ++end) {
        const double sign = end == 0 ? -1.0 : 1.0;
        const double a = third * static_cast<double>(k) + half * sign;
        const double b = third * (static_cast<double>(k) + 0.5 * sign) - half * sign;
        base[2 * k + end] = {600.0 * std::cos(a), 600.0 * std::sin(a), 0.0};
        platform[2 * k + end] = {250.0 * std::cos(b), 250.0 * std::sin(b), 0.0};
      }
    }
  }

  [[nodiscard]] bool Inside(const double* x) const {
    const double ca = std::cos(x[3]), sa = std::sin(x[3]);
    const double cb = std::cos(x[4]), sb = std::sin(x[4]);
    const double cc = std::cos(x[5]), sc = std::sin(x[5]);
    const double R[3][3] = {{cb * cc, -cb * sc, sb},
                            {ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb},
                            {sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb}};
    for (std::size_t i = 0; i < 6; ++i) {
      double square = 0.0;
      for (std::size_t r = 0; r < 3; ++r) {
        const double leg = x[r] + R[r][0] * platform[i][0] + R[r][1] * platform[i][1] +
                           R[r][2] * platform[i][2] - base[i][r];
        square += leg * leg;
      }
      const double length = std::sqrt(square);
      if (length < 800.0 || length > 1200.0) return false;
    }
    return true;
  }
};

/// Joints by points, as measured machines have them.
std::string LayoutText() {
  std::string base;
  std::string platform;
  const PlainHexapod hexapod;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto add = [](std::string& text, const std::array<double, 3>& p) {
      char number[128];
      std::snprintf(number, sizeof number, "[%.17g, %.17g, %.17g], ", p[0], p[1], p[2]);
      text += number;
    };
    add(base, hexapod.base[i]);
    add(platform, hexapod.platform[i]);
  }
  std::string text =
      "kompono = 1\nname = \"Hexapod\"\nformula = \"part O (XYZABC):struts tool\"\n"
      "[block.struts]\nmodule = \"hexapod\"\n"
      "home = { X = 0, Y = 0, Z = 900, A = 2, B = 3, C = 4 }\n"
      "[block.struts.parameters]\nbase = [" +
      base + "]\nplatform = [" + platform + "]\n";
  for (int i = 1; i <= 6; ++i)
    text += "[block.struts.drive.q" + std::to_string(i) + "]\nrange = [800, 1200]\n";
  return text;
}

constexpr std::array<std::uint64_t, 3> kSteps{100, 100, 100};

const Machine& Hexapod() {
  static const std::array<std::filesystem::path, 1> folders{
      std::filesystem::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins"};
  static const auto registry = kompono::plugin::Registry::Discover(folders);
  static const std::unique_ptr<const Machine> machine = [] {
    auto layout = kompono::layout::ParseLayout(LayoutText(), "bench.toml", registry);
    if (!layout) {
      std::fputs(kompono::RenderAll(layout.error(), {}).c_str(), stderr);
      std::exit(1);
    }
    auto built = Machine::Build(std::move(*layout), registry);
    if (!built) std::exit(1);
    return std::make_unique<const Machine>(std::move(*built));
  }();
  return *machine;
}

Region Zone(const Machine& machine) {
  return {.z = machine.home(),
          .varied = {0, 1, 2},
          .lower = {-500.0, -500.0, 500.0},
          .upper = {500.0, 500.0, 1200.0}};
}

std::uint64_t PlainCount(const Region& region) {
  static const PlainHexapod hexapod;
  std::array<double, 6> x{};
  for (std::size_t i = 0; i < 6; ++i) x[i] = region.z[static_cast<Eigen::Index>(i)];
  const auto middle = [&region](std::size_t i, std::uint64_t k) {
    return region.lower[i] +
           (static_cast<double>(k) + 0.5) * region.Extent(i) / static_cast<double>(kSteps[i]);
  };
  std::uint64_t inside = 0;
  for (std::uint64_t i = 0; i < kSteps[0]; ++i) {
    x[0] = middle(0, i);
    for (std::uint64_t j = 0; j < kSteps[1]; ++j) {
      x[1] = middle(1, j);
      for (std::uint64_t k = 0; k < kSteps[2]; ++k) {
        x[2] = middle(2, k);
        benchmark::DoNotOptimize(x);
        inside += hexapod.Inside(x.data()) ? 1 : 0;
      }
    }
  }
  return inside;
}

constexpr std::int64_t Poses() {
  return static_cast<std::int64_t>(kSteps[0] * kSteps[1] * kSteps[2]);
}

void Plain(benchmark::State& state) {
  const Region region = Zone(Hexapod());
  std::uint64_t inside = 0;
  for (auto _ : state) benchmark::DoNotOptimize(inside = PlainCount(region));
  state.SetItemsProcessed(state.iterations() * Poses());
}

void Counted(benchmark::State& state, unsigned threads) {
  const Machine& machine = Hexapod();
  const auto judge = PoseJudge::Make(machine, machine.nominal(), Limits{});
  const Region region = Zone(machine);
  PoseCount count;
  for (auto _ : state) count = CountGrid(*judge, region, kSteps, false, {.threads = threads});
  if (count.inside != PlainCount(region)) state.SkipWithError("the two counts differ");
  state.SetItemsProcessed(state.iterations() * Poses());
}

/// Time and memory by the number of poses, that no more than a block of is held.
void Growth(benchmark::State& state) {
  const Machine& machine = Hexapod();
  const auto judge = PoseJudge::Make(machine, machine.nominal(), Limits{});
  const Region region = Zone(machine);
  const std::array<std::uint64_t, 3> steps{
      100, 100, static_cast<std::uint64_t>(state.range(0)) / 10000};
  PoseCount count;
  for (auto _ : state) count = CountGrid(*judge, region, steps, false, {.threads = 1});
  state.SetItemsProcessed(state.iterations() * state.range(0));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
  state.counters["inside"] = static_cast<double>(count.inside) / static_cast<double>(count.poses);
}

/// With the condition number of every pose: plain code would need a Jacobian and a decomposition.
void Conditioned(benchmark::State& state, unsigned threads) {
  const Machine& machine = Hexapod();
  const auto judge = PoseJudge::Make(machine, machine.nominal(), Limits{});
  const Region region = Zone(machine);
  const double length = kompono::analysis::CharacteristicLength(*judge, 0);
  constexpr std::array<std::uint64_t, 3> kFewer{50, 50, 50};
  kompono::analysis::DexterityField field;
  for (auto _ : state)
    field = DexterityOver(*judge, 0, length, region, kFewer, {.threads = threads});
  benchmark::DoNotOptimize(field);
  state.SetItemsProcessed(state.iterations() * 50 * 50 * 50);
}

/// One pose after the other: exact derivatives and Eigen's SVD.
void ConditionedOneByOne(benchmark::State& state) {
  const Machine& machine = Hexapod();
  const auto judge = PoseJudge::Make(machine, machine.nominal(), Limits{});
  const double length = kompono::analysis::CharacteristicLength(*judge, 0);
  kompono::kinematics::VectorXd z = machine.home();
  for (auto _ : state) {
    z[0] = std::fmod(z[0] + 1.0, 100.0);
    benchmark::DoNotOptimize(DexterityAt(*judge, 0, z, length).dexterity.condition);
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(ConditionedOneByOne)->Name("condition/baseline");
BENCHMARK_CAPTURE(Conditioned, one, 1)->Name("condition/one_core")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Conditioned, two, 2)
    ->Name("condition/two_cores")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(Plain)->Name("zone/baseline")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Counted, one, 1)->Name("zone/one_core")->Unit(benchmark::kMillisecond);
BENCHMARK(Growth)
    ->Name("zone/growth")
    ->RangeMultiplier(10)
    ->Range(100000, 100000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Counted, two, 2)
    ->Name("zone/two_cores")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
