// SPDX-License-Identifier: Apache-2.0
#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

Formula Read(std::string_view text) {
  return ParseFormula(text).value();
}

TEST(Names, AreWrittenAsInTheText) {
  EXPECT_EQ((Axis{.letter = 'X', .number = 4}.Name()), "X4");
  EXPECT_EQ((Axis{.letter = 'Z', .working = false}.Name()), "z");
  EXPECT_EQ((Leaf{.kind = LeafKind::kPart, .number = 1, .plane = "xy"}.Name()), "part1_xy");
  EXPECT_EQ((Leaf{.kind = LeafKind::kTool, .number = 2}.Name()), "tool2");
  EXPECT_EQ((Leaf{.kind = LeafKind::kProcess, .direction = 'z'}.Name()), "P_z");
}

TEST(Canonical, IsTheSameForAllWaysOfWriting) {
  const std::string canonical = "part_xy (XY):drive O|O Z P_z";
  EXPECT_EQ(Canonical(Read(canonical)), canonical);
  EXPECT_EQ(Canonical(Read("Z_{xy}(XY):drive O|O P_zZ")), canonical);
  EXPECT_EQ(Canonical(Read("  (X Y) :drive part_yx 0|0\tZ P_z ")), canonical);
}

TEST(Canonical, SeparatesElementsWithOneSpace) {
  EXPECT_EQ(Canonical(Read("(part1C_hZ+part2C2_hZ2)O((YZBC):front tool1+(YZBC):back tool2)")),
            "(part1 C_h Z + part2 C2_h Z2) O ((YZBC):front tool1 + (YZBC):back tool2)");
  EXPECT_EQ(Canonical(Read("O 12( (x2 A)_i:q )")), "part O 12((x2A)_i:q tool)");
}

TEST(ItemText, WritesASingleElement) {
  const Formula formula = Read("X:table O (CZ)_v:quill");
  EXPECT_EQ(ItemText(formula.left.at(1)), "X:table");
  EXPECT_EQ(ItemText(formula.right.at(0)), "(CZ)_v:quill");
  EXPECT_EQ(ChainText(formula.right), "(CZ)_v:quill tool");
}

TEST(AxesOf, GoesThroughForksAndGroupsInTheOrderOfTheText) {
  std::string names;
  for (const Axis& axis : AxesOf(Read("(C_h + C2_h z) O (YB):arm 2(W (PA))")))
    names += axis.Name() + " ";
  EXPECT_EQ(names, "C C2 z Y B W P A ");
}

}  // namespace
}  // namespace kompono::formula
