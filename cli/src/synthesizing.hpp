// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_SYNTHESIZING_HPP_
#define KOMPONO_CLI_SYNTHESIZING_HPP_

#include "console.hpp"
#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kompono/synthesis/run.hpp"

/// What a run of a study comes to, and how it is told.
namespace kompono::cli {

/// A layout of the front, or one that is compared with it.
struct SynthesisRow {
  synthesis::Evaluation row;
  std::vector<double> values;  ///< of the objectives
  std::string choices;         ///< what the formula doesn't tell: "drive.mode ++-, drive.L2 820"
  std::vector<std::size_t> best_in;  ///< objectives
  bool knee = false;
};

/// The layout that the study names, against the front.
struct ReferenceResult {
  std::string formula;
  std::string problem;  ///< why it isn't in the space; the rest is empty then
  std::size_t variants = 0, ok = 0, on_front = 0;
  std::optional<SynthesisRow> best;  ///< on the front, or dominated by the fewest
  std::optional<synthesis::Domination> domination;
  std::optional<SynthesisRow> dominator;
};

struct SynthesisSummary {
  const synthesis::Study* study = nullptr;
  synthesis::Count candidates = 0;
  synthesis::IndexRange range;    ///< of this run: the whole, or a shard
  std::uint64_t done_before = 0;  ///< of the range
  synthesis::RunReport report;    ///< of this run
  synthesis::Funnel funnel{};     ///< of all rows that are known, earlier runs included
  std::uint64_t ok = 0, known = 0;
  /// Stage and reason -> rows, of all that are known.
  std::map<std::pair<std::size_t, std::string>, std::uint64_t> reasons;
  std::vector<synthesis::MetricId> objectives;
  std::vector<SynthesisRow> front;
  std::size_t front_size = 0;  ///< before it was thinned
  double epsilon = 0.0;        ///< as given; 0: the whole front
  std::optional<ReferenceResult> reference;
};

[[nodiscard]] std::string SynthesisText(const Console& console,
                                        const SynthesisSummary& summary,
                                        std::size_t most_rows);
[[nodiscard]] nlohmann::ordered_json SynthesisJson(const SynthesisSummary& summary);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_SYNTHESIZING_HPP_
