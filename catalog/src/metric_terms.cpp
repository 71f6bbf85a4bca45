// SPDX-License-Identifier: Apache-2.0
#include "metric_terms.hpp"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::catalog {
namespace {

constexpr std::string_view kPrefix = "metric";

bool IsName(const Token& token) {
  return token.kind == Token::Kind::kWord || token.kind == Token::Kind::kQuotedName;
}

bool IsPrefix(const Expression& expression, std::size_t i) {
  return IsName(expression.tokens[i]) &&
         SameWord(Unquoted(expression.TextOf(expression.tokens[i])), kPrefix);
}

bool IsDot(const Expression& expression, std::size_t i) {
  return i < expression.tokens.size() && expression.TextOf(expression.tokens[i]) == ".";
}

/// Somebody's own table or column of this name: then the word has its ordinary meaning.
bool IsTaken(const Expression& expression) {
  for (std::size_t i = 0; i < expression.tokens.size(); ++i) {
    const bool behind_dot = i > 0 && IsDot(expression, i - 1);
    if (IsPrefix(expression, i) && !behind_dot && !IsDot(expression, i + 1)) return true;
  }
  return false;
}

}  // namespace

std::string MetricTerms::Term::Sql() const {
  return fmt::format("metric_{}.value", number);
}

Parsed<std::vector<MetricTerms::Term>> MetricTerms::In(const Expression& expression) {
  std::vector<Term> terms;
  if (IsTaken(expression)) return terms;
  Diagnostics found;
  for (std::size_t i = 0; i + 2 < expression.tokens.size(); ++i) {
    if (!IsPrefix(expression, i) || !IsDot(expression, i + 1)) continue;
    if (i > 0 && IsDot(expression, i - 1)) continue;
    const Token& name = expression.tokens[i + 2];
    if (!IsName(name)) continue;
    const Parsed<std::int64_t> measure = MeasureOf(expression, name);
    if (measure) {
      terms.push_back({.first = i, .last = i + 3, .number = NumberOf(*measure)});
    } else {
      found.insert(found.end(), measure.error().begin(), measure.error().end());
    }
  }
  if (!found.empty()) return tl::make_unexpected(std::move(found));
  return terms;
}

std::string MetricTerms::Joins() const {
  std::string sql;
  for (std::size_t i = 0; i < measures_.size(); ++i) {
    sql += fmt::format(
        " JOIN metric_values AS metric_{0} ON metric_{0}.layout_id = layouts.id AND "
        "metric_{0}.measure = {1}",
        i,
        measures_[i]);
  }
  return sql;
}

Parsed<std::int64_t> MetricTerms::MeasureOf(const Expression& expression, const Token& token) {
  const std::string wanted = Unquoted(expression.TextOf(token));
  SQLite::Statement row(db_,
                        "SELECT measure, name, unit, method FROM measures ORDER BY name, measure");
  std::vector<std::int64_t> measures;
  std::vector<std::string> ways;
  std::vector<std::string> names;
  while (row.executeStep()) {
    const std::string name = row.getColumn(1).getString();
    const std::string whole = fmt::format(
        "{} [{}, {}]", name, row.getColumn(2).getString(), row.getColumn(3).getString());
    if (whole == wanted) return row.getColumn(0).getInt64();
    if (names.empty() || names.back() != name) names.push_back(name);
    if (name != wanted) continue;
    measures.push_back(row.getColumn(0).getInt64());
    ways.push_back(fmt::format("metric.\"{}\"", whole));
  }
  if (measures.size() == 1) return measures.front();
  if (measures.empty()) {
    return tl::make_unexpected(
        Diagnostics{expression.At(token.begin,
                                  token.end,
                                  "E0543",
                                  fmt::format("no metric is called '{}'", wanted),
                                  DidYouMean(wanted, names, 30))});
  }
  return tl::make_unexpected(Diagnostics{
      expression.At(token.begin,
                    token.end,
                    "E0544",
                    fmt::format("'{}' was computed in {} ways", wanted, measures.size()),
                    fmt::format("say which: {}", fmt::join(ways, ", ")))});
}

std::size_t MetricTerms::NumberOf(std::int64_t measure) {
  const auto found = std::find(measures_.begin(), measures_.end(), measure);
  const auto number = static_cast<std::size_t>(found - measures_.begin());
  if (found == measures_.end()) measures_.push_back(measure);
  return number;
}

}  // namespace kompono::catalog
