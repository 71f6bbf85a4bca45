// SPDX-License-Identifier: Apache-2.0
// docs/layout-file.md speaks of every key and every code.
#include "shipped_registry.hpp"
#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include "kompono/layout/codes.hpp"

namespace kompono::layout {
namespace {

const std::string& Page() {
  static const std::string page = ReadText("docs/layout-file.md");
  return page;
}

TEST(LayoutFilePage, ExplainsEveryCode) {
  for (const CodeTitle& code : kCodes) {
    const std::string row = "| " + std::string(code.code) + " | " + std::string(code.title) + " |";
    EXPECT_NE(Page().find(row), std::string::npos) << row;
  }
}

void ExpectKeys(const nlohmann::json& table, const std::string& where) {
  for (const char* list : {"properties", "patternProperties"}) {
    if (!table.contains(list)) continue;
    for (const auto& [key, value] : table[list].items()) {
      std::string name = key;
      if (name.front() == '^') name = name.substr(1, name.find('[') - 1);
      const bool as_key = Page().find("`" + name + "`") != std::string::npos;
      const bool as_table = Page().find("`[" + name) != std::string::npos;
      EXPECT_TRUE(as_key || as_table) << where << " " << name;
    }
  }
}

TEST(LayoutFilePage, ExplainsEveryKey) {
  const auto schema = nlohmann::json::parse(LayoutSchema(ShippedRegistry()));
  ExpectKeys(schema, "the file");
  for (const auto& [name, table] : schema["$defs"].items()) ExpectKeys(table, name);
}

TEST(LayoutFilePage, ShowsAnExampleThatIsGood) {
  const std::size_t begin = Page().find("```toml\n") + 8;
  const std::size_t end = Page().find("```", begin);
  ASSERT_LT(end, Page().size());
  const Outcome outcome = Parse(Page().substr(begin, end - begin));
  EXPECT_TRUE(outcome.layout) << outcome.complaints;
}

}  // namespace
}  // namespace kompono::layout
