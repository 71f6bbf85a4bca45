// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_WAITING_ROWS_HPP_
#define KOMPONO_CATALOG_SRC_WAITING_ROWS_HPP_

#include "command.hpp"
#include <SQLiteCpp/Database.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kompono::catalog {

/// Rows of one table that are written many by one statement. Starting a statement costs more than
/// a row, and a table that gets its rows one after another is appended to without being searched.
/// Copies nothing: texts must live until `Write`. Errors are SQLite::Exception.
class WaitingRows {
 public:
  /// `table` as after INSERT INTO, with the names of columns if not all are given.
  WaitingRows(SQLite::Database& db, std::string table, std::size_t columns);

  /// The cells of a row from the left; a row is whole when it has all columns.
  WaitingRows& Integer(std::int64_t value) { return Add(value); }
  WaitingRows& Real(double value) { return Add(value); }
  WaitingRows& RealOrNull(const std::optional<double>& value) {
    return value ? Real(*value) : Null();
  }
  WaitingRows& Text(std::string_view text) { return Add(text); }
  WaitingRows& TextOrNull(std::string_view text) { return text.empty() ? Null() : Text(text); }
  WaitingRows& Digest(const Sha256& digest) { return Add(&digest); }
  WaitingRows& Null() { return Add(std::monostate{}); }

  [[nodiscard]] std::size_t Rows() const { return cells_.size() / columns_; }

  /// All that wait, in their order, inside the transaction of the caller.
  void Write();

 private:
  using Cell = std::variant<std::monostate, std::int64_t, double, std::string_view, const Sha256*>;
  static constexpr std::array<std::size_t, 3> kRowsAtOnce = {64, 8, 1};

  template <class Value>
  WaitingRows& Add(Value value) {
    cells_.emplace_back(value);
    return *this;
  }
  [[nodiscard]] Command& Insert(std::size_t size);

  SQLite::Database& db_;
  std::string table_;
  std::size_t columns_;
  std::vector<Cell> cells_;
  std::array<std::unique_ptr<Command>, kRowsAtOnce.size()> inserts_;  // made when first needed
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_WAITING_ROWS_HPP_
