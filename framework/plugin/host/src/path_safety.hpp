// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_PATH_SAFETY_HPP_
#define KOMPONO_PLUGIN_HOST_PATH_SAFETY_HPP_

#include <filesystem>
#include <optional>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::plugin {

/// A library runs with the rights of whoever starts kompono, so nobody else may be able to put one
/// there: `file` and the folder it really lies in (after symbolic links) must not be writable for
/// everyone. The sticky bit of a folder like /tmp does not help: anybody may still add files.
/// Nothing is said about a file that does not exist.
[[nodiscard]] std::optional<Diagnostic> JudgePath(const std::filesystem::path& file);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_PATH_SAFETY_HPP_
