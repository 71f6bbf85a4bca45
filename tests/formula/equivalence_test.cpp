// SPDX-License-Identifier: Apache-2.0
#include "kompono/formula/equivalence.hpp"

#include <set>
#include <stdexcept>

namespace kompono::formula {
namespace {

Formula Read(std::string_view text) {
  return ParseFormula(text).value();
}
std::string Distribution(std::string_view text) {
  return DistributionKey(Read(text));
}
std::string RelativeMotion(std::string_view text) {
  return RelativeMotionKey(Read(text));
}

// docs/design.md, section 4.
TEST(CountClasses, GivesTheKnownCounts) {
  EXPECT_EQ(CountClasses("XYZ"), (ClassCounts{24, 8, 1}));
  EXPECT_EQ(CountClasses("XYZC"), (ClassCounts{120, 54, 8}));
  EXPECT_EQ(CountClasses("XYZAC"), (ClassCounts{720, 384, 54}));
}

TEST(CountClasses, GivesTheKnownCountsForAllThreeRotaryPairs) {
  ClassCounts all;
  for (const std::string_view letters : {"XYZAB", "XYZAC", "XYZBC"}) {
    const ClassCounts counts = CountClasses(letters);
    all.strings += counts.strings;
    all.distributions += counts.distributions;
    all.relative_motions += counts.relative_motions;
  }
  EXPECT_EQ(all, (ClassCounts{2160, 1152, 162}));
}

// With t translations and r rotations: each translation stands in one of the gaps between things it
// does not commute with, r + 1 gaps between rotations, r + 2 with O.
TEST(CountClasses, MeetsTheClosedForm) {
  const auto factorial = [](long n) {
    long product = 1;
    for (long i = 2; i <= n; ++i) product *= i;
    return product;
  };
  const auto power = [](long base, long exponent) {
    long product = 1;
    for (long i = 0; i < exponent; ++i) product *= base;
    return product;
  };
  struct Case {
    std::string_view letters;
    long translations, rotations;
  };
  for (const Case& c : {Case{"", 0, 0},
                        Case{"X", 1, 0},
                        Case{"A", 0, 1},
                        Case{"AB", 0, 2},
                        Case{"XYZUV", 5, 0},
                        Case{"XYZABC", 3, 3},
                        Case{"XYZWC", 4, 1},
                        Case{"xX2a", 2, 1}}) {
    const long t = c.translations;
    const long r = c.rotations;
    EXPECT_EQ(CountClasses(c.letters),
              (ClassCounts{factorial(t + r + 1),
                           factorial(r + 1) * power(r + 2, t),
                           factorial(r) * power(r + 1, t)}))
        << c.letters;
  }
}

TEST(ForEachDistribution, GivesEachLayoutOnceAndAllOfThemParse) {
  std::set<std::string> seen;
  ForEachDistribution("XyC2", [&seen](const Formula& formula) {
    EXPECT_TRUE(seen.insert(StringKey(formula)).second);
    EXPECT_EQ(Read(StringKey(formula)), formula);
    return true;
  });
  EXPECT_EQ(seen.size(), 24U);
  EXPECT_EQ(seen.count("part y O C2 X tool"), 1U);
}

TEST(ForEachDistribution, StopsWhenTold) {
  int visits = 0;
  ForEachDistribution("XYZ", [&visits](const Formula&) { return ++visits < 5; });
  EXPECT_EQ(visits, 5);
}

TEST(ForEachDistribution, RefusesWhatIsNoListOfAxes) {
  const auto ignore = [](const Formula&) { return true; };
  EXPECT_THROW(ForEachDistribution("XOY", ignore), std::logic_error);
  EXPECT_THROW(ForEachDistribution("XYX", ignore), std::logic_error);
  EXPECT_THROW(ForEachDistribution("2X", ignore), std::logic_error);
}

TEST(DistributionKey, LetsNeighbouringTranslationsCommuteOnOneSide) {
  EXPECT_EQ(Distribution("X Y O Z"), Distribution("Y X O Z"));
  EXPECT_NE(Distribution("X Y O Z"), Distribution("X Z O Y"));
  EXPECT_NE(Distribution("X Y O"), Distribution("X O Y"));
  EXPECT_NE(Distribution("X C Y O"), Distribution("Y C X O"));
  EXPECT_NE(Distribution("O A B"), Distribution("O B A"));
  EXPECT_NE(Distribution("X O Y"), Distribution("X O|O Y"));
  EXPECT_NE(Distribution("X Y O"), Distribution("x Y O"));
}

TEST(DistributionKey, TakesAGroupAsOneItem) {
  EXPECT_EQ(Distribution("(YX):d Z O"), Distribution("Z (XY):d O"));
  EXPECT_NE(Distribution("(XY):d O"), Distribution("(XY):e O"));
  EXPECT_NE(Distribution("(XY):d O"), Distribution("X Y O"));
  EXPECT_EQ(Distribution("(YZBC):s O"), Distribution("(ZYBC):s O"));
  EXPECT_NE(Distribution("(YZBC):s O"), Distribution("(YZCB):s O"));
  EXPECT_NE(Distribution("(XC):s O"), Distribution("(CX):s O"));
  EXPECT_NE(Distribution("(XC):s Z O"), Distribution("Z (XC):s O"));
  EXPECT_NE(Distribution("(CZ)_v O"), Distribution("(CZ)_h O"));
}

TEST(DistributionKey, GivesTheBranchesOfAForkNoOrder) {
  EXPECT_EQ(Distribution("O (X Y tool1 + Z tool2)"), Distribution("O (Z tool2 + Y X tool1)"));
  EXPECT_NE(Distribution("O (X tool1 + Z tool2)"), Distribution("O (X tool2 + Z tool1)"));
  EXPECT_NE(Distribution("O 2(X tool)"), Distribution("O 3(X tool)"));
  EXPECT_NE(Distribution("O X (tool1 + Y tool2)"), Distribution("O (X tool1 + Y tool2)"));
}

TEST(RelativeMotionKey, DoesNotSeeTheBase) {
  EXPECT_EQ(RelativeMotion("X Y Z O C_v"), RelativeMotion("O Z Y X C_v"));
  EXPECT_EQ(RelativeMotion("part_xy X Y O Z P_z"), RelativeMotion("part_xy O X Y Z P_z"));
  EXPECT_EQ(RelativeMotion("X O Y"), RelativeMotion("Y O|O X"));
  EXPECT_NE(RelativeMotion("X C O Y"), RelativeMotion("X O Y C"));
  EXPECT_EQ(RelativeMotion("(part1 + part2) Z O (XY):d"),
            RelativeMotion("(part2 + part1) (YX):d O Z"));
}

}  // namespace
}  // namespace kompono::formula
