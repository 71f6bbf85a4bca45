// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_LAYOUT_SHIPPED_REGISTRY_HPP_
#define KOMPONO_TESTS_LAYOUT_SHIPPED_REGISTRY_HPP_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kompono/layout/layout.hpp"
#include "kompono/layout/numbers.hpp"
#include "kompono/plugin/registry.hpp"

namespace kompono::layout {

/// The sidecars of the shipped plugins, and one with a fault (tests/layout/plugins). Makes the
/// source tree the current folder, so that names in messages are short and the same everywhere.
[[nodiscard]] const plugin::Registry& ShippedRegistry();

/// "layouts/machines/knee_mill.toml", …, sorted.
[[nodiscard]] std::vector<std::string> TomlFilesIn(const std::string& folder);

[[nodiscard]] std::string ReadText(const std::filesystem::path& file);

/// ParseLayout, and the whole rendered complaint in its place if it fails.
struct Outcome {
  std::optional<Layout> layout;
  Diagnostics notes;
  std::string complaints;
};
[[nodiscard]] Outcome Parse(const std::string& text);

}  // namespace kompono::layout

#endif  // KOMPONO_TESTS_LAYOUT_SHIPPED_REGISTRY_HPP_
