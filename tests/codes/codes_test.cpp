// SPDX-License-Identifier: Apache-2.0
// docs/codes.md lists every code that a diagnostic can carry, and no others. Sources are searched
// for string literals such as "E0304" and "W0455"; the plugin host numbers its refusals in an
// enumeration, E0201 and up.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

const fs::path kSource = KOMPONO_SOURCE_DIR;

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct InSources {
  std::set<std::string> codes;
  std::map<std::string, std::string> titles;  ///< where a part gives its codes titles
};

void Search(const std::string& text, InSources* found) {
  static const std::regex code(R"re("([EWN][0-9]{4})")re");
  static const std::regex title(R"re(\{\s*"([EWN][0-9]{4})",\s*"([^"]+)"\s*\};)re");
  const std::sregex_iterator end;
  for (std::sregex_iterator i(text.begin(), text.end(), code); i != end; ++i) {
    found->codes.insert((*i)[1]);
  }
  for (std::sregex_iterator i(text.begin(), text.end(), title); i != end; ++i) {
    found->titles[(*i)[1]] = (*i)[2];
  }
}

void SearchRefusals(const std::string& text, InSources* found) {
  static const std::regex enumerator(R"(\bk[A-Za-z]+ = (2[0-9]{2}),)");
  for (std::sregex_iterator i(text.begin(), text.end(), enumerator); i != std::sregex_iterator();
       ++i) {
    found->codes.insert("E0" + (*i)[1].str());
  }
}

InSources SearchSources() {
  InSources found;
  for (const char* part : {"framework", "plugins", "calibration", "catalog", "cli"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kSource / part)) {
      const std::string extension = entry.path().extension();
      if (extension == ".cpp" || extension == ".hpp") Search(Bytes(entry.path()), &found);
    }
  }
  SearchRefusals(Bytes(kSource / "framework/plugin/host/include/kompono/plugin/registry.hpp"),
                 &found);
  return found;
}

/// The rows "| E0304 | unknown module |" of docs/codes.md.
std::map<std::string, std::string> Listed() {
  static const std::regex row(R"(\| ([EWN][0-9]{4}) \| ([^|]*[^| ]) *\|)");
  std::map<std::string, std::string> listed;
  const std::string text = Bytes(kSource / "docs/codes.md");
  for (std::sregex_iterator i(text.begin(), text.end(), row); i != std::sregex_iterator(); ++i) {
    const bool is_new = listed.emplace((*i)[1], (*i)[2]).second;
    EXPECT_TRUE(is_new) << (*i)[1] << " is listed twice";
  }
  return listed;
}

TEST(Codes, TheSearchFindsLiteralsTitlesAndRefusals) {
  InSources found;
  Search(R"(inline constexpr CodeTitle kA{"E0999", "a thing"}; Complain("W0998", span); // E0997)",
         &found);
  SearchRefusals("  kCannotOpen = 201,\n", &found);
  EXPECT_THAT(found.codes, testing::ElementsAre("E0201", "E0999", "W0998"));
  EXPECT_THAT(found.titles, testing::ElementsAre(testing::Pair("E0999", "a thing")));
}

TEST(Codes, EveryCodeInTheSourcesIsListed) {
  const std::map<std::string, std::string> listed = Listed();
  for (const std::string& code : SearchSources().codes) {
    EXPECT_TRUE(listed.contains(code)) << code << " is missing in docs/codes.md";
  }
}

TEST(Codes, EveryListedCodeIsInTheSources) {
  const InSources found = SearchSources();
  for (const auto& [code, meaning] : Listed()) {
    EXPECT_TRUE(found.codes.contains(code)) << code << " is listed but nothing gives it";
  }
}

TEST(Codes, TitlesAreTheSameInBothPlaces) {
  const std::map<std::string, std::string> listed = Listed();
  for (const auto& [code, title] : SearchSources().titles) {
    const auto row = listed.find(code);
    if (row != listed.end()) {
      EXPECT_EQ(row->second, title) << code;
    }
  }
}

}  // namespace
