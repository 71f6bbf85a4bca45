// SPDX-License-Identifier: Apache-2.0
#include "path_safety.hpp"

#include "manifest.hpp"
#include <fmt/format.h>

#include <system_error>

namespace kompono::plugin {

std::optional<Diagnostic> JudgePath(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  if (error) return std::nullopt;
  for (const std::filesystem::path& path : {real.parent_path(), real}) {
    const std::filesystem::perms permissions = std::filesystem::status(path, error).permissions();
    if (error ||
        (permissions & std::filesystem::perms::others_write) == std::filesystem::perms::none)
      continue;
    return Diagnostic{
        .code = CodeOf(LoadError::kUnsafePath),
        .file = file.string(),
        .message = fmt::format("everyone may write to '{}'", path.string()),
        .help = fmt::format("plugins run as part of this program; take the right away with: chmod "
                            "o-w '{}'",
                            path.string())};
  }
  return std::nullopt;
}

}  // namespace kompono::plugin
