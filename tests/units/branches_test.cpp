// SPDX-License-Identifier: Apache-2.0
// Machines with several parts and tools: every pair of them is solved there and back, and every
// block is on one of the branches.
#include "kompono/kinematics/branches.hpp"

#include "shipped_machines.hpp"

#include <set>

#include <gtest/gtest.h>

namespace kompono::tests {
namespace {

using kinematics::Machine;
using kinematics::VectorXd;

class EveryMachine : public testing::TestWithParam<std::string> {};

TEST_P(EveryMachine, HasEveryBlockAndAxisOnABranch) {
  const Machine machine = LoadMachine(GetParam());
  std::set<std::string> seen;
  for (const kinematics::Branch& branch : kinematics::Branches(machine)) {
    for (const auto& frame : branch.chain.Frames(branch.chain.home(), machine.nominal()))
      seen.insert(frame.name);
  }
  for (const auto& block : machine.layout().blocks) EXPECT_TRUE(seen.contains(block.name));
  for (const auto& axis : machine.layout().axes) EXPECT_TRUE(seen.contains(axis.name)) << axis.name;
  for (const auto& end : machine.layout().ends) EXPECT_TRUE(seen.contains(end.name)) << end.name;
}

TEST_P(EveryMachine, FramesAgreeWithTheToolPose) {
  const Machine machine = LoadMachine(GetParam());
  for (const kinematics::Branch& branch : kinematics::Branches(machine)) {
    const VectorXd z = branch.chain.home();
    Pose<double> X_MT;
    Pose<double> X_MW;
    for (const auto& frame : branch.chain.Frames(z, machine.nominal())) {
      (frame.workpiece_side ? X_MW : X_MT) = frame.X_MF;
    }
    const Pose<double> X_WT = branch.chain.ToolPose(z, machine.nominal());
    const Pose<double> through_base = X_MW.Inverse() * X_MT;
    EXPECT_LT((through_base.p - X_WT.p).norm(), 1e-9 * (1.0 + X_WT.p.norm()))
        << branch.part << " " << branch.tool;
    EXPECT_LT((through_base.R - X_WT.R).norm(), 1e-12);
  }
}

TEST_P(EveryMachine, IsSolvedThereAndBackOnEveryBranch) {
  const Machine machine = LoadMachine(GetParam());
  for (const kinematics::Branch& branch : kinematics::Branches(machine)) {
    std::mt19937 random(Seed());
    for (const NamedPose& pose : PosesOf(branch.chain, 5, &random)) {
      if (pose.kind == "near a limit") continue;
      const Pose<double> X_WT = branch.chain.ToolPose(pose.z, machine.nominal());
      kinematics::PoseTarget target;
      const auto numbers = kinematics::NumbersFromPose(X_WT, target.order);
      for (std::size_t k = 0; k < 6; ++k) target.component[k] = numbers.value[k];
      const kinematics::Solution there = branch.chain.Inverse(target, machine.nominal(), pose.z);
      ASSERT_TRUE(there.ok()) << GetParam() << " " << branch.part << " " << there.message;
      const kinematics::Solution back =
          branch.chain.Forward(there.drives, machine.nominal(), pose.z);
      ASSERT_TRUE(back.ok()) << GetParam() << " " << back.message;
      EXPECT_LT((back.X_WT.p - X_WT.p).norm(), 1e-8 * (1.0 + X_WT.p.norm()))
          << GetParam() << " " << branch.part << " " << branch.tool << " seed " << Seed();
      EXPECT_LT((back.X_WT.R - X_WT.R).norm(), 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         EveryMachine,
                         testing::ValuesIn(ShippedMachineFiles()),
                         [](const auto& machine) { return machine.param; });

TEST(Branches, OfAMirroredPairArePartsAndTools) {
  const auto branches = kinematics::Branches(LoadMachine("kdd_mirrored_pair"));
  ASSERT_EQ(branches.size(), 3U);
  EXPECT_EQ(branches[0].part + branches[0].tool, "part1tool1");
  EXPECT_EQ(branches[1].part + branches[1].tool, "part2tool1");
  EXPECT_EQ(branches[2].part + branches[2].tool, "part1tool2");
}

TEST(Branches, CoordinatesAreTakenOverByName) {
  const Machine machine = LoadMachine("kdd_mirrored_pair");
  VectorXd z = machine.home();
  z[machine.FindCoordinate("front.Y")] = 12.0;
  const auto branches = kinematics::Branches(machine);
  const VectorXd second = kinematics::CoordinatesOn(branches[1].chain, machine, z);
  EXPECT_EQ(second[branches[1].chain.FindCoordinate("front.Y")], 12.0);
  EXPECT_EQ(second[branches[1].chain.FindCoordinate("Z2")], 0.0);
}

}  // namespace
}  // namespace kompono::tests
