// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_METRIC_TERMS_HPP_
#define KOMPONO_CATALOG_SRC_METRIC_TERMS_HPP_

#include "expression.hpp"
#include <SQLiteCpp/Database.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::catalog {

/// `metric.stiffness` in a user's text: the value of that metric of the layout. Each metric that is
/// named becomes one join with a number instead of a name, so that its index serves conditions and
/// sorting. A layout without the metric is not found.
class MetricTerms {
 public:
  /// `db` must outlive the terms.
  explicit MetricTerms(SQLite::Database& db) : db_(db) {}

  struct Term {
    std::size_t first = 0;  ///< tokens
    std::size_t last = 0;   ///< one past the end
    std::size_t number = 0;
    [[nodiscard]] std::string Sql() const;
  };

  /// The terms of a text, in its order. E0543 no such metric, E0544 computed in several ways: then
  /// `metric."stiffness [N/um, grid]"` says which.
  [[nodiscard]] Parsed<std::vector<Term>> In(const Expression& expression);

  /// What follows behind FROM layouts.
  [[nodiscard]] std::string Joins() const;

 private:
  [[nodiscard]] Parsed<std::int64_t> MeasureOf(const Expression& expression, const Token& token);
  [[nodiscard]] std::size_t NumberOf(std::int64_t measure);

  SQLite::Database& db_;
  std::vector<std::int64_t> measures_;  // by number
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_METRIC_TERMS_HPP_
