// SPDX-License-Identifier: Apache-2.0
// What a tree makes possible, and what takes it away: a lathe of plain axes, changed piece by
// piece.
#include "kompono/analysis/abilities.hpp"

#include "shipped_machines.hpp"

#include <map>

namespace kompono::analysis {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

/// A lathe text with named gaps, so that a test says only what is different.
class Lathe {
 public:
  Lathe& With(const std::string& gap, const std::string& text) {
    gaps_.at(gap) = text;
    return *this;
  }

  [[nodiscard]] std::map<std::string, Ability> Judged() const {
    std::string text = "kompono = 1\nformula = \"" + gaps_.at("formula") + "\"\n";
    for (const auto& [gap, table] : gaps_) {
      if (gap != "formula") text += table + "\n";
    }
    std::map<std::string, Ability> out;
    for (Ability& ability : Abilities(tests::MachineFromText(text), tests::ShippedRegistry()))
      out[std::string(ability.name())] = std::move(ability);
    return out;
  }

  [[nodiscard]] std::vector<std::string> Possible() const {
    std::vector<std::string> names;
    for (const auto& [name, ability] : Judged()) {
      if (ability.possible) names.push_back(name);
    }
    return names;
  }

  [[nodiscard]] std::string Reason(const std::string& ability) const {
    return Judged().at(ability).reason;
  }

 private:
  // Stops of the chucks: 180 mm before the headstock's face, and at 1000 - 180 = 820 mm.
  std::map<std::string, std::string> gaps_{
      {"formula", "(part1 C_h + part2 C2_h Z2) O X Z B tool"},
      {"part1", "[part1]\nmodule = \"headstock\""},
      {"part2", "[part2]\nmodule = \"counter_spindle\"\nmount = { position = [0, 0, 1000] }"},
      {"Z2", "[axis.Z2]\nrange = [-600, 0]"},
      {"X", "[axis.X]\nrange = [-50, 300]"},
      {"Z", "[axis.Z]\nrange = [0, 1200]"},
      {"tool", "[tool]\nmodule = \"tool\""},
  };
};

/// Two slides with a tool each, two moving heads: the third row of the table in plain axes.
Lathe Pair() {
  return Lathe()
      .With("formula", "(part1 C_h Z1 + part2 C2_h Z2) O (X3 Z3 tool1 + X4 Z4 tool2)")
      .With("X", "[axis.Z1]\nrange = [0, 300]")
      .With("Z", "[axis.X3]\nrange = [-50, 300]\n[axis.Z3]\nrange = [0, 700]")
      .With("tool", "[axis.X4]\nrange = [-50, 300]\n[axis.Z4]\nrange = [400, 1200]");
}

TEST(Abilities, OfACounterSpindleAndASwivellingTool) {
  EXPECT_THAT(Lathe().Possible(),
              UnorderedElementsAre("sequential_parts", "take_over", "long_part_ends"));
  // 820 - 180 = 640 mm between the stops, less the 600 mm of Z2.
  EXPECT_EQ(Lathe().Reason("take_over"),
            "part1 and part2 are coaxial and face each other, 40 to 640 mm apart by Z2");
  EXPECT_EQ(Lathe().Reason("sequential_parts"), "tool works on part1, then on part2");
  EXPECT_EQ(Lathe().Reason("long_part_ends"), "tool faces either end by B; parts up to 640 mm");
  EXPECT_THAT(Lathe().Judged().at("take_over").by, UnorderedElementsAre("part1", "part2", "Z2"));
}

TEST(Abilities, AllNineAreJudgedAndNamed) {
  const auto judged = Lathe().Judged();
  EXPECT_EQ(judged.size(), 9U);
  for (const auto& [name, ability] : judged) {
    EXPECT_NE(ability.reason, "") << name;
    EXPECT_EQ(ability.by.empty(), !ability.possible) << name;
  }
}

TEST(Abilities, WithoutASecondSpindleNothingIsTakenOver) {
  const Lathe lathe =
      Lathe().With("formula", "part1 C_h O X Z B tool").With("part2", "").With("Z2", "");
  EXPECT_THAT(lathe.Possible(), testing::IsEmpty());
  EXPECT_EQ(lathe.Reason("take_over"), "part1 is the only spindle that turns a part");
  EXPECT_EQ(lathe.Reason("sequential_parts"), "part1 is the only spindle that turns a part");
}

TEST(Abilities, ATailstockIsNoSpindle) {
  Lathe lathe;
  lathe.With("formula", "(part1 C_h + part2 Z2) O X Z B tool")
      .With("part2", "[part2]\nmodule = \"tailstock\"\nmount = { position = [0, 0, 1000] }");
  EXPECT_THAT(lathe.Possible(), testing::IsEmpty());
  EXPECT_EQ(lathe.Reason("take_over"), "part1 is the only spindle that turns a part");
}

TEST(Abilities, ASpindleBesideTheAxisTakesNothingOver) {
  Lathe lathe;
  lathe.With("part2",
             "[part2]\nmodule = \"counter_spindle\"\nmount = { position = [0.3, 0, 1000] }");
  EXPECT_THAT(lathe.Possible(), UnorderedElementsAre("sequential_parts"));
  EXPECT_EQ(lathe.Reason("take_over"), "part2 stands 0.3 mm beside the axis of part1");
  EXPECT_THAT(lathe.Reason("long_part_ends"), HasSubstr("no take-over"));
}

TEST(Abilities, TwoSpindlesLookingTheSameWayTakeNothingOver) {
  Lathe lathe;
  lathe.With("part2", "[part2]\nmodule = \"headstock\"\nmount = { position = [0, 0, 640] }");
  EXPECT_THAT(lathe.Possible(), UnorderedElementsAre("sequential_parts"));
  EXPECT_EQ(lathe.Reason("take_over"),
            "part2 does not look back at part1: 180° are left between their axes");
}

TEST(Abilities, ASpindleThatStandsOrIsOnlySetTakesNothingOver) {
  for (const char* formula :
       {"(part1 C_h + part2 C2_h) O X Z B tool", "(part1 C_h + part2 C2_h z2) O X Z B tool"}) {
    Lathe lathe;
    lathe.With("formula", formula)
        .With("Z2",
              std::string(formula).find("z2") == std::string::npos
                  ? ""
                  : "[axis.z2]\nrange = [-600, 0]");
    EXPECT_THAT(lathe.Possible(), UnorderedElementsAre("sequential_parts")) << formula;
    EXPECT_EQ(lathe.Reason("take_over"), "no working motion brings part1 and part2 together");
  }
}

TEST(Abilities, SpindlesBackToBackTakeNothingOver) {
  Lathe lathe;
  lathe.With("part2", "[part2]\nmodule = \"counter_spindle\"\nmount = { position = [0, 0, 300] }");
  EXPECT_EQ(lathe.Reason("take_over"), "part2 stands behind part1 in all their range");
}

TEST(Abilities, AToolThatReachesOnePartOnlyWorksOnOne) {
  Lathe lathe;
  lathe.With("Z", "[axis.Z]\nrange = [0, 100]");  // its tip ends at 0 mm, both stops lie beyond
  EXPECT_THAT(lathe.Possible(), UnorderedElementsAre("take_over"));
  EXPECT_EQ(lathe.Reason("sequential_parts"), "no tool reaches both part1 and part2");
  lathe.With("X", "[axis.X]\nrange = [100, 300]").With("Z", "[axis.Z]\nrange = [0, 1200]");
  EXPECT_THAT(lathe.Possible(), UnorderedElementsAre("take_over")) << "never on the axis";
}

TEST(Abilities, WithoutSwivelOneEndIsOutOfSight) {
  Lathe lathe;
  lathe.With("formula", "(part1 C_h + part2 C2_h Z2) O X Z tool");
  EXPECT_THAT(lathe.Possible(), UnorderedElementsAre("sequential_parts", "take_over"));
  EXPECT_EQ(lathe.Reason("long_part_ends"),
            "no tool that reaches both ends can turn to either of them");
  // A turn about the part's own axis shows the tool no other end.
  lathe.With("formula", "(part1 C_h + part2 C2_h Z2) O X Z C3 tool");
  EXPECT_THAT(lathe.Possible(), UnorderedElementsAre("sequential_parts", "take_over"));
}

TEST(Abilities, ATwinTurretHasMoreToolsAndFacesBothEnds) {
  Lathe lathe;
  lathe.With("formula", "(part1 C_h + part2 C2_h Z2) O X Z tool")
      .With("tool",
            "[tool]\nmodule = \"twin_turret\"\nparameters = { pockets = 8 }\nmount = { position = "
            "[-300, 0, 0] }\n");
  EXPECT_THAT(
      lathe.Possible(),
      UnorderedElementsAre("sequential_parts", "take_over", "long_part_ends", "more_tools"));
  EXPECT_EQ(lathe.Reason("more_tools"),
            "two turrets on tool, 8 tools in each: one indexes while the other cuts");
  lathe.With("tool", "[tool]\nmodule = \"turret\"\n");
  EXPECT_EQ(lathe.Reason("more_tools"), "tool is the only set of tools");
}

TEST(Abilities, OfThePairOfSlides) {
  EXPECT_THAT(Pair().Possible(),
              UnorderedElementsAre("sequential_parts",
                                   "take_over",
                                   "long_part_ends",
                                   "more_tools",
                                   "two_tools_at_once",
                                   "parallel_parts",
                                   "reclamped_ends",
                                   "quick_changeover",
                                   "larger_zone"));
  EXPECT_EQ(Pair().Reason("parallel_parts"), "tool1 works on part1 while tool2 works on part2");
  EXPECT_EQ(Pair().Reason("larger_zone"), "the travel of Z1, Z2 adds to that of the tools");
}

TEST(Abilities, ToolsOnOnePlatformDoNotWorkByThemselves) {
  Lathe lathe = Pair();
  lathe.With("formula", "(part1 C_h Z1 + part2 C2_h Z2) O X3 Z3 (tool1 + tool2)").With("tool", "");
  EXPECT_THAT(lathe.Possible(),
              UnorderedElementsAre("sequential_parts", "take_over", "more_tools", "larger_zone"));
  EXPECT_EQ(lathe.Reason("parallel_parts"), "tool1, tool2 share their motions");
}

TEST(Abilities, OneSlideOfItsOwnIsNotEnough) {
  Lathe lathe = Pair();
  lathe.With("formula", "(part1 C_h Z1 + part2 C2_h Z2) O Z3 (X3 tool1 + X4 tool2)")
      .With("tool", "[axis.X4]\nrange = [-50, 300]");
  EXPECT_EQ(lathe.Reason("two_tools_at_once"), "tool1, tool2 share their motions")
      << "with one feed for both";
}

TEST(Abilities, AStandingHeadMakesNoLargerZone) {
  Lathe lathe = Pair();
  lathe.With("formula", "(part1 C_h + part2 C2_h Z2) O (X3 Z3 tool1 + X4 Z4 tool2)").With("X", "");
  EXPECT_THAT(lathe.Possible(), testing::Not(testing::Contains("larger_zone")));
  EXPECT_EQ(lathe.Reason("larger_zone"),
            "part1 is not moved in a direction in which the tool is moved too");
}

TEST(Abilities, ALongPartNeedsItsOtherEndHeld) {
  Lathe lathe = Pair();
  lathe.With("formula", "part1 C_h Z1 O (X3 Z3 tool1 + X4 Z4 tool2)")
      .With("part2", "")
      .With("Z2", "")
      .With("tool", "[axis.X4]\nrange = [-50, 300]\n[axis.Z4]\nrange = [0, 1200]");
  EXPECT_EQ(lathe.Reason("two_tools_at_once"),
            "no part held at both ends is reached by two tools that move by themselves");
  lathe.With("formula", "(part1 C_h Z1 + part2 Z2) O (X3 Z3 tool1 + X4 Z4 tool2)")
      .With("part2", "[part2]\nmodule = \"tailstock\"\nmount = { position = [0, 0, 1000] }")
      .With("Z2", "[axis.Z2]\nrange = [-600, 0]");
  EXPECT_THAT(lathe.Possible(), testing::Contains("two_tools_at_once"));
}

std::vector<std::string> OfShipped(const std::string& machine) {
  std::vector<std::string> names;
  for (const Ability& ability : Abilities(tests::LoadMachine(machine), tests::ShippedRegistry())) {
    if (ability.possible) names.emplace_back(ability.name());
  }
  return names;
}

// KDD table 1, row by row; a later row keeps what the units it shares with the first make possible.
TEST(KddTable1, CounterSpindleAndSwivellingTurret) {
  EXPECT_THAT(OfShipped("kdd_counter_spindle"),
              testing::ElementsAre("sequential_parts", "take_over", "long_part_ends"));
}

TEST(KddTable1, TwinTurret) {
  EXPECT_THAT(
      OfShipped("kdd_twin_turret"),
      testing::ElementsAre("sequential_parts", "take_over", "long_part_ends", "more_tools"));
}

TEST(KddTable1, MirroredMechanismsWithMovingHeads) {
  EXPECT_THAT(OfShipped("kdd_mirrored_pair"),
              testing::ElementsAre("sequential_parts",
                                   "take_over",
                                   "long_part_ends",
                                   "more_tools",
                                   "two_tools_at_once",
                                   "parallel_parts",
                                   "reclamped_ends",
                                   "quick_changeover",
                                   "larger_zone"));
}

TEST(KddTable1, ATailstockInPlaceOfTheSecondSpindleTakesMostOfItAway) {
  EXPECT_THAT(OfShipped("kdd_tailstock"),
              testing::ElementsAre("more_tools", "two_tools_at_once", "larger_zone"));
}

TEST(KddTable1, PlainLathesHaveNoneOfIt) {
  EXPECT_THAT(OfShipped("kdd_four_strut_lathe"), testing::IsEmpty());
  EXPECT_THAT(OfShipped("kdd_six_strut_lathe"), testing::IsEmpty());
  EXPECT_THAT(OfShipped("v100_lathe"), testing::IsEmpty());
}

TEST(Abilities, OfAMillAreNone) {
  for (const Ability& ability :
       Abilities(tests::LoadMachine("knee_mill"), tests::ShippedRegistry()))
    EXPECT_FALSE(ability.possible) << ability.name() << ": " << ability.reason;
}

}  // namespace
}  // namespace kompono::analysis
