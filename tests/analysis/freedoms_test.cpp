// SPDX-License-Identifier: Apache-2.0
// The fifteen choices of four motions for four struts, worked out by hand at the symmetric pose.
#include "kompono/analysis/freedoms.hpp"

#include "shipped_machines.hpp"

#include <cmath>

namespace kompono::analysis {
namespace {

BlockFreedoms OnlyBlock(const kinematics::Machine& machine, std::optional<double> length_mm) {
  const std::vector<BlockFreedoms> blocks = Freedoms(machine, machine.home(), length_mm);
  EXPECT_EQ(blocks.size(), 1U);
  return blocks.at(0);
}

// Joints (±150, 0, ±100), struts (0, 300, ∓350): with 150 mm for a radian the columns are 300 in Y
// and C, 350 in Z and B, 200 in A, all pairwise square to each other except Z with A and with X.
TEST(Freedoms, OfFourStrutsWithPlaneContours) {
  const BlockFreedoms block = OnlyBlock(tests::LoadMachine("kdd_four_strut_lathe"), 150.0);
  EXPECT_EQ(block.struts, 4);
  ASSERT_EQ(block.choices.size(), 15U);
  EXPECT_EQ(block.choices[0].letters, "YZBC");
  EXPECT_NEAR(block.choices[0].condition, 350.0 / 300.0, 1e-9);
  EXPECT_EQ(block.choices[1].letters, "YABC");
  EXPECT_NEAR(block.choices[1].condition, 350.0 / 200.0, 1e-9);
  for (std::size_t i = 2; i < 15; ++i)
    EXPECT_TRUE(std::isinf(block.choices[i].condition)) << block.choices[i].letters;
}

TEST(Freedoms, EveryChoiceStandsOnce) {
  const BlockFreedoms block = OnlyBlock(tests::LoadMachine("linuxcnc_pentakins_default"), {});
  std::set<std::string> letters;
  for (const FreedomChoice& choice : block.choices) letters.insert(choice.letters);
  EXPECT_EQ(letters.size(), 6U);
  EXPECT_EQ(letters.count("XYZAB"), 1U);
  EXPECT_TRUE(std::isfinite(block.choices.front().condition));
  EXPECT_GT(block.length_mm, 50.0);
}

TEST(Freedoms, OfSixStrutsIsTheOnlyChoiceWithTheConditionOfTheDomain) {
  const BlockFreedoms block = OnlyBlock(tests::LoadMachine("kdd_six_strut_lathe"), 150.0);
  ASSERT_EQ(block.choices.size(), 1U);
  EXPECT_EQ(block.choices[0].letters, "XYZABC");
  EXPECT_NEAR(block.choices[0].condition, 2.586382429206, 1e-9);
}

TEST(Freedoms, OfPodsToOnePointAreTheThreeTranslations) {
  const BlockFreedoms block = OnlyBlock(tests::LoadMachine("linuxcnc_tripod"), {});
  ASSERT_EQ(block.choices.size(), 20U);
  EXPECT_EQ(block.choices[0].letters, "XYZ");
  EXPECT_TRUE(std::isfinite(block.choices[0].condition));
  EXPECT_TRUE(std::isinf(block.choices[1].condition)) << block.choices[1].letters;
}

TEST(Freedoms, AreNotCountedWhereADriveHasNoStrutOfItsOwn) {
  EXPECT_TRUE(OnlyBlock(tests::LoadMachine("so_waterjet_lambda"), {}).choices.empty());
  const kinematics::Machine mill = tests::LoadMachine("knee_mill");
  EXPECT_TRUE(Freedoms(mill, mill.home()).empty());
}

}  // namespace
}  // namespace kompono::analysis
