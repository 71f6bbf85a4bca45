// SPDX-License-Identifier: Apache-2.0
// Counts of design.md, section 4, against an enumeration through the formula's own equivalences.
#include "studies.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/formula/equivalence.hpp"

namespace kompono::synthesis {
namespace {

using KeyOf = std::string (*)(const formula::Formula&);

KeyOf KeyFor(const std::string& equivalence) {
  return equivalence == "string"         ? &formula::StringKey
         : equivalence == "distribution" ? &formula::DistributionKey
                                         : &formula::RelativeMotionKey;
}

struct Expected {
  std::string letters;
  unsigned strings, distributions, relative_motions;
};

class Counts : public testing::TestWithParam<Expected> {};

TEST_P(Counts, AreThoseOfTheDesign) {
  const Expected& expected = GetParam();
  const std::map<std::string, unsigned> counts{{"string", expected.strings},
                                               {"distribution", expected.distributions},
                                               {"relative_motion", expected.relative_motions}};
  for (const auto& [equivalence, count] : counts) {
    const Outcome outcome = BuildStudy(PlainStudy(expected.letters, equivalence));
    ASSERT_TRUE(outcome.space) << outcome.complaints;
    const Enumeration all(outcome.space->space());
    EXPECT_EQ(CountText(all.count()), std::to_string(count)) << expected.letters << equivalence;
  }
}

TEST_P(Counts, HaveOneMemberOfEveryClassOfTheFormula) {
  for (const std::string equivalence : {"string", "distribution", "relative_motion"}) {
    const Outcome outcome = BuildStudy(PlainStudy(GetParam().letters, equivalence));
    ASSERT_TRUE(outcome.space) << outcome.complaints;
    std::multiset<std::string> ours;
    const KeyOf key = KeyFor(equivalence);
    Enumeration(outcome.space->space()).VisitAll([&](Count, const Selection& selection) {
      ours.insert(key(outcome.space->FormulaOf(outcome.space->At(selection))));
      return true;
    });
    std::set<std::string> theirs;
    formula::ForEachDistribution(GetParam().letters, [&](const formula::Formula& formula) {
      theirs.insert(key(formula));
      return true;
    });
    EXPECT_EQ(ours, std::multiset<std::string>(theirs.begin(), theirs.end())) << equivalence;
  }
}

INSTANTIATE_TEST_SUITE_P(OfMotions,
                         Counts,
                         testing::Values(Expected{"XYZ", 24, 8, 1},
                                         Expected{"XYZC", 120, 54, 8},
                                         Expected{"XYZAB", 720, 384, 54},
                                         Expected{"XYZAC", 720, 384, 54},
                                         Expected{"XYZBC", 720, 384, 54}),
                         [](const auto& one) { return one.param.letters; });

/// Bohez: three translations and any two of the three rotations.
TEST(Counts, OfThreePairsAddUp) {
  for (const auto& [equivalence, count] : std::map<std::string, unsigned>{
           {"string", 2160}, {"distribution", 1152}, {"relative_motion", 162}}) {
    Count sum = 0;
    for (const std::string pair : {"AB", "AC", "BC"}) {
      const Outcome outcome = BuildStudy(PlainStudy("XYZ" + pair, equivalence));
      ASSERT_TRUE(outcome.space) << outcome.complaints;
      sum += Enumeration(outcome.space->space()).count();
    }
    EXPECT_EQ(CountText(sum), std::to_string(count)) << equivalence;
  }
}

/// ISO 10791-2 lists twelve layouts of machining centres with a vertical spindle. Its table is not
/// at hand: these twelve are the orders of X, Y and Z whose Z moves the head, which is what one
/// would expect there; the other twelve orders are in the space without the rule.
TEST(Counts, TheTwelveVerticalLayoutsAreExpressed) {
  const std::string study = PlainStudy("XYZ", "string") +
                            "[ends.spindle]\nside = \"tool\"\nchain = \"C_v tool\"\n"
                            "[[rule]]\nname = \"the spindle's head moves in Z\"\n"
                            "forbid = [\"part:Z\"]\nkind = \"normative\"\n"
                            "reason = \"the head moves vertically\"\nauthor = \"this test\"\n";
  const Outcome outcome = BuildStudy(study);
  ASSERT_TRUE(outcome.space) << outcome.complaints;
  std::set<std::string> texts;
  Enumeration(outcome.space->space()).VisitAll([&](Count, const Selection& selection) {
    texts.insert(formula::Canonical(outcome.space->FormulaOf(outcome.space->At(selection))));
    return true;
  });
  EXPECT_EQ(texts.size(), 12U);
  for (const std::string text : {"part X Y O Z C_v tool",
                                 "part Y X O Z C_v tool",
                                 "part X O Y Z C_v tool",
                                 "part X O Z Y C_v tool",
                                 "part Y O X Z C_v tool",
                                 "part Y O Z X C_v tool",
                                 "part O X Y Z C_v tool",
                                 "part O Y X Z C_v tool",
                                 "part O X Z Y C_v tool",
                                 "part O Y Z X C_v tool",
                                 "part O Z X Y C_v tool",
                                 "part O Z Y X C_v tool"}) {
    EXPECT_TRUE(texts.contains(text)) << text;
    const auto formula = formula::ParseFormula(text);
    ASSERT_TRUE(formula);
    const auto fixing = outcome.space->FixFormula(*formula);
    ASSERT_TRUE(fixing) << text;
    EXPECT_EQ(CountText(Enumeration(outcome.space->space(), *fixing).count()), "1") << text;
  }
}

}  // namespace
}  // namespace kompono::synthesis
