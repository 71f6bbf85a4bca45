// SPDX-License-Identifier: Apache-2.0
#include "pose_limits.hpp"

#include "assignments.hpp"
#include "text.hpp"

namespace kompono::cli {

void AddPoseLimits(CLI::App& command, PoseLimitOptions& options) {
  command
      .add_option("--joint", options.joint, "Largest swing from home of a strut in a joint, deg")
      ->type_name("POINT=DEG,..")
      ->allow_extra_args(false);
  command.add_option("--strut-diameter", options.strut_diameter, "Struts are this thick, mm")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--clearance", options.clearance, "Struts keep this distance, mm")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber);
}

analysis::Limits ReadPoseLimits(const PoseLimitOptions& options, Diagnostics& problems) {
  analysis::Limits limits;
  const Argument joint("--joint", options.joint);
  for (const Assignment& assignment : joint.Split(problems)) {
    const auto number = joint.Number(assignment, problems);
    if (number) limits.swings.push_back({assignment.name, *number / kDegPerRad});
  }
  limits.of_layout = !options.no_ranges;
  if (options.strut_diameter) limits.strut_radius_mm = 0.5 * *options.strut_diameter;
  limits.clearance_mm = options.clearance;
  return limits;
}

}  // namespace kompono::cli
