// SPDX-License-Identifier: Apache-2.0
// Which letters of the formula a mechanism realises under its mount.
#include "shipped_registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::layout {
namespace {

using testing::HasSubstr;

/// "X+ Z-": the axes that the local coordinates realise, with their signs; or the complaints.
std::string Letters(const std::string& formula,
                    const std::string& block,
                    const std::string& rotation) {
  const Outcome outcome = Parse("kompono = 1\nformula = \"" + formula + "\"\n[block.b]\n" + block +
                                "\nmount = { rotation = " + rotation + " }\n");
  if (!outcome.layout) return outcome.complaints;
  std::string text;
  for (const Block::LetterMap& letter : outcome.layout->blocks.front().letters) {
    if (!text.empty()) text += ' ';
    text += letter.axis + (letter.sign > 0 ? "+" : "-");
  }
  return text;
}

const std::string kLambda = "module = \"lambda\"\nparameters = { L1 = 1200, L2 = 820, L3 = 600 }";
const std::string kDelta = "module = \"linear_delta\"\nparameters = { radius = 150, strut = 300 }";
const std::string kHexapod =
    "module = \"hexapod_symmetric\"\nparameters = { base_radius = 600, base_half_angle = 10, "
    "platform_radius = 250, platform_half_angle = 10 }";

TEST(Letters, AreTheModulesOwnWithoutAMount) {
  EXPECT_EQ(Letters("part (XY):b O tool", kLambda, "[0, 0, 0]"), "X+ Y+");
  EXPECT_EQ(Letters("part (YX):b O tool", kLambda, "[0, 0, 0]"), "X+ Y+");
}

TEST(Letters, FollowTheMountWithTheirSigns) {
  EXPECT_EQ(Letters("part (XZ):b O tool", kLambda, "[90, 0, 0]"), "X+ Z+");
  EXPECT_EQ(Letters("part (XZ):b O tool", kLambda, "[-90, 0, 0]"), "X+ Z-");
  EXPECT_EQ(Letters("part (XY):b O tool", kLambda, "[0, 0, 90]"), "Y+ X-");
  EXPECT_EQ(Letters("part (XY):b O tool", kLambda, "[180, 0, 0]"), "X+ Y-");
  EXPECT_EQ(Letters("part (YZ):b O tool", kLambda, "[0, 90, 90]"), "Y+ Z+");
  EXPECT_EQ(Letters("part O (XYZABC):b tool", kHexapod, "[180, 0, 0]"), "X+ Y- Z- A+ B- C-");
}

TEST(Letters, MayBeParallelAndNumbered) {
  EXPECT_EQ(Letters("part (U2V):b O tool", kLambda, "[0, 0, 0]"), "U2+ V+");
  EXPECT_EQ(Letters("part O (PQR):b tool", kDelta, "[0, 0, 0]"), "P+ Q+ R+");
  EXPECT_EQ(Letters("part O (x4y4):b tool", kLambda, "[0, 0, 0]"), "x4+ y4+");
}

TEST(Letters, StayWhenACalibrationTurnsTheMountALittle) {
  EXPECT_EQ(Letters("part (XY):b O tool", kLambda, "[0, 0, 9.9]"), "X+ Y+");
  EXPECT_THAT(Letters("part (XY):b O tool", kLambda, "[0, 0, 10.1]"), HasSubstr("[E0324]"));
  EXPECT_EQ(Letters("part (XZ):b O tool", kLambda, "[91, 2, -3]"), "X+ Z+");
}

TEST(Letters, OfAllThreeTranslationsMayLieAskew) {
  EXPECT_EQ(Letters("part O (XYZ):b tool", kDelta, "[0, 0, 45]"), "X+ Y+ Z+");
  EXPECT_EQ(Letters("part O (XYZABC):b tool", kHexapod, "[20, 30, 45]"), "X+ Y+ Z+ A+ B+ C+");
  const Outcome outcome = Parse("kompono = 1\nformula = \"part O (XYZ):b tool\"\n[block.b]\n" +
                                kDelta + "\nmount = { rotation = [0, 0, 45] }\n");
  ASSERT_EQ(outcome.notes.size(), 1U);
  EXPECT_EQ(outcome.notes.front().code, "N0301");
}

TEST(Letters, ThatDoNotFitComeWithARotationThatWould) {
  const std::string upright = Letters("part (XZ):b O tool", kLambda, "[0, 0, 0]");
  EXPECT_THAT(upright, HasSubstr("realises X Y, but the formula asks 'b' for X Z [E0324]"));
  EXPECT_THAT(upright, HasSubstr("mount.rotation = [90, 0, 0] would turn them so"));
  EXPECT_THAT(Letters("part (YZ):b O tool", kLambda, "[0, 0, 0]"),
              HasSubstr("mount.rotation = [0, -90, 0] would turn them so"));
  EXPECT_THAT(Letters("part O (XYZ):b tool", kLambda, "[0, 0, 0]"), HasSubstr("[E0325]"));
  EXPECT_THAT(Letters("part O (XYZABD):b tool", kHexapod, "[0, 0, 0]"),
              HasSubstr("no rotation of the mount changes that"));
}

TEST(Letters, TheProposedRotationIsAcceptedInTheFilesUnit) {
  const std::string text =
      "kompono = 1\nformula = \"part (YZ):b O tool\"\nunits = { angle = \"rad\" }\n[block.b]\n" +
      kLambda + "\n";
  const Outcome refused = Parse(text);
  const std::string key = "mount.rotation = ";
  const std::size_t at = refused.complaints.find(key);
  ASSERT_NE(at, std::string::npos) << refused.complaints;
  const std::size_t end = refused.complaints.find(']', at);
  const Outcome accepted = Parse(text + refused.complaints.substr(at, end + 1 - at) + "\n");
  EXPECT_TRUE(accepted.layout) << accepted.complaints;
}

}  // namespace
}  // namespace kompono::layout
