// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_STUDY_WRITING_HPP_
#define KOMPONO_CATALOG_SRC_STUDY_WRITING_HPP_

#include "command.hpp"
#include "waiting_rows.hpp"
#include "writing.hpp"
#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>

#include "kompono/catalog/study.hpp"

namespace kompono::catalog {

/// Who evaluated, and when it began; of a study of another catalog that is merged.
struct RunOrigin {
  Provenance provenance;
  std::string started_at;  ///< empty: now
};

/// Studies and their evaluations; the caller holds the transaction, has called `Writer::Begin` and
/// checked the records. Worthless after a rollback, as its Writer.
class StudyWriter {
 public:
  StudyWriter(SQLite::Database& db, Writer& writer);

  struct Begun {
    std::int64_t id = 0;
    bool added = false;
  };
  Begun Begin(const StudyRecord& study);

  /// By the program that called `Begin` unless `origin` says who.
  AppendResult Append(std::int64_t study,
                      const IndexRange& range,
                      std::span<const EvaluationRecord> records,
                      const RunOrigin* origin = nullptr);

  /// Writes what waits, the Writer's first.
  void Flush();

 private:
  static constexpr std::size_t kMostWaiting = 64;

  struct Run {
    std::int64_t id = 0;  ///< 0: not yet written
    std::int64_t provenance = 0;
  };
  void Write(std::int64_t study, const EvaluationRecord& record, std::int64_t provenance);
  void MarkDone(std::int64_t study, const IndexRange& range, std::int64_t run);
  std::int64_t RunOf(std::int64_t study, Run& run, const std::string& started_at);

  SQLite::Database& db_;
  Writer& writer_;
  std::unordered_map<std::int64_t, Run> runs_;  // of studies begun by this program
  Dictionary verdicts_;
  Command study_;
  Command find_study_;
  Command rule_;
  Command words_;
  Command study_provenance_;
  Command run_;
  Command find_run_;
  WaitingRows evaluation_;
  WaitingRows metric_;
  Command before_;
  Command after_;
  Command range_;
  Command clear_range_;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_STUDY_WRITING_HPP_
