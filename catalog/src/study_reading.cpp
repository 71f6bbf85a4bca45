// SPDX-License-Identifier: Apache-2.0
#include "study_reading.hpp"

#include <algorithm>

namespace kompono::catalog {
namespace {

EvaluationStatus StatusOf(std::string_view word) {
  if (word == Word(EvaluationStatus::kOk)) return EvaluationStatus::kOk;
  return word == Word(EvaluationStatus::kRejected) ? EvaluationStatus::kRejected
                                                   : EvaluationStatus::kFailed;
}

void CountEvaluations(SQLite::Database& db, StudySummary& summary) {
  SQLite::Statement row(db,
                        "SELECT v.status, sum(e.n) FROM (SELECT verdict_id, count(*) AS n FROM "
                        "evaluation WHERE study_id = ? GROUP BY verdict_id) AS e "
                        "JOIN verdict AS v ON v.id = e.verdict_id GROUP BY v.status");
  row.bind(1, summary.id);
  while (row.executeStep()) {
    const std::int64_t count = row.getColumn(1).getInt64();
    switch (StatusOf(row.getColumn(0).getString())) {
      case EvaluationStatus::kOk:
        summary.ok = count;
        break;
      case EvaluationStatus::kRejected:
        summary.rejected = count;
        break;
      case EvaluationStatus::kFailed:
        summary.failed = count;
        break;
    }
  }
}

}  // namespace

std::vector<IndexRange> DoneRanges(SQLite::Database& db,
                                   std::int64_t study,
                                   const IndexRange& whole) {
  // The last range that begins before `whole` may reach into it.
  SQLite::Statement row(
      db,
      "SELECT begin, past FROM run_range WHERE study_id = ?1 AND begin < ?3 AND begin >= coalesce("
      "(SELECT max(begin) FROM run_range WHERE study_id = ?1 AND begin <= ?2), 0) ORDER BY begin");
  row.bind(1, study);
  row.bind(2, whole.begin);
  row.bind(3, whole.end);
  std::vector<IndexRange> done;
  while (row.executeStep()) {
    const IndexRange part{.begin = std::max(row.getColumn(0).getInt64(), whole.begin),
                          .end = std::min(row.getColumn(1).getInt64(), whole.end)};
    if (part.begin >= part.end) continue;
    if (!done.empty() && done.back().end >= part.begin) {
      done.back().end = std::max(done.back().end, part.end);
    } else {
      done.push_back(part);
    }
  }
  return done;
}

std::vector<IndexRange> MissingRanges(SQLite::Database& db,
                                      std::int64_t study,
                                      const IndexRange& whole) {
  std::vector<IndexRange> missing;
  std::int64_t next = whole.begin;
  for (const IndexRange& done : DoneRanges(db, study, whole)) {
    if (next < done.begin) missing.push_back({.begin = next, .end = done.begin});
    next = done.end;
  }
  if (next < whole.end) missing.push_back({.begin = next, .end = whole.end});
  return missing;
}

std::vector<StudySummary> ReadStudies(SQLite::Database& db) {
  std::vector<StudySummary> studies;
  SQLite::Statement row(db, "SELECT id, name, content_hash, candidates FROM study ORDER BY id");
  while (row.executeStep()) {
    StudySummary& summary = studies.emplace_back();
    summary.id = row.getColumn(0).getInt64();
    summary.name = row.getColumn(1).getString();
    summary.hash = Hex(DigestAt(row, 2));
    summary.candidates = row.getColumn(3).getInt64();
    summary.done_ranges = DoneRanges(db, summary.id, {.begin = 0, .end = summary.candidates});
    for (const IndexRange& range : summary.done_ranges) summary.done += range.size();
    CountEvaluations(db, summary);
  }
  return studies;
}

StudyRecord ReadStudy(SQLite::Database& db, std::int64_t study) {
  SQLite::Statement row(
      db, "SELECT name, candidates, toml, content, provenance_id FROM study WHERE id = ?");
  row.bind(1, study);
  StudyRecord record;
  if (!row.executeStep()) return record;
  record.name = row.getColumn(0).getString();
  record.candidates = row.getColumn(1).getInt64();
  record.toml = row.getColumn(2).getString();
  record.content = row.getColumn(3).getString();
  record.provenance = ReadProvenance(db, row.getColumn(4).getInt64());
  SQLite::Statement rule(db,
                         "SELECT first, second, kind, reason, author, active FROM study_rule "
                         "WHERE study_id = ? ORDER BY position");
  rule.bind(1, study);
  while (rule.executeStep()) {
    record.rules.push_back({.first = rule.getColumn(0).getString(),
                            .second = rule.getColumn(1).getString(),
                            .kind = rule.getColumn(2).getString(),
                            .reason = rule.getColumn(3).getString(),
                            .author = rule.getColumn(4).getString(),
                            .active = rule.getColumn(5).getInt() != 0});
  }
  return record;
}

std::optional<std::int64_t> CandidatesOf(SQLite::Database& db, std::int64_t study) {
  SQLite::Statement row(db, "SELECT candidates FROM study WHERE id = ?");
  row.bind(1, study);
  if (!row.executeStep()) return std::nullopt;
  return row.getColumn(0).getInt64();
}

std::vector<RangeOfRun> ReadRuns(SQLite::Database& db, std::int64_t study) {
  SQLite::Statement row(db,
                        "SELECT g.begin, g.past, r.provenance_id, r.started_at FROM run_range AS g "
                        "JOIN run AS r ON r.id = g.run_id WHERE g.study_id = ? ORDER BY g.begin");
  row.bind(1, study);
  std::vector<RangeOfRun> runs;
  while (row.executeStep()) {
    runs.push_back(
        {.range = {.begin = row.getColumn(0).getInt64(), .end = row.getColumn(1).getInt64()},
         .provenance = row.getColumn(2).getInt64(),
         .started_at = row.getColumn(3).getString()});
  }
  return runs;
}

EvaluationReader::EvaluationReader(SQLite::Database& db, Layouts layouts)
    : layouts_(layouts),
      evaluation_(
          db,
          "SELECT e.candidate, v.status, v.stage, v.reason, f.text, e.layout_id "
          "FROM evaluation AS e JOIN verdict AS v ON v.id = e.verdict_id "
          "LEFT JOIN formula AS f ON f.id = e.formula_id "
          "WHERE e.study_id = ? AND e.candidate >= ? AND e.candidate < ? ORDER BY e.candidate"),
      own_metrics_(db,
                   "SELECT m.name, r.value, m.unit, m.method, r.failure FROM evaluation_metric AS "
                   "r JOIN measure AS m ON m.id = r.measure_id "
                   "WHERE r.study_id = ? AND r.candidate = ? ORDER BY m.name, m.unit, m.method"),
      layout_metrics_(db,
                      "SELECT m.name, r.value, m.unit, m.method, r.failure FROM metric AS r "
                      "JOIN measure AS m ON m.id = r.measure_id "
                      "WHERE r.layout_id = ? ORDER BY m.name, m.unit, m.method"),
      layout_(db) {}

void EvaluationReader::Start(std::int64_t study, const IndexRange& range) {
  study_ = study;
  evaluation_.reset();
  evaluation_.bind(1, study);
  evaluation_.bind(2, range.begin);
  evaluation_.bind(3, range.end);
}

bool EvaluationReader::Next(EvaluationRecord& record) {
  if (!evaluation_.executeStep()) return false;
  record.candidate = evaluation_.getColumn(0).getInt64();
  record.status = StatusOf(evaluation_.getColumn(1).getString());
  record.stage = evaluation_.getColumn(2).getString();
  record.reason = evaluation_.getColumn(3).getString();
  record.formula = evaluation_.getColumn(4).getString();
  record.metrics.clear();
  record.layout.reset();
  layout_id_ = evaluation_.getColumn(5).getInt64();
  if (layout_id_ == 0) {
    own_metrics_.reset();
    own_metrics_.bind(1, study_);
    own_metrics_.bind(2, record.candidate);
    ReadMetrics(own_metrics_, record);
    return true;
  }
  layout_metrics_.reset();
  layout_metrics_.bind(1, layout_id_);
  ReadMetrics(layout_metrics_, record);
  if (layouts_ == Layouts::kNone) return true;
  record.layout = layouts_ == Layouts::kWhole ? layout_.Read(layout_id_).record
                                              : layout_.ReadStructure(layout_id_).record;
  record.layout->metrics.clear();
  return true;
}

void EvaluationReader::ReadMetrics(SQLite::Statement& row, EvaluationRecord& record) {
  while (row.executeStep()) record.metrics.push_back(MetricAt(row));
}

}  // namespace kompono::catalog
