// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_PATTERNS_HPP_
#define KOMPONO_CLI_PATTERNS_HPP_

#include "assignments.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"
#include "kompono/plugin/registry.hpp"

/// Options about geometry numbers by pattern: "struts.base[*]=0.05", in mm or deg.
namespace kompono::cli {

/// For each of the machine's parameters all forms of its name that layouts accept
/// (kompono/layout/numbers.hpp), the one that they prefer first.
using GeometryForms = std::vector<std::vector<std::string>>;
[[nodiscard]] GeometryForms FormsOf(const kinematics::Machine& machine,
                                    const plugin::Registry& registry);

/// Pattern -> mm or rad. E0604 for a pattern that names no number of the machine, E0611 for one
/// that names lengths and angles.
[[nodiscard]] std::map<std::string, double> ReadPatternNumbers(const Argument& argument,
                                                               const kinematics::Machine& machine,
                                                               const GeometryForms& forms,
                                                               Diagnostics& problems);
/// The same for `pattern=lower:upper`.
[[nodiscard]] std::map<std::string, std::array<double, 2>> ReadPatternRanges(
    const Argument& argument,
    const kinematics::Machine& machine,
    const GeometryForms& forms,
    Diagnostics& problems);

/// Patterns with commas between them, over several uses of an option.
[[nodiscard]] std::vector<std::string> SplitWords(const std::vector<std::string>& uses);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_PATTERNS_HPP_
