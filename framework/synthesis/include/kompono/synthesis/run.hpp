// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_RUN_HPP_
#define KOMPONO_SYNTHESIS_RUN_HPP_

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/synthesis/front.hpp"
#include "kompono/synthesis/progress.hpp"
#include "kompono/synthesis/stage.hpp"

/// Running a study: pieces of the index space on all cores, rows handed on in ascending order.
///
/// A shard is a range of indices, so that N programs on N machines need to know nothing of one
/// another; rows depend on the study and the index only, so that neither N nor the number of
/// threads changes the result. Where rows are kept is the sink's business.
namespace kompono::synthesis {

/// Candidates begin … end - 1.
struct IndexRange {
  std::uint64_t begin = 0, end = 0;
  [[nodiscard]] std::uint64_t size() const { return end - begin; }
  bool operator==(const IndexRange&) const = default;
};

/// Part `number` (from 1) of `parts` of 0 … count - 1: together they are the whole, none overlaps.
[[nodiscard]] IndexRange ShardRange(std::uint64_t count, std::uint64_t number, std::uint64_t parts);

struct Shard {
  std::uint64_t number = 1, parts = 1;
};
/// "3/16". E0845 for what is not k/N with 1 <= k <= N.
[[nodiscard]] tl::expected<Shard, Diagnostic> ParseShard(std::string_view text);

/// Receives one finished chunk at a time, in ascending order within each range, never two at once,
/// but from changing threads. Complaints end the run.
using Sink = std::function<Diagnostics(const IndexRange& range, std::span<const Evaluation> rows)>;

struct RunOptions {
  unsigned threads = 0;      ///< 0: all cores
  std::uint64_t chunk = 16;  ///< candidates handed on together; borders are multiples of it
  const std::atomic<bool>* stop = nullptr;        ///< what is begun is finished and handed on
  std::function<void(const Progress&)> progress;  ///< about ten times a second
};

struct RunReport {
  Progress progress;
  Funnel funnel{};
  bool stopped = false;
  Diagnostics problems;  ///< of the sink
};

/// Evaluates the candidates of `todo` (ascending, disjoint).
RunReport Run(const Evaluator& evaluator,
              const Enumeration& all,
              std::span<const IndexRange> todo,
              const RunOptions& options,
              const Sink& sink);

/// The front of a study's objectives. Rows that are not ok do not count, nor do those that lack the
/// value of an objective.
class StudyFront {
 public:
  /// A study without objectives has no front: at least one, names known to FindMetric.
  explicit StudyFront(const Study& study);
  bool Insert(const Evaluation& row);
  [[nodiscard]] const Front& front() const { return front_; }
  [[nodiscard]] const std::vector<MetricId>& metrics() const { return metrics_; }
  /// The row's objectives; nothing if it is not ok or lacks one.
  [[nodiscard]] std::optional<std::vector<double>> ValuesOf(const Evaluation& row) const;

 private:
  std::vector<MetricId> metrics_;
  Front front_;
};

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_RUN_HPP_
