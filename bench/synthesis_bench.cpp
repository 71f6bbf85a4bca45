// SPDX-License-Identifier: Apache-2.0
// Counting and walking of morphological spaces, and the Pareto front. Spaces are of the kind that
// 12 features of 6 alternatives with 14.4 % forbidden pairs are; random numbers are seeded.
#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <vector>

#include "kompono/synthesis/front.hpp"
#include "kompono/synthesis/space.hpp"

namespace kompono::synthesis {
namespace {

Space RandomSpace(int features, int alternatives, double density, int window) {
  Space space;
  const int rule = space.Add(RuleTitle{.name = "random"});
  for (int f = 0; f < features; ++f) {
    Feature feature{.name = std::to_string(f)};
    for (int a = 0; a < alternatives; ++a) {
      feature.alternatives.push_back({.name = std::to_string(a)});
    }
    space.Add(std::move(feature));
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (int f = 0; f < features; ++f) {
    for (int g = f + 1; g < features && g - f <= window; ++g) {
      for (int a = 0; a < alternatives; ++a) {
        for (int b = 0; b < alternatives; ++b) {
          if (uniform(random) < density) space.Forbid({f, a}, {g, b}, rule);
        }
      }
    }
  }
  return space;
}

/// What one would write first: choose, compare with all choices before, go on.
Count Naive(const std::vector<std::vector<char>>& forbidden,
            const Space& space,
            std::size_t feature,
            std::vector<std::size_t>& chosen) {
  const auto& features = space.features();
  if (feature == features.size()) return 1;
  Count count = 0;
  const std::size_t width = features[0].alternatives.size();
  for (std::size_t a = 0; a < features[feature].alternatives.size(); ++a) {
    bool allowed = true;
    for (std::size_t f = 0; f < feature && allowed; ++f) {
      allowed = forbidden[f * width + chosen[f]][feature * width + a] == 0;
    }
    if (!allowed) continue;
    chosen[feature] = a;
    count += Naive(forbidden, space, feature + 1, chosen);
  }
  return count;
}

void CountNaively(benchmark::State& state) {
  const Space space = RandomSpace(12, 6, 0.144, 11);
  std::vector<std::vector<char>> forbidden(72, std::vector<char>(72));
  for (const Space::Conflict& conflict : space.conflicts()) {
    const auto row = [](const Choice& c) {
      return static_cast<std::size_t>(6 * c.feature + c.alternative);
    };
    forbidden[row(conflict.first)][row(conflict.second)] = 1;
  }
  std::vector<std::size_t> chosen(12);
  for (auto _ : state) benchmark::DoNotOptimize(Naive(forbidden, space, 0, chosen));
}
BENCHMARK(CountNaively)->Name("count_12x6/baseline")->Unit(benchmark::kMillisecond);

void CountByBits(benchmark::State& state) {
  const Space space = RandomSpace(12, 6, 0.144, 11);
  for (auto _ : state) benchmark::DoNotOptimize(CountDepthFirst(space));
}
BENCHMARK(CountByBits)->Name("count_12x6/depth_first")->Unit(benchmark::kMillisecond);

void CountByDiagram(benchmark::State& state) {
  const Space space = RandomSpace(12, 6, 0.144, 11);
  for (auto _ : state) benchmark::DoNotOptimize(Enumeration(space).count());
}
BENCHMARK(CountByDiagram)->Name("count_12x6/diagram")->Unit(benchmark::kMillisecond);

void CountLocal(benchmark::State& state) {
  const Space space = RandomSpace(20, 8, 0.25, 3);
  for (auto _ : state) benchmark::DoNotOptimize(Enumeration(space).count());
  state.counters["raw_log10"] = space.RawLog10();
}
BENCHMARK(CountLocal)->Name("count_20x8_local/baseline")->Unit(benchmark::kMillisecond);

void Unrank(benchmark::State& state) {
  const Enumeration all(RandomSpace(12, 6, 0.144, 11));
  Count index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(all.Unrank(index));
    index = (index + 7919) % all.count();
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(Unrank)->Name("candidates_12x6/baseline");

void Walk(benchmark::State& state) {
  const Enumeration all(RandomSpace(12, 6, 0.144, 11));
  std::uint64_t sum = 0;
  for (auto _ : state) {
    all.VisitAll([&sum](Count, const Selection& selection) {
      sum += selection[11];
      return true;
    });
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.count()));
}
BENCHMARK(Walk)->Name("candidates_12x6/walk");

void FrontOfMillion(benchmark::State& state) {
  const auto objectives = static_cast<std::size_t>(state.range(0));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> values(objectives * 1000000);
  for (double& value : values) value = uniform(random);
  std::size_t size = 0;
  for (auto _ : state) {
    Front front(std::vector<Direction>(objectives, Direction::kMinimise));
    for (std::size_t i = 0; i < 1000000; ++i) {
      front.Insert(i, std::span(values).subspan(objectives * i, objectives));
    }
    size = front.size();
  }
  state.counters["front"] = static_cast<double>(size);
}
BENCHMARK(FrontOfMillion)->Name("front_1e6/baseline")->Arg(3)->Unit(benchmark::kMillisecond);
BENCHMARK(FrontOfMillion)->Name("front_1e6/five")->Arg(5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kompono::synthesis
