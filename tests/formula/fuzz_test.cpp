// SPDX-License-Identifier: Apache-2.0
#include "random_formula.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "kompono/formula/codes.hpp"

namespace kompono::formula {
namespace {

int CodePoints(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string Escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    escaped += byte >= 0x20 && byte < 0x7F
                   ? std::string(1, c)
                   : std::string{'\\', 'x', kDigits[byte / 16], kDigits[byte % 16]};
  }
  return escaped;
}

/// Lies inside the text, or right behind a line's end.
testing::AssertionResult IsInside(const SourceSpan& span, std::string_view text) {
  text = text.substr(0, kMaxTextBytes);
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  if (span.line < 1 || span.line > lines)
    return testing::AssertionFailure() << "line " << span.line;
  const int width = CodePoints(span.line_text);
  if (span.column < 1 || span.column > width + 1)
    return testing::AssertionFailure() << "column " << span.column;
  if (span.length < 1 || span.column + span.length > std::max(width, span.column) + 1) {
    return testing::AssertionFailure() << "column " << span.column << " length " << span.length;
  }
  if (text.find(span.line_text) == std::string_view::npos)
    return testing::AssertionFailure() << "foreign line";
  return testing::AssertionSuccess();
}

bool IsKnown(const Diagnostic& said, char kind) {
  return said.code.front() == kind &&
         std::any_of(kCodes.begin(), kCodes.end(), [&said](const CodeTitle& known) {
           return known.code == said.code;
         });
}

/// What must hold for any text whatsoever. Returns whether it was a formula.
bool Judge(std::string_view text) {
  SCOPED_TRACE(Escaped(text));
  Diagnostics notes;
  const auto formula = ParseFormula(text, "fuzz", &notes);
  for (const Diagnostic& note : notes) {
    EXPECT_TRUE(IsKnown(note, 'N')) << note.code;
    EXPECT_EQ(note.severity, Severity::kNote);
    EXPECT_TRUE(IsInside(note.span, text)) << note.message;
  }
  if (!formula) {
    EXPECT_TRUE(HasErrors(formula.error()));
    for (const Diagnostic& error : formula.error()) {
      EXPECT_TRUE(IsKnown(error, 'E')) << error.code;
      EXPECT_EQ(error.severity, Severity::kError);
      EXPECT_TRUE(IsInside(error.span, text)) << error.message;
      EXPECT_FALSE(error.message.empty());
      EXPECT_FALSE(error.help.empty()) << error.message;
    }
    return false;
  }
  const std::string canonical = Canonical(*formula);
  Diagnostics again_notes;
  const auto again = ParseFormula(canonical, "fuzz", &again_notes);
  EXPECT_TRUE(again) << canonical;
  EXPECT_TRUE(again.has_value() && *again == *formula) << canonical;
  EXPECT_TRUE(again_notes.empty()) << canonical;
  EXPECT_FALSE(Explain(*formula).empty());
  return true;
}

TEST(Fuzz, RandomBytesAreJudged) {
  std::mt19937 random(Seed(11));
  for (int i = 0; i < 20000 && !testing::Test::HasFailure(); ++i) {
    std::string text(static_cast<std::size_t>(Pick(random, 40)), ' ');
    for (char& c : text) c = static_cast<char>(Pick(random, 255));
    Judge(text);
  }
}

TEST(Fuzz, RandomWordsOfTheNotationAreJudged) {
  constexpr std::array<std::string_view, 56> kWords{
      "X",     "Y",     "Z",    "C",        "B",    "P",      "z", "w",  "b",  "t",
      "O",     "O",     "O|O",  "|",        "0",    "1",      "2", "10", "(",  ")",
      "(",     ")",     "+",    "_",        ":",    " ",      " ", "_v", "_h", "_xy",
      "_{xy}", "part",  "tool", "P_z",      "Z_xy", ":drive", "{", "}",  "$",  "\\,",
      "[",     "]",     "'",    "′",        "О",    "С",      "Ж", "\n", "\t", "K",
      "(XY)",  "(X+Y)", "2(",   "\\mathrm", "-",    "x"};
  std::mt19937 random(Seed(12));
  int formulas = 0;
  for (int i = 0; i < 40000 && !testing::Test::HasFailure(); ++i) {
    std::string text;
    for (int n = Pick(random, 12); n >= 0; --n)
      text += kWords[static_cast<std::size_t>(Pick(random, 55))];
    formulas += Judge(text) ? 1 : 0;
  }
  EXPECT_GT(formulas, 100) << "too few of them are formulas to test the good path";
}

TEST(Fuzz, MutatedFormulasAreJudged) {
  constexpr std::string_view kSigns = "XYZABCOPxyzv()+|_:20[]{}$'\\ part";
  std::mt19937 random(Seed(13));
  int formulas = 0;
  for (int i = 0; i < 20000 && !testing::Test::HasFailure(); ++i) {
    std::string text = Canonical(RandomFormula(random));
    for (int n = Pick(random, 3); n >= 0; --n) {
      const auto at = static_cast<std::size_t>(Pick(random, static_cast<int>(text.size())));
      const auto length = static_cast<std::size_t>(Pick(random, 3));
      const char sign =
          kSigns[static_cast<std::size_t>(Pick(random, static_cast<int>(kSigns.size()) - 1))];
      switch (Pick(random, 3)) {
        case 0:
          text.insert(at, 1, sign);
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, text.substr(at / 2, 4 * length));
          break;
        default:
          text.replace(at, length, 1, static_cast<char>(Pick(random, 255)));
      }
    }
    formulas += Judge(text) ? 1 : 0;
  }
  EXPECT_GT(formulas, 500);
}

TEST(Fuzz, ExtremesAreJudged) {
  for (const std::string_view unit :
       {"(", ")",  "+", "O",    "|",   "X",    "_",    ":",  "0", "2(",   "(X+", "[",
        "{", "\\", "Ж", "part", "P_z", "\xff", "\xd0", "\n", "$", "((X)", "O|"}) {
    for (const std::size_t bytes : {std::size_t{3}, kMaxTextBytes - 8, kMaxTextBytes + 8}) {
      std::string text;
      while (text.size() < bytes) text += unit;
      Judge(text);
    }
  }
  Judge(std::string("X\0O\0Z", 5));
  Judge("");
}

}  // namespace
}  // namespace kompono::formula
