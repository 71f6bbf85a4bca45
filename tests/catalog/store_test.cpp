// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/store.hpp"

#include "catalog_fixture.hpp"
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <thread>

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class StoreTest : public CatalogTest {};

TEST_F(StoreTest, GivesBackWhatWasAdded) {
  Store store = Create();
  const LayoutRecord record = Lambda();
  const Parsed<AddResult> added = store.Add(record);
  ASSERT_TRUE(added) << Said(added.error());
  EXPECT_EQ(added->status, AddStatus::kAdded);

  const Parsed<StoredLayout> shown = store.Show(record.name);
  ASSERT_TRUE(shown) << Said(shown.error());
  EXPECT_EQ(shown->id, added->id);
  EXPECT_EQ(shown->hash, ContentHash(record));
  EXPECT_EQ(shown->rms_after_um, 38.25);
  const LayoutRecord& stored = shown->record;
  EXPECT_EQ(stored.formula, record.formula);
  EXPECT_EQ(stored.distribution, record.distribution);
  EXPECT_EQ(stored.relative_motion, record.relative_motion);
  EXPECT_TRUE(stored.open_base);
  EXPECT_EQ(stored.coordinates, 3);
  EXPECT_EQ(stored.drives, 3);
  ASSERT_EQ(stored.motions.size(), 3U);
  EXPECT_EQ(stored.motions[1].axis, "Y");
  EXPECT_EQ(stored.motions[1].block, "drive");
  EXPECT_EQ(stored.motions[2].side, Side::kTool);
  ASSERT_EQ(stored.blocks.size(), 2U);
  EXPECT_EQ(stored.blocks[1].module, "jet_head");
  ASSERT_EQ(stored.parameters.size(), 2U);
  EXPECT_EQ(stored.parameters[1].name, "drive.L2");
  EXPECT_EQ(stored.parameters[1].value, 820.5);
  ASSERT_EQ(stored.metrics.size(), 2U);
  EXPECT_EQ(stored.metrics[0].failure, "no stiffness given");
  EXPECT_FALSE(stored.metrics[0].value);
  EXPECT_EQ(stored.metrics[1].value, 1.9e6);
  ASSERT_EQ(stored.capabilities.size(), 1U);
  EXPECT_EQ(stored.capabilities[0].detail, "sheet up to 150 mm");
  ASSERT_EQ(stored.calibrations.size(), 1U);
  EXPECT_EQ(stored.calibrations[0].degrees_of_freedom, 54);
  EXPECT_EQ(stored.calibrations[0].report_json, R"({"iterations": 6})");
}

TEST_F(StoreTest, KeepsWhoMadeARow) {
  const Parsed<StoredLayout> shown = Filled().Show("Lambda water-jet");
  ASSERT_TRUE(shown) << Said(shown.error());
  const Provenance& provenance = shown->record.provenance;
  EXPECT_THAT(provenance.program_version, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_EQ(provenance.source_path, "layouts/machines/lambda.toml");
  EXPECT_EQ(provenance.source_sha256, Hex(Sha256Of(Lambda().toml)));
  ASSERT_EQ(provenance.plugins.size(), 2U);
  EXPECT_EQ(provenance.plugins[0].id, "org.kompono.lambda");
  EXPECT_EQ(provenance.plugins[0].version, "1.0.0");
}

TEST_F(StoreTest, AddingTwiceChangesNothing) {
  Store store = Filled();
  const std::string before = Bytes(File()) + Bytes(File("machines.db-wal"));
  const Parsed<AddResult> again = store.Add(Lambda());
  ASSERT_TRUE(again) << Said(again.error());
  EXPECT_EQ(again->status, AddStatus::kUnchanged);
  EXPECT_EQ(again->id, store.Show("Lambda water-jet")->id);
  EXPECT_EQ(store.Stats()->layouts, 3);
  EXPECT_EQ(store.Stats()->calibrations, 1);
  EXPECT_EQ(before, Bytes(File()) + Bytes(File("machines.db-wal")));
}

TEST_F(StoreTest, AddsNewResultsToAKnownLayoutAndKeepsTheOldOnes) {
  Store store = Filled();
  LayoutRecord record = Lambda();
  record.metrics = {
      {.name = "workspace_area", .value = 2.0e6, .unit = "mm2", .method = "grid 50x50"}};
  record.capabilities.clear();
  record.calibrations[0].measurements_sha256 = std::string(64, 'b');
  record.calibrations[0].rms_after_um = 12.5;
  const Parsed<AddResult> updated = store.Add(record);
  ASSERT_TRUE(updated) << Said(updated.error());
  EXPECT_EQ(updated->status, AddStatus::kUpdated);

  const Parsed<StoredLayout> shown = store.Show(std::to_string(updated->id));
  ASSERT_TRUE(shown) << Said(shown.error());
  EXPECT_EQ(shown->record.metrics.size(), 2U);
  EXPECT_EQ(shown->record.metrics[1].value, 2.0e6);
  EXPECT_EQ(shown->record.capabilities.size(), 1U);
  EXPECT_EQ(shown->record.calibrations.size(), 2U);
  EXPECT_EQ(shown->rms_after_um, 12.5) << "the newest calibration counts";
}

TEST_F(StoreTest, TakesTheResidualsOfTheCalibrationThatIsLeft) {
  Store store = Filled();
  LayoutRecord record = Lambda();
  record.calibrations[0].rms_after_um = 12.5;
  ASSERT_TRUE(store.Add(record));
  Tamper("DELETE FROM calibration WHERE rms_after_um = 12.5");
  EXPECT_EQ(store.Show("Lambda water-jet")->rms_after_um, 38.25);
  Tamper("DELETE FROM calibration");
  EXPECT_EQ(store.Show("Lambda water-jet")->rms_after_um, std::nullopt);
}

TEST_F(StoreTest, TakesANewTextOfTheSameContent) {
  Store store = Create();
  LayoutRecord record = KneeMill();
  record.content = "the meaning";
  ASSERT_TRUE(store.Add(record));
  record.toml += "# a comment\n";
  const Parsed<AddResult> added = store.Add(record);
  ASSERT_TRUE(added) << Said(added.error());
  EXPECT_EQ(added->status, AddStatus::kUpdated);
  EXPECT_EQ(store.Export("Knee mill"), record.toml);
  EXPECT_EQ(store.Stats()->layouts, 1);
}

TEST_F(StoreTest, TakesWhatAnotherVersionDerivesFromTheSameContent) {
  Store store = Filled();
  LayoutRecord record = KneeMill();
  record.drives = 4;
  record.distribution = "another key";
  record.motions.pop_back();
  EXPECT_EQ(store.Add(record)->status, AddStatus::kUpdated);
  const Parsed<StoredLayout> shown = store.Show("Knee mill");
  ASSERT_TRUE(shown) << Said(shown.error());
  EXPECT_EQ(shown->record.drives, 4);
  EXPECT_EQ(shown->record.distribution, "another key");
  EXPECT_EQ(shown->record.motions.size(), 2U);
  EXPECT_TRUE(store.Verify()->Ok());
}

TEST_F(StoreTest, FindsByNameIdAndHashPrefix) {
  Store store = Filled();
  const Parsed<StoredLayout> byname = store.Show("Hexapod");
  ASSERT_TRUE(byname) << Said(byname.error());
  EXPECT_EQ(store.Show(std::to_string(byname->id))->hash, byname->hash);
  EXPECT_EQ(store.Show(byname->hash)->id, byname->id);
  EXPECT_EQ(store.Show(byname->hash.substr(0, 9))->id, byname->id);
  EXPECT_EQ(CodeOf(store.Show(byname->hash.substr(0, 3))), "E0512") << "three digits are too few";
}

TEST_F(StoreTest, SuggestsTheNearestNameForAnUnknownOne) {
  const Parsed<StoredLayout> shown = Filled().Show("Hexapot");
  ASSERT_FALSE(shown);
  EXPECT_EQ(Said(shown.error()),
            File().string() +
                ": error: no layout has the name, id or hash 'Hexapot' [E0512]\n"
                "  help: did you mean 'Hexapod'?\n1 error\n");
}

TEST_F(StoreTest, AsksWhichOfSeveralLayoutsOfOneNameIsMeant) {
  Store store = Filled();
  LayoutRecord other = Hexapod();
  other.parameters[0].value = 401.0;
  ASSERT_TRUE(store.Add(other));
  const Parsed<StoredLayout> shown = store.Show("Hexapod");
  EXPECT_EQ(CodeOf(shown), "E0513");
  EXPECT_THAT(Said(shown.error()), HasSubstr(ContentHash(other).substr(0, 12)));
}

TEST_F(StoreTest, ExportsTheTextByteForByte) {
  Store store = Create();
  LayoutRecord record = KneeMill();
  record.toml = "# Fräse\r\nkompono = 1\r\n\tname = \"Кнее\"  ";
  ASSERT_TRUE(store.Add(record));
  EXPECT_EQ(store.Export("Knee mill"), record.toml);
}

TEST_F(StoreTest, ListsInTheOrderOfIdsPageByPage) {
  const Store store = Filled();
  const auto first = store.List({.limit = 2});
  ASSERT_TRUE(first);
  ASSERT_EQ(first->size(), 2U);
  EXPECT_EQ((*first)[0].name, "Lambda water-jet");
  EXPECT_EQ((*first)[0].rms_after_um, 38.25);
  const auto rest = store.List({.limit = 2, .after_id = first->back().id});
  ASSERT_TRUE(rest);
  ASSERT_EQ(rest->size(), 1U);
  EXPECT_EQ(rest->front().name, "Hexapod");
  EXPECT_EQ(store.List({.limit = 0})->size(), 3U);
}

TEST_F(StoreTest, CountsWhatItHolds) {
  const Parsed<Statistics> stats = Filled().Stats();
  ASSERT_TRUE(stats) << Said(stats.error());
  EXPECT_EQ(stats->layouts, 3);
  EXPECT_EQ(stats->open_base_layouts, 1);
  EXPECT_EQ(stats->calibrated_layouts, 1);
  EXPECT_EQ(stats->formulas, 3);
  EXPECT_EQ(stats->relative_motions, 3);
  EXPECT_EQ(stats->parameters, 4);
  EXPECT_EQ(stats->metrics, 4);
  EXPECT_EQ(stats->failed_metrics, 1);
  EXPECT_THAT(
      stats->modules,
      ElementsAre(Pair("hexapod", 1), Pair("jet_head", 1), Pair("lambda", 1), Pair("spindle", 1)));
  EXPECT_THAT(stats->plugins,
              ElementsAre(Pair("org.kompono.units 1.2.0", 2),
                          Pair("org.kompono.hexapod 2.0.1", 1),
                          Pair("org.kompono.lambda 1.0.0", 1)));
  EXPECT_EQ(ToJson(*stats)["plugins"]["org.kompono.units 1.2.0"], 2);
}

TEST_F(StoreTest, RefusesToWriteWhenOpenedForReading) {
  static_cast<void>(Filled());
  Parsed<Store> store = Store::Open(File());
  ASSERT_TRUE(store) << Said(store.error());
  LayoutRecord record = KneeMill();
  record.name = "another";
  EXPECT_EQ(CodeOf(store->Add(record)), "E0502");
}

TEST_F(StoreTest, AFailureInTheMiddleLeavesNothing) {
  Store store = Filled();
  Tamper(
      "CREATE TRIGGER full BEFORE INSERT ON metric WHEN NEW.value = 666 BEGIN SELECT RAISE(ABORT, "
      "'no more'); END");
  std::vector<LayoutRecord> records(4, KneeMill());
  for (std::size_t i = 0; i < records.size(); ++i)
    records[i].parameters[0].value = 1000.0 + static_cast<double>(i);
  records[2].metrics.push_back({.name = "bad", .value = 666.0, .unit = "", .method = "m"});
  records[2].formula = "part Q O tool";

  const auto failed = store.AddAll(records);
  EXPECT_EQ(CodeOf(failed), "E0511");
  EXPECT_THAT(Said(failed.error()), HasSubstr("no more; 0 of 4 layouts are stored"));
  EXPECT_EQ(store.Stats()->layouts, 3);
  EXPECT_EQ(store.Stats()->formulas, 3) << "what the layouts refer to goes with them";

  const auto chunks = store.AddAll(records, {.layouts_per_transaction = 2});
  EXPECT_THAT(Said(chunks.error()), HasSubstr("2 of 4 layouts are stored"));
  EXPECT_EQ(store.Stats()->layouts, 5);

  Tamper("DROP TRIGGER full");
  const auto repaired = store.AddAll(records);
  ASSERT_TRUE(repaired) << "ids remembered from the rolled-back transaction would break this: "
                        << Said(repaired.error());
  EXPECT_EQ((*repaired)[1].status, AddStatus::kUnchanged);
  EXPECT_EQ((*repaired)[3].status, AddStatus::kAdded);
  EXPECT_TRUE(store.Verify()->Ok());
}

TEST_F(StoreTest, AReaderSeesOneStateWhileAnotherConnectionWrites) {
  Store writer = Filled();
  Parsed<Store> reader = Store::Open(File());
  ASSERT_TRUE(reader) << Said(reader.error());
  std::atomic<bool> done = false;
  std::string trouble;
  int looks = 0;
  std::thread reading([&] {
    // Every transaction adds ten layouts, so any count but 3 + 10 n is a torn view.
    while (!done || looks == 0) {
      const Parsed<Table> counted = reader->Query({.columns = "count(*)"});
      ++looks;
      if (!counted)
        trouble = Said(counted.error());
      else if ((std::get<std::int64_t>(counted->rows[0][0]) - 3) % 10 != 0)
        trouble = RenderText(*counted);
    }
  });
  for (int batch = 0; batch < 20; ++batch) {
    std::vector<LayoutRecord> records(10, KneeMill());
    for (std::size_t i = 0; i < 10; ++i)
      records[i].parameters[0].value = 1000.0 * (batch + 1) + static_cast<double>(i);
    const auto added = writer.AddAll(records);
    EXPECT_TRUE(added) << Said(added.error());
  }
  done = true;
  reading.join();
  EXPECT_EQ(trouble, "");
  EXPECT_EQ(reader->Stats()->layouts, 203);
}

TEST_F(StoreTest, TwoWritersWaitForEachOther) {
  static_cast<void>(Filled());
  const auto work = [this](double base) {
    Parsed<Store> store = Store::Open(File(), {.mode = OpenMode::kReadWrite});
    ASSERT_TRUE(store) << Said(store.error());
    for (int i = 0; i < 25; ++i) {
      LayoutRecord record = KneeMill();
      record.parameters[0].value = base + i;
      record.formula = "part " + std::to_string(i) + " O tool";  // both meet the same new formulas
      const Parsed<AddResult> added = store->Add(record);
      ASSERT_TRUE(added) << Said(added.error());
    }
  };
  std::thread other([&] { work(1000.0); });
  work(2000.0);
  other.join();
  const Store store = Create();
  EXPECT_EQ(store.Stats()->layouts, 53);
  EXPECT_EQ(store.Stats()->formulas, 28);
}

TEST_F(StoreTest, GivesUpWaitingForALockedCatalog) {
  static_cast<void>(Filled());
  Parsed<Store> store = Store::Open(
      File(), {.mode = OpenMode::kReadWrite, .busy_timeout = std::chrono::milliseconds(50)});
  ASSERT_TRUE(store) << Said(store.error());
  SQLite::Database other(File().string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  LayoutRecord record = KneeMill();
  record.name = "another";
  EXPECT_EQ(CodeOf(store->Add(record)), "E0509");
  other.exec("ROLLBACK");
  EXPECT_TRUE(store->Add(record)) << "and goes on afterwards";
}

TEST_F(StoreTest, TheTablesRefuseWhatTheViewsCouldNotExplain) {
  static_cast<void>(Filled());
  const auto refused = [this](const std::string& sql) {
    SQLite::Database db(File().string(), SQLite::OPEN_READWRITE, 5000);
    db.exec("PRAGMA foreign_keys = ON");
    EXPECT_THROW(db.exec(sql), SQLite::Exception) << sql;
  };
  refused(
      "INSERT INTO layout SELECT NULL, content_hash, name, formula_id, 3, 3, provenance_id, "
      "added_at, 0, 0 FROM layout");
  refused("UPDATE layout SET formula_id = 99");
  refused("UPDATE layout SET coordinates = -1");
  refused("UPDATE layout SET coordinates = 'three'");
  refused("UPDATE layout SET name = ''");
  refused("UPDATE layout SET added_at = 'yesterday'");
  refused("UPDATE layout SET content_hash = x'00'");
  refused("UPDATE formula SET base = 'ajar'");
  refused("UPDATE motion SET side = 'left'");
  refused("UPDATE metric SET failure = 'both' WHERE value IS NOT NULL");
  refused("UPDATE metric SET value = NULL WHERE value IS NOT NULL");
  refused("UPDATE parameter SET value = 'long'");
  refused("UPDATE calibration SET report = ''");
  refused("UPDATE calibration SET rms_after_um = -1");
  refused("UPDATE provenance SET source_hash = 'abc'");
  refused("DELETE FROM formula");
}

TEST_F(StoreTest, RemovingALayoutTakesItsRowsAlong) {
  Store store = Filled();
  Tamper("PRAGMA foreign_keys = ON; DELETE FROM layout");
  const Parsed<Statistics> stats = store.Stats();
  EXPECT_EQ(stats->parameters + stats->metrics + stats->calibrations, 0);
  EXPECT_TRUE(store.Verify()->Ok());
}

}  // namespace
}  // namespace kompono::catalog
