// SPDX-License-Identifier: Apache-2.0
#include "catalog_fixture.hpp"

#include <chrono>
#include <cstdio>

namespace kompono::catalog {
namespace {

/// What a synthesis run hands in: few formulas, many sizes, one source.
std::vector<LayoutRecord> Sized(int count) {
  std::vector<LayoutRecord> records;
  records.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    LayoutRecord record = Hexapod();
    const std::string number = std::to_string(i);
    record.name = "study/" + number;
    record.formula = "part " + std::to_string(i % 500) + " O (XYZABC):struts tool";
    record.parameters = {{.name = "struts.radius", .value = 300.0 + 0.01 * i, .unit = "mm"}};
    record.toml =
        "kompono = 1\nname = \"study/" + number + "\"\n[block.struts]\nmodule = \"hexapod\"\n";
    record.metrics = {{.name = "workspace_volume",
                       .value = 1e6 + (i * 7919) % 100003,
                       .unit = "mm3",
                       .method = "grid"},
                      {.name = "stiffness_min",
                       .value = 5.0 + (i * 104729) % 9973,
                       .unit = "N/um",
                       .method = "grid"}};
    record.capabilities.clear();
    record.provenance = {.plugins = {{.id = "org.kompono.hexapod", .version = "2.0.1"}},
                         .source_path = "studies/six.toml",
                         .source_sha256 = std::string(64, 'c')};
    records.push_back(std::move(record));
  }
  return records;
}

class BulkTest : public CatalogTest {};

TEST_F(BulkTest, AddsManyInChunksAndFindsThemAgain) {
  constexpr int kCount = 20'000;
  const std::vector<LayoutRecord> records = Sized(kCount);
  Store store = Create();
  const auto begin = std::chrono::steady_clock::now();
  const auto added = store.AddAll(records, {.layouts_per_transaction = 5000});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  ASSERT_TRUE(added) << Said(added.error());
  ASSERT_EQ(added->size(), records.size());
  EXPECT_EQ(added->back().status, AddStatus::kAdded);
  std::printf(
      "%.0f layouts/s, %d parameters, metrics and blocks each\n", kCount / taken.count(), 4);
  RecordProperty("layouts_per_second", static_cast<int>(kCount / taken.count()));

  const auto again = store.AddAll(records);
  ASSERT_TRUE(again);
  for (std::size_t i = 0; i < records.size(); i += 997) {
    EXPECT_EQ((*again)[i].status, AddStatus::kUnchanged);
    EXPECT_EQ((*again)[i].id, (*added)[i].id);
  }
  const Parsed<Statistics> stats = store.Stats();
  EXPECT_EQ(stats->layouts, kCount);
  EXPECT_EQ(stats->formulas, 500);
  EXPECT_EQ(stats->metrics, 2 * kCount);
  EXPECT_EQ(store.Query({.where = "name = 'study/4711'"})->rows.size(), 1U);
  const Parsed<VerifyReport> report = store.Verify();
  ASSERT_TRUE(report);
  EXPECT_EQ(Said(report->findings), "");
  EXPECT_EQ(report->layouts, kCount);
}

/// 64 rows wait at a time: repetitions stand among them, behind them and far away.
TEST_F(BulkTest, WhatIsRepeatedWhileItsRowsWaitIsOneLayout) {
  std::vector<LayoutRecord> records = Sized(203);
  for (LayoutRecord& record : records) record.capabilities = {{.name = "turns", .detail = "C"}};
  records[3] = records[2];
  records[70] = records[1];
  records[202] = records[201];
  records[202].metrics[0].value = 1.0;
  for (const bool bulk : {false, true}) {
    Store store = Create(bulk ? "bulk.db" : "plain.db");
    if (bulk) {
      ASSERT_TRUE(store.BeginBulk().empty());
    }
    const auto added = store.AddAll(records);
    ASSERT_TRUE(added) << Said(added.error());
    if (bulk) {
      ASSERT_TRUE(store.EndBulk().empty());
    }
    EXPECT_EQ((*added)[3].id, (*added)[2].id);
    EXPECT_EQ((*added)[3].status, AddStatus::kUnchanged);
    EXPECT_EQ((*added)[70].id, (*added)[1].id);
    EXPECT_EQ((*added)[202].id, (*added)[201].id);
    EXPECT_EQ((*added)[202].status, AddStatus::kUpdated);
    const Parsed<Statistics> stats = store.Stats();
    EXPECT_EQ(stats->layouts, 200);
    EXPECT_EQ(stats->metrics, 400);
    const Parsed<Table> last =
        store.Query({.where = "metric.workspace_volume = 1", .columns = "name"});
    ASSERT_TRUE(last) << Said(last.error());
    EXPECT_EQ(last->rows.size(), 1U);
    EXPECT_EQ(store.Search("turns", 1000)->size(), 200U) << "each has its words once";
    EXPECT_EQ(Said(store.Verify()->findings), "");
  }
}

}  // namespace
}  // namespace kompono::catalog
