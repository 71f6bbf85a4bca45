// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/singularities.hpp"

#include "shipped_machines.hpp"

#include <cmath>

namespace kompono::analysis {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;

Machine BiGlide(const std::string& lengths) {
  return tests::MachineFromText(
      "kompono = 1\nformula = \"part O (XY):glides tool\"\n"
      "[block.glides]\nmodule = \"biglide\"\nparameters = { " +
      lengths + " }\nhome = { X = 0, Y = 200 }\n");
}

Machine Lambda(double l2, double l3, char mode) {
  return tests::MachineFromText(
      "kompono = 1\nformula = \"part O (XY):drive tool\"\n[block.drive]\nmodule = \"lambda\"\n"
      "parameters = { L1 = 1000, L2 = " +
      std::to_string(l2) + ", L3 = " + std::to_string(l3) + " }\nmode = { q2 = \"" + mode +
      "\" }\nhome = { X = 0, Y = 300 }\n");
}

PoseJudge JudgeOf(const Machine& machine) {
  auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  EXPECT_TRUE(judge);
  return std::move(*judge);
}

std::vector<PathSingularity> Along(const Machine& machine, const std::vector<VectorXd>& path) {
  const PoseJudge judge = JudgeOf(machine);
  const auto report = SingularitiesOnPath(judge, path);
  EXPECT_TRUE(report);
  return report ? report->singularities : std::vector<PathSingularity>();
}

TEST(SingularitiesOnPath, FindsTheBiglidesInnerOneBetweenTwoSamples) {
  const Machine machine = BiGlide("L1 = 400, L2 = 350, width = 60");
  const auto found = Along(machine, {Vector2d(0, 200), Vector2d(50, -100)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].type, 2);
  EXPECT_TRUE(found[0].crossed);
  EXPECT_NEAR(found[0].from, 2.0 / 3.0, 1e-8);
  EXPECT_NEAR(found[0].z[1], 0.0, 1e-6);
  EXPECT_LT(found[0].to - found[0].from, 1e-7);
}

TEST(SingularitiesOnPath, FindsTwoCrossingsWithinOneStep) {
  // From y = -1 over y = 200 back: the samples at both ends have one sign of det A.
  const Machine machine = BiGlide("L1 = 400, L2 = 350, width = 0");
  const auto found =
      Along(machine, {Vector2d(0, -1), Vector2d(0, 200), Vector2d(10, -1), Vector2d(20, -300)});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].from, 1.0 / 201.0, 1e-8);
  EXPECT_NEAR(found[1].from, 1.0 + 200.0 / 201.0, 1e-8);
}

TEST(SingularitiesOnPath, SeesAPathThatOnlyTouches) {
  const Machine machine = BiGlide("L1 = 400, L2 = 350, width = 0");
  const auto found = Along(machine, {Vector2d(0, 100), Vector2d(50, 0), Vector2d(100, 100)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].type, 2);
  EXPECT_FALSE(found[0].crossed);
  EXPECT_NEAR(found[0].from, 1.0, 1e-7);
  EXPECT_TRUE(Along(machine, {Vector2d(0, 100), Vector2d(50, 1e-3), Vector2d(100, 100)}).empty())
      << "a micrometre away is regular";
}

TEST(SingularitiesOnPath, EndOfReachIsType1AndWhereTheCarriagesMeetType3) {
  const Machine unequal = BiGlide("L1 = 400, L2 = 350, width = 0");
  const auto first = Along(unequal, {Vector2d(0, 200), Vector2d(0, 500)});
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].type, 1);
  EXPECT_EQ(first[0].drive, "glides.q2");
  EXPECT_NEAR(first[0].z[1], 350.0, 1e-5);
  const Machine equal = BiGlide("L1 = 400, L2 = 400, width = 0");
  const auto both = Along(equal, {Vector2d(0, 200), Vector2d(0, 500)});
  ASSERT_EQ(both.size(), 1U);
  EXPECT_EQ(both[0].type, 3) << "at y = L the carriages meet";
  EXPECT_NEAR(both[0].z[1], 400.0, 1e-5);
}

TEST(SingularitiesOnPath, AlongASingularityIsOneStretch) {
  const Machine machine = BiGlide("L1 = 400, L2 = 350, width = 0");
  const auto found = Along(machine, {Vector2d(-50, 0), Vector2d(50, 0)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].from, 0.0, 1e-3);
  EXPECT_NEAR(found[0].to, 1.0, 1e-3);
}

// The lambda, L1 = 1000: type 2 at y = 0; type 1 at y = L1 and, if L2 < L3, at y = L1 L2 / L3.
TEST(SingularitiesOnPath, OfTheLambdaWithTheSecondLinkShorter) {
  const auto found = Along(Lambda(300, 500, '+'), {Vector2d(0, 100), Vector2d(0, 900)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].type, 1);
  EXPECT_EQ(found[0].drive, "drive.q2");
  EXPECT_NEAR(found[0].z[1], 1000.0 * 300.0 / 500.0, 1e-5);
}

TEST(SingularitiesOnPath, OfTheLambdaWithTheSecondLinkLonger) {
  const auto found = Along(Lambda(700, 500, '+'), {Vector2d(0, -100), Vector2d(0, 1100)});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].type, 2);
  EXPECT_NEAR(found[0].z[1], 0.0, 1e-5);
  EXPECT_EQ(found[1].type, 1);
  EXPECT_EQ(found[1].drive, "drive.q1");
  EXPECT_NEAR(found[1].z[1], 1000.0, 1e-5);
}

TEST(SingularitiesOnPath, OfTheLambdaWithEqualLinks) {
  const auto plus = Along(Lambda(500, 500, '+'), {Vector2d(0, 100), Vector2d(0, 1100)});
  ASSERT_EQ(plus.size(), 1U);
  EXPECT_EQ(plus[0].type, 3) << "q1 = q2 only at y = L1, where both reaches end";
  EXPECT_NEAR(plus[0].z[1], 1000.0, 1e-5);
}

TEST(SingularitiesOnPath, OfAHexapodThatTurnsAboutItsAxis) {
  // Known of the symmetric hexapod (Fichter): at home turned by ±90° it is singular.
  const Machine machine = tests::MachineFromText(R"(
kompono = 1
formula = "part O (XYZABC):struts tool"
[block.struts]
module = "hexapod_symmetric"
parameters = { base_radius = 600, base_half_angle = 10, platform_radius = 250, platform_half_angle = 10 }
home = { X = 0, Y = 0, Z = 900, A = 0, B = 0, C = 0 }
)");
  VectorXd to = machine.home();
  to[5] = 2.0;
  const auto found = Along(machine, {machine.home(), to});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].crossed);
  EXPECT_NEAR(found[0].z[5], std::acos(0.0), 1e-6);
  to[5] = 1.2;
  EXPECT_TRUE(Along(machine, {machine.home(), to}).empty());
}

TEST(DistanceToSingularity, IsExactForTheBiglide) {
  const Machine machine = BiGlide("L1 = 400, L2 = 350, width = 0");
  const PoseJudge judge = JudgeOf(machine);
  const SingularityDistance low = DistanceToSingularity(judge, Vector2d(30, 60));
  EXPECT_EQ(low.type, 2);
  EXPECT_NEAR(low.distance_mm, 60.0, 1e-3);
  EXPECT_NEAR(low.z[1], 0.0, 1e-3);
  const SingularityDistance high = DistanceToSingularity(judge, Vector2d(30, 330));
  EXPECT_EQ(high.type, 1);
  EXPECT_EQ(high.drive, "glides.q2");
  EXPECT_NEAR(high.distance_mm, 20.0, 1e-6);
}

TEST(SingularitiesIn, CoverTheBiglidesRailAndNothingElse) {
  const Machine machine = BiGlide("L1 = 400, L2 = 350, width = 40");
  const PoseJudge judge = JudgeOf(machine);
  const auto region =
      RegionOf(machine, {{"X", -100.0, 100.0}, {"Y", -300.0, 300.0}}, machine.home());
  const auto function = ZoneFunction::Make(judge, *region, true);
  const SingularSet set = SingularitiesIn(judge, *function);
  ASSERT_FALSE(set.cells.empty());
  EXPECT_TRUE(set.crossed);
  EXPECT_NEAR(set.lower[0], -100.0, 1e-9);
  EXPECT_NEAR(set.upper[0], 100.0, 1e-9);
  EXPECT_NEAR(set.lower[1], 0.0, 2.0);
  EXPECT_NEAR(set.upper[1], 0.0, 2.0);
  ASSERT_TRUE(set.nearest);
  EXPECT_NEAR((*set.nearest)[1], 0.0, 1e-5);
  EXPECT_NEAR(set.nearest_distance, 200.0, 1e-5);
  const auto above = RegionOf(machine, {{"X", -100.0, 100.0}, {"Y", 10.0, 300.0}}, machine.home());
  const auto regular = ZoneFunction::Make(judge, *above, true);
  EXPECT_TRUE(SingularitiesIn(judge, *regular).cells.empty());
}

}  // namespace
}  // namespace kompono::analysis
