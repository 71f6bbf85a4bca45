// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/study.hpp"

#include "failure.hpp"
#include "record_parts.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kompono/catalog/hash.hpp"

namespace kompono::catalog {
namespace {

constexpr std::size_t kMostComplaints = 20;

/// A study's hash is over texts with their lengths in front.
void Append(std::string& bytes, std::string_view text) {
  bytes += fmt::format("{}:", text.size());
  bytes += text;
}

class Judge {
 public:
  explicit Judge(std::string file) : file_(std::move(file)) {}

  void Require(bool good, std::string_view what, std::string_view fault) {
    if (!good && found_.size() < kMostComplaints)
      found_.push_back(Complaint("E0540", file_, fmt::format("{} {}", what, fault)));
  }
  void Text(std::string_view text, std::string_view what) {
    if (!IsText(text)) Require(false, what, "is not UTF-8 text");
  }
  [[nodiscard]] bool Full() const { return found_.size() >= kMostComplaints; }
  [[nodiscard]] const std::string& File() const { return file_; }
  void Take(Diagnostics found) {
    std::move(found.begin(), found.end(), std::back_inserter(found_));
  }
  [[nodiscard]] Diagnostics Take() { return std::move(found_); }

 private:
  std::string file_;
  Diagnostics found_;
};

bool SameMeasure(const Metric& a, const Metric& b) {
  return std::tie(a.name, a.unit, a.method) == std::tie(b.name, b.unit, b.method);
}

bool Sound(const Metric& metric) {
  return !metric.name.empty() && IsText(metric.name) && IsText(metric.unit) &&
         IsText(metric.method) && IsText(metric.failure) &&
         metric.value.has_value() == metric.failure.empty() &&
         (!metric.value || std::isfinite(*metric.value));
}

/// Few metrics per candidate: comparing all pairs is quicker than sorting.
bool Sound(const std::vector<Metric>& metrics) {
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    if (!Sound(metrics[i])) return false;
    for (std::size_t k = 0; k < i; ++k) {
      if (SameMeasure(metrics[i], metrics[k])) return false;
    }
  }
  return true;
}

void CheckEvaluation(const EvaluationRecord& record, Judge& judge) {
  const auto what = [&record] { return fmt::format("candidate {}", record.candidate); };
  if (!IsText(record.stage) || !IsText(record.reason) || !IsText(record.formula))
    judge.Require(false, what(), "has a text that is not UTF-8");
  if ((record.status == EvaluationStatus::kOk) != record.reason.empty()) {
    judge.Require(false,
                  what(),
                  record.reason.empty() ? "is not ok and has no reason" : "is ok and has a reason");
  }
  if (!Sound(record.metrics)) {
    // The layout's judge says in words what is wrong with metrics.
    judge.Take(Check(
        LayoutRecord{.name = what(), .formula = "O", .metrics = record.metrics, .provenance = {}}));
  }
  if (!record.layout) return;
  const LayoutRecord& layout = *record.layout;
  if (!layout.metrics.empty())
    judge.Require(false, what(), "has metrics in its layout, where they are not looked for");
  if (!record.formula.empty() && record.formula != layout.formula)
    judge.Require(false, what(), "has another formula than its layout");
  judge.Take(Check(layout));
}

}  // namespace

const char* Word(EvaluationStatus status) {
  switch (status) {
    case EvaluationStatus::kOk:
      return "ok";
    case EvaluationStatus::kRejected:
      return "rejected";
    case EvaluationStatus::kFailed:
      break;
  }
  return "failed";
}

Diagnostics Check(const StudyRecord& study) {
  Judge judge(study.provenance.source_path.empty() ? study.name : study.provenance.source_path);
  judge.Require(!study.name.empty(), "the study's name", "is empty");
  judge.Text(study.name, "the study's name");
  judge.Text(study.toml, "the study file");
  judge.Text(study.content, "the study's content");
  judge.Require(study.candidates >= 0, "the number of candidates", "is negative");
  for (const StudyRule& rule : study.rules) {
    const std::string what = fmt::format("the rule '{}' against '{}'", rule.first, rule.second);
    judge.Require(!rule.first.empty(), what, "names nothing");
    for (const std::string_view text :
         {std::string_view(rule.first), std::string_view(rule.second)}) {
      judge.Text(text, "a tag of a rule");
    }
    judge.Require(rule.kind == "logical" || rule.kind == "empirical" || rule.kind == "normative",
                  what,
                  "is of no kind: logical, empirical or normative");
    judge.Text(rule.reason, "the reason of a rule");
    judge.Text(rule.author, "the author of a rule");
  }
  judge.Take(Check(LayoutRecord{.name = "x", .formula = "O", .provenance = study.provenance}));
  return judge.Take();
}

Diagnostics Check(const IndexRange& range, std::span<const EvaluationRecord> records) {
  Judge judge("study");
  judge.Require(range.begin >= 0 && range.begin < range.end,
                fmt::format("the range {} .. {}", range.begin, range.end),
                "is empty");
  judge.Require(range.end - range.begin == std::ssize(records),
                fmt::format("the range {} .. {}", range.begin, range.end),
                fmt::format("has {} evaluations", records.size()));
  std::int64_t next = range.begin;
  for (const EvaluationRecord& record : records) {
    if (record.candidate != next)
      judge.Require(false,
                    fmt::format("candidate {}", record.candidate),
                    fmt::format("stands where {} is expected", next));
    ++next;
    CheckEvaluation(record, judge);
    if (judge.Full()) break;
  }
  return judge.Take();
}

Sha256 ContentDigest(const StudyRecord& study) {
  std::string bytes = "kompono study 1;";
  Append(bytes, study.name);
  bytes += fmt::format("{};", study.candidates);
  Append(bytes, study.content.empty() ? study.toml : study.content);
  return Sha256Of(bytes);
}

std::string StudyHash(const StudyRecord& study) {
  return Hex(ContentDigest(study));
}

}  // namespace kompono::catalog
