// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/mobility.hpp"

#include "shipped_machines.hpp"

namespace kompono::analysis {
namespace {

BlockMobility OnlyBlock(const std::string& machine) {
  const std::vector<BlockMobility> all = Mobility(tests::LoadMachine(machine));
  EXPECT_EQ(all.size(), 1U);
  return all.front();
}

TEST(Mobility, OfAHexapodIsSixBothWays) {
  const BlockMobility mobility = OnlyBlock("hexapod_reference");
  EXPECT_EQ(mobility.gruebler, 6);
  EXPECT_EQ(mobility.numeric, 6);
  EXPECT_EQ(mobility.loops, 5);
  EXPECT_EQ(mobility.links + mobility.loops - mobility.pairs, 1) << "KDD eq. 1";
  EXPECT_EQ(mobility.explanation, "");
}

TEST(Mobility, OfAPyramidCountsSixStrutsThatSpin) {
  const BlockMobility mobility = OnlyBlock("ksm_pyramid");
  EXPECT_EQ(mobility.numeric, 3);
  EXPECT_EQ(mobility.gruebler, 9);
  EXPECT_THAT(mobility.explanation,
              testing::HasSubstr("6 of the counted motions move no platform"));
}

TEST(Mobility, OfEveryShippedMechanismIsItsNumberOfDrives) {
  for (const std::string& name : tests::ShippedMachineFiles()) {
    for (const BlockMobility& mobility : Mobility(tests::LoadMachine(name))) {
      EXPECT_EQ(mobility.numeric, mobility.drives) << name;
      EXPECT_TRUE(mobility.counted) << name << ": the sidecar gives no links and pairs";
      EXPECT_GE(mobility.gruebler, mobility.numeric) << name;
    }
  }
}

}  // namespace
}  // namespace kompono::analysis
