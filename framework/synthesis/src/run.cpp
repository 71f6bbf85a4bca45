// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/run.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <memory>

#include "kompono/diagnostics/expects.hpp"

namespace kompono::synthesis {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kProgressSeconds = 0.1;

struct Chunk {
  IndexRange range;
  std::vector<Evaluation> rows;
};

/// Cuts ranges at multiples of the chunk's size.
class Chunks {
 public:
  Chunks(std::span<const IndexRange> todo, std::uint64_t size) : todo_(todo), size_(size) {
    if (!todo_.empty()) at_ = todo_.front().begin;
  }
  std::optional<IndexRange> Next() {
    while (range_ < todo_.size() && at_ >= todo_[range_].end) {
      if (++range_ < todo_.size()) at_ = todo_[range_].begin;
    }
    if (range_ >= todo_.size()) return std::nullopt;
    const IndexRange out{at_, std::min(todo_[range_].end, (at_ / size_ + 1) * size_)};
    at_ = out.end;
    return out;
  }

 private:
  std::span<const IndexRange> todo_;
  std::uint64_t size_;
  std::size_t range_ = 0;
  std::uint64_t at_ = 0;
};

class Runner {
 public:
  Runner(const Evaluator& evaluator,
         const Enumeration& all,
         std::span<const IndexRange> todo,
         const RunOptions& options,
         const Sink& sink)
      : evaluator_(evaluator),
        all_(all),
        options_(options),
        sink_(sink),
        chunks_(todo, std::max<std::uint64_t>(1, options.chunk)) {
    for (const IndexRange& range : todo) report_.progress.all += range.size();
  }

  RunReport Run() {
    const unsigned threads = options_.threads != 0
                                 ? options_.threads
                                 : static_cast<unsigned>(tbb::info::default_concurrency());
    const tbb::global_control most(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(static_cast<int>(threads));
    arena.execute([&] { Pipeline(threads); });
    return std::move(report_);
  }

 private:
  using ChunkPtr = std::shared_ptr<Chunk>;

  void Pipeline(unsigned threads) {
    const auto cut = tbb::make_filter<void, ChunkPtr>(
        tbb::filter_mode::serial_in_order,
        [this](tbb::flow_control& control) { return Begin(control); });
    const auto evaluate = tbb::make_filter<ChunkPtr, ChunkPtr>(
        tbb::filter_mode::parallel, [this](ChunkPtr chunk) { return Fill(std::move(chunk)); });
    const auto hand_on = tbb::make_filter<ChunkPtr, void>(
        tbb::filter_mode::serial_in_order, [this](const ChunkPtr& chunk) { HandOn(*chunk); });
    tbb::parallel_pipeline(2 * static_cast<std::size_t>(threads), cut & evaluate & hand_on);
  }

  ChunkPtr Begin(tbb::flow_control& control) {
    const bool stopped = options_.stop != nullptr && options_.stop->load();
    const std::optional<IndexRange> range = stopped || failed_ ? std::nullopt : chunks_.Next();
    report_.stopped = report_.stopped || stopped;
    if (!range) {
      control.stop();
      return nullptr;
    }
    auto chunk = std::make_shared<Chunk>();
    chunk->range = *range;
    return chunk;
  }

  [[nodiscard]] ChunkPtr Fill(ChunkPtr chunk) const {
    chunk->rows.reserve(chunk->range.size());
    all_.Visit(chunk->range.begin,
               chunk->range.end,
               [&](synthesis::Count index, const Selection& selection) {
                 chunk->rows.push_back(evaluator_.Evaluate(
                     evaluator_.space().At(selection, static_cast<std::uint64_t>(index))));
                 return true;
               });
    return chunk;
  }

  void HandOn(const Chunk& chunk) {
    if (failed_) return;
    Diagnostics problems = sink_(chunk.range, chunk.rows);
    if (HasErrors(problems)) {
      failed_ = true;
      report_.problems = std::move(problems);
      return;
    }
    for (const Evaluation& row : chunk.rows) Tally(row, report_.funnel);
    Progress& progress = report_.progress;
    progress.done += chunk.range.size();
    progress.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const bool due = progress.seconds - told_ >= kProgressSeconds;
    if (!options_.progress || !due) return;
    told_ = progress.seconds;
    options_.progress(progress);
  }

  const Evaluator& evaluator_;
  const Enumeration& all_;
  const RunOptions& options_;
  const Sink& sink_;
  Chunks chunks_;
  Clock::time_point start_ = Clock::now();
  double told_ = 0.0;
  std::atomic<bool> failed_{false};
  RunReport report_;
};

std::vector<MetricId> ObjectiveMetrics(const Study& study) {
  std::vector<MetricId> out;
  for (const Objective& objective : study.objectives) {
    const MetricDescription* metric = FindMetric(objective.metric);
    KOMPONO_EXPECTS(metric != nullptr);
    out.push_back(metric->id);
  }
  return out;
}

std::vector<Direction> ObjectiveDirections(const Study& study) {
  std::vector<Direction> out;
  for (const Objective& objective : study.objectives)
    out.push_back(objective.maximise ? Direction::kMaximise : Direction::kMinimise);
  return out;
}

}  // namespace

IndexRange ShardRange(std::uint64_t count, std::uint64_t number, std::uint64_t parts) {
  KOMPONO_EXPECTS(number >= 1 && number <= parts);
  const auto border = [count, parts](std::uint64_t k) {
    return static_cast<std::uint64_t>(synthesis::Count{count} * k / parts);
  };
  return {border(number - 1), border(number)};
}

tl::expected<Shard, Diagnostic> ParseShard(std::string_view text) {
  Shard out;
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto read = [](std::string_view digits, std::uint64_t& number) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  const bool good = slash < text.size() && read(text.substr(0, slash), out.number) &&
                    read(text.substr(slash + 1), out.parts) && out.number >= 1 &&
                    out.number <= out.parts;
  if (good) return out;
  return tl::unexpected(Diagnostic{
      .code = "E0845",
      .message = fmt::format("'{}' is no shard", text),
      .help = "write k/N with k from 1 to N: --shard 3/16 is the third of sixteen parts"});
}

RunReport Run(const Evaluator& evaluator,
              const Enumeration& all,
              std::span<const IndexRange> todo,
              const RunOptions& options,
              const Sink& sink) {
  return Runner(evaluator, all, todo, options, sink).Run();
}

StudyFront::StudyFront(const Study& study)
    : metrics_(ObjectiveMetrics(study)), front_(ObjectiveDirections(study)) {}

std::optional<std::vector<double>> StudyFront::ValuesOf(const Evaluation& row) const {
  if (row.status != EvaluationStatus::kOk) return std::nullopt;
  std::vector<double> out;
  for (const MetricId id : metrics_) {
    if (!row.metrics.Has(id)) return std::nullopt;
    out.push_back(row.metrics[id]);
  }
  return out;
}

bool StudyFront::Insert(const Evaluation& row) {
  const std::optional<std::vector<double>> values = ValuesOf(row);
  return values && front_.Insert(row.index, *values);
}

}  // namespace kompono::synthesis
