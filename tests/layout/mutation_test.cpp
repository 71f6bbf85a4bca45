// SPDX-License-Identifier: Apache-2.0
// Whatever stands in a layout file, reading it ends with a layout or with complaints.
#include "shipped_registry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

namespace kompono::layout {
namespace {

using Random = std::mt19937_64;

std::size_t Below(Random& random, std::size_t limit) {
  return limit == 0 ? 0 : static_cast<std::size_t>(random() % limit);
}

/// Pieces that mean something to TOML, to formulas or to the reader.
constexpr std::array<std::string_view, 36> kPieces{"nan",
                                                   "-inf",
                                                   "1e308",
                                                   "1e-320",
                                                   "[",
                                                   "]",
                                                   "{",
                                                   "}",
                                                   "\"",
                                                   "'",
                                                   "\"\"\"",
                                                   "\n",
                                                   "\r\n",
                                                   "\\",
                                                   "\\u0041",
                                                   "\xff",
                                                   "\xd0\x9e",
                                                   "O|O",
                                                   "(XY):",
                                                   "+",
                                                   "= ",
                                                   ",",
                                                   "[block.",
                                                   "[[part]]",
                                                   "module",
                                                   "\"hexapod\"",
                                                   "0",
                                                   "-1",
                                                   "9223372036854775807",
                                                   "true",
                                                   "1979-05-27",
                                                   "mount = { rotation = [0, 0, 30] }",
                                                   "[open_base]\n",
                                                   "#",
                                                   "free = [\"*\"]",
                                                   "\0"};

std::string Mutate(std::string text, const std::vector<std::string>& all, Random& random) {
  const std::size_t changes = 1 + Below(random, 4);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = Below(random, text.size() + 1);
    const std::size_t length = std::min(Below(random, 40), text.size() - at);
    switch (Below(random, 6)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, kPieces[Below(random, kPieces.size())]);
        break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(random() & 0xFFU);
        break;
      case 3:
        text.insert(Below(random, text.size() + 1), text.substr(at, length));
        break;
      case 4: {  // a line of another file
        const std::string& other = all[Below(random, all.size())];
        const std::size_t begin = Below(random, other.size());
        text.insert(at, other.substr(begin, other.find('\n', begin) + 1 - begin));
        break;
      }
      default: {  // a value in place of another
        const std::size_t equals = text.find("= ", at);
        if (equals == std::string::npos) break;
        const std::size_t end = std::min(text.find('\n', equals), text.size());
        text.replace(equals + 2, end - equals - 2, kPieces[Below(random, kPieces.size())]);
      }
    }
  }
  return text;
}

std::vector<std::string> Seeds() {
  std::vector<std::string> texts;
  for (const char* folder : {"layouts/machines", "layouts/bad"}) {
    for (const std::string& file : TomlFilesIn(folder)) texts.push_back(ReadText(file));
  }
  return texts;
}

std::uint64_t SeedOfRun() {
  const char* given = std::getenv("KOMPONO_TEST_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
}

/// True if the text is a good layout; then a number can be replaced in it whatever it looks like.
bool ExpectJudged(const std::string& text) {
  const Parsed<Layout> layout = ParseLayout(text, "mutant.toml", ShippedRegistry());
  if (!layout) {
    EXPECT_TRUE(HasErrors(layout.error())) << text;
    EXPECT_FALSE(RenderAll(layout.error(), {}).empty());
    return false;
  }
  const std::vector<Number> numbers = NumbersOf(*layout, ShippedRegistry());
  // Four of them, spread over the layout, and others for another text.
  const std::size_t step = 1 + numbers.size() / 4;
  for (std::size_t i = text.size() % step; i < numbers.size(); i += step) {
    const Number& number = numbers[i];
    const bool whole = number.pure && number.value == std::round(number.value);  // a count
    const Replacement change{.parameter = number.name,
                             .value = whole ? number.value : number.value * 1.0001,
                             .sigma = 1e-3};
    const auto rewritten = ReplaceNumbers(*layout, ShippedRegistry(), {change}, "mutation");
    EXPECT_TRUE(rewritten) << RenderAll(rewritten.error(), {}) << number.name << " of\n" << text;
    if (!rewritten) break;
  }
  return true;
}

TEST(MutatedLayouts, AreJudgedWithoutACrash) {
  const std::uint64_t seed = SeedOfRun();
  RecordProperty("seed", std::to_string(seed));
  std::cout << "seed " << seed << " (set KOMPONO_TEST_SEED to repeat)\n";
  Random random(seed);
  const std::vector<std::string> texts = Seeds();
  int good = 0;
  constexpr int kRounds = 2000;
  for (int i = 0; i < kRounds && !HasFailure(); ++i)
    good += ExpectJudged(Mutate(texts[Below(random, texts.size())], texts, random)) ? 1 : 0;
  EXPECT_GT(good, kRounds / 100) << "mutants that stay good are wanted too";
  EXPECT_LT(good, kRounds * 2 / 3) << "so are those that break";
}

TEST(CutLayouts, AreJudgedWithoutACrash) {
  for (const std::string& text : {ReadText("layouts/machines/so_waterjet_lambda.toml"),
                                  ReadText("layouts/bad/everything.toml")}) {
    for (std::size_t length = 0; length < text.size(); length += 3)
      static_cast<void>(ExpectJudged(text.substr(0, length)));
  }
}

TEST(DeeplyNestedLayouts, AreRefusedAndNotFollowed) {
  EXPECT_FALSE(ExpectJudged("kompono = 1\nformula = " + std::string(100000, '[')));
  std::string tables = "kompono = 1\nformula = \"X O\"\na = ";
  for (int i = 0; i < 5000; ++i) tables += "{ a = ";
  EXPECT_FALSE(ExpectJudged(tables));
}

}  // namespace
}  // namespace kompono::layout
