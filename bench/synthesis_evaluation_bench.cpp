// SPDX-License-Identifier: Apache-2.0
// Layouts of the water-jet study per second: structure alone, and all stages with a work-zone map
// of 10,000 poses, on one thread and on all.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "kompono/plugin/registry.hpp"
#include "kompono/synthesis/run.hpp"

namespace {

namespace synthesis = kompono::synthesis;

struct Opened {
  std::optional<kompono::plugin::Registry> registry;
  std::optional<synthesis::StudySpace> space;
  synthesis::EvaluationSettings settings;

  Opened() {
    const std::array folders{std::filesystem::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins"};
    registry.emplace(kompono::plugin::Registry::Discover(folders));
    auto study = synthesis::ReadStudy(
        std::filesystem::path(KOMPONO_SOURCE_DIR) / "layouts/studies/so_waterjet.toml", *registry);
    if (!study) Leave(study.error());
    settings = synthesis::ReadEvaluationSettings(study->text, "so_waterjet.toml").value();
    auto built = synthesis::StudySpace::Build(std::move(*study), *registry);
    if (!built) Leave(built.error());
    space.emplace(std::move(*built));
  }

  [[noreturn]] static void Leave(const kompono::Diagnostics& problems) {
    std::fputs(kompono::RenderAll(problems, {}).c_str(), stderr);
    std::exit(1);
  }
};

const Opened& Study() {
  static const Opened opened;
  return opened;
}

void Structure(benchmark::State& state) {
  const Opened& study = Study();
  const synthesis::Evaluator evaluator(*study.space, study.settings);
  const synthesis::Enumeration all(study.space->space());
  std::int64_t layouts = 0;
  for (auto _ : state) {
    all.VisitAll([&](synthesis::Count index, const synthesis::Selection& selection) {
      const auto row =
          evaluator.Structure(study.space->At(selection, static_cast<std::uint64_t>(index)));
      benchmark::DoNotOptimize(row.metrics[synthesis::MetricId::kDriveCount]);
      ++layouts;
      return true;
    });
  }
  state.SetItemsProcessed(layouts);
}
BENCHMARK(Structure)->Name("evaluation/structure");

/// Shared results are thrown away before each pass.
void Full(benchmark::State& state) {
  const Opened& study = Study();
  const synthesis::Enumeration all(study.space->space());
  const std::array<synthesis::IndexRange, 1> whole{
      synthesis::IndexRange{0, static_cast<std::uint64_t>(all.count())}};
  std::int64_t layouts = 0;
  for (auto _ : state) {
    const synthesis::Evaluator evaluator(*study.space, study.settings);
    const synthesis::RunReport report = synthesis::Run(
        evaluator,
        all,
        whole,
        {.threads = static_cast<unsigned>(state.range(0)), .chunk = 8},
        [](const auto& /*range*/, const auto& /*rows*/) { return kompono::Diagnostics{}; });
    layouts += static_cast<std::int64_t>(report.progress.done);
  }
  state.SetItemsProcessed(layouts);
}
BENCHMARK(Full)->Name("evaluation/baseline")->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Full)->Name("evaluation/two")->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
