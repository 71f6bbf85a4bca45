// SPDX-License-Identifier: Apache-2.0
// kompono synthesize STUDY: evaluates the candidates and tells what came of them.
#include "synthesize_run.hpp"

#include "codes.hpp"
#include "synthesizing.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>
#include <set>

#include "kompono/formula/formula.hpp"

namespace kompono::cli {
namespace {

using synthesis::Enumeration;
using synthesis::Evaluation;
using synthesis::Evaluator;
using synthesis::IndexRange;
using synthesis::StudyFront;
using synthesis::StudySpace;

constexpr std::uint64_t kMostVariants = 4096;  ///< of the reference that are evaluated

std::atomic<bool>& Interrupted() {
  static std::atomic<bool> interrupted{false};
  return interrupted;
}

void OnInterrupt(int /*signal*/) {
  Interrupted() = true;
  // A second Ctrl-C ends the program as usual.
  std::signal(SIGINT, SIG_DFL);
}

/// What a selection chooses beside the formula.
std::string ChoicesText(const StudySpace& space, const synthesis::Selection& selection) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const synthesis::Feature& feature = space.space().features()[i];
    const std::string& name = feature.alternatives[selection[i]].name;
    if (feature.name.find('.') == std::string::npos || name == "none") continue;
    words.push_back(fmt::format("{}={}", feature.name, name));
  }
  return Joined(words);
}

/// Everything that a summary is made of.
class Synthesis {
 public:
  Synthesis(const StudySpace& space,
            const synthesis::Fixing& fixed,
            const synthesis::EvaluationSettings& settings)
      : space_(space), all_(space.space(), fixed), fixed_(fixed), evaluator_(space, settings) {
    summary_.study = &space.study();
    summary_.candidates = all_.count();
    if (!space.study().objectives.empty()) {
      front_.emplace(space.study());
      summary_.objectives = front_->metrics();
    }
  }

  [[nodiscard]] const Enumeration& all() const { return all_; }
  [[nodiscard]] const Evaluator& evaluator() const { return evaluator_; }
  [[nodiscard]] SynthesisSummary& summary() { return summary_; }

  /// A row that is known, of this run or an earlier one.
  void Take(const Evaluation& row) {
    ++summary_.known;
    synthesis::Tally(row, summary_.funnel);
    if (row.status == synthesis::EvaluationStatus::kOk) {
      ++summary_.ok;
    } else {
      ++summary_.reasons[{static_cast<std::size_t>(row.stage), row.reason}];
    }
    if (front_) (void)front_->Insert(row);
  }

  void Finish() {
    if (!front_) return;
    const std::vector<synthesis::FrontPoint> extremes = front_->front().Extremes();
    const std::optional<synthesis::FrontPoint> knee = front_->front().Knee();
    summary_.front_size = front_->front().size();
    for (const synthesis::FrontPoint& point : Shown(extremes, knee)) {
      SynthesisRow row = RowOf(point.id);
      row.values = point.values;
      row.knee = knee && knee->id == point.id;
      for (std::size_t i = 0; i < extremes.size(); ++i) {
        if (extremes[i].id == point.id) row.best_in.push_back(i);
      }
      summary_.front.push_back(std::move(row));
    }
    if (!space_.study().reference.empty()) summary_.reference = Reference();
  }

 private:
  /// The front, or what stands for it: a point for each box, the extremes and the knee.
  [[nodiscard]] std::vector<synthesis::FrontPoint> Shown(
      const std::vector<synthesis::FrontPoint>& extremes,
      const std::optional<synthesis::FrontPoint>& knee) const {
    std::vector<synthesis::FrontPoint> all = front_->front().Points();
    if (summary_.epsilon <= 0.0 || all.empty()) return all;
    std::vector<double> sides;
    for (std::size_t k = 0; k < front_->metrics().size(); ++k) {
      const auto [least, most] =
          std::minmax_element(all.begin(), all.end(), [k](const auto& a, const auto& b) {
            return a.values[k] < b.values[k];
          });
      const double extent = most->values[k] - least->values[k];
      sides.push_back(extent > 0.0 ? summary_.epsilon * extent : 1.0);
    }
    std::set<std::uint64_t> kept;
    for (const synthesis::FrontPoint& point : front_->front().Thinned(sides)) kept.insert(point.id);
    for (const synthesis::FrontPoint& point : extremes) kept.insert(point.id);
    if (knee) kept.insert(knee->id);
    std::erase_if(all, [&kept](const auto& point) { return !kept.contains(point.id); });
    return all;
  }

  /// Computed again: rows are the same whenever they are computed.
  [[nodiscard]] SynthesisRow RowOf(std::uint64_t index) const {
    const synthesis::Selection selection = all_.Unrank(index);
    return {.row = evaluator_.Evaluate(space_.At(selection, index)),
            .choices = ChoicesText(space_, selection)};
  }

  [[nodiscard]] ReferenceResult Reference() const {
    const synthesis::Study& study = space_.study();
    ReferenceResult out{.formula = study.reference};
    const Parsed<formula::Formula> formula = formula::ParseFormula(study.reference);
    std::optional<synthesis::Fixing> wanted;
    if (formula) wanted = space_.FixFormula(*formula);
    if (!wanted) {
      out.problem = "no candidate of the space has this formula";
      return out;
    }
    for (const auto& [feature, alternative] : study.reference_fix) {
      const auto choice = space_.ParseChoice(fmt::format("{}={}", feature, alternative));
      if (!choice) {
        out.problem = choice.error().message;
        return out;
      }
      wanted->push_back(*choice);
    }
    Compare(*wanted, out);
    return out;
  }

  void Compare(const synthesis::Fixing& wanted, ReferenceResult& out) const {
    const Enumeration variants(space_.space(), wanted);
    out.variants = static_cast<std::size_t>(variants.count());
    if (variants.count() == 0) {
      out.problem = "the study's rules forbid it";
      return;
    }
    variants.Visit(0,
                   std::min<synthesis::Count>(variants.count(), kMostVariants),
                   [&](synthesis::Count /*index*/, const synthesis::Selection& selection) {
                     const auto index = all_.Rank(selection);
                     if (index) CompareOne(static_cast<std::uint64_t>(*index), out);
                     return true;
                   });
    if (out.domination) out.dominator = RowOf(out.domination->by.id);
  }

  void CompareOne(std::uint64_t index, ReferenceResult& out) const {
    SynthesisRow row = RowOf(index);
    const auto values = front_->ValuesOf(row.row);
    if (!values) return;
    ++out.ok;
    row.values = *values;
    auto domination = front_->front().WhyDominated(*values);
    if (!domination) ++out.on_front;
    const std::size_t dominators = domination ? domination->dominators : 0;
    const bool better = !out.best || (out.domination && dominators < out.domination->dominators);
    if (!better) return;
    out.best = std::move(row);
    out.domination = std::move(domination);
  }

  const StudySpace& space_;
  Enumeration all_;
  synthesis::Fixing fixed_;
  Evaluator evaluator_;
  std::optional<StudyFront> front_;
  SynthesisSummary summary_;
};

Diagnostic TooMany(synthesis::Count count) {
  return {.code = "E0846",
          .message = fmt::format("the space has {} candidates, too many to evaluate",
                                 synthesis::GroupedText(count)),
          .help = "narrow it with --fix feature=alternative or with rules"};
}

/// The ranges still to do, cut to the limit.
std::vector<IndexRange> Cut(std::vector<IndexRange> todo, std::uint64_t limit) {
  if (limit == 0) return todo;
  std::vector<IndexRange> out;
  for (const IndexRange& range : todo) {
    const std::uint64_t size = std::min(limit, range.size());
    if (size == 0) break;
    out.push_back({range.begin, range.begin + size});
    limit -= size;
  }
  return out;
}

/// Runs what is missing of the range; rows go into the store.
Diagnostics RunMissing(Session& session,
                       Synthesis& synthesis,
                       const SynthesizeRunOptions& options,
                       const RowStore& store) {
  SynthesisSummary& summary = synthesis.summary();
  const auto missing = store.missing(summary.range);
  if (!missing) return missing.error();
  summary.done_before = summary.range.size();
  for (const IndexRange& range : *missing) summary.done_before -= range.size();
  const std::vector<IndexRange> todo = Cut(*missing, options.limit);
  std::signal(SIGINT, OnInterrupt);
  summary.report =
      synthesis::Run(synthesis.evaluator(),
                     synthesis.all(),
                     todo,
                     {.threads = options.threads,
                      .stop = &Interrupted(),
                      .progress =
                          [&session](const synthesis::Progress& progress) {
                            session.console.Progress(synthesis::ProgressText(progress));
                          }},
                     store.append);
  session.console.Progress("");
  return summary.report.problems;
}

Parsed<IndexRange> RangeOf(const Synthesis& synthesis, const SynthesizeRunOptions& options) {
  const synthesis::Count count = synthesis.all().count();
  if (count >= synthesis::Count{1} << 62U) return tl::unexpected(Diagnostics{TooMany(count)});
  synthesis::Shard shard;
  if (!options.shard.empty()) {
    const auto parsed = synthesis::ParseShard(options.shard);
    if (!parsed) return tl::unexpected(Diagnostics{parsed.error()});
    shard = *parsed;
  }
  return synthesis::ShardRange(static_cast<std::uint64_t>(count), shard.number, shard.parts);
}

}  // namespace

void AddRunOptions(CLI::App& command, Session& session, SynthesizeRunOptions& options) {
  session.Hint(command
                   .add_option("--catalog",
                               options.catalog,
                               "Keep every row in this catalog; what is in it is not computed "
                               "again")
                   ->type_name("DB"),
               ValueHint::Kind::kFile);
  command
      .add_option(
          "--shard", options.shard, "Only part k of N of the candidates, for many computers")
      ->type_name("k/N");
  command.add_option("--threads", options.threads, "Threads; all cores if not given")
      ->type_name("N");
  command.add_option("--limit", options.limit, "Evaluate at most so many candidates now")
      ->type_name("N");
  command.add_option("--front", options.front, "Show so many layouts of the front")->type_name("N");
  command
      .add_option("--epsilon",
                  options.epsilon,
                  "Thin the front: one layout for each box of this share of its extent")
      ->type_name("SHARE")
      ->check(CLI::Range(0.0, 1.0));
}

RowStore MemoryStore() {
  auto kept = std::make_shared<std::vector<Evaluation>>();
  return {
      .missing =
          [](const IndexRange& whole) {
            return Parsed<std::vector<IndexRange>>(std::vector<IndexRange>{whole});
          },
      .append =
          [kept](const IndexRange& /*range*/, std::span<const Evaluation> rows) {
            kept->insert(kept->end(), rows.begin(), rows.end());
            return Diagnostics{};
          },
      .rows =
          [kept](const IndexRange& /*range*/, const std::function<void(const Evaluation&)>& take) {
            for (const Evaluation& row : *kept) take(row);
            return Diagnostics{};
          }};
}

ExitCode RunSynthesis(Session& session,
                      const StudySpace& space,
                      const synthesis::Fixing& fixed,
                      const SynthesizeRunOptions& options) {
  const auto settings =
      synthesis::ReadEvaluationSettings(space.study().text, space.study().file.string());
  if (!settings) return session.Refuse(settings.error());
  Synthesis synthesis(space, fixed, *settings);
  const Parsed<IndexRange> range = RangeOf(synthesis, options);
  if (!range) return session.Refuse(range.error());
  synthesis.summary().range = *range;
  Diagnostics notes;
  const Parsed<RowStore> store =
      options.catalog.empty() ? MemoryStore()
                              : CatalogStore(options.catalog, space, synthesis.all(), fixed, notes);
  if (!store) return session.Refuse(store.error());
  session.console.Report(notes);
  const Diagnostics problems = RunMissing(session, synthesis, options, *store);
  if (HasErrors(problems)) return session.Refuse(problems);
  const Diagnostics unread =
      store->rows(*range, [&synthesis](const Evaluation& row) { synthesis.Take(row); });
  if (HasErrors(unread)) return session.Refuse(unread);
  synthesis.summary().epsilon = options.epsilon;
  synthesis.Finish();
  const SynthesisSummary& summary = synthesis.summary();
  if (session.json) {
    session.console.Json(SynthesisJson(summary));
  } else {
    session.console.Out(SynthesisText(session.console, summary, options.front));
  }
  return summary.ok == 0 || summary.report.stopped ? ExitCode::kNegative : ExitCode::kOk;
}

}  // namespace kompono::cli
