// SPDX-License-Identifier: Apache-2.0
#include "bulk.hpp"

#include "schema.hpp"
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

namespace kompono::catalog {

bool BulkLoading(SQLite::Database& db) {
  return db.execAndGet("SELECT count(*) FROM bulk_load").getInt() > 0;
}

void BeginBulk(SQLite::Database& db) {
  // What the rows refer to was looked up or written a moment ago; looking again for each of twenty
  // references of a layout takes a third of the time. `verify` checks them all.
  db.exec("PRAGMA foreign_keys = OFF");
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement mark(db, "INSERT INTO bulk_load VALUES(1, ?) ON CONFLICT DO NOTHING");
  mark.bind(1, Now());
  mark.exec();
  for (const DeferredIndex& index : kDeferredIndexes)
    db.exec(fmt::format("DROP INDEX IF EXISTS {}", index.name));
  transaction.commit();
}

void EndBulk(SQLite::Database& db) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  for (const DeferredIndex& index : kDeferredIndexes) {
    SQLite::Statement there(db, "SELECT 1 FROM sqlite_schema WHERE type = 'index' AND name = ?");
    there.bind(1, std::string(index.name));
    if (!there.executeStep()) db.exec(std::string(index.sql));
  }
  db.exec("DELETE FROM bulk_load");
  transaction.commit();
  db.exec("PRAGMA foreign_keys = ON");
}

}  // namespace kompono::catalog
