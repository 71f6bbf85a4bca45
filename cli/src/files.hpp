// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_FILES_HPP_
#define KOMPONO_CLI_FILES_HPP_

#include <optional>
#include <string>
#include <string_view>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::cli {

/// The whole file; "-" is standard input. E0613.
[[nodiscard]] Parsed<std::string> ReadWhole(const std::string& file);

/// E0615 if `file` exists and `force` is not given; called before the work starts, so that no
/// result is lost at its end.
[[nodiscard]] std::optional<Diagnostic> RefuseToOverwrite(const std::string& file, bool force);

/// Writes into a new file beside `file` and renames it, so that nobody ever sees half a file and an
/// error leaves what was there. Without `force` a file that came into being meanwhile is kept
/// (E0615); other failures are E0614. Devices and pipes are written directly.
[[nodiscard]] std::optional<Diagnostic> WriteFileAside(const std::string& file,
                                                       std::string_view text,
                                                       bool force);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_FILES_HPP_
