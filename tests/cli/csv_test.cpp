// SPDX-License-Identifier: Apache-2.0
#include "csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(NumberTable, ReadsHeadingsNumbersCommentsAndMarks) {
  const auto table =
      ReadNumberTable("\xEF\xBB\xBF# comment\r\n x , y\r\n1,-2.5\r\n\r\n3e2,4", "t.csv");
  ASSERT_TRUE(table.has_value());
  EXPECT_THAT(table->headings, ElementsAre("x", "y"));
  EXPECT_THAT(table->rows, ElementsAre(ElementsAre(1.0, -2.5), ElementsAre(300.0, 4.0)));
  EXPECT_THAT(table->lines, ElementsAre(3, 5));
}

TEST(NumberTable, ReportsEveryFaultWithItsPlace) {
  const auto table = ReadNumberTable("x,y\n1\na,2\n3,b\n", "t.csv");
  ASSERT_FALSE(table.has_value());
  ASSERT_EQ(table.error().size(), 3U);
  EXPECT_EQ(table.error()[0].span.line, 2);
  EXPECT_EQ(table.error()[2].span.line, 4);
  EXPECT_EQ(table.error()[2].span.column, 3);
  EXPECT_THAT(table.error()[2].message, HasSubstr("'b' is no number"));
  EXPECT_FALSE(ReadNumberTable("", "t.csv").has_value());
  EXPECT_FALSE(ReadNumberTable("# only this\n", "t.csv").has_value());
}

TEST(NumberTable, FieldsAreQuotedWhenTheyMust) {
  EXPECT_EQ(CsvField("plain text"), "plain text");
  EXPECT_EQ(CsvField("a,b"), "\"a,b\"");
  EXPECT_EQ(CsvField("say \"no\""), "\"say \"\"no\"\"\"");
}

}  // namespace
}  // namespace kompono::cli
