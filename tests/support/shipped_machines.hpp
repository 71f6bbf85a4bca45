// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_SUPPORT_SHIPPED_MACHINES_HPP_
#define KOMPONO_TESTS_SUPPORT_SHIPPED_MACHINES_HPP_

#include <random>
#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"
#include "kompono/plugin/registry.hpp"

/// Every machine file that ships, and poses of four kinds in each: the laws hold for all of them or
/// not at all.
namespace kompono::tests {

[[nodiscard]] const plugin::Registry& ShippedRegistry();
[[nodiscard]] std::vector<std::string> ShippedMachineFiles();  ///< names without ".toml"
[[nodiscard]] kinematics::Machine LoadMachine(const std::string& name);
/// From the text of a layout file. @throws std::runtime_error with the rendered diagnostics.
[[nodiscard]] kinematics::Machine MachineFromText(const std::string& toml);

/// The seed of this run: KOMPONO_TEST_SEED or a fixed one; printed with every failure.
[[nodiscard]] unsigned Seed();

/// Whether the straight way from home to z keeps to home's side of every type 2 singularity, away
/// from it. A like sign of det A at both ends is not enough: two crossings restore it (pentapods
/// have such poses inside their own axis limits).
[[nodiscard]] bool OnHomesBranch(const kinematics::Machine& machine, const kinematics::VectorXd& z);

struct NamedPose {
  std::string kind;  ///< "home", "near home", "random", "near a limit"
  kinematics::VectorXd z;
};

/// Home, home + 1e-6, `random_count` reachable poses around home, and as many close to where a
/// drive runs out of reach.
[[nodiscard]] std::vector<NamedPose> PosesOf(const kinematics::Machine& machine,
                                             int random_count,
                                             std::mt19937* random);

}  // namespace kompono::tests

#endif  // KOMPONO_TESTS_SUPPORT_SHIPPED_MACHINES_HPP_
