// SPDX-License-Identifier: Apache-2.0
#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

std::string Told(std::string_view text) {
  std::string told;
  for (const Explanation& line : Explain(ParseFormula(text).value())) {
    told += std::string(2 * static_cast<std::size_t>(line.depth), ' ') + line.text + " = " +
            line.meaning + "\n";
  }
  return told;
}

TEST(Explain, TellsWhatCarriesWhat) {
  EXPECT_EQ(Told("X z O|O C_v"),
            "part = workpiece; carried by X\n"
            "X = translation along X, working motion, workpiece side; carried by z, carries part\n"
            "z = translation along Z, setting motion, workpiece side; carried by the "
            "workpiece-side foundation, "
            "carries X\n"
            "O|O = open base: two foundations coupled only electronically, their mutual pose is "
            "identified\n"
            "C_v = main-motion spindle, vertical, rotation about Z, tool side; carried by the "
            "tool-side foundation, "
            "carries tool\n"
            "tool = tool or turret; carried by C_v\n");
}

TEST(Explain, TellsGroupsAndBlocks) {
  EXPECT_EQ(Told("part_xz (Xb):drive O (CZ)_v D:head P_z"),
            "part_xz = workpiece, clamped in the xz plane; carried by (Xb):drive\n"
            "(Xb):drive = 2 motions realised together by the mechanism 'drive': X translation "
            "along X, b rotation "
            "about Y (setting), workpiece side; carried by the base, carries part_xz\n"
            "O = base: carries both sides\n"
            "(CZ)_v = 2 motions realised together by one mechanism that the layout must name: C "
            "rotation about Z, Z "
            "translation along Z; its rotation is a main-motion spindle, vertical, tool side; "
            "carried by the base, "
            "carries D:head\n"
            "D:head = additional rotation D, working motion, realised by block 'head', tool side; "
            "carried by (CZ)_v, "
            "carries P_z\n"
            "P_z = process (jet or beam) acting along z; carried by D:head\n");
}

TEST(Explain, GoesIntoTheBranchesOfAFork) {
  EXPECT_EQ(
      Told("2(C_h) O X (tool1 + W tool2)"),
      "2(part C_h) = 2 identical branches side by side; carried by the base\n"
      "  part C_h = each of the 2 branches\n"
      "    part = workpiece; carried by C_h\n"
      "    C_h = main-motion spindle, horizontal, rotation about Z, workpiece side; carried by the "
      "base, "
      "carries part\n"
      "O = base: carries both sides\n"
      "X = translation along X, working motion, tool side; carried by the base, carries the fork\n"
      "(tool1 + W tool2) = 2 branches side by side; carried by X\n"
      "  tool1 = branch 1 of 2\n"
      "    tool1 = tool or turret 1; carried by X\n"
      "  W tool2 = branch 2 of 2\n"
      "    W = secondary translation parallel to Z, working motion, tool side; carried by X, "
      "carries tool2\n"
      "    tool2 = tool or turret 2; carried by W\n");
}

}  // namespace
}  // namespace kompono::formula
