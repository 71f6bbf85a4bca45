// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/indices.hpp"

#include "shipped_machines.hpp"

#include <numbers>

namespace kompono::analysis {
namespace {

TEST(IndicesOf, APlainMachineUsesAllOfItsTravelsAndDoesNotTurn) {
  const Machine machine = tests::LoadMachine("knee_mill");
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  const auto function = ZoneFunction::Make(*judge, *RegionOf(machine, {}, machine.home()), true);
  const WorkZone zone = ComputeZone(*function, {});
  const LayoutIndices indices = IndicesOf(*judge, *function, zone, 0.2);
  EXPECT_NEAR(indices.utilisation, 1.0, 1e-9);
  EXPECT_FALSE(indices.orientation_space);
  EXPECT_FALSE(indices.orientation_angle);
}

TEST(IndicesOf, AHexapodTiltsLessFarTheMoreIsAsked) {
  std::string ranges;
  for (int i = 1; i <= 6; ++i)
    ranges += "[block.struts.drive.q" + std::to_string(i) + "]\nrange = [850, 1150]\n";
  const Machine machine = tests::MachineFromText(R"(
kompono = 1
formula = "part O (XYZABC):struts tool"
[block.struts]
module = "hexapod_symmetric"
parameters = { base_radius = 600, base_half_angle = 10, platform_radius = 250, platform_half_angle = 10 }
home = { X = 0, Y = 0, Z = 900, A = 0, B = 0, C = 0 }
)" + ranges);
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  const auto function = ZoneFunction::Make(*judge, *RegionOf(machine, {}, machine.home()), true);
  const WorkZone zone = ComputeZone(*function, {.tolerance = 0.05});
  const LayoutIndices none = IndicesOf(*judge, *function, zone, 0.0, 20);
  const LayoutIndices some = IndicesOf(*judge, *function, zone, 0.1, 20);
  const LayoutIndices more = IndicesOf(*judge, *function, zone, 0.3, 20);
  EXPECT_DOUBLE_EQ(*none.orientation_space, 1.0);
  EXPECT_LT(*some.orientation_space, 1.0);
  EXPECT_LT(*more.orientation_space, *some.orientation_space);
  EXPECT_GT(*some.orientation_space, 0.0);
  ASSERT_EQ(some.ranges.size(), 3U);
  double product = 1.0;
  for (const LayoutIndices::Range& range : some.ranges) {
    EXPECT_LT(range.lower_rad, -0.1);
    EXPECT_GT(range.upper_rad, 0.1);
    product *= (range.upper_rad - range.lower_rad) / (2.0 * std::numbers::pi);
  }
  EXPECT_NEAR(*some.orientation_angle, product, 1e-12);
  // Turning about Z alone ends where every second strut is as long as allowed: symmetric.
  EXPECT_NEAR(some.ranges[2].lower_rad, -some.ranges[2].upper_rad, 1e-6);
  EXPECT_GT(some.utilisation, 0.1);
  EXPECT_LT(some.utilisation, 1.0);
  EXPECT_LT(some.space_efficiency, some.utilisation);
}

}  // namespace
}  // namespace kompono::analysis
