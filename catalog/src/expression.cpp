// SPDX-License-Identifier: Apache-2.0
#include "expression.hpp"

#include "failure.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace kompono::catalog {
namespace {

constexpr std::size_t kLongest = 16384;

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}
bool StartsWord(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         (static_cast<unsigned char>(c) & 0x80U) != 0;
}
bool ContinuesWord(char c) {
  return StartsWord(c) || IsDigit(c) || c == '$';
}
bool IsSpace(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f';
}

/// Reads one text; every rule here is SQLite's own (tokenize.c), or stricter.
class Scanner {
 public:
  Scanner(std::string_view text, std::string label)
      : text_(text),
        expression_{.label = std::move(label), .text = std::string(text), .tokens = {}} {}

  Parsed<Expression> Run() {
    if (text_.size() > kLongest) {
      return Refuse("E0525", expression_.label, fmt::format("longer than {} bytes", kLongest));
    }
    if (!IsText(text_)) return Refuse("E0525", expression_.label, "not UTF-8 text");
    while (at_ < text_.size()) Next();
    for (const std::size_t open : brackets_) {
      Complain(open, open + 1, "E0524", "this bracket is not closed");
    }
    if (!found_.empty()) return tl::make_unexpected(std::move(found_));
    return std::move(expression_);
  }

 private:
  void Next() {
    const char c = text_[at_];
    const std::string_view two = text_.substr(at_, 2);
    if (IsSpace(c)) {
      ++at_;
    } else if (two == "--" || two == "/*") {
      Complain(at_,
               at_ + 2,
               "E0525",
               "comments are not allowed here",
               two == "--" ? "to subtract a negative number write '- -1'" : "");
      at_ += 2;
    } else if (c == '\'' || c == '"' || c == '`') {
      Quoted(c, c == '\'' ? Token::Kind::kString : Token::Kind::kQuotedName);
    } else if (c == '[') {
      Quoted(']', Token::Kind::kQuotedName);
    } else if (StartsWord(c)) {
      Take(Token::Kind::kWord, Length(ContinuesWord));
    } else if (IsDigit(c)) {
      Take(Token::Kind::kNumber, Length([](char d) { return ContinuesWord(d) || d == '.'; }));
    } else {
      Punctuation(c);
    }
  }

  void Punctuation(char c) {
    if (c == ';') {
      Complain(at_, at_ + 1, "E0525", "one expression is expected, not several statements");
    } else if (std::string_view("?:@#$").find(c) != std::string_view::npos) {
      Complain(at_, at_ + 1, "E0525", "parameters are not allowed here", "write the value itself");
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      Complain(at_, at_ + 1, "E0525", "control characters are not allowed here");
    } else if (c == '(') {
      brackets_.push_back(at_);
    } else if (c == ')') {
      if (brackets_.empty()) {
        Complain(at_, at_ + 1, "E0524", "this bracket was never opened");
      } else {
        brackets_.pop_back();
      }
    }
    Take(Token::Kind::kPunctuation, 1);
  }

  /// A doubled quote stands for itself; in [name] there is no such thing.
  void Quoted(char close, Token::Kind kind) {
    std::size_t end = at_ + 1;
    for (;; ++end) {
      end = text_.find(close, end);
      if (end == std::string_view::npos) {
        Complain(at_, at_ + 1, "E0524", "this quote is not closed");
        at_ = text_.size();
        return;
      }
      if (close == ']' || end + 1 >= text_.size() || text_[end + 1] != close) break;
      ++end;
    }
    Take(kind, end + 1 - at_);
  }

  template <class Belongs>
  [[nodiscard]] std::size_t Length(Belongs belongs) const {
    return static_cast<std::size_t>(
        std::find_if_not(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.end(), belongs) -
        (text_.begin() + static_cast<std::ptrdiff_t>(at_)));
  }

  void Take(Token::Kind kind, std::size_t length) {
    expression_.tokens.push_back({.kind = kind, .begin = at_, .end = at_ + length});
    at_ += length;
  }

  void Complain(std::size_t begin,
                std::size_t end,
                std::string code,
                std::string message,
                std::string help = "") {
    found_.push_back(
        expression_.At(begin, end, std::move(code), std::move(message), std::move(help)));
  }

  std::string_view text_;
  Expression expression_;
  std::size_t at_ = 0;
  std::vector<std::size_t> brackets_;
  Diagnostics found_;
};

/// A whole statement instead of an expression is the likeliest slip, and `(select ...)` would
/// quietly be a value.
std::optional<Diagnostic> StatementIn(const Expression& expression) {
  constexpr std::array kStatements = {
      "select",   "with",      "values",  "insert",  "update",  "delete", "replace", "create",
      "drop",     "alter",     "attach",  "detach",  "pragma",  "vacuum", "begin",   "commit",
      "rollback", "savepoint", "release", "reindex", "analyze", "explain"};
  const Token& first = expression.tokens.front();
  const std::string_view word = expression.TextOf(first);
  if (first.kind != Token::Kind::kWord) return std::nullopt;
  if (SameWord(word, "where") || SameWord(word, "order")) {
    return expression.At(first.begin,
                         first.end,
                         "E0520",
                         fmt::format("'{}' is put there by the program", word),
                         "give the expression alone");
  }
  const bool call = expression.tokens.size() > 1 && expression.TextOf(expression.tokens[1]) == "(";
  const bool statement =
      std::any_of(kStatements.begin(), kStatements.end(), [word](std::string_view keyword) {
        return SameWord(word, keyword);
      });
  if (!statement || (call && SameWord(word, "replace"))) return std::nullopt;
  return expression.At(first.begin,
                       first.end,
                       "E0523",
                       "an expression is expected, not a statement",
                       "give a condition such as rms_after_um < 100");
}

Parsed<std::vector<ListItem>> Split(const Expression& expression) {
  std::vector<ListItem> items;
  Diagnostics found;
  const std::vector<Token>& tokens = expression.tokens;
  int depth = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= tokens.size(); ++i) {
    const std::string_view token = i < tokens.size() ? expression.TextOf(tokens[i]) : ",";
    if (token == "(") ++depth;
    if (token == ")") --depth;
    if (token != "," || depth > 0) continue;
    if (i == first) {
      const std::size_t place = i < tokens.size() ? tokens[i].begin : expression.text.size();
      found.push_back(
          expression.At(place, place + 1, "E0520", "something is missing beside the comma"));
    }
    items.push_back({.first = first, .last = i, .alias = "", .direction = ""});
    first = i + 1;
  }
  if (!found.empty()) return tl::make_unexpected(std::move(found));
  return items;
}

}  // namespace

std::string_view Expression::TextOf(const Token& token) const {
  return std::string_view(text).substr(token.begin, token.end - token.begin);
}

Diagnostic Expression::At(std::size_t begin,
                          std::size_t end,
                          std::string code,
                          std::string message,
                          std::string help) const {
  Diagnostic diagnostic = Complaint(std::move(code), label, std::move(message), std::move(help));
  diagnostic.span = SpanOf(text, begin, end);
  return diagnostic;
}

Parsed<Expression> Scan(std::string_view text, std::string label) {
  Parsed<Expression> expression = Scanner(text, std::move(label)).Run();
  if (!expression || expression->tokens.empty()) return expression;
  if (std::optional<Diagnostic> statement = StatementIn(*expression)) {
    return tl::make_unexpected(Diagnostics{*std::move(statement)});
  }
  return expression;
}

Parsed<std::vector<ListItem>> SplitColumns(const Expression& expression) {
  return Split(expression).map([&](std::vector<ListItem> items) {
    for (ListItem& item : items) {
      if (item.last - item.first < 3) continue;
      const Token& as = expression.tokens[item.last - 2];
      const Token& name = expression.tokens[item.last - 1];
      const bool named = name.kind == Token::Kind::kWord || name.kind == Token::Kind::kQuotedName;
      if (!named || as.kind != Token::Kind::kWord || !SameWord(expression.TextOf(as), "as"))
        continue;
      item.alias = Unquoted(expression.TextOf(name));
      item.last -= 2;
    }
    return items;
  });
}

Parsed<std::vector<ListItem>> SplitSort(const Expression& expression) {
  return Split(expression).map([&](std::vector<ListItem> items) {
    for (ListItem& item : items) {
      const auto word = [&](std::size_t from_end) {
        return item.last - item.first > from_end
                   ? expression.TextOf(expression.tokens[item.last - from_end])
                   : std::string_view();
      };
      std::string nulls;
      if (SameWord(word(2), "nulls") && (SameWord(word(1), "first") || SameWord(word(1), "last"))) {
        nulls = SameWord(word(1), "first") ? " NULLS FIRST" : " NULLS LAST";
        item.last -= 2;
      }
      if (SameWord(word(1), "desc") || SameWord(word(1), "asc")) {
        item.direction = SameWord(word(1), "desc") ? " DESC" : " ASC";
        item.last -= 1;
      }
      item.direction += nulls;
    }
    return items;
  });
}

bool SameWord(std::string_view a, std::string_view b) {
  const auto lower = [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [lower](char x, char y) {
    return lower(x) == lower(y);
  });
}

std::string Unquoted(std::string_view name) {
  const char open = name.empty() ? 'x' : name.front();
  if (name.size() < 2 || (open != '"' && open != '`' && open != '[')) return std::string(name);
  const char close = open == '[' ? ']' : open;
  std::string text;
  for (std::size_t i = 1; i + 1 < name.size(); ++i) {
    text += name[i];
    if (open != '[' && name[i] == close) ++i;
  }
  return text;
}

}  // namespace kompono::catalog
