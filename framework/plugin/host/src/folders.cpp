// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {

std::vector<std::filesystem::path> PluginFolders(std::span<const std::filesystem::path> given) {
  std::vector<std::filesystem::path> folders(given.begin(), given.end());
  const char* const variable = std::getenv("KOMPONO_PLUGIN_PATH");
  std::string_view rest = variable == nullptr ? std::string_view() : std::string_view(variable);
  while (!rest.empty()) {
    const std::string_view entry = rest.substr(0, rest.find(':'));
    if (!entry.empty()) folders.emplace_back(entry);
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
  }
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    // KOMPONO_LIBRARY_FOLDER: "lib", or "lib/x86_64-linux-gnu" where a distribution wants it so.
    const std::filesystem::path prefix = program.parent_path().parent_path();
    folders.push_back(prefix / KOMPONO_LIBRARY_FOLDER / "kompono" / "plugins");
  }
  return folders;
}

}  // namespace kompono::plugin
