// SPDX-License-Identifier: Apache-2.0
#include "synthesizing.hpp"

#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace kompono::cli {
namespace {

using synthesis::DescriptionOf;
using synthesis::GroupedText;
using synthesis::MetricDescription;
using synthesis::MetricId;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostReasons = 12;

/// Four digits, as many as a comparison needs.
std::string Digits(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string UnitText(const MetricDescription& metric) {
  return metric.unit == "1" ? "" : fmt::format(" {}", metric.unit);
}

std::string Marks(const SynthesisSummary& summary, const SynthesisRow& row) {
  std::vector<std::string> words;
  if (row.knee) words.emplace_back("knee");
  for (const std::size_t i : row.best_in) {
    words.push_back(fmt::format("{} {}",
                                summary.study->objectives[i].maximise ? "most" : "least",
                                DescriptionOf(summary.objectives[i]).name));
  }
  return Joined(words);
}

std::string StageText(const SynthesisSummary& summary) {
  TextTable table({{"stage"}, {"entered", true}, {"rejected", true}, {"failed", true}});
  for (const synthesis::StageDescription& stage : synthesis::Stages()) {
    const synthesis::StageCounts& counts = summary.funnel[static_cast<std::size_t>(stage.stage)];
    table.Row({std::string(stage.name),
               GroupedText(counts.entered),
               GroupedText(counts.rejected),
               GroupedText(counts.failed)});
  }
  std::string out = table.Render();
  out += fmt::format("  {} of {} are ok\n", GroupedText(summary.ok), GroupedText(summary.known));
  std::vector<std::pair<std::uint64_t, std::string>> reasons;
  for (const auto& [key, count] : summary.reasons)
    reasons.emplace_back(count,
                         fmt::format("{}: {}", synthesis::Stages()[key.first].name, key.second));
  std::stable_sort(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) {
    return a.first > b.first;
  });
  for (std::size_t i = 0; i < std::min(kMostReasons, reasons.size()); ++i)
    out += fmt::format("  {:>10}  {}\n", GroupedText(reasons[i].first), reasons[i].second);
  return out;
}

std::string FrontText(const Console& console,
                      const SynthesisSummary& summary,
                      std::size_t most_rows) {
  if (summary.objectives.empty()) return "\nno front: the study names no objectives\n";
  if (summary.front.empty()) return console.Paint("\nno layout is left for a front\n", Hue::kRed);
  std::vector<TextTable::Column> columns{{"index", true}};
  for (std::size_t i = 0; i < summary.objectives.size(); ++i) {
    const MetricDescription& metric = DescriptionOf(summary.objectives[i]);
    columns.push_back({fmt::format("{}{}", metric.name, UnitText(metric)), true});
  }
  columns.push_back({"layout"});
  TextTable table(columns);
  std::size_t shown = 0;
  for (const SynthesisRow& row : summary.front) {
    const std::string marks = Marks(summary, row);
    if (++shown > most_rows && marks.empty()) continue;
    std::vector<std::string> cells{fmt::format("{}", row.row.index)};
    for (const double value : row.values) cells.push_back(Digits(value));
    std::string layout = row.row.formula;
    if (!row.choices.empty()) layout += "  " + row.choices;
    if (!marks.empty()) layout += "  " + console.Paint("<- " + marks, Hue::kBold);
    cells.push_back(std::move(layout));
    table.Row(std::move(cells));
  }
  std::string out = fmt::format("\nfront: {}", Counted(summary.front.size(), "layout"));
  if (summary.epsilon > 0.0) {
    out += fmt::format(" of {}, one for each box of {:.4g} of its extent, ends and knee besides",
                       summary.front_size,
                       summary.epsilon);
  }
  out += "\n";
  out += table.Render();
  if (summary.front.size() > most_rows) out += "  more with --front N, all with --json\n";
  return out;
}

std::string WhyText(const SynthesisSummary& summary, const ReferenceResult& reference) {
  const synthesis::Domination& why = *reference.domination;
  std::string out = fmt::format("  #{} is dominated by {}, first of all by #{}: {}\n",
                                reference.best->row.index,
                                Counted(why.dominators, "layout"),
                                why.by.id,
                                reference.dominator ? reference.dominator->row.formula : "");
  if (reference.dominator && !reference.dominator->choices.empty())
    out += fmt::format("    {}\n", reference.dominator->choices);
  for (std::size_t i = 0; i < summary.objectives.size(); ++i) {
    const MetricDescription& metric = DescriptionOf(summary.objectives[i]);
    out += fmt::format("    {:<20} {:>10} against {:>10}{}{}\n",
                       metric.name,
                       Digits(reference.best->values[i]),
                       Digits(why.by.values[i]),
                       UnitText(metric),
                       i == why.most             ? "  <- decisive"
                       : why.better_by[i] == 0.0 ? "  equal"
                                                 : "");
  }
  return out;
}

std::string ReferenceText(const SynthesisSummary& summary) {
  if (!summary.reference) return "";
  const ReferenceResult& reference = *summary.reference;
  std::string out = fmt::format("\nreference: {}\n", reference.formula);
  if (!reference.problem.empty()) return out + "  " + reference.problem + "\n";
  out += fmt::format("  {} in the space, {} ok, {} on the front\n",
                     Counted(reference.variants, "variant"),
                     reference.ok,
                     reference.on_front);
  if (!reference.best) return out;
  if (reference.domination) return out + WhyText(summary, reference);
  return out + fmt::format(
                   "  #{} is on the front: nothing is at least as good in all objectives "
                   "and better in one\n",
                   reference.best->row.index);
}

Json SizesJson(const synthesis::Evaluation& row) {
  Json out = Json::object();
  for (const synthesis::SizedNumber& size : row.sizes)
    out[size.name] = Outward(size.value, size.angle);
  return out;
}

Json RowJson(const SynthesisSummary& summary, const SynthesisRow& row) {
  Json metrics = Json::object();
  for (const MetricDescription& metric : synthesis::Metrics()) {
    if (row.row.metrics.Has(metric.id))
      metrics[std::string(metric.name)] = row.row.metrics[metric.id];
  }
  Json out{{"index", row.row.index},
           {"formula", row.row.formula},
           {"choices", row.choices},
           {"sizes", SizesJson(row.row)},
           {"metrics", std::move(metrics)}};
  if (row.knee) out["knee"] = true;
  if (!row.best_in.empty()) {
    out["best_in"] = Json::array();
    for (const std::size_t i : row.best_in)
      out["best_in"].push_back(DescriptionOf(summary.objectives[i]).name);
  }
  return out;
}

Json ReferenceJson(const SynthesisSummary& summary) {
  const ReferenceResult& reference = *summary.reference;
  Json out{{"formula", reference.formula}};
  if (!reference.problem.empty()) {
    out["problem"] = reference.problem;
    return out;
  }
  out["variants"] = reference.variants;
  out["ok"] = reference.ok;
  out["on_front"] = reference.on_front;
  if (reference.best) out["best"] = RowJson(summary, *reference.best);
  if (!reference.domination) return out;
  out["dominators"] = reference.domination->dominators;
  if (reference.dominator) out["dominated_by"] = RowJson(summary, *reference.dominator);
  out["decisive"] = DescriptionOf(summary.objectives[reference.domination->most]).name;
  Json better = Json::object();
  for (std::size_t i = 0; i < summary.objectives.size(); ++i)
    better[std::string(DescriptionOf(summary.objectives[i]).name)] =
        reference.domination->better_by[i];
  out["better_by"] = std::move(better);
  return out;
}

Json StagesJson(const SynthesisSummary& summary) {
  Json out = Json::array();
  for (const synthesis::StageDescription& stage : synthesis::Stages()) {
    const auto at = static_cast<std::size_t>(stage.stage);
    Json reasons = Json::object();
    for (const auto& [key, count] : summary.reasons) {
      if (key.first == at) reasons[key.second] = count;
    }
    out.push_back({{"stage", stage.name},
                   {"needs", stage.needs},
                   {"gives", stage.gives},
                   {"entered", summary.funnel[at].entered},
                   {"rejected", summary.funnel[at].rejected},
                   {"failed", summary.funnel[at].failed},
                   {"reasons", std::move(reasons)}});
  }
  return out;
}

}  // namespace

std::string SynthesisText(const Console& console,
                          const SynthesisSummary& summary,
                          std::size_t most_rows) {
  const synthesis::Progress& progress = summary.report.progress;
  std::string out =
      fmt::format("{}: {} candidates", summary.study->name, GroupedText(summary.candidates));
  if (summary.range.size() != summary.candidates)
    out += fmt::format(", of these {} to {} here",
                       GroupedText(summary.range.begin),
                       GroupedText(summary.range.end == 0 ? 0 : summary.range.end - 1));
  out += fmt::format("\n  {} evaluated now{}{}\n",
                     GroupedText(progress.done),
                     summary.done_before > 0
                         ? fmt::format(", {} done before", GroupedText(summary.done_before))
                         : "",
                     summary.report.stopped ? ", stopped: the rest can follow" : "");
  out += StageText(summary);
  out += FrontText(console, summary, most_rows);
  return out + ReferenceText(summary);
}

nlohmann::ordered_json SynthesisJson(const SynthesisSummary& summary) {
  Json objectives = Json::array();
  for (std::size_t i = 0; i < summary.objectives.size(); ++i) {
    const MetricDescription& metric = DescriptionOf(summary.objectives[i]);
    objectives.push_back({{"metric", metric.name},
                          {"unit", metric.unit},
                          {"goal", summary.study->objectives[i].maximise ? "max" : "min"},
                          {"method", metric.method}});
  }
  Json front = Json::array();
  for (const SynthesisRow& row : summary.front) front.push_back(RowJson(summary, row));
  const synthesis::Progress& progress = summary.report.progress;
  Json out{{"study", summary.study->name},
           {"candidates", synthesis::CountText(summary.candidates)},
           {"range", {summary.range.begin, summary.range.end}},
           {"done_before", summary.done_before},
           {"evaluated", progress.done},
           {"stopped", summary.report.stopped},
           {"seconds", progress.seconds},
           {"ok", summary.ok},
           {"stages", StagesJson(summary)},
           {"objectives", std::move(objectives)},
           {"epsilon", summary.epsilon},
           {"front_size", summary.front_size},
           {"front", std::move(front)}};
  if (summary.reference) out["reference"] = ReferenceJson(summary);
  return out;
}

}  // namespace kompono::cli
