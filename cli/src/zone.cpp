// SPDX-License-Identifier: Apache-2.0
#include "zone.hpp"

#include "text.hpp"

namespace kompono::cli {

std::map<std::string, std::array<double, 2>> ReadRegion(const std::vector<std::string>& words,
                                                        const kinematics::Machine& machine,
                                                        Diagnostics& problems) {
  std::map<std::string, std::array<double, 2>> region;
  if (words.empty()) return region;
  std::vector<std::string> names;
  for (const kinematics::Coordinate& coordinate : machine.coordinates()) {
    names.push_back(coordinate.name);
  }
  const NameTable table("coordinate", names);
  const Argument argument("--region", words);
  std::vector<bool> taken(names.size(), false);
  for (const Assignment& assignment : argument.Split(problems)) {
    const auto index = table.Find(argument, assignment, taken, problems);
    const auto range = argument.Range(assignment, problems);
    if (!index || !range) continue;
    const bool angle = machine.coordinates()[*index].rotary;
    region[names[*index]] = {Inward(range->lower, angle), Inward(range->upper, angle)};
  }
  return region;
}

}  // namespace kompono::cli
