// SPDX-License-Identifier: Apache-2.0
// Shards, threads, stopping and resuming: the rows are always the same.
#include "kompono/synthesis/run.hpp"

#include "studies.hpp"
#include <fmt/format.h>

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::synthesis {
namespace {

constexpr const char* kPlain = R"(kompono = 1
study = "plain"
equivalence = "string"
base = ["closed", "open"]
[motions]
X = { range = [-200, 200] }
Y = { range = [-100, 100] }
Z = { range = [0, 100] }
B = { range = [-20, 20], part_pivot = [0, 0, -100], tool_pivot = [0, 0, 300] }
[modules.drive]
module = "lambda"
letters = ["XY"]
home = { Y = 500 }
parameters = { L1 = { range = [600, 1600], start = 1000 }, L2 = 820, L3 = 600 }
[objectives]
footprint = "min"
error_budget = "min"
[evaluation]
poses = 64
sizing_rounds = 30
)";

struct Fixture {
  Fixture()
      : outcome(BuildStudy(kPlain)),
        space(std::move(outcome.space.value())),
        all(space.space()),
        settings(ReadEvaluationSettings(space.study().text, "study.toml").value()),
        count(static_cast<std::uint64_t>(all.count())) {}
  Outcome outcome;
  StudySpace space;
  Enumeration all;
  EvaluationSettings settings;
  std::uint64_t count;
};

/// Every digit of a row.
std::string Text(const Evaluation& row) {
  std::string out = fmt::format(
      "{} {} {} {} {}", row.index, NameOf(row.status), NameOf(row.stage), row.reason, row.formula);
  for (const MetricDescription& metric : Metrics())
    out += fmt::format(" {:a}", row.metrics[metric.id]);
  for (const SizedNumber& size : row.sizes) out += fmt::format(" {}={:a}", size.name, size.value);
  return out;
}

/// What a sink is handed, once for each index.
struct Kept {
  std::map<std::uint64_t, std::string> rows;
  std::uint64_t last_end = 0;
  bool ascending = true;
  Sink sink() {
    return [this](const IndexRange& range, std::span<const Evaluation> given) {
      ascending = ascending && range.begin >= last_end && given.size() == range.size();
      last_end = range.end;
      for (const Evaluation& row : given) {
        EXPECT_TRUE(rows.emplace(row.index, Text(row)).second) << row.index << " came twice";
      }
      return Diagnostics{};
    };
  }
};

std::map<std::uint64_t, std::string> RowsOf(const Fixture& f,
                                            const std::vector<IndexRange>& todo,
                                            unsigned threads,
                                            std::uint64_t chunk) {
  const Evaluator evaluator(f.space, f.settings);  // its own shared results
  Kept kept;
  const RunReport report =
      synthesis::Run(evaluator, f.all, todo, {.threads = threads, .chunk = chunk}, kept.sink());
  EXPECT_TRUE(kept.ascending);
  EXPECT_FALSE(report.stopped);
  EXPECT_EQ(report.progress.done, kept.rows.size());
  return kept.rows;
}

TEST(ShardRange, CutsTheWholeWithoutGapOrOverlap) {
  for (const std::uint64_t count : {0ULL, 1ULL, 7ULL, 1000ULL, 1ULL << 62U}) {
    for (const std::uint64_t parts : {1ULL, 3ULL, 4ULL, 1000ULL}) {
      std::uint64_t at = 0;
      for (std::uint64_t k = 1; k <= parts; ++k) {
        const IndexRange range = ShardRange(count, k, parts);
        ASSERT_EQ(range.begin, at);
        EXPECT_LE(range.size(), count / parts + 1);
        at = range.end;
      }
      EXPECT_EQ(at, count);
    }
  }
}

TEST(ParseShard, TakesKOfNAndNothingElse) {
  const auto good = ParseShard("3/16");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->number, 3U);
  EXPECT_EQ(good->parts, 16U);
  for (const char* bad : {"", "3", "0/4", "5/4", "a/4", "3/", "/4", "-1/4", "1/4x", "1 /4"}) {
    const auto parsed = ParseShard(bad);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_EQ(parsed.error().code, "E0845");
  }
}

TEST(Run, GivesTheSameRowsWhateverTheThreadsChunksAndShards) {
  const Fixture f;
  ASSERT_GT(f.count, 100U);
  const auto whole = RowsOf(f, {{0, f.count}}, 1, 64);
  ASSERT_EQ(whole.size(), f.count);
  EXPECT_EQ(RowsOf(f, {{0, f.count}}, 2, 5), whole);
  EXPECT_EQ(RowsOf(f, {{0, f.count}}, 3, 1), whole);
  std::map<std::uint64_t, std::string> merged;
  for (std::uint64_t k = 4; k >= 1; --k)
    merged.merge(RowsOf(f, {ShardRange(f.count, k, 4)}, 2, 16));
  EXPECT_EQ(merged, whole);
}

TEST(Run, KeepsWhatIsDoneWhenItIsStoppedAndTheRestCompletesIt) {
  const Fixture f;
  const auto whole = RowsOf(f, {{0, f.count}}, 2, 16);
  const Evaluator evaluator(f.space, f.settings);
  std::atomic<bool> stop{false};
  Kept kept;
  const Sink inner = kept.sink();
  const RunReport report =
      synthesis::Run(evaluator,
                     f.all,
                     std::vector<IndexRange>{{0, f.count}},
                     {.threads = 2, .chunk = 8, .stop = &stop},
                     [&](const IndexRange& range, std::span<const Evaluation> rows) {
                       if (range.begin >= 24) stop = true;
                       return inner(range, rows);
                     });
  EXPECT_TRUE(report.stopped);
  ASSERT_GE(kept.rows.size(), 32U);
  ASSERT_LT(kept.rows.size(), f.count);
  EXPECT_EQ(kept.rows.rbegin()->first + 1, kept.rows.size()) << "no hole";
  auto merged = kept.rows;
  merged.merge(RowsOf(f, {{kept.rows.size(), f.count}}, 2, 16));
  EXPECT_EQ(merged, whole);
}

TEST(Run, EndsWithTheComplaintsOfItsSink) {
  const Fixture f;
  const Evaluator evaluator(f.space, f.settings);
  int calls = 0;
  const RunReport report =
      synthesis::Run(evaluator,
                     f.all,
                     std::vector<IndexRange>{{0, f.count}},
                     {.threads = 2, .chunk = 8},
                     [&calls](const IndexRange& /*range*/, std::span<const Evaluation> /*rows*/) {
                       ++calls;
                       return Diagnostics{{.code = "E0500", .message = "disk full"}};
                     });
  EXPECT_EQ(calls, 1);
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems[0].message, "disk full");
  EXPECT_EQ(report.progress.done, 0U) << "what was not kept is not done";
}

TEST(Run, CountsWhatEachStageRejects) {
  const Fixture f;
  const Evaluator evaluator(f.space, f.settings);
  const RunReport report = synthesis::Run(
      evaluator, f.all, std::vector<IndexRange>{{0, f.count}}, {}, [](const auto&, const auto&) {
        return Diagnostics{};
      });
  EXPECT_EQ(report.funnel[0].entered, f.count);
  for (std::size_t i = 1; i < kStages; ++i) {
    const StageCounts& before = report.funnel[i - 1];
    EXPECT_EQ(report.funnel[i].entered, before.entered - before.rejected - before.failed);
  }
}

TEST(ProgressText, SaysRateAndRemainingTime) {
  EXPECT_EQ(ProgressText({.done = 0, .all = 79900}), "0 of 79,900 (0 %)");
  EXPECT_EQ(ProgressText({.done = 12345, .all = 79900, .seconds = 57.6}),
            "12,345 of 79,900 (15 %), 214/s, 5 min 15 s left");
  EXPECT_EQ(DurationText(4.23), "4.2 s");
  EXPECT_EQ(DurationText(59.4), "59 s");
  EXPECT_EQ(DurationText(7380.0), "2 h 3 min");
}

}  // namespace
}  // namespace kompono::synthesis
