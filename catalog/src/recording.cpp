// SPDX-License-Identifier: Apache-2.0
// What changes a catalog: layouts, chunks of a study, other catalogs.
#include "store_impl.hpp"
#include "study_reading.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace kompono::catalog {
namespace {

/// Layouts or candidates that are read from another catalog and written in one transaction.
constexpr std::int64_t kMergedAtOnce = 20'000;

/// From so many new layouts on, indexes are quicker made at the end.
constexpr std::int64_t kBulk = 50'000;

std::int64_t LayoutsIn(SQLite::Database& db) {
  return db.execAndGet("SELECT count(*) FROM layout").getInt64();
}

}  // namespace

Parsed<std::vector<AddResult>> Store::Impl::AddAll(std::span<const LayoutRecord> records,
                                                   std::size_t chunk) {
  Diagnostics unfit;
  for (const LayoutRecord& record : records) {
    Diagnostics found = Check(record);
    std::move(found.begin(), found.end(), std::back_inserter(unfit));
  }
  if (!unfit.empty()) return tl::make_unexpected(std::move(unfit));

  std::vector<AddResult> results;
  results.reserve(records.size());
  const std::size_t step = chunk == 0 ? std::max<std::size_t>(1, records.size()) : chunk;
  for (std::size_t begin = 0; begin < records.size(); begin += step) {
    auto outcome = Writing([&]() -> Parsed<std::size_t> {
      for (const LayoutRecord& record :
           records.subspan(begin, std::min(step, records.size() - begin))) {
        results.push_back(writer->Add(record));
      }
      return results.size();
    });
    if (outcome) continue;
    for (Diagnostic& diagnostic : outcome.error()) {
      diagnostic.message += fmt::format("; {} of {} layouts are stored", begin, records.size());
    }
    return tl::make_unexpected(std::move(outcome.error()));
  }
  return results;
}

Parsed<AppendResult> Store::Impl::Append(std::int64_t study,
                                         const IndexRange& range,
                                         std::span<const EvaluationRecord> records,
                                         const RunOrigin* origin) {
  if (Diagnostics unfit = Check(range, records); !unfit.empty())
    return tl::make_unexpected(std::move(unfit));
  return Writing([&]() -> Parsed<AppendResult> {
    const std::optional<std::int64_t> candidates = CandidatesOf(*db, study);
    if (!candidates) return Refuse("E0541", Name(), fmt::format("there is no study {}", study));
    if (range.end > *candidates) {
      return Refuse("E0542",
                    Name(),
                    fmt::format("candidates {} .. {} are not in the study: it has {}",
                                range.begin,
                                range.end - 1,
                                *candidates));
    }
    return studies->Append(study, range, records, origin);
  });
}

Parsed<bool> Store::Impl::MergeLayouts(SQLite::Database& other, MergeResult& result) {
  // Those that only a study made come with their evaluations.
  SQLite::Statement own(
      other,
      "SELECT l.id FROM layout AS l WHERE EXISTS (SELECT 1 FROM word WHERE rowid = 2 * l.id) "
      "OR NOT EXISTS (SELECT 1 FROM evaluation AS e WHERE e.layout_id = l.id) ORDER BY l.id");
  LayoutReader layouts(other);
  std::vector<LayoutRecord> records;
  bool more = true;
  while (more) {
    records.clear();
    while (std::ssize(records) < kMergedAtOnce && (more = own.executeStep()))
      records.push_back(layouts.Read(own.getColumn(0).getInt64()).record);
    const auto added = AddAll(records, 0);
    if (!added) return tl::make_unexpected(added.error());
    for (const AddResult& one : *added) {
      result.layouts_added += one.status == AddStatus::kAdded ? 1 : 0;
      result.layouts_updated += one.status == AddStatus::kUpdated ? 1 : 0;
      result.layouts_unchanged += one.status == AddStatus::kUnchanged ? 1 : 0;
    }
  }
  return true;
}

Parsed<bool> Store::Impl::MergeStudy(SQLite::Database& other,
                                     std::int64_t study,
                                     MergeResult& result) {
  const StudyRecord record = ReadStudy(other, study);
  if (Diagnostics unfit = Check(record); !unfit.empty())
    return tl::make_unexpected(std::move(unfit));
  const auto begun =
      Writing([&]() -> Parsed<StudyWriter::Begun> { return studies->Begin(record); });
  if (!begun) return tl::make_unexpected(begun.error());
  result.studies_added += begun->added ? 1 : 0;
  EvaluationReader evaluations(other, EvaluationReader::Layouts::kWhole);
  std::vector<EvaluationRecord> records;
  for (const RangeOfRun& run : ReadRuns(other, study)) {
    const RunOrigin origin{.provenance = ReadProvenance(other, run.provenance),
                           .started_at = run.started_at};
    const std::vector<IndexRange> todo = catalog::MissingRanges(*db, begun->id, run.range);
    result.evaluations_skipped += run.range.size();
    for (const IndexRange& part : todo) {
      for (std::int64_t begin = part.begin; begin < part.end; begin += kMergedAtOnce) {
        const IndexRange chunk{.begin = begin, .end = std::min(part.end, begin + kMergedAtOnce)};
        records.clear();
        evaluations.Start(study, chunk);
        for (EvaluationRecord next; evaluations.Next(next);) records.push_back(std::move(next));
        const auto appended = Append(begun->id, chunk, records, &origin);
        if (!appended) return tl::make_unexpected(appended.error());
        result.evaluations_written += appended->written;
        result.evaluations_skipped -= appended->written;
      }
    }
  }
  return true;
}

Parsed<MergeResult> Store::Impl::Merge(SQLite::Database& other) {
  MergeResult result;
  const std::int64_t coming = LayoutsIn(other);
  const bool bulk = coming > kBulk && coming > LayoutsIn(*db) / 4;
  if (bulk) catalog::BeginBulk(*db);
  const std::int64_t before = LayoutsIn(*db);
  Parsed<bool> done = MergeLayouts(other, result);
  SQLite::Statement study(other, "SELECT id FROM study ORDER BY id");
  while (done && study.executeStep())
    done = MergeStudy(other, study.getColumn(0).getInt64(), result);
  if (bulk) catalog::EndBulk(*db);
  if (!done) return tl::make_unexpected(std::move(done.error()));
  result.layouts_added = LayoutsIn(*db) - before;
  return result;
}

}  // namespace kompono::catalog
