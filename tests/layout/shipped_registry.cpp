// SPDX-License-Identifier: Apache-2.0
#include "shipped_registry.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

namespace kompono::layout {

namespace fs = std::filesystem;

const plugin::Registry& ShippedRegistry() {
  static const plugin::Registry registry = [] {
    fs::current_path(KOMPONO_SOURCE_DIR);
    const std::array<fs::path, 2> folders{"plugins", "tests/layout/plugins"};
    return plugin::Registry::Discover(folders);
  }();
  return registry;
}

std::vector<std::string> TomlFilesIn(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(KOMPONO_SOURCE_DIR) / folder)) {
    if (entry.path().extension() == ".toml")
      files.push_back(folder + "/" + entry.path().filename().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string ReadText(const fs::path& file) {
  std::ifstream in(fs::path(KOMPONO_SOURCE_DIR) / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Outcome Parse(const std::string& text) {
  Outcome outcome;
  Parsed<Layout> layout = ParseLayout(text, "test.toml", ShippedRegistry(), &outcome.notes);
  if (layout) {
    outcome.layout = std::move(*layout);
  } else {
    outcome.complaints = RenderAll(layout.error(), {});
  }
  return outcome;
}

}  // namespace kompono::layout
