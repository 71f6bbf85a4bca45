// SPDX-License-Identifier: Apache-2.0
#include "catalog_fixture.hpp"
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// All that stands in the tables and views of a database, and its version.
std::string Rows(const std::filesystem::path& path) {
  SQLite::Database db(path.string());
  std::string text = db.execAndGet("PRAGMA user_version").getString() +
                     db.execAndGet("PRAGMA application_id").getString();
  SQLite::Statement table(
      db, "SELECT name, sql FROM sqlite_schema WHERE type IN ('table', 'view') ORDER BY name");
  while (table.executeStep()) {
    text += table.getColumn(0).getString() + ": " + table.getColumn(1).getString() + "\n";
    SQLite::Statement row(db, "SELECT * FROM " + table.getColumn(0).getString());
    while (row.executeStep()) {
      for (int i = 0; i < row.getColumnCount(); ++i) text += row.getColumn(i).getString() + "|";
      text += "\n";
    }
  }
  return text;
}

/// data/catalog_v1.sql is a catalog of schema 1 with three layouts, as the first program made it;
/// catalog_v2.sql the same of schema 2 with a calibrated fourth.
class MigrationTest : public CatalogTest {
 protected:
  void StoreOldCatalog(int version = 1) const {
    SQLite::Database db(File().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    db.exec(Bytes(std::filesystem::path(KOMPONO_SOURCE_DIR) /
                  fmt::format("tests/catalog/data/catalog_v{}.sql", version)));
  }
};

TEST_F(MigrationTest, BringsAnOldCatalogUpToDateAfterCopyingIt) {
  StoreOldCatalog();
  const std::string before = Rows(File());
  Parsed<Store> store = Store::Open(File(), {.mode = OpenMode::kReadWrite});
  ASSERT_TRUE(store) << Said(store.error());
  EXPECT_EQ(Said(store->Notes()),
            File().string() + ": note: brought from schema 1 to 3; the file as it was lies in '" +
                File("machines.db.v1.bak").string() + "' [N0501]\n");
  EXPECT_EQ(Rows(File("machines.db.v1.bak")), before);

  const Parsed<Statistics> stats = store->Stats();
  ASSERT_TRUE(stats) << Said(stats.error());
  EXPECT_EQ(stats->schema_version, 3);
  EXPECT_EQ(stats->layouts, 3);
  EXPECT_EQ(stats->parameters, 4);
  const Parsed<VerifyReport> report = store->Verify();
  ASSERT_TRUE(report) << Said(report.error());
  EXPECT_EQ(Said(report->findings), "")
      << "the migrated schema and rows are those of a new catalog";
  EXPECT_EQ(report->layouts, 3);
}

TEST_F(MigrationTest, KeepsResultsAndCalibrationsOfTheSecondSchema) {
  StoreOldCatalog(2);
  std::map<std::string, double> metrics;
  {
    SQLite::Database db(File().string());
    SQLite::Statement row(db, "SELECT layout || name || unit || method, value FROM metrics");
    while (row.executeStep()) metrics[row.getColumn(0).getString()] = row.getColumn(1).getDouble();
    ASSERT_EQ(metrics.size(), 5U);
  }
  Parsed<Store> store = Store::Open(File(), {.mode = OpenMode::kReadWrite});
  ASSERT_TRUE(store) << Said(store.error());
  EXPECT_EQ(Said(store->Verify()->findings), "");
  EXPECT_EQ(store->Stats()->layouts, 4);
  EXPECT_EQ(store->Stats()->calibrations, 1);
  EXPECT_EQ(store->Query({.where = "rms_after_um < 100"})->rows.size(), 1U);
  EXPECT_EQ(store->Query({.where = "metric.singularity_margin > 0"})->rows.size(), 1U);
  EXPECT_EQ(store->Search("sheet drive")->size(), 1U) << "words of what was there before";
  EXPECT_FALSE(store->Similar("Knee mill")->empty());
  const Parsed<StoredLayout> jet = store->Show("4");
  EXPECT_EQ(jet->record.metrics.size(), 5U);
  EXPECT_GT(jet->record.parameters.size(), 40U);
  SQLite::Database db(File().string());
  SQLite::Statement row(db, "SELECT layout || name || unit || method, value FROM metrics");
  while (row.executeStep())
    EXPECT_EQ(metrics.at(row.getColumn(0).getString()), row.getColumn(1).getDouble());
  EXPECT_EQ(db.execAndGet("SELECT count(*) FROM formulas WHERE tree IS NULL").getInt(), 0);
  EXPECT_EQ(db.execAndGet("PRAGMA user_version").getInt(), 3);
}

TEST_F(MigrationTest, OldCatalogsAreMergedAfterTheyAreBroughtUpToDate) {
  StoreOldCatalog(2);
  Store fresh = Create("fresh.db");
  EXPECT_EQ(CodeOf(Store::Open(File())), "E0506");
  ASSERT_TRUE(fresh.Merge(Create()));
  EXPECT_EQ(fresh.Stats()->layouts, 4);
  EXPECT_EQ(Said(fresh.Verify()->findings), "");
}

TEST_F(MigrationTest, AddsResultsToLayoutsOfTheOldCatalog) {
  StoreOldCatalog();
  Store store = Create();
  const Parsed<AddResult> added = store.Add(Lambda());
  ASSERT_TRUE(added) << Said(added.error());
  EXPECT_EQ(added->status, AddStatus::kUpdated) << "the layout is recognised by its hash";
  EXPECT_EQ(store.Query({.where = "rms_after_um < 100"})->rows.size(), 1U);
}

TEST_F(MigrationTest, DoesItOnlyOnce) {
  StoreOldCatalog();
  static_cast<void>(Create());
  EXPECT_THAT(Create().Notes(), ElementsAre());
  EXPECT_THAT(FilesInFolder(), ElementsAre("machines.db", "machines.db.v1.bak"));
}

TEST_F(MigrationTest, IncludesInTheCopyWhatStillLiesInTheLog) {
  StoreOldCatalog();
  SQLite::Database other(File().string(), SQLite::OPEN_READWRITE);
  other.exec("PRAGMA journal_mode = WAL; UPDATE layout SET name = 'renamed' WHERE id = 2");
  ASSERT_GT(std::filesystem::file_size(File("machines.db-wal")), 0U) << "the case under test";
  static_cast<void>(Create());
  SQLite::Database copy(File("machines.db.v1.bak").string());
  EXPECT_EQ(copy.execAndGet("SELECT name FROM layout WHERE id = 2").getString(), "renamed");
  EXPECT_EQ(copy.execAndGet("PRAGMA user_version").getInt(), 1);
}

TEST_F(MigrationTest, NeverOverwritesAnOlderCopy) {
  StoreOldCatalog();
  WriteBytes(File("machines.db.v1.bak"), "precious");
  static_cast<void>(Create());
  EXPECT_EQ(Bytes(File("machines.db.v1.bak")), "precious");
  EXPECT_TRUE(std::filesystem::exists(File("machines.db.v1.2.bak")));
}

TEST_F(MigrationTest, UndoesAStepThatFails) {
  StoreOldCatalog();
  Tamper("CREATE TABLE calibration(x)");
  const Parsed<Store> store = Store::Open(File(), {.mode = OpenMode::kReadWrite});
  EXPECT_EQ(CodeOf(store), "E0507");
  EXPECT_THAT(Said(store.error()),
              HasSubstr("from schema 1 to 3 failed and was undone: table calibration already"));
  EXPECT_THAT(Said(store.error()),
              HasSubstr("help: a copy lies in '" + File("machines.db.v1.bak").string()));
  SQLite::Database db(File().string());
  EXPECT_EQ(db.execAndGet("PRAGMA user_version").getInt(), 1);
  EXPECT_EQ(
      db.execAndGet("SELECT count(*) FROM sqlite_schema WHERE name IN ('term', 'metric')").getInt(),
      0);
  EXPECT_EQ(db.execAndGet("SELECT count(*) FROM layouts").getInt(), 3);
}

TEST_F(MigrationTest, UndoesAStepThatFindsBrokenReferences) {
  StoreOldCatalog();
  Tamper("PRAGMA foreign_keys = OFF; DELETE FROM formula WHERE id = 1");
  EXPECT_EQ(CodeOf(Store::Open(File(), {.mode = OpenMode::kReadWrite})), "E0507");
}

TEST_F(MigrationTest, LeavesAnOldCatalogAloneThatIsOpenedForReading) {
  StoreOldCatalog();
  const std::string before = Bytes(File());
  const Parsed<Store> store = Store::Open(File());
  EXPECT_EQ(CodeOf(store), "E0506");
  EXPECT_THAT(Said(store.error()), HasSubstr("brings it up to date"));
  EXPECT_TRUE(Bytes(File()) == before);
  EXPECT_THAT(FilesInFolder(), ElementsAre("machines.db"));
}

}  // namespace
}  // namespace kompono::catalog
