// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "kompono/catalog/query.hpp"

namespace kompono::catalog {
namespace {

Table Sample() {
  return {.columns = {{.name = "name", .type = "text"},
                      {.name = "rms, µm", .type = "real"},
                      {.name = "n", .type = "integer"}},
          .rows = {{std::string("Фреза"), 38.25, std::int64_t{3}},
                   {std::string("a \"quoted\", one"), std::monostate{}, std::int64_t{-12}},
                   {std::string("two\nlines"), 1.0 / 3.0, std::monostate{}},
                   {std::string(), 1e300, std::int64_t{9007199254740993}}}};
}

TEST(RenderText, AlignsTextLeftAndNumbersRight) {
  EXPECT_EQ(RenderText(Sample()),
            "name              rms, µm                 n\n"
            "---------------  --------  ----------------\n"
            "Фреза               38.25                 3\n"
            "a \"quoted\", one                         -12\n"
            "two\\x0alines     0.333333\n"
            "                   1e+300  9007199254740993\n");
}

TEST(RenderText, ShowsTheHeadingOfAnEmptyTable) {
  EXPECT_EQ(RenderText({.columns = {{.name = "id"}, {.name = "name"}}, .rows = {}}),
            "id  name\n--  ----\n");
}

TEST(RenderText, LetsNothingReachTheTerminalThatCouldSteerIt) {
  const Table table{.columns = {{.name = "\x1b[2J"}},
                    .rows = {{std::string("\x1b]0;x\x07 \x7f \xc2\x9b"
                                          "31m é")}}};
  EXPECT_EQ(RenderText(table),
            "\\x1b[2J\n---------------------------\n\\x1b]0;x\\x07 \\x7f \\x9b31m é\n");
}

TEST(RenderCsv, FollowsRfc4180) {
  EXPECT_EQ(RenderCsv(Sample()),
            "name,\"rms, µm\",n\r\n"
            "Фреза,38.25,3\r\n"
            "\"a \"\"quoted\"\", one\",,-12\r\n"
            "\"two\nlines\",0.3333333333333333,\r\n"
            "\"\",1e+300,9007199254740993\r\n");
}

/// An independent reader of RFC 4180.
std::vector<std::vector<std::string>> ReadCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows = {{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"')
        rows.back().back() += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        rows.back().back() += text[i++];
      else
        quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      rows.back().emplace_back();
    } else if (c == '\r' && text[i + 1] == '\n') {
      rows.push_back({""});
      ++i;
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

TEST(RenderCsv, ReadsBackWhateverTheTextsHold) {
  const std::vector<std::string> nasty = {
      "", " ", "\"", "\"\"", ",", "\r\n", "\r", "a,b", " lead", "trail ", "x\"y,\nz"};
  Table table{.columns = {{.name = "a,\"b\""}, {.name = "c"}}, .rows = {}};
  for (const std::string& a : nasty) {
    for (const std::string& b : nasty) table.rows.push_back({a, b});
  }
  const auto read = ReadCsv(RenderCsv(table));
  ASSERT_EQ(read.size(), table.rows.size() + 1);
  EXPECT_EQ(read[0], (std::vector<std::string>{"a,\"b\"", "c"}));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    EXPECT_EQ(read[i + 1][0], std::get<std::string>(table.rows[i][0]));
    EXPECT_EQ(read[i + 1][1], std::get<std::string>(table.rows[i][1]));
  }
}

TEST(RenderCsv, NumbersReadBackExactly) {
  for (const double value :
       {0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -0.0, 123456789.123456789}) {
    const auto read = ReadCsv(RenderCsv({.columns = {{.name = "x"}}, .rows = {{value}}}));
    EXPECT_EQ(std::strtod(read[1][0].c_str(), nullptr), value);
  }
}

TEST(ToJson, KeepsColumnOrderTypesAndNull) {
  EXPECT_EQ(
      ToJson(Table{.columns = {{.name = "z", .type = "text"}, {.name = "a", .type = "real"}},
                   .rows = {{std::string("é\"\n"), std::monostate{}}, {std::monostate{}, 0.5}},
                   .more = true})
          .dump(),
      "{\"columns\":[{\"name\":\"z\",\"type\":\"text\"},{\"name\":\"a\",\"type\":\"real\"}],"
      "\"rows\":[{\"z\":\"é\\\"\\n\",\"a\":null},{\"z\":null,\"a\":0.5}],\"more\":true}");
}

TEST(ToJson, HasNoNumberForInfinity) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ToJson(Table{.columns = {{.name = "x"}}, .rows = {{infinity}}})["rows"][0]["x"],
            nullptr);
}

}  // namespace
}  // namespace kompono::catalog
