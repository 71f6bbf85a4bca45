// SPDX-License-Identifier: Apache-2.0
// The catalog with many layouts: writing them, opening the file, asking for the best twenty. The
// baseline of writing is what SQLite needs for as many rows without an index.
//     bench_catalog --benchmark_filter=insert
//     KOMPONO_BENCH_LAYOUTS=100000 bench_catalog       (1,000,000 if not said)
#include <SQLiteCpp/SQLiteCpp.h>
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "kompono/catalog/store.hpp"

namespace {

namespace fs = std::filesystem;
using kompono::catalog::EvaluationRecord;
using kompono::catalog::IndexRange;
using kompono::catalog::LayoutRecord;
using kompono::catalog::OpenMode;
using kompono::catalog::QueryRequest;
using kompono::catalog::Store;

constexpr std::int64_t kChunk = 4096;

std::int64_t Layouts() {
  const char* given = std::getenv("KOMPONO_BENCH_LAYOUTS");
  return given == nullptr ? 1'000'000 : std::strtoll(given, nullptr, 10);
}

/// Spreads its argument over all numbers.
std::uint64_t Mixed(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31U);
}

double Between(double low, double high, std::int64_t candidate, std::uint64_t which) {
  const std::uint64_t bits = Mixed(static_cast<std::uint64_t>(candidate) * 8 + which);
  return low + (high - low) * static_cast<double>(bits >> 11U) * 0x1p-53;
}

/// A folder of its own on the disk of the build, not in memory.
fs::path Folder() {
  static const fs::path folder =
      fs::path(KOMPONO_BINARY_DIR) / "bench" / fmt::format("catalog-{}", ::getpid());
  fs::create_directories(folder);
  return folder;
}

/// What a study hands in: few formulas, many sizes, three metrics.
std::vector<EvaluationRecord> Chunk(const IndexRange& range) {
  std::vector<EvaluationRecord> records;
  records.reserve(static_cast<std::size_t>(range.size()));
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    EvaluationRecord record{.candidate = i, .stage = "work zone"};
    record.metrics = {
        {.name = "volume", .value = Between(1e6, 9e6, i, 0), .unit = "mm3", .method = "grid"},
        {.name = "stiffness", .value = Between(5, 90, i, 1), .unit = "N/um", .method = "grid"},
        {.name = "moving_mass", .value = Between(20, 400, i, 2), .unit = "kg", .method = "sum"}};
    record.layout = LayoutRecord{
        .name = fmt::format("sheet/{}", i),
        .formula = fmt::format("part X{} Y O (XYZABC):struts tool", 2 + i % 400),
        .coordinates = 6,
        .drives = static_cast<int>(3 + i % 4),
        .blocks = {{.name = "struts", .module = "hexapod", .plugin = "org.kompono.hexapod"}},
        .parameters = {
            {.name = "struts.base_radius", .value = Between(300, 900, i, 3), .unit = "mm"},
            {.name = "struts.platform_radius", .value = Between(90, 200, i, 4), .unit = "mm"}}};
    records.push_back(std::move(record));
  }
  return records;
}

void Require(bool good, const kompono::Diagnostics& complaints) {
  if (good) return;
  fmt::print(stderr, "{}", RenderAll(complaints, {}));
  std::exit(1);
}

Store Opened(const fs::path& file, OpenMode mode) {
  auto store = Store::Open(file, {.mode = mode});
  Require(store.has_value(), store ? kompono::Diagnostics{} : store.error());
  return *std::move(store);
}

void Remove(const fs::path& file) {
  for (const char* suffix : {"", "-wal", "-shm"}) fs::remove(file.string() + suffix);
}

/// Only the writing is timed, not the making of the records.
void Fill(benchmark::State& state, const fs::path& file, std::int64_t layouts) {
  double seconds = 0.0;
  double cpu = 0.0;
  const auto timed = [&seconds, &cpu](const auto& work) {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t cpu_begin = std::clock();
    work();
    cpu += static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  Store store = Opened(file, OpenMode::kCreate);
  const auto study = store.BeginStudy({.name = "sheet", .toml = "bench", .candidates = layouts});
  Require(study.has_value(), study ? kompono::Diagnostics{} : study.error());
  timed([&] { Require(store.BeginBulk().empty(), {}); });
  for (std::int64_t i = 0; i < layouts; i += kChunk) {
    const IndexRange range{.begin = i, .end = std::min(i + kChunk, layouts)};
    const std::vector<EvaluationRecord> records = Chunk(range);
    timed([&] {
      const auto appended = store.AppendChunk(*study, range, records);
      Require(appended.has_value(), appended ? kompono::Diagnostics{} : appended.error());
    });
  }
  const double rows = seconds;
  timed([&] { Require(store.EndBulk().empty(), {}); });
  state.SetIterationTime(seconds);
  state.counters["cpu_s"] = cpu;
  state.counters["rows_s"] = rows;
  state.counters["indexes_s"] = seconds - rows;
}

const fs::path& Filled() {
  static const fs::path file = Folder() / "million.db";
  return file;
}

void InsertBaseline(benchmark::State& state) {
  const std::int64_t layouts = Layouts();
  const fs::path file = Folder() / "plain.db";
  for (auto _ : state) {
    Remove(file);
    SQLite::Database db(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    db.exec("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL");
    db.exec("CREATE TABLE number(layout INTEGER, what INTEGER, value REAL)");
    SQLite::Statement row(db, "INSERT INTO number VALUES(?, ?, ?)");
    constexpr int kRowsOfALayout =
        9;  // layout, text, block, evaluation, two parameters, three metrics
    for (std::int64_t i = 0; i < layouts; i += kChunk) {
      SQLite::Transaction transaction(db);
      for (std::int64_t k = i; k < std::min(i + kChunk, layouts); ++k) {
        for (int n = 0; n < kRowsOfALayout; ++n) {
          row.bind(1, k);
          row.bind(2, n);
          row.bind(3, 0.5 * n);
          row.exec();
          row.reset();
        }
      }
      transaction.commit();
    }
  }
  Remove(file);
  state.SetItemsProcessed(state.iterations() * layouts);
}

void InsertStudy(benchmark::State& state) {
  const std::int64_t layouts = Layouts();
  for (auto _ : state) {
    Remove(Filled());
    Fill(state, Filled(), layouts);
  }
  state.SetItemsProcessed(state.iterations() * layouts);
}

void Open(benchmark::State& state) {
  for (auto _ : state) {
    const Store store = Opened(Filled(), OpenMode::kReadOnly);
    benchmark::DoNotOptimize(store.Notes());
  }
}

/// A new program asks its first question: opening, fences, compiling, answer.
void OpenAndAsk(benchmark::State& state) {
  for (auto _ : state) {
    const Store store = Opened(Filled(), OpenMode::kReadOnly);
    benchmark::DoNotOptimize(store.Query({.where = "id = 4711", .limit = 1}));
  }
}

void Ask(benchmark::State& state, const QueryRequest& request) {
  const Store store = Opened(Filled(), OpenMode::kReadOnly);
  for (auto _ : state) {
    const auto table = store.Query(request);
    Require(table.has_value(), table ? kompono::Diagnostics{} : table.error());
    state.counters["rows"] = static_cast<double>(table->rows.size());
  }
}

BENCHMARK(InsertBaseline)
    ->Name("insert/baseline")
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->UseRealTime();
BENCHMARK(InsertStudy)
    ->Name("insert/study")
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->UseManualTime();
BENCHMARK(Open)->Name("open/baseline")->Unit(benchmark::kMillisecond);
BENCHMARK(OpenAndAsk)->Name("open/and_ask")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ask, by_id, QueryRequest{.where = "id = 4711", .limit = 20})
    ->Name("query/baseline")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ask,
                  by_metrics,
                  QueryRequest{.where = "metric.stiffness > 40 and metric.moving_mass < 150 and "
                                        "metric.volume > 4e6",
                               .columns = "name, formula, drives, metric.stiffness",
                               .sort = "metric.stiffness desc",
                               .limit = 20})
    ->Name("query/three_metrics_top_20")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ask,
                  by_mixed,
                  QueryRequest{
                      .where = "metric.moving_mass < 60 and drives <= 4 and base = 'closed'",
                      .columns = "name, formula, drives, metric.moving_mass",
                      .sort = "metric.moving_mass",
                      .limit = 20})
    ->Name("query/metric_drives_base_top_20")
    ->Unit(benchmark::kMillisecond);

}  // namespace
