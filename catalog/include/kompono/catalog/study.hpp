// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_STUDY_HPP_
#define KOMPONO_CATALOG_STUDY_HPP_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kompono/catalog/record.hpp"
#include "kompono/diagnostics/diagnostic.hpp"

/// What a synthesis run writes: a study, and for each candidate of its space one evaluation.
///
///     Parsed<std::int64_t> study = store.BeginStudy({.name = "sheet", .toml = text,
///                                                    .candidates = space.Count()});
///     Parsed<std::vector<IndexRange>> todo = store.MissingRanges(*study, shard);
///     for (const IndexRange& chunk : Pieces(*todo, 4096)) {
///       store.AppendChunk(*study, chunk, Evaluate(chunk));  // one transaction
///     }
///
/// A chunk is in the catalog completely or not at all, whatever happens to the program or the
/// machine; what is missing is found by `MissingRanges`. Several programs may write shards into one
/// file, or each into a file of its own, merged later.
namespace kompono::catalog {

/// Candidates `begin` .. `end` - 1 of a study.
struct IndexRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;
  bool operator==(const IndexRange&) const = default;
  [[nodiscard]] std::int64_t size() const { return end - begin; }
};

/// A pair of alternatives that the study forbids, or one alone.
struct StudyRule {
  std::string first;   ///< tag: "module:lambda"
  std::string second;  ///< tag: "base:closed"; empty: the first is forbidden altogether
  std::string kind;    ///< "logical", "empirical" or "normative"
  std::string reason;
  std::string author;
  bool active = true;  ///< false: switched off in this study
};

/// Two records are the same study if `name`, `candidates` and `content` are equal.
struct StudyRecord {
  std::string name;
  std::string toml;             ///< the study file's text
  std::string content;          ///< its meaning without comments and spacing; empty: `toml`
  std::int64_t candidates = 0;  ///< size of the space
  std::vector<StudyRule> rules;
  Provenance provenance;
};

enum class EvaluationStatus { kOk, kRejected, kFailed };

/// "ok", "rejected", "failed"
[[nodiscard]] const char* Word(EvaluationStatus status);

/// What became of one candidate.
struct EvaluationRecord {
  std::int64_t candidate = 0;  ///< index in the study's space
  EvaluationStatus status = EvaluationStatus::kOk;
  std::string stage;            ///< the last stage that looked at it: "mobility"
  std::string reason;           ///< why it is not ok; empty if it is. Few different texts are best:
                                ///< numbers belong into `metrics`
  std::string formula;          ///< canonical text; may be empty if `layout` is given
  std::vector<Metric> metrics;  ///< all that is known, whatever the status
  /// The sized layout, most often of those that are ok: what `query`, `show` and `similar` find.
  /// Its own `metrics` stay empty, those above count. Leave `toml` empty where the text can be made
  /// again from study and index, and fill in `name` (unique: "sheet/4711"), `formula`, `blocks` and
  /// the sized `parameters`. Its provenance is the run's.
  std::optional<LayoutRecord> layout;
};

/// E0540: everything that makes the study or a chunk unfit. A chunk has exactly one record for each
/// candidate of its range, in ascending order: a failed evaluation is a record with its reason,
/// never a hole.
[[nodiscard]] Diagnostics Check(const StudyRecord& study);
[[nodiscard]] Diagnostics Check(const IndexRange& range, std::span<const EvaluationRecord> records);

/// 64 hex digits.
[[nodiscard]] std::string StudyHash(const StudyRecord& study);

struct AppendResult {
  std::int64_t written = 0;
  std::int64_t skipped = 0;  ///< candidates done before: what stands in the catalog stays
};

struct StudySummary {
  std::int64_t id = 0;
  std::string name;
  std::string hash;
  std::int64_t candidates = 0;
  std::int64_t done = 0;
  std::int64_t ok = 0;
  std::int64_t rejected = 0;
  std::int64_t failed = 0;
  std::vector<IndexRange> done_ranges;  ///< ascending, disjoint, not adjacent
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_STUDY_HPP_
