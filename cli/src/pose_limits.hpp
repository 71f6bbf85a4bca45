// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_POSE_LIMITS_HPP_
#define KOMPONO_CLI_POSE_LIMITS_HPP_

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kompono/analysis/pose_judge.hpp"

/// Options about what poses must keep besides reach.
namespace kompono::cli {

struct PoseLimitOptions {
  std::vector<std::string> joint;  ///< POINT=DEG
  std::optional<double> strut_diameter, clearance;
  bool no_ranges = false;
};

/// --joint, --strut-diameter and --clearance.
void AddPoseLimits(CLI::App& command, PoseLimitOptions& options);

[[nodiscard]] analysis::Limits ReadPoseLimits(const PoseLimitOptions& options,
                                              Diagnostics& problems);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_POSE_LIMITS_HPP_
