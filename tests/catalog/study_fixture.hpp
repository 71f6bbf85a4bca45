// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_CATALOG_STUDY_FIXTURE_HPP_
#define KOMPONO_TESTS_CATALOG_STUDY_FIXTURE_HPP_

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kompono/catalog/store.hpp"

namespace kompono::catalog {

inline StudyRecord SheetStudy(std::int64_t candidates) {
  return {.name = "sheet",
          .toml = "# cuts sheets with a water jet\n[study]\nname = \"sheet\"\n",
          .candidates = candidates,
          .rules = {{.first = "module:lambda",
                     .second = "base:closed",
                     .kind = "empirical",
                     .reason = "the drive shakes the gantry",
                     .author = "Sokolov"}},
          .provenance = {.plugins = {{.id = "org.kompono.lambda", .version = "1.0.0"}},
                         .source_path = "studies/sheet.toml"}};
}

/// Any number that follows from the candidate, the same on every machine.
inline double Figure(std::int64_t candidate, std::int64_t factor) {
  return static_cast<double>(candidate * factor % 10'007) / 16.0;
}

/// Every third candidate is rejected, every seventh of the others fails, the others are layouts.
inline EvaluationRecord Evaluated(std::int64_t candidate) {
  EvaluationRecord record{.candidate = candidate, .stage = "work zone"};
  record.formula = fmt::format("part X Y O Z{} tool", 2 + candidate % 5);
  record.metrics = {
      {.name = "stiffness", .value = Figure(candidate, 7919), .unit = "N/um", .method = "grid"},
      {.name = "volume", .value = Figure(candidate, 104'729), .unit = "mm3", .method = "grid"}};
  if (candidate % 3 == 0) {
    record.status = EvaluationStatus::kRejected;
    record.stage = "mobility";
    record.reason = "too few freedoms";
    record.metrics.resize(1);
    return record;
  }
  if (candidate % 7 == 0) {
    record.status = EvaluationStatus::kFailed;
    record.reason = "no assembly";
    record.metrics[1].value.reset();
    record.metrics[1].failure = "no assembly";
    return record;
  }
  record.layout = LayoutRecord{
      .name = fmt::format("sheet/{}", candidate),
      .formula = record.formula,
      .coordinates = 3,
      .drives = static_cast<int>(3 + candidate % 3),
      .blocks = {{.name = "drive", .module = "lambda", .plugin = "org.kompono.lambda"}},
      .parameters = {{.name = "drive.L1", .value = Figure(candidate, 31), .unit = "mm"}},
      .capabilities = {{.name = "cutting", .detail = "sheet"}}};
  return record;
}

inline std::vector<EvaluationRecord> EvaluatedAll(const IndexRange& range) {
  std::vector<EvaluationRecord> records;
  records.reserve(static_cast<std::size_t>(range.size()));
  for (std::int64_t i = range.begin; i < range.end; ++i) records.push_back(Evaluated(i));
  return records;
}

}  // namespace kompono::catalog

#endif  // KOMPONO_TESTS_CATALOG_STUDY_FIXTURE_HPP_
