// SPDX-License-Identifier: Apache-2.0
#include "guard.hpp"

#include "expression.hpp"
#include "schema.hpp"
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include <sqlite3.h>

namespace kompono::catalog {
namespace {

/// Pure functions whose cost is bounded by the length of their arguments. printf and format are
/// not: a precision of 2e9 for %c keeps SQLite busy for seconds that no deadline interrupts.
constexpr std::array<std::string_view, 57> kFunctions = {
    "abs",     "acos",      "asin",   "atan",         "atan2",   "avg",       "ceil",
    "ceiling", "coalesce",  "cos",    "count",        "date",    "datetime",  "degrees",
    "exp",     "floor",     "glob",   "group_concat", "hex",     "ifnull",    "iif",
    "instr",   "julianday", "length", "like",         "ln",      "log",       "log10",
    "log2",    "lower",     "ltrim",  "max",          "min",     "mod",       "nullif",
    "pi",      "pow",       "power",  "radians",      "replace", "round",     "rtrim",
    "sign",    "sin",       "sqrt",   "strftime",     "substr",  "substring", "sum",
    "tan",     "time",      "total",  "trim",         "trunc",   "typeof",    "unicode",
    "upper"};

/// Virtual-machine steps between two looks at the clock, some microseconds.
constexpr int kStepsBetweenLooks = 200;

struct Limit {
  int id;
  int value;
};

/// No text longer than 100 kB can be built, so that one call of a function is quick, and no
/// expression so deep or wide that compiling it takes long.
constexpr std::array<Limit, 10> kLimits = {{{SQLITE_LIMIT_LENGTH, 100'000},
                                            {SQLITE_LIMIT_SQL_LENGTH, 100'000},
                                            {SQLITE_LIMIT_COLUMN, 200},
                                            {SQLITE_LIMIT_EXPR_DEPTH, 200},
                                            {SQLITE_LIMIT_COMPOUND_SELECT, 20},
                                            {SQLITE_LIMIT_VDBE_OP, 100'000},
                                            {SQLITE_LIMIT_FUNCTION_ARG, 32},
                                            {SQLITE_LIMIT_ATTACHED, 0},
                                            {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 500},
                                            {SQLITE_LIMIT_WORKER_THREADS, 0}}};

void Restrict(SQLite::Database& db) {
  for (const Limit& limit : kLimits) sqlite3_limit(db.getHandle(), limit.id, limit.value);
}

std::string_view OrEmpty(const char* text) {
  return text == nullptr ? std::string_view() : text;
}

}  // namespace

Permissions::Permissions(SQLite::Database& db) : shadow_(":memory:", SQLite::OPEN_READWRITE) {
  sqlite3_set_authorizer(db.getHandle(), &Permissions::OnFile, this);
  for (const std::string_view view : kViews) {
    const SQLite::Statement all(db, "SELECT * FROM " + std::string(view));
    std::vector<std::string>& columns = views_[std::string(view)];
    for (int i = 0; i < all.getColumnCount(); ++i) columns.emplace_back(all.getColumnName(i));
    shadow_.exec(fmt::format("CREATE TABLE {}({})", view, fmt::join(columns, ", ")));
  }
  learning_ = false;
  Restrict(db);
  Restrict(shadow_);
  sqlite3_set_authorizer(shadow_.getHandle(), &Permissions::OnShadow, this);
}

std::vector<std::string> Permissions::Functions() {
  return {kFunctions.begin(), kFunctions.end()};
}

int Permissions::OnFile(
    void* self, int action, const char* a, const char* b, const char* database, const char* view) {
  static_cast<void>(database);
  auto* permissions = static_cast<Permissions*>(self);
  try {
    const bool may_read =
        action == SQLITE_READ && permissions->MayReadInFile(OrEmpty(a), OrEmpty(b), OrEmpty(view));
    return permissions->Judge(action, OrEmpty(a), OrEmpty(b), may_read);
  } catch (...) {
    return SQLITE_DENY;  // an exception must not cross SQLite
  }
}

int Permissions::OnShadow(
    void* self, int action, const char* a, const char* b, const char* database, const char* view) {
  static_cast<void>(database);
  static_cast<void>(view);
  auto* permissions = static_cast<Permissions*>(self);
  try {
    const bool may_read =
        action == SQLITE_READ && permissions->views_.contains(a == nullptr ? "" : a);
    return permissions->Judge(action, OrEmpty(a), OrEmpty(b), may_read);
  } catch (...) {
    return SQLITE_DENY;
  }
}

int Permissions::Judge(int action, std::string_view a, std::string_view b, bool may_read) {
  switch (action) {
    case SQLITE_SELECT:
      return SQLITE_OK;
    case SQLITE_READ:
      return may_read ? SQLITE_OK : Deny(Denial::Kind::kTable, a);
    case SQLITE_FUNCTION: {
      const bool known =
          std::any_of(kFunctions.begin(), kFunctions.end(), [b](std::string_view function) {
            return SameWord(function, b);
          });
      return known ? SQLITE_OK : Deny(Denial::Kind::kFunction, b);
    }
    case SQLITE_RECURSIVE:
      return Deny(Denial::Kind::kRecursion, "recursive");
    default:
      return Deny(Denial::Kind::kAction, a);
  }
}

bool Permissions::MayReadInFile(std::string_view table,
                                std::string_view column,
                                std::string_view view) {
  const bool is_view = std::find(kViews.begin(), kViews.end(), table) != kViews.end();
  if (is_view) return true;
  if (learning_) {
    reads_.emplace(view, table, column);
    tables_.emplace(table);
    return true;
  }
  // No column: the rows are counted or joined; on whose behalf, only the shadow could tell.
  if (column.empty()) return tables_.contains(table);
  return reads_.contains(std::tuple(std::string(view), std::string(table), std::string(column)));
}

int Permissions::Deny(Denial::Kind kind, std::string_view name) {
  denied_ = {.kind = kind, .name = std::string(name)};
  return SQLITE_DENY;
}

// SQLite's hard heap limit would do for memory too, but it holds for the whole process and would
// fail the other connections of a server; looking at the total leaves them alone.
Watch::Watch(SQLite::Database& db, const QueryLimits& limits)
    : db_(db),
      deadline_(std::chrono::steady_clock::now() + limits.deadline),
      most_bytes_(sqlite3_memory_used() + static_cast<std::int64_t>(limits.memory_bytes)) {
  sqlite3_progress_handler(db_.getHandle(), kStepsBetweenLooks, &Watch::Callback, this);
}

Watch::~Watch() {
  sqlite3_progress_handler(db_.getHandle(), 0, nullptr, nullptr);
}

int Watch::Callback(void* self) {
  auto* watch = static_cast<Watch*>(self);
  if (std::chrono::steady_clock::now() > watch->deadline_) watch->reason_ = Stop::kTime;
  if (sqlite3_memory_used() > watch->most_bytes_) watch->reason_ = Stop::kMemory;
  return watch->reason_ == Stop::kNone ? 0 : 1;
}

Reader::Reader(const std::string& uri, std::string file, std::chrono::milliseconds busy_timeout)
    : file_(std::move(file)),
      db_(uri,
          SQLite::OPEN_READONLY | SQLite::OPEN_URI | SQLite::OPEN_NOMUTEX,
          static_cast<int>(busy_timeout.count())) {
  Configure(db_);
  db_.exec("PRAGMA query_only = ON");
  db_.exec("PRAGMA temp_store = MEMORY");
  permissions_ = std::make_unique<Permissions>(db_);
}

}  // namespace kompono::catalog
