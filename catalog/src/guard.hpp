// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_GUARD_HPP_
#define KOMPONO_CATALOG_SRC_GUARD_HPP_

#include <SQLiteCpp/Database.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "kompono/catalog/query.hpp"
#include "kompono/diagnostics/diagnostic.hpp"

struct sqlite3_stmt;

namespace kompono::catalog {

/// What a query may touch, enforced twice.
///
/// First the text is compiled against a shadow: an empty database in memory whose tables are called
/// and shaped like the views, so that no other name means anything. Only then it meets the file,
/// where SQLite's authorizer lets through the columns the views themselves read, each only on
/// behalf of its view. (The authorizer alone would not do: SQLite asks about a table that is only
/// counted, without saying on whose behalf.) Both allow a list of functions, no more.
class Permissions {
 public:
  /// Installs itself as the authorizer of `db`, which must not outlive it.
  explicit Permissions(SQLite::Database& db);
  Permissions(const Permissions&) = delete;
  Permissions& operator=(const Permissions&) = delete;
  Permissions(Permissions&&) = delete;
  Permissions& operator=(Permissions&&) = delete;
  ~Permissions() = default;

  struct Denial {
    enum class Kind { kNone, kTable, kFunction, kRecursion, kAction } kind = Kind::kNone;
    std::string name;
  };
  /// Why the statement that was just prepared was refused.
  [[nodiscard]] const Denial& Denied() const { return denied_; }
  void Reset() { denied_ = {}; }

  [[nodiscard]] SQLite::Database& Shadow() { return shadow_; }

  /// Columns of each view, in their order.
  [[nodiscard]] const std::map<std::string, std::vector<std::string>>& Views() const {
    return views_;
  }
  [[nodiscard]] static std::vector<std::string> Functions();

 private:
  static int OnFile(
      void* self, int action, const char* a, const char* b, const char* database, const char* view);
  static int OnShadow(
      void* self, int action, const char* a, const char* b, const char* database, const char* view);
  int Judge(int action, std::string_view a, std::string_view b, bool may_read);
  bool MayReadInFile(std::string_view table, std::string_view column, std::string_view view);
  int Deny(Denial::Kind kind, std::string_view name);

  bool learning_ = true;
  std::set<std::tuple<std::string, std::string, std::string>> reads_;  // view, table, column
  std::set<std::string, std::less<>> tables_;                          // those the views read
  std::map<std::string, std::vector<std::string>> views_;
  Denial denied_;
  SQLite::Database shadow_;
};

/// Stops what runs on `db` when time or memory is used up; lives as long as the statement runs.
class Watch {
 public:
  Watch(SQLite::Database& db, const QueryLimits& limits);
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  Watch(Watch&&) = delete;
  Watch& operator=(Watch&&) = delete;
  ~Watch();

  enum class Stop { kNone, kTime, kMemory };
  [[nodiscard]] Stop Reason() const { return reason_; }

 private:
  static int Callback(void* self);

  SQLite::Database& db_;
  std::chrono::steady_clock::time_point deadline_;
  std::int64_t most_bytes_;
  Stop reason_ = Stop::kNone;
};

/// A connection for questions: read-only, watched, and blind to everything but the views.
class Reader {
 public:
  Reader(const std::string& uri, std::string file, std::chrono::milliseconds busy_timeout);

  [[nodiscard]] Parsed<Table> Query(const QueryRequest& request);
  [[nodiscard]] Parsed<std::vector<std::string>> Explain(const QueryRequest& request);

 private:
  std::string file_;
  std::unique_ptr<Permissions> permissions_;  // outlives db_
  SQLite::Database db_;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_GUARD_HPP_
