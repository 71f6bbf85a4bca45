// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_ZONE_HPP_
#define KOMPONO_CLI_ZONE_HPP_

#include "assignments.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"

namespace kompono::cli {

/// `--region NAME=LO:HI`: ranges of virtual coordinates, mm or rad inside.
[[nodiscard]] std::map<std::string, std::array<double, 2>> ReadRegion(
    const std::vector<std::string>& words,
    const kinematics::Machine& machine,
    Diagnostics& problems);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_ZONE_HPP_
