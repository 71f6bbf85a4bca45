// SPDX-License-Identifier: Apache-2.0
// Rows of a run in the catalog: one transaction for each chunk, and what is missing of a range.
#include "synthesize_run.hpp"
#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "kompono/catalog/store.hpp"
#include "kompono/catalog/study.hpp"
#include "kompono/formula/equivalence.hpp"

namespace kompono::cli {
namespace {

using catalog::EvaluationRecord;
using synthesis::Evaluation;
using synthesis::IndexRange;
using synthesis::MetricDescription;
using synthesis::StudySpace;

constexpr std::uint64_t kRowsAtOnce = 4096;

catalog::IndexRange Kept(const IndexRange& range) {
  return {.begin = static_cast<std::int64_t>(range.begin),
          .end = static_cast<std::int64_t>(range.end)};
}

std::string TermText(const synthesis::Term& term) {
  return Joined(term, " ");
}

std::vector<catalog::StudyRule> RulesOf(const StudySpace& space) {
  std::vector<catalog::StudyRule> out;
  const auto& titles = space.space().rules();
  for (const synthesis::StudyRule& rule : space.study().rules) {
    const auto title = std::find_if(titles.begin(), titles.end(), [&rule](const auto& one) {
      return !one.structural && one.name == rule.title.name;
    });
    const bool off = title == titles.end()
                         ? rule.off
                         : space.space().off(static_cast<int>(title - titles.begin()));
    // A rule with one term forbids what meets it with itself.
    out.push_back({.first = TermText(rule.forbid.front()),
                   .second = TermText(rule.forbid.back()),
                   .kind = std::string(synthesis::NameOf(rule.title.kind)),
                   .reason = rule.title.reason,
                   .author = rule.title.author,
                   .active = !off});
  }
  return out;
}

/// What makes it the same study: the file, and how the command line narrowed its space.
catalog::StudyRecord RecordOf(const StudySpace& space,
                              const synthesis::Fixing& fixed,
                              synthesis::Count candidates) {
  catalog::StudyRecord out{.name = space.study().name,
                           .toml = space.study().text,
                           .candidates = static_cast<std::int64_t>(candidates),
                           .rules = RulesOf(space)};
  out.content = space.study().text;
  for (const synthesis::Choice& choice : fixed)
    out.content += fmt::format("\n# fixed {} {}", choice.feature, choice.alternative);
  for (std::size_t i = 0; i < space.space().rules().size(); ++i) {
    if (space.space().off(static_cast<int>(i)))
      out.content += fmt::format("\n# off {}", space.space().rules()[i].name);
  }
  return out;
}

catalog::EvaluationStatus StatusOf(synthesis::EvaluationStatus status) {
  switch (status) {
    case synthesis::EvaluationStatus::kOk:
      return catalog::EvaluationStatus::kOk;
    case synthesis::EvaluationStatus::kRejected:
      return catalog::EvaluationStatus::kRejected;
    case synthesis::EvaluationStatus::kFailed:
      return catalog::EvaluationStatus::kFailed;
  }
  return catalog::EvaluationStatus::kFailed;
}

catalog::LayoutRecord LayoutOf(const StudySpace& space,
                               const synthesis::Candidate& candidate,
                               const Evaluation& row) {
  const formula::Formula formula = space.FormulaOf(candidate);
  catalog::LayoutRecord out;
  out.name = fmt::format("{}/{}", space.study().name, row.index);
  out.formula = row.formula;
  out.distribution = formula::DistributionKey(formula);
  out.relative_motion = formula::RelativeMotionKey(formula);
  out.open_base = formula.open_base;
  out.coordinates = static_cast<int>(space.study().motions.size());
  out.drives = static_cast<int>(row.metrics[synthesis::MetricId::kDriveCount]);
  for (const synthesis::Candidate::Block& block : candidate.blocks) {
    const synthesis::StudyModule& module =
        space.study().modules[static_cast<std::size_t>(block.module)];
    const plugin::ModuleDescription* description = space.registry().Find(module.module);
    out.blocks.push_back({.name = module.name,
                          .module = module.module,
                          .plugin = description == nullptr ? "" : description->plugin_id});
    for (std::size_t i = 0; i < module.parameters.size(); ++i) {
      const synthesis::StudyParameter& parameter = module.parameters[i];
      const int level = block.levels[i];
      if (level < 0 || parameter.levels.empty()) continue;
      const auto& numbers = parameter.levels[static_cast<std::size_t>(level)].numbers;
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        out.parameters.push_back(
            {.name = numbers.size() == 1
                         ? fmt::format("{}.{}", module.name, parameter.name)
                         : fmt::format("{}.{}[{}]", module.name, parameter.name, k + 1),
             .value = Outward(numbers[k], parameter.angle),
             .unit = std::string(UnitOf(parameter.angle))});
      }
    }
  }
  for (const synthesis::SizedNumber& size : row.sizes)
    out.parameters.push_back({.name = size.name,
                              .value = Outward(size.value, size.angle),
                              .unit = std::string(UnitOf(size.angle))});
  return out;
}

EvaluationRecord RecordOf(const StudySpace& space,
                          const synthesis::Enumeration& all,
                          const Evaluation& row) {
  EvaluationRecord out{.candidate = static_cast<std::int64_t>(row.index),
                       .status = StatusOf(row.status),
                       .stage = std::string(synthesis::NameOf(row.stage)),
                       .reason = row.reason,
                       .formula = row.formula};
  for (const MetricDescription& metric : synthesis::Metrics()) {
    if (!row.metrics.Has(metric.id)) continue;
    out.metrics.push_back({.name = std::string(metric.name),
                           .value = row.metrics[metric.id],
                           .unit = std::string(metric.unit),
                           .method = std::string(metric.method)});
  }
  if (row.status == synthesis::EvaluationStatus::kOk)
    out.layout = LayoutOf(space, space.At(all.Unrank(row.index), row.index), row);
  return out;
}

Evaluation RowOf(const EvaluationRecord& record) {
  Evaluation out{.index = static_cast<std::uint64_t>(record.candidate),
                 .reason = record.reason,
                 .formula = record.formula};
  out.status = record.status == catalog::EvaluationStatus::kOk ? synthesis::EvaluationStatus::kOk
               : record.status == catalog::EvaluationStatus::kRejected
                   ? synthesis::EvaluationStatus::kRejected
                   : synthesis::EvaluationStatus::kFailed;
  for (const synthesis::StageDescription& stage : synthesis::Stages()) {
    if (stage.name == record.stage) out.stage = stage.stage;
  }
  for (const catalog::Metric& metric : record.metrics) {
    const MetricDescription* known = synthesis::FindMetric(metric.name);
    if (known != nullptr && metric.value) out.metrics.Set(known->id, *metric.value);
  }
  return out;
}

/// A study in an open catalog.
class CatalogRows {
 public:
  CatalogRows(catalog::Store store,
              std::int64_t study,
              const StudySpace& space,
              const synthesis::Enumeration& all)
      : store_(std::move(store)), study_(study), space_(space), all_(all) {}

  [[nodiscard]] Parsed<std::vector<IndexRange>> Missing(const IndexRange& whole) const {
    const auto missing = store_.MissingRanges(study_, Kept(whole));
    if (!missing) return tl::unexpected(missing.error());
    std::vector<IndexRange> out;
    for (const catalog::IndexRange& range : *missing)
      out.push_back(
          {static_cast<std::uint64_t>(range.begin), static_cast<std::uint64_t>(range.end)});
    return out;
  }

  Diagnostics Append(const IndexRange& range, std::span<const Evaluation> rows) {
    std::vector<EvaluationRecord> records;
    records.reserve(rows.size());
    for (const Evaluation& row : rows) records.push_back(RecordOf(space_, all_, row));
    const auto appended = store_.AppendChunk(study_, Kept(range), records);
    return appended ? Diagnostics{} : appended.error();
  }

  Diagnostics Rows(const IndexRange& range,
                   const std::function<void(const Evaluation&)>& take) const {
    for (std::uint64_t begin = range.begin; begin < range.end; begin += kRowsAtOnce) {
      const IndexRange piece{begin, std::min(range.end, begin + kRowsAtOnce)};
      const auto records = store_.Evaluations(study_, Kept(piece));
      if (!records) return records.error();
      for (const EvaluationRecord& record : *records) take(RowOf(record));
    }
    return {};
  }

 private:
  catalog::Store store_;
  std::int64_t study_;
  const StudySpace& space_;
  const synthesis::Enumeration& all_;
};

}  // namespace

Parsed<RowStore> CatalogStore(const std::string& file,
                              const StudySpace& space,
                              const synthesis::Enumeration& all,
                              const synthesis::Fixing& fixed,
                              Diagnostics& notes) {
  auto store = catalog::Store::Open(file, {.mode = catalog::OpenMode::kCreate});
  if (!store) return tl::unexpected(store.error());
  notes = store->Notes();
  const auto study = store->BeginStudy(RecordOf(space, fixed, all.count()));
  if (!study) return tl::unexpected(study.error());
  const auto rows = std::make_shared<CatalogRows>(std::move(*store), *study, space, all);
  return RowStore{
      .missing = [rows](const IndexRange& whole) { return rows->Missing(whole); },
      .append = [rows](const IndexRange& range,
                       std::span<const Evaluation> given) { return rows->Append(range, given); },
      .rows =
          [rows](const IndexRange& range, const std::function<void(const Evaluation&)>& take) {
            return rows->Rows(range, take);
          }};
}

}  // namespace kompono::cli
