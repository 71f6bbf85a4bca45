// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_USAGE_HPP_
#define KOMPONO_CLI_USAGE_HPP_

#include <CLI/CLI.hpp>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::cli {

/// The innermost subcommand that the command line named so far; `root` if there is none.
[[nodiscard]] const CLI::App* DeepestCommand(const CLI::App& root);

/// What was wrong with the command line (E0601-E0603), with what was perhaps meant. `error` may be
/// null when parsing went well but arguments are left over.
[[nodiscard]] Diagnostics UsageProblems(const CLI::App& root, const CLI::ParseError* error);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_USAGE_HPP_
