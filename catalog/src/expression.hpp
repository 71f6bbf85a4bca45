// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_EXPRESSION_HPP_
#define KOMPONO_CATALOG_SRC_EXPRESSION_HPP_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::catalog {

struct Token {
  enum class Kind { kWord, kQuotedName, kString, kNumber, kPunctuation } kind = Kind::kPunctuation;
  std::size_t begin = 0;  ///< bytes
  std::size_t end = 0;
};

/// One text of the user, cut into tokens as SQLite does. It is certain to stay within the brackets
/// put around it: its own brackets are balanced, its quotes closed, and it has no comment, no
/// semicolon and no parameter.
struct Expression {
  std::string label;  ///< "where", "columns" or "sort"
  std::string text;
  std::vector<Token> tokens;

  [[nodiscard]] std::string_view TextOf(const Token& token) const;
  /// A complaint about `text[begin, end)`.
  [[nodiscard]] Diagnostic At(std::size_t begin,
                              std::size_t end,
                              std::string code,
                              std::string message,
                              std::string help = "") const;
};

/// A stretch of tokens between commas, with what was split off its end.
struct ListItem {
  std::size_t first = 0;  ///< tokens
  std::size_t last = 0;   ///< one past the end
  std::string alias;      ///< columns: the name after AS
  std::string direction;  ///< sort: "DESC NULLS LAST" or parts of it
};

/// E0520 text that is no expression, E0524 open quotes and brackets, E0525 what could leave the
/// brackets.
[[nodiscard]] Parsed<Expression> Scan(std::string_view text, std::string label);

[[nodiscard]] Parsed<std::vector<ListItem>> SplitColumns(const Expression& expression);
[[nodiscard]] Parsed<std::vector<ListItem>> SplitSort(const Expression& expression);

/// Equal but for the case of ASCII letters, as SQL compares keywords and names.
[[nodiscard]] bool SameWord(std::string_view a, std::string_view b);

/// A name without its quotes.
[[nodiscard]] std::string Unquoted(std::string_view name);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_EXPRESSION_HPP_
