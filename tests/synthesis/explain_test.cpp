// SPDX-License-Identifier: Apache-2.0
#include "studies.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::synthesis {
namespace {

Space ThreeByThree() {
  Space space;
  for (const std::string name : {"f", "g", "h"}) {
    space.Add(Feature{.name = name, .alternatives = {{.name = "a"}, {.name = "b"}, {.name = "c"}}});
  }
  const int structural = space.Add(RuleTitle{.name = "meaning", .structural = true});
  const int wide = space.Add(RuleTitle{.name = "wide"});
  const int narrow = space.Add(RuleTitle{.name = "narrow"});
  space.Forbid({0, 0}, {1, 0}, structural);
  space.Forbid({0, 1}, {1, 1}, wide);
  space.Forbid({0, 2}, {1, 1}, wide);
  space.Forbid({0, 1}, {1, 1}, narrow);
  space.Forbid({2, 2}, narrow);
  return space;
}

TEST(Explain, TellsWhatEachRuleAndEachPairKeepsOut) {
  const Space space = ThreeByThree();
  const Effects effects = Explain(space);
  EXPECT_EQ(CountText(effects.raw), "27");
  EXPECT_EQ(CountText(effects.structural), "24");
  EXPECT_EQ(CountText(effects.count), "12");  // (9 - 3) pairs of f and g, two of h
  ASSERT_EQ(effects.rules.size(), 2U);
  EXPECT_EQ(effects.rules[0].rule, 2);
  EXPECT_EQ(CountText(effects.rules[0].gained), "6");  // the third of h; b with b stays forbidden
  EXPECT_EQ(effects.rules[0].pairs, 2U);
  EXPECT_EQ(CountText(effects.rules[1].gained), "2");
  ASSERT_EQ(effects.pairs.size(), 3U);
  EXPECT_EQ(CountText(effects.pairs[0].gained), "6");
  EXPECT_TRUE((effects.pairs[0].pair.first == Choice{2, 2}));
  EXPECT_EQ(CountText(effects.pairs[1].gained), "2");
}

TEST(Explain, GainsAreWhatCountingWithoutTheRuleGives) {
  Space space = ThreeByThree();
  const Effects effects = Explain(space);
  for (const RuleEffect& effect : effects.rules) {
    space.SwitchOff(effect.rule);
    EXPECT_TRUE(Enumeration(space).count() == effects.count + effect.gained);
    space.SwitchOff(effect.rule, false);
  }
  EXPECT_THROW(space.SwitchOff(0), std::logic_error);
}

TEST(Explain, KeepsToWhatIsFixed) {
  const Effects effects = Explain(ThreeByThree(), {{2, 0}});
  EXPECT_EQ(CountText(effects.count), "6");
  for (const PairEffect& effect : effects.pairs) {
    EXPECT_FALSE((effect.pair.first == Choice{2, 2})) << "h=c is not let through";
  }
}

}  // namespace
}  // namespace kompono::synthesis
