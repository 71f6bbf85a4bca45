// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_KINEMATICS_BRANCHES_HPP_
#define KOMPONO_KINEMATICS_BRANCHES_HPP_

#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"

namespace kompono::kinematics {

/// A forked machine seen from one part to one tool.
struct Branch {
  std::string part, tool;  ///< leaves of the formula: "part1", "tool2"
  Machine chain;
};

/// Chains that together pass every block: every part to the first tool, then the first part to
/// every other tool. A machine without forks has one.
[[nodiscard]] std::vector<Branch> Branches(const Machine& machine);

/// z of a chain from values of another one: coordinates of the same name are taken over, the others
/// are at home.
[[nodiscard]] VectorXd CoordinatesOn(const Machine& chain,
                                     const Machine& other,
                                     const VectorXd& z_of_other);

}  // namespace kompono::kinematics

#endif  // KOMPONO_KINEMATICS_BRANCHES_HPP_
