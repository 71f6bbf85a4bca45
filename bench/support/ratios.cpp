// SPDX-License-Identifier: Apache-2.0
// The main program of every benchmark. After Google Benchmark's own table it prints each variant of
// a family as a ratio to the family's baseline: seconds differ from machine to machine, ratios of
// one run hardly do.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace {

constexpr const char* kBaseline = "baseline";

class RatioReporter final : public benchmark::ConsoleReporter {
 public:
  RatioReporter() : ConsoleReporter(isatty(STDOUT_FILENO) != 0 ? OO_ColorTabular : OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.error_occurred || run.run_type != Run::RT_Iteration) continue;
      const std::string& name = run.run_name.function_name;
      const std::size_t slash = name.find('/');
      if (slash == std::string::npos) continue;
      families_[name.substr(0, slash)].push_back({name.substr(slash + 1), SecondsPerItem(run)});
    }
  }

  void Finalize() override {
    ConsoleReporter::Finalize();
    std::printf("\n%-44s %12s %10s\n", "per item", "time", "ratio");
    for (const auto& [family, variants] : families_) PrintFamily(family, variants);
  }

 private:
  struct Variant {
    std::string name;
    double seconds = 0.0;
  };

  static double SecondsPerItem(const Run& run) {
    const auto rate = run.counters.find("items_per_second");
    if (rate != run.counters.end()) return 1.0 / rate->second.value;
    return run.real_accumulated_time / static_cast<double>(run.iterations);
  }

  static void PrintFamily(const std::string& family, const std::vector<Variant>& variants) {
    double baseline = 0.0;
    for (const Variant& variant : variants) {
      if (variant.name == kBaseline) baseline = variant.seconds;
    }
    for (const Variant& variant : variants) {
      const std::string name = family + "/" + variant.name;
      std::printf("%-44s %9.1f ns", name.c_str(), variant.seconds * 1e9);
      if (baseline > 0.0) std::printf(" %10.2f", variant.seconds / baseline);
      std::printf("\n");
    }
  }

  std::map<std::string, std::vector<Variant>> families_;
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  return 0;
}
