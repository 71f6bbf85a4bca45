// SPDX-License-Identifier: Apache-2.0
#include "kompono/layout/numbers.hpp"

#include "shipped_registry.hpp"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::layout {
namespace {

TEST(Patterns, MatchNamesAndWhatLiesBelowThem) {
  EXPECT_TRUE(MatchesPattern("struts.base[1].x", "struts.base[1].x"));
  EXPECT_TRUE(MatchesPattern("struts.base[1]", "struts.base[1].x"));
  EXPECT_TRUE(MatchesPattern("struts.base[*]", "struts.base[1].x"));
  EXPECT_TRUE(MatchesPattern("struts.base", "struts.base[1].x"));
  EXPECT_TRUE(MatchesPattern("struts", "struts.base[1].x"));
  EXPECT_TRUE(MatchesPattern("*.zero", "struts.q1.zero"));
  EXPECT_TRUE(MatchesPattern("*", "Z.zero"));
  EXPECT_TRUE(MatchesPattern("s*s.q*.z*", "struts.q1.zero"));
  EXPECT_FALSE(MatchesPattern("struts.base", "struts.base_radius"));
  EXPECT_FALSE(MatchesPattern("struts.base[1]", "struts.base[12].x"));
  EXPECT_FALSE(MatchesPattern("*.zeros", "struts.q1.zero"));
  EXPECT_FALSE(MatchesPattern("", "struts"));
  EXPECT_FALSE(MatchesPattern("base", "struts.base"));
}

TEST(Patterns, WithManyStarsEndSoon) {
  std::string pattern;
  for (int i = 0; i < 2000; ++i) pattern += "a*";
  EXPECT_FALSE(MatchesPattern(pattern + "b", std::string(1000, 'a')));
}

TEST(NumbersOfALayout, HaveTheirNamesOnce) {
  for (const std::string& file : TomlFilesIn("layouts/machines")) {
    const auto layout = ReadLayout(file, ShippedRegistry());
    ASSERT_TRUE(layout) << RenderAll(layout.error(), {});
    std::set<std::string> names;
    for (const Number& number : NumbersOf(*layout, ShippedRegistry())) {
      EXPECT_TRUE(names.insert(number.name).second) << file << ": " << number.name;
      for (const std::string& other : number.other_names)
        EXPECT_TRUE(names.insert(other).second) << file << ": " << other;
    }
  }
}

TEST(NumbersOfALayout, CoverParametersMountsZerosOpenBaseAndEnds) {
  const auto layout = ReadLayout("layouts/machines/so_waterjet_lambda.toml", ShippedRegistry());
  ASSERT_TRUE(layout);
  const std::vector<Number> numbers = NumbersOf(*layout, ShippedRegistry());
  const auto value = [&numbers](const std::string& name) {
    for (const Number& number : numbers) {
      const auto& others = number.other_names;
      if (number.name == name || std::count(others.begin(), others.end(), name) > 0)
        return number.value;
    }
    ADD_FAILURE() << name;
    return 0.0;
  };
  EXPECT_EQ(value("drive.L1"), 1200.0);
  EXPECT_EQ(value("drive.q1.zero"), 0.0);
  EXPECT_EQ(value("drive.mount.position.x"), 0.0);
  EXPECT_EQ(value("drive.mount.c"), 0.0);
  EXPECT_EQ(value("open_base.x"), 500.0);
  EXPECT_EQ(value("open_base.position.y"), 600.0);
  EXPECT_EQ(value("Z.position.z"), 0.0);
  EXPECT_EQ(value("Z.x"), 0.0);
  EXPECT_EQ(value("P_z.tube_length"), 76.0);
  EXPECT_EQ(value("tool.tube_length"), 76.0);
  EXPECT_EQ(value("tool.mount.rotation.a"), 0.0);
}

TEST(NumbersOfALayout, LeaveOutWhatAPresetHasFixed) {
  const auto layout = ReadLayout("layouts/machines/flsun_v400.toml", ShippedRegistry());
  ASSERT_TRUE(layout);
  for (const Number& number : NumbersOf(*layout, ShippedRegistry()))
    EXPECT_EQ(number.name.find("inclination"), std::string::npos) << number.name;
}

}  // namespace
}  // namespace kompono::layout
