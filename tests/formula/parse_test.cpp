// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> ErrorCodes(std::string_view text) {
  std::vector<std::string> codes;
  const Parsed<Formula> formula = ParseFormula(text);
  if (formula) return codes;
  for (const Diagnostic& diagnostic : formula.error()) codes.push_back(diagnostic.code);
  return codes;
}

const Axis kX{.letter = 'X'};
const Axis kY{.letter = 'Y'};
const Axis kZ{.letter = 'Z'};
const Leaf kPart{.kind = LeafKind::kPart};
const Leaf kTool{.kind = LeafKind::kTool};

TEST(ParseFormula, GivesTheTreeOfAKneeMill) {
  const Formula expected{{kPart, kX, kY, kZ},
                         {Axis{.letter = 'C', .orientation = Orientation::kVertical}, kTool},
                         false};
  EXPECT_EQ(ParseFormula("part X Y Z O C_v tool"), expected);
  EXPECT_EQ(ParseFormula("XYZOC_v"), expected) << "leaves and spaces may be left out";
}

TEST(ParseFormula, GivesTheTreeOfAnOpenBase) {
  const Group drive{{kX, kY}, Orientation::kNone, "drive"};
  const Leaf part{.kind = LeafKind::kPart, .plane = "xy"};
  const Leaf jet{.kind = LeafKind::kProcess, .direction = 'z'};
  const Formula expected{{part, drive}, {kZ, jet}, true};
  EXPECT_EQ(ParseFormula("part_xy (XY):drive O|O Z P_z"), expected);
  EXPECT_EQ(ParseFormula("part_xy(XY):drive O|OZP_z"), expected);
  EXPECT_EQ(ParseFormula("part_xy ( X Y ) :drive O | O Z P_z"), expected);
}

TEST(ParseFormula, NestsForksAndGroups) {
  const auto formula = ParseFormula("C_h O ((YZBC):front tool1 + 2((XA)_h tool2))");
  ASSERT_TRUE(formula) << RenderAll(formula.error(), {});
  const auto& fork = std::get<Fork>(formula->right.at(0));
  ASSERT_EQ(fork.branches.size(), 2U);
  EXPECT_EQ(std::get<Group>(fork.branches[0].at(0)).block, "front");
  const auto& counted = std::get<Fork>(fork.branches[1].at(0));
  EXPECT_EQ(counted.count, 2);
  ASSERT_EQ(counted.branches.size(), 1U);
  EXPECT_EQ(std::get<Group>(counted.branches[0].at(0)).orientation, Orientation::kHorizontal);
}

TEST(ParseFormula, TellsTheProcessFromTheAxisP) {
  EXPECT_EQ(ParseFormula("O P P_x"),
            (Formula{{kPart},
                     {Axis{.letter = 'P'}, Leaf{.kind = LeafKind::kProcess, .direction = 'x'}},
                     false}));
  EXPECT_THAT(ErrorCodes("O P_h"), ElementsAre("E0121"));
  EXPECT_THAT(ErrorCodes("O p_z"), ElementsAre("E0120")) << "a setting motion is no process";
  EXPECT_EQ(Canonical(ParseFormula("O (Z P1_z + Z2 P2_z)").value()), "part O (Z P1_z + Z2 P2_z)");
}

TEST(ParseFormula, TellsWordsFromSettingMotions) {
  EXPECT_EQ(Canonical(ParseFormula("parta p r Obwdtool").value()), "part a p r O b w d tool");
  EXPECT_EQ(Canonical(ParseFormula("part_xyz O C_vw").value()), "part_xy z O C_v w tool")
      << "an index takes the letters it needs";
}

TEST(ParseFormula, ReadsDigitsByWhatStandsBeforeThem) {
  EXPECT_EQ(Canonical(ParseFormula("X2 O 2(Z)").value()), "part X2 O 2(Z tool)");
  EXPECT_EQ(Canonical(ParseFormula("O2(Z)").value()), "part O 2(Z tool)");
  EXPECT_THAT(ErrorCodes("X 2 O"), ElementsAre("E0127"));
}

TEST(ParseFormula, NumbersEqualLeavesOfAForkAndSaysSo) {
  Diagnostics notes;
  const auto formula = ParseFormula("dO(X4A+Y4B_h tool1+Z5C_v+tool)", "formula", &notes);
  ASSERT_TRUE(formula);
  EXPECT_EQ(Canonical(*formula), "part d O (X4 A tool2 + Y4 B_h tool1 + Z5 C_v tool3 + tool4)");
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_EQ(notes[0].code, "N0108");
  EXPECT_EQ(notes[0].message, "leaf 'tool2' put in: this branch names none");
  EXPECT_EQ(notes[0].span.column, 4);
  EXPECT_EQ(notes[0].span.length, 3);
  EXPECT_EQ(notes[2].message, "leaf 'tool' read as 'tool4': there are several");
}

TEST(ParseFormula, LeavesDifferentLeavesAlone) {
  Diagnostics notes;
  EXPECT_EQ(
      Canonical(ParseFormula("(part C + part2) O (Z P_z + X P_x + tool)", "f", &notes).value()),
      "(part C + part2) O (Z P_z + X P_x + tool)");
  EXPECT_TRUE(notes.empty());
}

TEST(ParseFormula, KeepsWorkingAndSettingMotionsApart) {
  EXPECT_EQ(Canonical(ParseFormula("Z_xyO X Y z P_z").value()), "part_xy O X Y z P_z");
  EXPECT_EQ(Canonical(ParseFormula("X x O").value()), "part X x O tool");
  EXPECT_THAT(ErrorCodes("x x O"), ElementsAre("E0108"));
}

TEST(ParseFormula, LetsAMechanismRepeatALetterOfAPlainAxis) {
  EXPECT_TRUE(ParseFormula("O (YZBC):struts B tool"));
  EXPECT_TRUE(ParseFormula("O ((YZBC):front + (YZBC):back)"));
}

TEST(ParseFormula, ReportsAllComplaintsAtOnce) {
  EXPECT_THAT(ErrorCodes("X X K (Y) O C_q part Z_xx ?"),
              ElementsAre("E0106", "E0113", "E0120", "E0122", "E0129", "E0108", "E0116", "E0116"));
}

TEST(ParseFormula, NamesTheFileAndTheLine) {
  const auto formula = ParseFormula("X Y\nO K", "machine.toml");
  ASSERT_FALSE(formula);
  EXPECT_EQ(RenderAll(formula.error(), {}).substr(0, 53),
            "machine.toml:2:3: error: unknown letter 'K' [E0106]\n ");
}

TEST(ParseFormula, AppendsItsNotes) {
  Diagnostics notes(1);
  EXPECT_TRUE(ParseFormula("X0", "f", &notes));
  EXPECT_EQ(notes.size(), 2U);
  EXPECT_FALSE(ParseFormula("0 K", "f", &notes));
  EXPECT_EQ(notes.size(), 3U) << "what was changed is told even if the rest is wrong";
}

TEST(ParseFormula, BoundsTheDepthOfBrackets) {
  const auto nested = [](int depth) {
    std::string text = "tool1";
    for (int i = 0; i < depth; ++i) text = "(" + text + " + X" + std::to_string(i + 1) + ")";
    return "O " + text;
  };
  EXPECT_TRUE(ParseFormula(nested(32)));
  EXPECT_THAT(ErrorCodes(nested(33)), ElementsAre("E0130"));
  EXPECT_FALSE(ParseFormula(std::string(kMaxTextBytes, '(')));
}

TEST(ParseFormula, BoundsTheLengthOfTheText) {
  const std::string longest = "O" + std::string(kMaxTextBytes - 1, ' ');
  EXPECT_TRUE(ParseFormula(longest));
  EXPECT_THAT(ErrorCodes(longest + " "), ElementsAre("E0131"));
  const std::string million(1000000, 'X');
  EXPECT_EQ(ParseFormula(million).error().front().span.line_text.size(), kMaxTextBytes);
}

TEST(ParseFormula, BlamesAnOpenBracketOnce) {
  EXPECT_THAT(ErrorCodes("(XY:drive O Z"), ElementsAre("E0110", "E0137"));
  EXPECT_THAT(ErrorCodes("((XY):a + (YZ):b O Z"), ElementsAre("E0110"));
}

TEST(ParseFormula, ReadsOnBehindAZeroByte) {
  EXPECT_THAT(ErrorCodes(std::string_view("O (X\0 + Y)", 10)), ElementsAre("E0129"));
}

TEST(ParseFormula, TellsAMisspeltWordFromTheMotionBeforeIt) {
  const auto formula = ParseFormula("XTOOL O");
  ASSERT_FALSE(formula);
  ASSERT_EQ(formula.error().size(), 1U);
  EXPECT_EQ(formula.error().front().message, "unknown word 'TOOL'");
}

TEST(ParseFormula, KnowsWhereABlockNameWentTooFar) {
  const auto formula = ParseFormula("(XY):driveO Z");
  ASSERT_FALSE(formula);
  EXPECT_THAT(formula.error().front().help, HasSubstr("'driveO' goes on to the next space"));
}

TEST(ParseFormula, SuggestsAFreeNumber) {
  const auto formula = ParseFormula("X X2 O X X");
  ASSERT_FALSE(formula);
  ASSERT_EQ(formula.error().size(), 2U);
  EXPECT_THAT(formula.error()[0].help, HasSubstr("write X3"));
  EXPECT_THAT(formula.error()[1].help, HasSubstr("write X4"));
}

}  // namespace
}  // namespace kompono::formula
