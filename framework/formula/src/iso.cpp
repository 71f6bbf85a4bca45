// SPDX-License-Identifier: Apache-2.0
#include "glyphs.hpp"
#include "vocabulary.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace kompono::formula {
namespace {

enum class TokenKind { kPart, kBase, kTool, kAxis, kSpindle, kOther };

struct Token {
  TokenKind kind = TokenKind::kOther;
  std::vector<Glyph> glyphs;
  Range where;
  std::optional<Range> prime;
};

bool IsPrime(char32_t code) {
  return code == U'\'' || code == 0x2032 || code == 0x2019;
}
bool IsDash(char32_t code) {
  return code == U'-' || code == 0x2010 || code == 0x2013;
}

std::string NameOf(const Token& token) {
  std::string name;
  for (const Glyph& glyph : token.glyphs) name += static_cast<char>(glyph.code);
  return name;
}

class IsoReader {
 public:
  IsoReader(const std::vector<Glyph>& glyphs, Report& report) : glyphs_(glyphs), report_(report) {}

  std::vector<Glyph> Read() {
    const Range whole{glyphs_.front().where.begin, glyphs_.back().where.end};
    end_ = glyphs_.size();
    if (glyphs_.size() > 1 && glyphs_.back().code == U']') {
      --end_;
    } else {
      report_.Error(codes::kUnclosed,
                    glyphs_.front().where,
                    "bracket '[' is not closed",
                    "a structural code of ISO 230-1 ends in ']'");
    }
    for (at_ = 1; at_ < end_;) ReadToken();
    const bool reversed = TurnRound();
    report_.Note(codes::kIso,
                 whole,
                 fmt::format("structural code of ISO 230-1 read{}: w is part, b is O, t is tool",
                             reversed ? " from right to left" : ""));
    CheckPrimes();
    NameSpindles();
    return Join();
  }

 private:
  [[nodiscard]] char32_t CodeAt(std::size_t i) const { return i < end_ ? glyphs_[i].code : 0; }

  void ReadToken() {
    const Glyph& glyph = glyphs_[at_];
    const char32_t code = glyph.code;
    if (IsDash(code)) {
      ++at_;
    } else if (code == U'w') {
      PutWord(TokenKind::kPart, U"part");
    } else if (code == U'b') {
      PutWord(TokenKind::kBase, U"O");
    } else if (code == U't') {
      PutWord(TokenKind::kTool, U"tool");
    } else if (IsAxisLetter(code)) {
      tokens_.push_back(ReadAxis());
    } else if (code == U'(' && IsSpindle()) {
      ReadSpindle();
    } else if (IsPrime(code)) {
      report_.Error(codes::kStrayPrime,
                    glyph.where,
                    "prime without an axis",
                    "a prime follows the letter of an axis that moves the workpiece, as in X'");
      ++at_;
    } else {
      tokens_.push_back({TokenKind::kOther, {glyph}, glyph.where, std::nullopt});
      ++at_;
    }
  }

  void PutWord(TokenKind kind, std::u32string_view word) {
    const Range where = glyphs_[at_++].where;
    Token token{kind, {}, where, std::nullopt};
    for (const char32_t code : word) token.glyphs.push_back({code, where, Gap::kNone});
    tokens_.push_back(std::move(token));
  }

  Token ReadAxis() {
    Token token{TokenKind::kAxis, {glyphs_[at_]}, glyphs_[at_].where, std::nullopt};
    for (++at_; IsDigit(CodeAt(at_)) && glyphs_[at_].gap != Gap::kSpace; ++at_) {
      token.glyphs.push_back(glyphs_[at_]);
      token.where.end = glyphs_[at_].where.end;
    }
    TakePrime(token);
    return token;
  }

  void TakePrime(Token& token) {
    if (!IsPrime(CodeAt(at_))) return;
    token.prime = glyphs_[at_++].where;
  }

  /// "(C)", "(C1)", "(C')".
  [[nodiscard]] bool IsSpindle() const {
    std::size_t i = at_ + 1;
    if (!IsAxisLetter(CodeAt(i))) return false;
    while (IsDigit(CodeAt(++i))) {
    }
    if (IsPrime(CodeAt(i))) ++i;
    return CodeAt(i) == U')';
  }

  void ReadSpindle() {
    const std::size_t begin = glyphs_[at_++].where.begin;
    Token token = ReadAxis();
    token.kind = TokenKind::kSpindle;
    token.where = {begin, glyphs_[at_++].where.end};
    TakePrime(token);
    tokens_.push_back(std::move(token));
  }

  [[nodiscard]] std::size_t Find(TokenKind kind) const {
    const auto found = std::find_if(
        tokens_.begin(), tokens_.end(), [kind](const Token& token) { return token.kind == kind; });
    return static_cast<std::size_t>(found - tokens_.begin());
  }

  /// ISO 230-1 may be written from the tool too. With foreign signs inside, the order of the rest
  /// means nothing.
  bool TurnRound() {
    const std::size_t none = tokens_.size();
    const std::size_t part = Find(TokenKind::kPart);
    const std::size_t base = Find(TokenKind::kBase);
    const std::size_t tool = Find(TokenKind::kTool);
    if (Find(TokenKind::kOther) != none) return false;
    const bool from_tool = (part != none && tool != none && tool < part) ||
                           (part == none && tool != none && tool < base) ||
                           (tool == none && part != none && base != none && base < part);
    if (from_tool) std::reverse(tokens_.begin(), tokens_.end());
    return from_tool;
  }

  void CheckPrimes() {
    const std::size_t base = Find(TokenKind::kBase);
    for (std::size_t i = base + 1; i < tokens_.size(); ++i) {
      const Token& token = tokens_[i];
      if (!token.prime) continue;
      report_.Error(codes::kStrayPrime,
                    *token.prime,
                    fmt::format("'{}' on the tool's side bears a prime", NameOf(token)),
                    "in ISO 230-1 primes mark the axes between w and b, which move the workpiece");
    }
  }

  void NameSpindles() {
    std::set<std::string> names;
    for (const Token& token : tokens_) {
      if (token.kind == TokenKind::kAxis) names.insert(NameOf(token));
    }
    for (Token& token : tokens_) {
      if (token.kind != TokenKind::kSpindle) continue;
      std::string name = NameOf(token);
      for (int number = 2; names.count(name) != 0; ++number) {
        name = fmt::format("{}{}", static_cast<char>(token.glyphs.front().code), number);
      }
      names.insert(name);
      token.glyphs.clear();
      for (const char c : name) {
        token.glyphs.push_back({static_cast<unsigned char>(c), token.where, Gap::kNone});
      }
      report_.Note(codes::kIsoSpindle,
                   token.where,
                   fmt::format("spindle '{}' read as the plain axis '{}': ISO 230-1 does not tell "
                               "how it lies",
                               report_.Quote(token.where),
                               name),
                   fmt::format("write {0}_h, {0}_v or {0}_i to mark the main motion", name));
    }
  }

  /// Words stand apart from what is beside them; letters and foreign signs keep their gaps.
  std::vector<Glyph> Join() {
    std::vector<Glyph> joined;
    bool apart = true;
    for (Token& token : tokens_) {
      const bool word = token.kind != TokenKind::kOther && token.kind != TokenKind::kAxis;
      if (word || apart) token.glyphs.front().gap = Gap::kSpace;
      apart = word;
      joined.insert(joined.end(), token.glyphs.begin(), token.glyphs.end());
    }
    return joined;
  }

  const std::vector<Glyph>& glyphs_;
  Report& report_;
  std::size_t at_ = 0;
  std::size_t end_ = 0;
  std::vector<Token> tokens_;
};

}  // namespace

void ReadIso(std::vector<Glyph>& glyphs, Report& report) {
  if (glyphs.empty() || glyphs.front().code != U'[') return;
  glyphs = IsoReader(glyphs, report).Read();
}

}  // namespace kompono::formula
