// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_SOLVE_TABLE_HPP_
#define KOMPONO_CLI_SOLVE_TABLE_HPP_

#include "session.hpp"
#include "solving.hpp"

#include <string>

namespace kompono::cli {

enum class TableKind { kPoses, kDrives };

/// Solves every row of a CSV file, each from the same start, so that no row depends on another.
/// Prints a table with a status per row; the exit code is that of the worst row.
[[nodiscard]] ExitCode SolveTable(Session& session,
                                  const kinematics::Machine& machine,
                                  Question question,
                                  const std::string& file,
                                  TableKind kind);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_SOLVE_TABLE_HPP_
