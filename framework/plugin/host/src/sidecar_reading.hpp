// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_SIDECAR_READING_HPP_
#define KOMPONO_PLUGIN_HOST_SIDECAR_READING_HPP_

#include <filesystem>
#include <string_view>

#include "kompono/plugin/description.hpp"

namespace kompono::plugin {

/// What could be understood of a sidecar, and what was wrong with it. A broken sidecar's plugin is
/// still listed, and a layout that asks for one of its modules is told why it is not there.
struct SidecarReading {
  Sidecar sidecar;
  Diagnostics problems;
};

[[nodiscard]] SidecarReading ReadLeniently(std::string_view text, std::string_view file);
[[nodiscard]] SidecarReading ReadFileLeniently(const std::filesystem::path& file);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_SIDECAR_READING_HPP_
