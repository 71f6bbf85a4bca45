// SPDX-License-Identifier: Apache-2.0
// What starting the program costs when a hundred plugins are installed: reading and judging their
// sidecars, against reading only the bytes of the files.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "kompono/plugin/registry.hpp"

namespace {

namespace fs = std::filesystem;

constexpr int kSidecars = 100;

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Copies of plugins/pyramid, each with an id of its own.
class ManyPlugins {
 public:
  ManyPlugins()
      : folder_(fs::temp_directory_path() / ("kompono-bench-" + std::to_string(::getpid()))) {
    const fs::path original = fs::path(KOMPONO_SOURCE_DIR) / "plugins/pyramid/plugin.toml";
    const std::string text = Bytes(original);
    for (int i = 0; i < kSidecars; ++i) {
      const std::string number = std::to_string(i);
      fs::create_directories(folder_ / number);
      std::ofstream(folder_ / number / "libpyramid.so") << "never opened";
      std::ofstream(folder_ / number / "plugin.toml") << WithOwnIds(text, number);
    }
  }
  ManyPlugins(const ManyPlugins&) = delete;
  ManyPlugins& operator=(const ManyPlugins&) = delete;
  ~ManyPlugins() { fs::remove_all(folder_); }
  [[nodiscard]] const fs::path& folder() const { return folder_; }

 private:
  static std::string WithOwnIds(std::string text, const std::string& number) {
    for (const std::string id : {"\"org.kompono.pyramid",
                                 "\"pyramid_by_angle",
                                 "\"pyramid",
                                 "\"linear_delta",
                                 "\"triglide"}) {
      for (std::size_t at = text.find(id + "\""); at != std::string::npos;
           at = text.find(id + "\"", at)) {
        text.insert(at + id.size(), "_" + number);
      }
    }
    return text;
  }

  fs::path folder_;
};

void ReadBytes(benchmark::State& state) {
  const ManyPlugins plugins;
  for (auto _ : state) {
    std::size_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(plugins.folder())) {
      bytes += Bytes(entry.path() / "plugin.toml").size();
    }
    benchmark::DoNotOptimize(bytes);
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t{kSidecars});
}

void Discover(benchmark::State& state) {
  const ManyPlugins plugins;
  const std::array<fs::path, 1> folders{plugins.folder()};
  for (auto _ : state) {
    const auto registry = kompono::plugin::Registry::Discover(folders);
    if (registry.modules().size() < std::size_t{kSidecars}) {
      state.SkipWithError("some of the copied sidecars were refused");
      return;
    }
    benchmark::DoNotOptimize(registry.modules().data());
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t{kSidecars});
}

BENCHMARK(ReadBytes)->Name("sidecar/baseline");
BENCHMARK(Discover)->Name("sidecar/discover");

}  // namespace
