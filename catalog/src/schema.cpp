// SPDX-License-Identifier: Apache-2.0
#include "schema.hpp"

#include "failure.hpp"
#include "record_parts.hpp"
#include "structure.hpp"
#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstring>
#include <ctime>

#include <sqlite3.h>

namespace kompono::catalog {
namespace {

/// The first free name of `<path>.v1.bak`, `<path>.v1.2.bak`, ...: an older copy is never
/// overwritten.
std::filesystem::path BackupName(const std::filesystem::path& path, int version) {
  std::filesystem::path name = path;
  name += fmt::format(".v{}.bak", version);
  for (int i = 2; std::filesystem::exists(name); ++i) {
    name = path;
    name += fmt::format(".v{}.{}.bak", version, i);
  }
  return name;
}

/// Copies through SQLite, which includes what still lies in the write-ahead log, and gives the copy
/// its name only when it is complete. The caller holds the write lock, so that nothing changes
/// meanwhile; the copy is read over a connection of its own because SQLite copies from none that is
/// writing.
std::filesystem::path CopyAside(const std::filesystem::path& path, int version) {
  std::filesystem::path name = BackupName(path, version);
  std::filesystem::path part = name;
  part += ".part";
  std::filesystem::remove(part);
  {
    SQLite::Database source(UriOf(path, false), SQLite::OPEN_READONLY | SQLite::OPEN_URI, 5000);
    SQLite::Database copy(UriOf(part, false),
                          SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE | SQLite::OPEN_URI);
    const int code = SQLite::Backup(copy, source).executeStep();
    if (code != SQLITE_DONE)
      throw SQLite::Exception("the copy before a migration cannot be made", code);
    // The copy of a file with a log is one too; without it all of the copy is in the one file that
    // is renamed.
    copy.exec("PRAGMA journal_mode = DELETE");
  }
  std::filesystem::rename(part, name);
  return name;
}

void RequireSoundReferences(SQLite::Database& db) {
  SQLite::Statement broken(db, "PRAGMA foreign_key_check");
  if (broken.executeStep()) {
    throw SQLite::Exception(
        "rows of '" + broken.getColumn(0).getString() + "' refer to missing rows",
        SQLITE_CONSTRAINT_FOREIGNKEY);
  }
}

/// content_key(BLOB): what `layout.hash_key` holds.
void ContentKey(sqlite3_context* context, int count, sqlite3_value** values) {
  static_cast<void>(count);
  Sha256 digest{};
  const void* bytes = sqlite3_value_blob(*values);
  if (bytes == nullptr || sqlite3_value_bytes(*values) != static_cast<int>(digest.size())) {
    sqlite3_result_error(context, "a layout has no hash", -1);
    return;
  }
  std::memcpy(digest.data(), bytes, digest.size());
  sqlite3_result_int64(context, KeyOf(digest));
}

/// formula_tree(TEXT): NULL for a text that is no formula.
void FormulaTree(sqlite3_context* context, int count, sqlite3_value** values) {
  static_cast<void>(count);
  try {
    const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(*values));
    const std::string tree = TreeJson(text == nullptr ? "" : text);
    if (tree.empty()) return;  // NULL
    sqlite3_result_text64(context, tree.data(), tree.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  } catch (...) {  // an exception must not cross SQLite
    sqlite3_result_error_nomem(context);
  }
}

/// What migrations compute and SQL has no words for.
void AddMigrationFunctions(SQLite::Database& db) {
  constexpr int kFlags = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY;
  db.check(sqlite3_create_function(
      db.getHandle(), "content_key", 1, kFlags, nullptr, &ContentKey, nullptr, nullptr));
  db.check(sqlite3_create_function(
      db.getHandle(), "formula_tree", 1, kFlags, nullptr, &FormulaTree, nullptr, nullptr));
}

/// Inside a transaction of the caller.
void Apply(SQLite::Database& db, const Migration& migration) {
  db.exec(migration.sql);
  RequireSoundReferences(db);
  SQLite::Statement history(db, "INSERT INTO schema_history VALUES(?, ?, ?, ?)");
  history.bind(1, migration.version);
  history.bind(2, migration.name);
  history.bind(3, KOMPONO_PROGRAM_VERSION);
  history.bind(4, Now());
  history.exec();
  db.exec(fmt::format("PRAGMA user_version = {}", migration.version));
}

}  // namespace

int NewestVersion() {
  return static_cast<int>(Migrations().size());
}

int VersionOf(SQLite::Database& db) {
  return db.execAndGet("PRAGMA user_version").getInt();
}

std::string UriOf(const std::filesystem::path& path, bool immutable) {
  std::string uri = "file:";
  const std::string name = path.is_absolute() ? path.string() : "./" + path.string();
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '.' || c == '-' || c == '_';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<std::uint8_t>(c));
  }
  return immutable ? uri + "?immutable=1" : uri;
}

std::string Now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

void Configure(SQLite::Database& db) {
  sqlite3* handle = db.getHandle();
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  db.exec("PRAGMA foreign_keys = ON");
  db.exec("PRAGMA cell_size_check = ON");
  db.exec("PRAGMA cache_size = -65536");  // KiB
  db.exec("PRAGMA synchronous = NORMAL");
}

void CreateSchema(SQLite::Database& db) {
  // Before the first table; a third less to be managed with a million layouts than with 4096.
  db.exec("PRAGMA page_size = 8192");
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::EXCLUSIVE);
  if (VersionOf(db) > 0) return;  // another program was faster
  AddMigrationFunctions(db);
  db.exec(fmt::format("PRAGMA application_id = {}", kApplicationId));
  for (const Migration& migration : Migrations()) Apply(db, migration);
  transaction.commit();
}

Parsed<Diagnostics> Upgrade(SQLite::Database& db, const std::filesystem::path& path) {
  const int before = VersionOf(db);
  std::filesystem::path copy;
  // Rebuilding a table drops it for a moment; references are checked at the end of each step
  // instead.
  db.exec("PRAGMA foreign_keys = OFF");
  try {
    AddMigrationFunctions(db);
    for (const Migration& migration : Migrations()) {
      SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
      // Read under the lock: another program may have migrated meanwhile.
      if (VersionOf(db) >= migration.version) continue;
      if (copy.empty()) copy = CopyAside(path, VersionOf(db));
      Apply(db, migration);
      transaction.commit();
    }
  } catch (const SQLite::Exception& e) {
    Diagnostic failed =
        Complaint("E0507",
                  path.string(),
                  fmt::format("bringing the catalog from schema {} to {} failed and was undone: {}",
                              before,
                              NewestVersion(),
                              e.what()));
    if (!copy.empty()) failed.help = fmt::format("a copy lies in '{}'", copy.string());
    return tl::make_unexpected(Diagnostics{std::move(failed)});
  } catch (const std::filesystem::filesystem_error& e) {
    return Refuse("E0507",
                  path.string(),
                  fmt::format("the copy before a migration cannot be written: {}", e.what()));
  }
  db.exec("PRAGMA foreign_keys = ON");
  Diagnostics notes;
  if (!copy.empty()) {
    notes.push_back(
        {.severity = Severity::kNote,
         .code = "N0501",
         .file = path.string(),
         .message = fmt::format("brought from schema {} to {}; the file as it was lies in '{}'",
                                before,
                                NewestVersion(),
                                copy.string()),
         .help = ""});
  }
  return notes;
}

}  // namespace kompono::catalog
