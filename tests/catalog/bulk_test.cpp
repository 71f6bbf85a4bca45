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

}  // namespace
}  // namespace kompono::catalog
