// SPDX-License-Identifier: Apache-2.0
#include "assignments.hpp"

#include "text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Argument, SplitsAtCommasAndKeepsPlaces) {
  Diagnostics problems;
  const Argument argument("--set", {"a = 1,b.c[2]=x", "d=-3"});
  const std::vector<Assignment> pieces = argument.Split(problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces[0].name, "a");
  EXPECT_EQ(pieces[0].value, "1");
  EXPECT_EQ(pieces[1].name, "b.c[2]");
  EXPECT_EQ(argument.text().substr(pieces[1].value_begin, 1), "x");
  EXPECT_EQ(argument.text().substr(pieces[2].name_begin, 4), "d=-3");
}

TEST(Argument, PiecesWithoutAValueAreNamed) {
  Diagnostics problems;
  EXPECT_EQ(Argument("--set", {"a=1,,b,=3"}).Split(problems).size(), 1U);
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_EQ(problems[0].message, "nothing between the commas");
  EXPECT_EQ(problems[1].message, "'b' has no value");
  EXPECT_EQ(problems[1].span.column, 6);
  EXPECT_EQ(problems[2].code, "E0609");
}

TEST(Argument, NumbersAndRangesAreWhole) {
  const auto number = [](const std::string& text) {
    Diagnostics problems;
    const Argument argument("--set", {"a=" + text});
    const auto value = argument.Number(argument.Split(problems).front(), problems);
    EXPECT_EQ(value.has_value(), problems.empty()) << text;
    return value;
  };
  EXPECT_EQ(number("-1.5e3"), -1500.0);
  EXPECT_EQ(number("+2"), 2.0);
  for (const char* wrong : {"", "1mm", "0x10", "nan", "inf", "1 2", "1e999", "+-1"})
    EXPECT_EQ(number(wrong), std::nullopt) << wrong;
  const auto range = [](const std::string& text) {
    Diagnostics problems;
    const Argument argument("--region", {"a=" + text});
    return argument.Range(argument.Split(problems).front(), problems).has_value();
  };
  EXPECT_TRUE(range("-5:5"));
  EXPECT_TRUE(range("3:3"));
  for (const char* wrong : {"5", "5:1", ":", "a:b", "1:2:3"}) EXPECT_FALSE(range(wrong)) << wrong;
}

TEST(NameTable, WholeNamesCountBeforeShortOnesAndLetterCaseLast) {
  const NameTable table("drive", {"front.q1", "back.q1", "front.q2", "Z", "z2"});
  EXPECT_THAT(table.Matches("front.q1"), ElementsAre(0));
  EXPECT_THAT(table.Matches("FRONT.Q1"), ElementsAre(0));
  EXPECT_THAT(table.Matches("q1"), ElementsAre(0, 1));
  EXPECT_THAT(table.Matches("q2"), ElementsAre(2));
  EXPECT_THAT(table.Matches("z"), ElementsAre(3));
  EXPECT_THAT(table.Matches("front"), ElementsAre());
}

TEST(NameTable, FurtherFormsCountAsMuch) {
  const NameTable table("number",
                        std::vector<std::vector<std::string>>{{"base.x", "base.position.x"},
                                                              {"Z.position.x", "Z.x"}});
  EXPECT_THAT(table.Matches("base.position.x"), ElementsAre(0));
  EXPECT_THAT(table.Matches("Z.x"), ElementsAre(1));
  EXPECT_THAT(table.Matches("position.x"), ElementsAre(0, 1));
  EXPECT_THAT(table.names(), ElementsAre("base.x", "Z.position.x"));
}

TEST(ReadNumbers, ReportsEveryKindOfFaultAtOnce) {
  Diagnostics problems;
  const NameTable table("drive", {"front.q1", "back.q1", "Z"});
  const auto numbers =
      ReadNumbers(Argument("--drives", {"q1=1,Z=2,Z=3,W=4,front.q1=x"}), table, problems);
  EXPECT_EQ(numbers[2], 2.0);
  std::vector<std::string> codes;
  for (const Diagnostic& problem : problems) codes.push_back(problem.code);
  EXPECT_THAT(codes, ElementsAre("E0606", "E0605", "E0604", "E0608"));
  EXPECT_THAT(problems[0].help, HasSubstr("front.q1, back.q1"));
}

TEST(Numbers, AreShortestExactAndNeverMinusZero) {
  EXPECT_EQ(Exact(0.1), "0.1");
  EXPECT_EQ(Exact(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(Fixed(-1e-9), "0.000000");
  EXPECT_EQ(Fixed(1.0 / 0.0), "-");
  EXPECT_EQ(Brief(-0.0), "0");
  EXPECT_EQ(Brief(Outward(Inward(210.0, true), true)), "210");
  EXPECT_EQ(RangeText(0.0, 10.0, false), "0 .. 10 mm");
  EXPECT_EQ(RangeText(std::nullopt, 10.0, false), "up to 10 mm");
  EXPECT_EQ(RangeText(std::nullopt, std::nullopt, true), "any");
}

TEST(TextTable, AlignsByCodePoints) {
  TextTable table({{"name"}, {"µm", true}, {"x"}});
  table.Row({"a", "1.5", "yes"});
  table.Line("between");
  table.Row({"Grübler", "20", ""});
  EXPECT_EQ(table.Render(),
            "  name      µm  x\n"
            "  a        1.5  yes\n"
            "between\n"
            "  Grübler   20\n");
}

}  // namespace
}  // namespace kompono::cli
