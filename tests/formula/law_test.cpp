// SPDX-License-Identifier: Apache-2.0
#include "random_formula.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "kompono/formula/equivalence.hpp"

namespace kompono::formula {
namespace {

constexpr int kRounds = 3000;

/// A random formula whose text is short enough to be read again in any of the dialects.
Formula NextFormula(std::mt19937& random) {
  Formula formula = RandomFormula(random);
  while (Canonical(formula).size() > kMaxTextBytes / 4) formula = RandomFormula(random);
  return formula;
}

TEST(RoundTrip, GivesBackEveryTreeWithoutNotes) {
  std::mt19937 random(Seed(1));
  for (int i = 0; i < kRounds; ++i) {
    const Formula formula = NextFormula(random);
    const std::string text = Canonical(formula);
    Diagnostics notes;
    const auto again = ParseFormula(text, "formula", &notes);
    ASSERT_TRUE(again) << RenderAll(again.error(), {});
    ASSERT_EQ(*again, formula) << text;
    ASSERT_TRUE(notes.empty()) << RenderAll(notes, {});
  }
}

TEST(RoundTrip, TellsDifferentTreesApart) {
  std::mt19937 random(Seed(2));
  std::map<std::string, Formula> seen;
  for (int i = 0; i < kRounds; ++i) {
    const Formula formula = NextFormula(random);
    const auto [place, is_new] = seen.emplace(Canonical(formula), formula);
    ASSERT_TRUE(is_new || place->second == formula) << place->first;
  }
  EXPECT_GT(seen.size(), static_cast<std::size_t>(kRounds / 2))
      << "the trees are too much alike to tell anything";
}

/// Spaces left out wherever the notation allows it.
std::string WithoutSpaces(std::string_view text) {
  std::string shorter;
  bool in_block = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ':') in_block = true;
    if (c != ' ') {
      shorter += c;
      if (std::string_view("()+").find(c) != std::string_view::npos) in_block = false;
      continue;
    }
    const char next = text[i + 1];
    const bool digit = std::isdigit(static_cast<unsigned char>(next)) != 0;
    // "p a r tool" would begin with "part", "b tool" is told apart.
    const bool word = std::islower(static_cast<unsigned char>(shorter.back())) != 0 &&
                      (text.substr(i + 1, 4) == "tool" || text.substr(i + 1, 4) == "part");
    if (digit || word || (in_block && std::string_view("()+").find(next) == std::string_view::npos))
      shorter += ' ';
    in_block = false;
  }
  return shorter;
}

TEST(Spaces, AreOptional) {
  EXPECT_EQ(WithoutSpaces("part X (XY):drive O|O Z2 2(Y tool + b tool)"),
            "partX(XY):drive O|OZ2 2(Ytool+b tool)");
  std::mt19937 random(Seed(3));
  for (int i = 0; i < kRounds; ++i) {
    const Formula formula = NextFormula(random);
    const std::string text = WithoutSpaces(Canonical(formula));
    const auto again = ParseFormula(text);
    ASSERT_TRUE(again) << RenderAll(again.error(), {});
    ASSERT_EQ(*again, formula) << text;
  }
}

std::string InCyrillic(std::mt19937& random, std::string_view text) {
  static const std::map<char, std::string> kLetters{{'A', "А"},
                                                    {'B', "В"},
                                                    {'C', "С"},
                                                    {'E', "Е"},
                                                    {'O', "О"},
                                                    {'P', "Р"},
                                                    {'X', "Х"},
                                                    {'Y', "У"},
                                                    {'a', "а"},
                                                    {'b', "в"},
                                                    {'c', "с"},
                                                    {'e', "е"},
                                                    {'o', "о"},
                                                    {'p', "р"},
                                                    {'x', "х"},
                                                    {'y', "у"}};
  std::string mixed;
  for (const char c : text) {
    const auto found = kLetters.find(c);
    mixed += found != kLetters.end() && Pick(random, 1) == 0 ? found->second : std::string(1, c);
  }
  return mixed;
}

TEST(Cyrillic, LookAlikesChangeNothing) {
  std::mt19937 random(Seed(4));
  for (int i = 0; i < kRounds; ++i) {
    const Formula formula = NextFormula(random);
    const std::string text = InCyrillic(random, Canonical(formula));
    const auto again = ParseFormula(text);
    ASSERT_TRUE(again) << RenderAll(again.error(), {});
    ASSERT_EQ(*again, formula) << text;
  }
}

/// Indices in braces, spaces as LaTeX spaces, between dollars; "_" in block names as "\_".
std::string InLatex(std::string_view text) {
  std::string latex = "$";
  bool in_block = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (std::string_view(" ()+:").find(c) != std::string_view::npos) in_block = c == ':';
    if (c == ' ') {
      latex += "\\,";
    } else if (c == '_' && in_block) {
      latex += "\\_";
    } else if (c == '_') {
      std::size_t end = i + 1;
      while (end < text.size() && std::islower(static_cast<unsigned char>(text[end])) != 0) ++end;
      latex += "_{" + std::string(text.substr(i + 1, end - i - 1)) + "}";
      i = end - 1;
    } else {
      latex += c;
    }
  }
  return latex + "$";
}

TEST(Latex, ChangesNothing) {
  EXPECT_EQ(InLatex("part_xy X:a_b O C_v"), "$part_{xy}\\,X:a\\_b\\,O\\,C_{v}$");
  std::mt19937 random(Seed(5));
  for (int i = 0; i < kRounds; ++i) {
    const Formula formula = NextFormula(random);
    const std::string text = InLatex(Canonical(formula));
    const auto again = ParseFormula(text);
    ASSERT_TRUE(again) << RenderAll(again.error(), {});
    ASSERT_EQ(*again, formula) << text;
  }
}

TEST(Explain, HasOneLineForEveryElement) {
  std::mt19937 random(Seed(6));
  for (int i = 0; i < kRounds / 10; ++i) {
    const Formula formula = NextFormula(random);
    const std::vector<Explanation> lines = Explain(formula);
    for (const Explanation& line : lines) ASSERT_FALSE(line.text.empty() || line.meaning.empty());
    for (const Item& item : formula.left) {
      ASSERT_TRUE(std::any_of(lines.begin(), lines.end(), [&item](const Explanation& line) {
        return line.depth == 0 && line.text == ItemText(item);
      }));
    }
  }
}

bool Translates(const Item& item) {
  const auto* axis = std::get_if<Axis>(&item);
  const auto* group = std::get_if<Group>(&item);
  if (group != nullptr) {
    return std::none_of(
        group->axes.begin(), group->axes.end(), [](const Axis& a) { return a.rotary(); });
  }
  return axis != nullptr && !axis->rotary();
}

TEST(Equivalence, SwappingNeighbouringTranslationsKeepsTheDistributionAndOtherSwapsDoNot) {
  std::mt19937 random(Seed(7));
  int commuting = 0;
  int others = 0;
  for (int i = 0; i < kRounds; ++i) {
    const Formula formula = NextFormula(random);
    Formula swapped = formula;
    Chain& right = swapped.right;
    for (std::size_t k = 0; k + 2 < right.size(); ++k) {
      const auto* group = std::get_if<Group>(&right[k]);
      if (group != nullptr && group->block.empty()) continue;  // two of them may be equal
      const bool commutes = Translates(right[k]) && Translates(right[k + 1]);
      std::swap(right[k], right[k + 1]);
      ASSERT_EQ(DistributionKey(swapped) == DistributionKey(formula), commutes)
          << Canonical(swapped);
      ASSERT_EQ(RelativeMotionKey(swapped) == RelativeMotionKey(formula), commutes)
          << Canonical(swapped);
      std::swap(right[k], right[k + 1]);
      ++(commutes ? commuting : others);
    }
  }
  EXPECT_GT(commuting, kRounds / 20);
  EXPECT_GT(others, kRounds / 20);
}

TEST(Equivalence, MovingAnAxisAcrossTheBaseKeepsTheRelativeMotionOnly) {
  std::mt19937 random(Seed(8));
  int moved = 0;
  for (int i = 0; i < kRounds; ++i) {
    const Formula formula = NextFormula(random);
    Formula other = formula;
    if (other.left.size() < 2) continue;
    other.right.insert(other.right.begin(), other.left.back());
    other.left.pop_back();
    ASSERT_EQ(RelativeMotionKey(other), RelativeMotionKey(formula)) << Canonical(other);
    ASSERT_NE(DistributionKey(other), DistributionKey(formula)) << Canonical(other);
    ++moved;
  }
  EXPECT_GT(moved, kRounds / 4);
}

}  // namespace
}  // namespace kompono::formula
