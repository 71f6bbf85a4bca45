// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"

#include <SQLiteCpp/Exception.h>

#include <string>

namespace kompono::catalog {

Command::Command(SQLite::Database& db, std::string_view sql) : db_(db.getHandle()) {
  sqlite3_stmt* raw = nullptr;
  Check(sqlite3_prepare_v3(
      db_, sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT, &raw, nullptr));
  statement_.reset(raw);
}

Command& Command::Text(std::string_view text) {
  // An empty view may point nowhere, which SQLite would take for NULL.
  const char* data = text.empty() ? "" : text.data();
  Check(sqlite3_bind_text64(
      statement_.get(), next_++, data, text.size(), SQLITE_STATIC, SQLITE_UTF8));
  return *this;
}

Command& Command::Bytes(std::string_view bytes) {
  const char* data = bytes.empty() ? "" : bytes.data();
  Check(sqlite3_bind_blob64(statement_.get(), next_++, data, bytes.size(), SQLITE_STATIC));
  return *this;
}

Command& Command::Digest(const Sha256& digest) {
  return Bytes({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

Command& Command::Integer(std::int64_t value) {
  Check(sqlite3_bind_int64(statement_.get(), next_++, value));
  return *this;
}

Command& Command::Real(double value) {
  Check(sqlite3_bind_double(statement_.get(), next_++, value));
  return *this;
}

Command& Command::Null() {
  Check(sqlite3_bind_null(statement_.get(), next_++));
  return *this;
}

int Command::Run() {
  static_cast<void>(Step());
  sqlite3_reset(statement_.get());
  return sqlite3_changes(db_);
}

std::int64_t Command::Ask() {
  const std::optional<std::int64_t> answer = Look();
  if (!answer) throw SQLite::Exception("a row just written is missing", SQLITE_CORRUPT);
  return *answer;
}

std::optional<std::int64_t> Command::Look() {
  std::optional<std::int64_t> answer;
  if (Step() == SQLITE_ROW) answer = sqlite3_column_int64(statement_.get(), 0);
  sqlite3_reset(statement_.get());
  return answer;
}

int Command::Step() {
  next_ = 1;
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    const std::string message = sqlite3_errmsg(db_);
    const int extended = sqlite3_extended_errcode(db_);
    sqlite3_reset(statement_.get());
    throw SQLite::Exception(message, extended);
  }
  return code;
}

void Command::Check(int code) {
  if (code != SQLITE_OK) throw SQLite::Exception(db_, code);
}

}  // namespace kompono::catalog
