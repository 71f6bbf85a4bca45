// SPDX-License-Identifier: Apache-2.0
#include "glyphs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace kompono::formula {
namespace {

struct LookAlike {
  char32_t cyrillic;
  char32_t latin;
};

/// Only letters that cannot be told apart in print; в goes with В, і is Ukrainian.
constexpr std::array kLookAlikes{LookAlike{U'А', U'A'},
                                 LookAlike{U'В', U'B'},
                                 LookAlike{U'С', U'C'},
                                 LookAlike{U'Е', U'E'},
                                 LookAlike{U'О', U'O'},
                                 LookAlike{U'Р', U'P'},
                                 LookAlike{U'Х', U'X'},
                                 LookAlike{U'У', U'Y'},
                                 LookAlike{U'а', U'a'},
                                 LookAlike{U'в', U'b'},
                                 LookAlike{U'с', U'c'},
                                 LookAlike{U'е', U'e'},
                                 LookAlike{U'о', U'o'},
                                 LookAlike{U'р', U'p'},
                                 LookAlike{U'х', U'x'},
                                 LookAlike{U'у', U'y'},
                                 LookAlike{U'і', U'i'}};

std::optional<char32_t> LatinFor(char32_t code) {
  const auto* found = std::find_if(kLookAlikes.begin(),
                                   kLookAlikes.end(),
                                   [code](const LookAlike& pair) { return pair.cyrillic == code; });
  if (found == kLookAlikes.end()) return std::nullopt;
  return found->latin;
}

bool IsSpace(char32_t code) {
  return code == U' ' || (code >= U'\t' && code <= U'\r') || code == 0xA0 || code == 0x202F ||
         (code >= 0x2000 && code <= 0x200B) || code == 0x3000 || code == 0xFEFF;
}

bool IsAsciiLetter(char32_t code) {
  return (code >= U'a' && code <= U'z') || (code >= U'A' && code <= U'Z');
}

/// What a LaTeX command means in a formula.
struct Command {
  std::string_view name;
  char32_t code;  ///< ' ' for a space, 0 for nothing, else the character it stands for
};

constexpr std::array kCommands{Command{",", U' '},
                               Command{";", U' '},
                               Command{":", U' '},
                               Command{"!", U' '},
                               Command{">", U' '},
                               Command{" ", U' '},
                               Command{"quad", U' '},
                               Command{"qquad", U' '},
                               Command{"thinspace", U' '},
                               Command{"(", 0},
                               Command{")", 0},
                               Command{"[", 0},
                               Command{"]", 0},
                               Command{"left", 0},
                               Command{"right", 0},
                               Command{"bigl", 0},
                               Command{"bigr", 0},
                               Command{"big", 0},
                               Command{"mathrm", 0},
                               Command{"mathit", 0},
                               Command{"mathbf", 0},
                               Command{"mathsf", 0},
                               Command{"mathtt", 0},
                               Command{"text", 0},
                               Command{"textrm", 0},
                               Command{"textit", 0},
                               Command{"rm", 0},
                               Command{"it", 0},
                               Command{"_", U'_'},
                               Command{"|", U'|'},
                               Command{"mid", U'|'},
                               Command{"vert", U'|'},
                               Command{"prime", U'\''},
                               Command{"textquotesingle", U'\''}};

class GlyphReader {
 public:
  GlyphReader(std::string_view text, Report& report) : text_(text), report_(report) {}

  std::vector<Glyph> Read() {
    while (at_ < text_.size()) ReadOne();
    for (const Range& brace : open_braces_) {
      report_.Error(codes::kUnclosed,
                    brace,
                    "brace '{' is not closed",
                    "LaTeX braces come in pairs, as in Z_{xy}");
    }
    SayCyrillic();
    for (const Saying& saying : latex_) {
      const std::string places = saying.count == 1 ? "" : fmt::format(" ({} places)", saying.count);
      report_.Note(codes::kLatex, saying.first, saying.text + places);
    }
    return std::move(glyphs_);
  }

 private:
  /// One kind of LaTeX construct: said once, at its first place.
  struct Saying {
    std::string text;
    Range first;
    int count = 1;
  };

  void ReadOne() {
    const CodePoint point = DecodeAt(text_, at_);
    const Range where{at_, at_ + point.size};
    if (point.valid && point.code == U'\\') {
      ReadCommand();
      return;
    }
    at_ = where.end;
    if (!point.valid || point.code == 0) {
      Put(kNoCharacter, where);
    } else if (IsSpace(point.code)) {
      gap_ = Gap::kSpace;
    } else if (point.code == U'~') {
      gap_ = Gap::kSpace;
      SayLatex("LaTeX '~' read as a space", where);
    } else if (point.code == U'$') {
      SayLatex("LaTeX '$' left out", where);
    } else if (point.code == U'{') {
      open_braces_.push_back(where);
      SayLatex("LaTeX braces left out", where);
    } else if (point.code == U'}') {
      CloseBrace(where);
    } else if (const auto latin = LatinFor(point.code)) {
      PutLatin(*latin, where);
    } else {
      Put(point.code, where);
    }
  }

  void CloseBrace(Range where) {
    if (open_braces_.empty()) {
      report_.Error(codes::kUnopened,
                    where,
                    "brace '}' is not opened",
                    "LaTeX braces come in pairs, as in Z_{xy}");
    } else {
      open_braces_.pop_back();
      if (!glyphs_.empty() && glyphs_.back().where.end == where.begin) {
        glyphs_.back().where.end = where.end;
      }
    }
    gap_ = std::max(gap_, Gap::kBrace);
  }

  void ReadCommand() {
    const std::size_t begin = at_++;
    if (at_ < text_.size() && IsAsciiLetter(static_cast<unsigned char>(text_[at_]))) {
      while (at_ < text_.size() && IsAsciiLetter(static_cast<unsigned char>(text_[at_]))) ++at_;
    } else if (at_ < text_.size()) {
      at_ += DecodeAt(text_, at_).size;
    }
    const Range where{begin, at_};
    const std::string_view name = text_.substr(begin + 1, at_ - begin - 1);
    const auto* command = std::find_if(
        kCommands.begin(), kCommands.end(), [name](const Command& c) { return c.name == name; });
    if (command == kCommands.end()) {
      report_.Error(
          codes::kUnknownCommand,
          where,
          fmt::format("LaTeX command '{}' means nothing in a formula", report_.Quote(where)),
          "spaces such as \\, and fonts such as \\mathrm are read; leave the rest out");
      gap_ = Gap::kSpace;
    } else if (command->code == U' ') {
      SayLatex(fmt::format("LaTeX '\\{}' read as a space", name), where);
      gap_ = Gap::kSpace;
    } else if (command->code == 0) {
      SayLatex(fmt::format("LaTeX '\\{}' left out", name), where);
    } else {
      SayLatex(fmt::format("LaTeX '\\{}' read as '{}'", name, static_cast<char>(command->code)),
               where);
      Put(command->code, where);
    }
  }

  void SayLatex(std::string text, Range where) {
    const auto known = std::find_if(latex_.begin(), latex_.end(), [&text](const Saying& saying) {
      return saying.text == text;
    });
    if (known == latex_.end()) {
      latex_.push_back({std::move(text), where});
    } else {
      ++known->count;
    }
  }

  void Put(char32_t code, Range where) {
    glyphs_.push_back({code, where, gap_});
    gap_ = Gap::kNone;
  }

  void PutLatin(char32_t latin, Range where) {
    if (cyrillic_.end != where.begin) SayCyrillic();
    if (latin_.empty()) cyrillic_.begin = where.begin;
    cyrillic_.end = where.end;
    latin_ += static_cast<char>(latin);
    Put(latin, where);
  }

  /// One note for letters that stand together.
  void SayCyrillic() {
    if (latin_.empty()) return;
    report_.Note(codes::kCyrillic,
                 cyrillic_,
                 fmt::format("Cyrillic '{}' read as Latin '{}'", report_.Quote(cyrillic_), latin_));
    latin_.clear();
  }

  std::string_view text_;
  Report& report_;
  std::size_t at_ = 0;
  Gap gap_ = Gap::kNone;
  std::vector<Glyph> glyphs_;
  std::vector<Range> open_braces_;
  std::vector<Saying> latex_;
  Range cyrillic_;
  std::string latin_;
};

}  // namespace

CodePoint DecodeAt(std::string_view text, std::size_t at) {
  const auto byte = [text](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned lead = byte(at);
  if (lead < 0x80U) return {static_cast<char32_t>(lead), 1, true};
  const std::size_t size = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U) return {kNoCharacter, 1, false};
  char32_t code = lead & (0xFFU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(at + i) & 0xC0U) != 0x80U) return {kNoCharacter, 1, false};
    code = (code << 6U) | (byte(at + i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kSmallest[size] || code > 0x10FFFF || surrogate) return {kNoCharacter, 1, false};
  return {code, size, true};
}

std::vector<Glyph> ReadGlyphs(std::string_view text, Report& report) {
  return GlyphReader(text, report).Read();
}

}  // namespace kompono::formula
