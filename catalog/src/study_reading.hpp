// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_STUDY_READING_HPP_
#define KOMPONO_CATALOG_SRC_STUDY_READING_HPP_

#include "reading.hpp"
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "kompono/catalog/study.hpp"

namespace kompono::catalog {

/// The ranges done of a study within `whole`, joined.
[[nodiscard]] std::vector<IndexRange> DoneRanges(SQLite::Database& db,
                                                 std::int64_t study,
                                                 const IndexRange& whole);
[[nodiscard]] std::vector<IndexRange> MissingRanges(SQLite::Database& db,
                                                    std::int64_t study,
                                                    const IndexRange& whole);

[[nodiscard]] std::vector<StudySummary> ReadStudies(SQLite::Database& db);
[[nodiscard]] StudyRecord ReadStudy(SQLite::Database& db, std::int64_t study);

/// The size of a study's space; nothing if there is no such study.
[[nodiscard]] std::optional<std::int64_t> CandidatesOf(SQLite::Database& db, std::int64_t study);

/// The ranges of a study with who did them, ascending.
struct RangeOfRun {
  IndexRange range;
  std::int64_t provenance = 0;
  std::string started_at;
};
[[nodiscard]] std::vector<RangeOfRun> ReadRuns(SQLite::Database& db, std::int64_t study);

/// Evaluations of a study one after the other, with statements that are kept.
class EvaluationReader {
 public:
  enum class Layouts { kNone, kStructure, kWhole };
  EvaluationReader(SQLite::Database& db, Layouts layouts);

  void Start(std::int64_t study, const IndexRange& range);
  /// False at the end.
  bool Next(EvaluationRecord& record);
  /// Of the evaluation read last; 0 without layout.
  [[nodiscard]] std::int64_t LayoutId() const { return layout_id_; }

 private:
  void ReadMetrics(SQLite::Statement& row, EvaluationRecord& record);

  Layouts layouts_;
  std::int64_t study_ = 0;
  std::int64_t layout_id_ = 0;
  SQLite::Statement evaluation_;
  SQLite::Statement own_metrics_;
  SQLite::Statement layout_metrics_;
  LayoutReader layout_;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_STUDY_READING_HPP_
