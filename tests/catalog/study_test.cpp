// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/study.hpp"

#include "catalog_fixture.hpp"
#include "study_fixture.hpp"

#include <algorithm>
#include <thread>

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::size_t LayoutsAmong(std::int64_t candidates) {
  std::size_t layouts = 0;
  for (std::int64_t i = 0; i < candidates; ++i) layouts += Evaluated(i).layout ? 1 : 0;
  return layouts;
}

class StudyTest : public CatalogTest {
 protected:
  /// A study with `done` evaluated.
  static std::int64_t Run(Store& store,
                          std::int64_t candidates,
                          const std::vector<IndexRange>& done) {
    const Parsed<std::int64_t> study = store.BeginStudy(SheetStudy(candidates));
    if (!study) throw std::runtime_error(Said(study.error()));
    for (const IndexRange& range : done) {
      const auto appended = store.AppendChunk(*study, range, EvaluatedAll(range));
      if (!appended) throw std::runtime_error(Said(appended.error()));
    }
    return *study;
  }
  [[nodiscard]] std::string Exported(const Store& store, const std::string& name) const {
    const auto written = store.ExportAll(ExportFormat::kJson, File(name));
    return written ? Bytes(File(name)) : Said(written.error());
  }
};

TEST_F(StudyTest, WhatIsMissingIsWhatWasNotAppended) {
  Store store = Create();
  const std::int64_t study = Run(store, 1000, {{100, 200}, {300, 350}, {200, 250}});
  EXPECT_THAT(*store.MissingRanges(study, {0, 1000}),
              ElementsAre(IndexRange{0, 100}, IndexRange{250, 300}, IndexRange{350, 1000}));
  EXPECT_THAT(*store.MissingRanges(study, {120, 310}), ElementsAre(IndexRange{250, 300}));
  EXPECT_THAT(*store.MissingRanges(study, {120, 240}), IsEmpty());
  EXPECT_THAT(*store.MissingRanges(study, {700, 800}), ElementsAre(IndexRange{700, 800}));
  EXPECT_EQ(CodeOf(store.MissingRanges(study + 1, {0, 10})), "E0541");
}

TEST_F(StudyTest, RangesOfOneRunAreJoined) {
  Store store = Create();
  Run(store, 1000, {{0, 10}, {20, 30}, {40, 50}, {10, 20}, {30, 40}});
  SQLite::Database db(File().string());
  EXPECT_EQ(db.execAndGet("SELECT group_concat(begin || '-' || past) FROM runs").getString(),
            "0-50");
}

TEST_F(StudyTest, EvaluationsComeBackAsTheyWere) {
  Store store = Create();
  const std::int64_t study = Run(store, 100, {{0, 50}});
  const auto records = store.Evaluations(study, {0, 100}, true);
  ASSERT_TRUE(records) << Said(records.error());
  ASSERT_EQ(records->size(), 50U);
  for (const EvaluationRecord& record : *records) {
    const EvaluationRecord expected = Evaluated(record.candidate);
    EXPECT_EQ(record.status, expected.status);
    EXPECT_EQ(record.stage, expected.stage);
    EXPECT_EQ(record.reason, expected.reason);
    EXPECT_EQ(record.formula, expected.formula);
    ASSERT_EQ(record.metrics.size(), expected.metrics.size());
    for (std::size_t i = 0; i < record.metrics.size(); ++i) {
      EXPECT_EQ(record.metrics[i].name, expected.metrics[i].name);
      EXPECT_EQ(record.metrics[i].value, expected.metrics[i].value);
      EXPECT_EQ(record.metrics[i].failure, expected.metrics[i].failure);
    }
    ASSERT_EQ(record.layout.has_value(), expected.layout.has_value());
    if (!record.layout) continue;
    EXPECT_EQ(ContentHash(*record.layout), ContentHash(*expected.layout));
    EXPECT_EQ(record.layout->relative_motion,
              fmt::format("part X Y Z{} tool", 2 + record.candidate % 5))
        << "follows from the formula";
  }
}

TEST_F(StudyTest, MotionsFollowFromTheFormulaIfNobodyGivesThem) {
  Store store = Create();
  const std::int64_t study = *store.BeginStudy(SheetStudy(10));
  std::vector<EvaluationRecord> records = EvaluatedAll({1, 3});
  records[0].layout->distribution = "given";
  records[0].layout->relative_motion = "given";
  ASSERT_TRUE(store.AppendChunk(study, {1, 3}, records));
  SQLite::Database db(File().string());
  EXPECT_EQ(
      db.execAndGet("SELECT group_concat(axis || ' ' || side, ', ') FROM motions WHERE layout = "
                    "'sheet/1'")
          .getString(),
      "X workpiece, Y workpiece, Z3 tool");
  EXPECT_EQ(db.execAndGet("SELECT count(*) FROM motions WHERE layout = 'sheet/2'").getInt(), 3);
}

TEST_F(StudyTest, ARuleMayForbidOneAlternativeAlone) {
  StudyRecord record = SheetStudy(10);
  record.rules.push_back({.first = "motion:A", .kind = "normative"});
  Store store = Create();
  EXPECT_TRUE(store.BeginStudy(record));
  record.rules.back().first.clear();
  EXPECT_EQ(CodeOf(store.BeginStudy(record)), "E0540");
}

TEST_F(StudyTest, AppendingAgainChangesNothing) {
  Store store = Create();
  const std::int64_t study = Run(store, 300, {{50, 100}});
  const auto again = store.AppendChunk(study, {0, 150}, EvaluatedAll({0, 150}));
  ASSERT_TRUE(again) << Said(again.error());
  EXPECT_EQ(again->written, 100);
  EXPECT_EQ(again->skipped, 50);
  const std::string before = Exported(store, "before.json");
  EXPECT_EQ(store.AppendChunk(study, {0, 150}, EvaluatedAll({0, 150}))->written, 0);
  EXPECT_EQ(Exported(store, "after.json"), before);
}

TEST_F(StudyTest, TheSameStudyIsRecognisedAndAnotherIsNot) {
  Store store = Create();
  const std::int64_t study = *store.BeginStudy(SheetStudy(100));
  EXPECT_EQ(*store.BeginStudy(SheetStudy(100)), study);
  EXPECT_NE(*store.BeginStudy(SheetStudy(101)), study);
  StudyRecord changed = SheetStudy(100);
  changed.toml += "[limits]\n";
  EXPECT_NE(*store.BeginStudy(changed), study);
  EXPECT_EQ(store.Studies()->size(), 3U);
}

TEST_F(StudyTest, ChunksWithHolesAreRefused) {
  Store store = Create();
  const std::int64_t study = *store.BeginStudy(SheetStudy(100));
  std::vector<EvaluationRecord> records = EvaluatedAll({0, 10});
  EXPECT_EQ(CodeOf(store.AppendChunk(study, {0, 11}, records)), "E0540");
  records[4].candidate = 5;
  EXPECT_EQ(CodeOf(store.AppendChunk(study, {0, 10}, records)), "E0540");
  EXPECT_EQ(CodeOf(store.AppendChunk(study, {95, 105}, EvaluatedAll({95, 105}))), "E0542");
  EXPECT_EQ(CodeOf(store.AppendChunk(study + 7, {0, 10}, EvaluatedAll({0, 10}))), "E0541");
  EXPECT_EQ(CodeOf(store.AppendChunk(study, {5, 5}, {})), "E0540");
  EXPECT_THAT(*store.MissingRanges(study, {0, 100}), ElementsAre(IndexRange{0, 100}));
}

TEST_F(StudyTest, EvaluationsMustSayWhyAndWhat) {
  Store store = Create();
  const std::int64_t study = *store.BeginStudy(SheetStudy(100));
  const auto refused = [&](auto change) {
    std::vector<EvaluationRecord> records = EvaluatedAll({0, 5});
    change(records);
    const auto appended = store.AppendChunk(study, {0, 5}, records);
    return appended ? std::string("taken") : Said(appended.error());
  };
  using Records = std::vector<EvaluationRecord>;
  EXPECT_THAT(refused([](Records& r) { r[0].reason.clear(); }),
              HasSubstr("candidate 0 is not ok and has no reason [E0540]"));
  EXPECT_THAT(refused([](Records& r) { r[1].reason = "odd"; }),
              HasSubstr("is ok and has a reason"));
  EXPECT_THAT(refused([](Records& r) { r[1].stage = "\xff"; }), HasSubstr("not UTF-8"));
  EXPECT_THAT(refused([](Records& r) { r[1].metrics[0].value = 0.0 / 0.0; }),
              HasSubstr("is not a finite number"));
  EXPECT_THAT(refused([](Records& r) { r[1].metrics[1] = r[1].metrics[0]; }),
              HasSubstr("is given twice"));
  EXPECT_THAT(refused([](Records& r) { r[1].layout->formula = "O tool"; }),
              HasSubstr("another formula than its layout"));
  EXPECT_THAT(refused([](Records& r) { r[1].layout->metrics = r[1].metrics; }),
              HasSubstr("metrics in its layout"));
  EXPECT_THAT(*store.MissingRanges(study, {0, 5}), ElementsAre(IndexRange{0, 5}));
  StudyRecord bad = SheetStudy(-1);
  bad.rules[0].kind = "odd";
  EXPECT_EQ(store.BeginStudy(bad).error().size(), 2U);
}

TEST_F(StudyTest, LayoutsOfAStudyAreFoundByTheirMetrics) {
  Store store = Create();
  Run(store, 500, {{0, 500}});
  const Parsed<Table> best = store.Query({.where = "metric.stiffness < 300 and metric.volume > 100",
                                          .columns = "name, metric.stiffness",
                                          .sort = "metric.stiffness desc",
                                          .limit = 5});
  ASSERT_TRUE(best) << Said(best.error());
  ASSERT_EQ(best->rows.size(), 5U);
  double expected = 0.0;
  for (std::int64_t i = 0; i < 500; ++i) {
    if (i % 3 == 0 || i % 7 == 0 || Figure(i, 104'729) <= 100) continue;
    if (Figure(i, 7919) < 300) expected = std::max(expected, Figure(i, 7919));
  }
  EXPECT_DOUBLE_EQ(std::get<double>(best->rows[0][1]), expected);
}

TEST_F(StudyTest, FourShardsMergedAreOneRunToTheByte) {
  constexpr std::int64_t kAll = 400;
  Store whole = Create("whole.db");
  Run(whole, kAll, {{0, kAll}});
  Store merged = Create("merged.db");
  for (const std::int64_t k : {2, 0, 3, 1}) {
    Store shard = Create(fmt::format("shard{}.db", k));
    const std::int64_t begin = k * kAll / 4;
    Run(shard, kAll, {{begin + 50, begin + 100}, {begin, begin + 50}});
    const auto result = merged.Merge(shard);
    ASSERT_TRUE(result) << Said(result.error());
    EXPECT_EQ(result->evaluations_written, kAll / 4);
  }
  EXPECT_EQ(Exported(merged, "merged.json"), Exported(whole, "whole.json"));
  EXPECT_GT(Bytes(File("whole.json")).size(), 50'000U);
  ASSERT_TRUE(merged.ExportAll(ExportFormat::kCsv, File("merged")));
  ASSERT_TRUE(whole.ExportAll(ExportFormat::kCsv, File("whole")));
  for (const auto& entry : std::filesystem::directory_iterator(File("whole"))) {
    EXPECT_EQ(Bytes(entry.path()), Bytes(File("merged") / entry.path().filename())) << entry.path();
  }
  EXPECT_EQ(Said(merged.Verify()->findings), "");
  const auto again = merged.Merge(Create("shard2.db"));
  EXPECT_EQ(again->layouts_added, 0);
  EXPECT_EQ(again->evaluations_written, 0);
  EXPECT_EQ(again->evaluations_skipped, kAll / 4);
  EXPECT_EQ(Exported(merged, "again.json"), Exported(whole, "whole.json"));
}

TEST_F(StudyTest, MergeTakesLayoutsWithTheirWordsAndCalibrations) {
  static_cast<void>(Filled());
  Store other = Create("other.db");
  Run(other, 30, {{0, 30}});
  ASSERT_TRUE(other.Merge(Create()));
  EXPECT_EQ(other.Search("jet")->size(), 2U) << "the layout and the study";
  EXPECT_EQ(other.Stats()->calibrations, 1);
  EXPECT_EQ(Said(other.Verify()->findings), "");
  EXPECT_EQ(CodeOf(other.Merge(other)), "E0549");
}

TEST_F(StudyTest, SeveralWritersShareOneFile) {
  constexpr std::int64_t kAll = 600;
  static_cast<void>(Create());
  std::vector<std::thread> threads;
  for (std::int64_t k = 0; k < 3; ++k) {
    threads.emplace_back([this, k] {
      Parsed<Store> store = Store::Open(
          File(), {.mode = OpenMode::kReadWrite, .busy_timeout = std::chrono::minutes(1)});
      const Parsed<std::int64_t> study = store->BeginStudy(SheetStudy(kAll));
      for (std::int64_t i = k * 20; i < kAll; i += 60) {
        const IndexRange range{i, i + 20};
        EXPECT_TRUE(store->AppendChunk(*study, range, EvaluatedAll(range)));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  Store whole = Create("whole.db");
  Run(whole, kAll, {{0, kAll}});
  EXPECT_EQ(Exported(Create(), "shared.json"), Exported(whole, "whole.json"));
}

TEST_F(StudyTest, ReadersDoNotWaitForAWriter) {
  Store store = Create();
  const std::int64_t study = Run(store, 100, {{0, 50}});
  const Parsed<Store> opened = Store::Open(File(), {.busy_timeout = std::chrono::milliseconds(0)});
  ASSERT_TRUE(opened);
  SQLite::Database writer(File().string(), SQLite::OPEN_READWRITE, 0);
  writer.exec("BEGIN IMMEDIATE; DELETE FROM evaluation_metric");
  EXPECT_EQ(opened->Evaluations(study, {0, 100})->size(), 50U);
  EXPECT_EQ(opened->Query({.where = "metric.stiffness > 0"})->rows.size(), LayoutsAmong(50));
  writer.exec("ROLLBACK");
}

TEST_F(StudyTest, BulkLoadingGivesTheSameCatalog) {
  Store plain = Create("plain.db");
  Run(plain, 500, {{0, 500}});
  {
    Store bulk = Create("bulk.db");
    ASSERT_TRUE(bulk.BeginBulk().empty());
    const std::int64_t study = Run(bulk, 500, {{0, 250}});
    EXPECT_EQ(Said(bulk.Verify()->findings), "") << "in the middle of it";
    EXPECT_EQ(bulk.Query({.where = "metric.stiffness > 0", .limit = 0})->rows.size(),
              LayoutsAmong(250));
    ASSERT_TRUE(bulk.AppendChunk(study, {250, 500}, EvaluatedAll({250, 500})));
    ASSERT_TRUE(bulk.EndBulk().empty());
    EXPECT_EQ(Exported(bulk, "bulk.json"), Exported(plain, "plain.json"));
    EXPECT_EQ(Said(bulk.Verify()->findings), "");
  }
  EXPECT_THAT(Create("bulk.db").Notes(), IsEmpty());
}

TEST_F(StudyTest, ABulkLoadThatWasCutShortIsHealedByTheNextWriter) {
  {
    Store bulk = Create();
    ASSERT_TRUE(bulk.BeginBulk().empty());
    Run(bulk, 100, {{0, 50}});
  }
  EXPECT_EQ(Said(Store::Open(File())->Verify()->findings), "");
  Store healed = Create();
  EXPECT_THAT(Said(healed.Notes()), HasSubstr("[N0502]"));
  const auto plan = healed.Explain({.where = "metric.stiffness > 5"});
  EXPECT_THAT(*plan, testing::Contains(HasSubstr("metric_by_value")));
  EXPECT_EQ(Said(healed.Verify()->findings), "");
}

TEST_F(StudyTest, DuplicatesAreFoundWhileLoadingInBulk) {
  Store one = Create();
  Store two = Create();
  Run(one, 100, {{0, 40}});
  ASSERT_TRUE(two.BeginBulk().empty());
  const std::int64_t study = Run(two, 200, {{0, 60}});
  EXPECT_EQ(one.Stats()->layouts, LayoutsAmong(60)) << "40 of them came twice";
  // The first writer goes on without the index of the hashes.
  Run(one, 200, {{60, 80}});
  Run(one, 100, {{40, 90}});
  ASSERT_TRUE(two.AppendChunk(study, {60, 90}, EvaluatedAll({60, 90})));
  ASSERT_TRUE(two.EndBulk().empty());
  EXPECT_EQ(Said(two.Verify()->findings), "");
  EXPECT_EQ(two.Stats()->layouts, LayoutsAmong(90));
}

TEST_F(StudyTest, VerifyNoticesHolesAndChangedStudies) {
  Store store = Create();
  Run(store, 100, {{0, 50}});
  const auto findings = [this](const std::string& damage) {
    Tamper(damage);
    return Said(Store::Open(File())->Verify()->findings);
  };
  EXPECT_THAT(findings("DELETE FROM evaluation WHERE candidate = 9"),
              HasSubstr("candidate 0 is in a range that is done but not complete [E0546]"));
  EXPECT_THAT(findings("UPDATE run_range SET past = 40"),
              HasSubstr("has 10 evaluations of candidates that are not done [E0546]"));
  EXPECT_THAT(findings("UPDATE study SET candidates = 20"),
              testing::AllOf(HasSubstr("[E0545]"), HasSubstr("candidate 39 is outside the study")));
  EXPECT_THAT(findings("DELETE FROM word; UPDATE study SET candidates = 100"),
              HasSubstr("full-text search has 0 wrong and lacks 1 [E0547]"));
}

TEST_F(StudyTest, StatisticsCountWhatFellAndWhy) {
  Store store = Create();
  Run(store, 100, {{0, 42}});
  const Parsed<Statistics> stats = store.Stats();
  EXPECT_EQ(stats->evaluations, 42);
  EXPECT_EQ(stats->evaluations_rejected, 14);
  EXPECT_EQ(stats->evaluations_failed, 4);
  EXPECT_THAT(stats->studies, ElementsAre(Count{"sheet", 42}));
  EXPECT_THAT(
      stats->rejected,
      ElementsAre(Count{"mobility: too few freedoms", 14}, Count{"work zone: no assembly", 4}));
  const StudySummary study = store.Studies()->front();
  EXPECT_EQ(study.done, 42);
  EXPECT_EQ(study.ok, 24);
  EXPECT_EQ(study.rejected, 14);
  EXPECT_EQ(study.failed, 4);
  EXPECT_THAT(study.done_ranges, ElementsAre(IndexRange{0, 42}));
}

}  // namespace
}  // namespace kompono::catalog
