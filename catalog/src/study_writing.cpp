// SPDX-License-Identifier: Apache-2.0
#include "study_writing.hpp"

#include "record_parts.hpp"
#include "study_reading.hpp"
#include "words.hpp"
#include <fmt/format.h>

#include <array>

namespace kompono::catalog {

StudyWriter::StudyWriter(SQLite::Database& db, Writer& writer)
    : db_(db),
      writer_(writer),
      verdicts_(db,
                "INSERT INTO verdict(status, stage, reason) VALUES(?1, ?2, ?3) "
                "ON CONFLICT DO NOTHING",
                "SELECT id FROM verdict WHERE status = ?1 AND stage = ?2 AND reason = ?3"),
      study_(db,
             "INSERT INTO study(content_hash, name, candidates, provenance_id, added_at, toml, "
             "content) VALUES(?, ?, ?, ?, ?, ?, ?)"),
      find_study_(db, "SELECT id FROM study WHERE content_hash = ?"),
      rule_(db, "INSERT INTO study_rule VALUES(?, ?, ?, ?, ?, ?, ?, ?)"),
      words_(db,
             fmt::format("INSERT INTO word(rowid, name, formula, parts, text) {} WHERE s.id = ?1",
                         kWordsOfStudies)),
      study_provenance_(db, "SELECT provenance_id FROM study WHERE id = ?"),
      run_(db, "INSERT INTO run(study_id, provenance_id, started_at) VALUES(?, ?, ?)"),
      find_run_(db,
                "SELECT id FROM run WHERE study_id = ? AND provenance_id = ? AND started_at = ?"),
      evaluation_(db, "evaluation", 5),
      metric_(db, "evaluation_metric", 5),
      before_(db,
              "SELECT begin FROM run_range WHERE study_id = ? AND past = ? AND run_id = ? "
              "AND begin = (SELECT max(begin) FROM run_range WHERE study_id = ?1 AND begin < ?2)"),
      after_(db, "SELECT past FROM run_range WHERE study_id = ? AND begin = ? AND run_id = ?"),
      range_(db,
             "INSERT INTO run_range(study_id, begin, past, run_id) VALUES(?1, ?2, ?3, ?4) "
             "ON CONFLICT DO UPDATE SET past = ?3"),
      clear_range_(db, "DELETE FROM run_range WHERE study_id = ? AND begin = ?") {}

StudyWriter::Begun StudyWriter::Begin(const StudyRecord& study) {
  const Sha256 digest = ContentDigest(study);
  const std::int64_t provenance = writer_.ProvenanceOf(study.provenance, study.toml);
  Begun begun;
  if (const auto found = find_study_.Digest(digest).Look()) {
    begun.id = *found;
  } else {
    study_.Digest(digest).Text(study.name).Integer(study.candidates).Integer(provenance);
    study_.Text(writer_.Moment()).Text(study.toml).TextOrNull(study.content).Run();
    begun = {.id = db_.getLastInsertRowid(), .added = true};
    std::int64_t position = 0;
    for (const StudyRule& rule : study.rules) {
      rule_.Integer(begun.id).Integer(position++).Text(rule.first).Text(rule.second);
      rule_.Text(rule.kind).Text(rule.reason).Text(rule.author).Integer(rule.active ? 1 : 0).Run();
    }
    words_.Integer(begun.id).Run();
  }
  runs_.try_emplace(begun.id, Run{.provenance = provenance});
  return begun;
}

AppendResult StudyWriter::Append(std::int64_t study,
                                 const IndexRange& range,
                                 std::span<const EvaluationRecord> records,
                                 const RunOrigin* origin) {
  AppendResult result;
  const std::vector<IndexRange> missing = MissingRanges(db_, study, range);
  result.skipped = range.size();
  if (missing.empty()) return result;
  Run foreign;
  if (origin != nullptr) foreign.provenance = writer_.ProvenanceOf(origin->provenance, "");
  const auto known = runs_.find(study);
  if (origin == nullptr && known == runs_.end())  // begun by another program, continued by this one
    foreign.provenance = study_provenance_.Integer(study).Ask();
  Run& run = origin == nullptr && known != runs_.end() ? known->second : foreign;
  const std::int64_t run_id =
      RunOf(study, run, origin == nullptr ? std::string() : origin->started_at);
  for (const IndexRange& part : missing) {
    const auto first = static_cast<std::size_t>(part.begin - range.begin);
    for (const EvaluationRecord& record :
         records.subspan(first, static_cast<std::size_t>(part.size()))) {
      Write(study, record, run.provenance);
    }
    MarkDone(study, part, run_id);
    result.written += part.size();
  }
  result.skipped -= result.written;
  return result;
}

std::int64_t StudyWriter::RunOf(std::int64_t study, Run& run, const std::string& started_at) {
  if (run.id > 0) return run.id;
  const std::string& moment = started_at.empty() ? writer_.Moment() : started_at;
  const auto found = find_run_.Integer(study).Integer(run.provenance).Text(moment).Look();
  if (found) {
    run.id = *found;
  } else {
    run_.Integer(study).Integer(run.provenance).Text(moment).Run();
    run.id = db_.getLastInsertRowid();
  }
  return run.id;
}

void StudyWriter::Write(std::int64_t study,
                        const EvaluationRecord& record,
                        std::int64_t provenance) {
  if (evaluation_.Rows() == kMostWaiting) Flush();
  const std::array<std::string_view, 3> columns{Word(record.status), record.stage, record.reason};
  evaluation_.Integer(study).Integer(record.candidate).Integer(verdicts_.Find(columns).id);
  if (record.layout) {
    const Writer::OfStudy stored = writer_.AddOfStudy(*record.layout, record.metrics, provenance);
    evaluation_.Integer(stored.formula).Integer(stored.layout);
    return;
  }
  if (record.formula.empty()) {
    evaluation_.Null();
  } else {
    evaluation_.Integer(writer_.FormulaOf(record.formula));
  }
  evaluation_.Null();
  for (const Metric& metric : record.metrics) {
    metric_.Integer(study).Integer(record.candidate).Integer(writer_.MeasureOf(metric));
    metric_.RealOrNull(metric.value).TextOrNull(metric.failure);
  }
}

void StudyWriter::Flush() {
  writer_.Flush();
  evaluation_.Write();
  metric_.Write();
}

/// Joins the range with its neighbours of the same run, so that a run of a million chunks has few.
void StudyWriter::MarkDone(std::int64_t study, const IndexRange& range, std::int64_t run) {
  IndexRange joined = range;
  if (const auto begin = before_.Integer(study).Integer(range.begin).Integer(run).Look())
    joined.begin = *begin;
  if (const auto past = after_.Integer(study).Integer(range.end).Integer(run).Look()) {
    joined.end = *past;
    clear_range_.Integer(study).Integer(range.end).Run();
  }
  range_.Integer(study).Integer(joined.begin).Integer(joined.end).Integer(run).Run();
}

}  // namespace kompono::catalog
