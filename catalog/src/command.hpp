// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_COMMAND_HPP_
#define KOMPONO_CATALOG_SRC_COMMAND_HPP_

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include <sqlite3.h>

#include "kompono/catalog/hash.hpp"

namespace kompono::catalog {

/// A prepared statement for bulk writing. Unlike SQLite::Statement it takes string views and copies
/// nothing: what is bound must live until `Run`. Errors are SQLite::Exception.
class Command {
 public:
  Command(SQLite::Database& db, std::string_view sql);

  /// Parameters are numbered from 1 in the order of the calls since the last `Run`.
  Command& Text(std::string_view text);
  Command& TextOrNull(std::string_view text) { return text.empty() ? Null() : Text(text); }
  Command& Bytes(std::string_view bytes);
  Command& Digest(const Sha256& digest);
  Command& Integer(std::int64_t value);
  Command& Real(double value);
  Command& RealOrNull(const std::optional<double>& value) { return value ? Real(*value) : Null(); }
  Command& Null();

  /// Executes and makes ready for the next; the number of rows changed.
  int Run();

  /// The same for a question that must have an answer: the first column of the first row.
  std::int64_t Ask();

  /// The first column of the first row, if there is one.
  std::optional<std::int64_t> Look();

  [[nodiscard]] int ParameterCount() const {
    return sqlite3_bind_parameter_count(statement_.get());
  }

 private:
  void Check(int code);
  int Step();

  sqlite3* db_;
  std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> statement_{nullptr, &sqlite3_finalize};
  int next_ = 1;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_COMMAND_HPP_
