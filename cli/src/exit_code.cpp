// SPDX-License-Identifier: Apache-2.0
#include "exit_code.hpp"

#include <algorithm>

namespace kompono::cli {
namespace {

struct Rule {
  std::string_view prefix;
  ExitCode code;
};

/// The longest prefix counts.
constexpr std::array<Rule, 32> kRules{{
    {"E", ExitCode::kBadInput},
    {"E0333", ExitCode::kInputOutput},  // layout that cannot be read
    {"E0401", ExitCode::kInputOutput},  // measurements that cannot be read
    {"E0431", ExitCode::kUsage},        // pattern that names no parameter
    {"E044", ExitCode::kUsage},         // simulation that cannot be done as asked
    {"E0442", ExitCode::kNegative},     // too few poses can be reached
    {"E0458", ExitCode::kNoSolution},   // identification that did not converge
    {"E0501", ExitCode::kInputOutput},  // no such catalog
    {"E0502", ExitCode::kInputOutput},  // catalog that cannot be read or written
    {"E0507", ExitCode::kInputOutput},  // migration undone
    {"E0509", ExitCode::kInputOutput},  // another program is writing
    {"E0510", ExitCode::kInputOutput},  // disk full and the like
    {"E0512", ExitCode::kNegative},     // no such layout
    {"E0513", ExitCode::kNegative},     // several such layouts
    {"E052", ExitCode::kUsage},         // query
    {"E0543", ExitCode::kUsage},        // no such metric
    {"E0544", ExitCode::kUsage},        // a metric of several kinds
    {"E0548", ExitCode::kUsage},        // search without words
    {"E0549", ExitCode::kUsage},        // a catalog into itself
    {"E0550", ExitCode::kInputOutput},  // export that cannot be written
    {"E06", ExitCode::kUsage},
    {"E0610", ExitCode::kBadInput},
    {"E0613", ExitCode::kInputOutput},
    {"E0614", ExitCode::kInputOutput},
    {"E0615", ExitCode::kInputOutput},
    {"E0617", ExitCode::kBadInput},
    {"E0618", ExitCode::kBadInput},
    {"E072", ExitCode::kUsage},         // analysis of what the machine does not have
    {"E0722", ExitCode::kBadInput},     // module that records no formulas
    {"E0829", ExitCode::kUsage},        // feature or alternative that the study does not have
    {"E0830", ExitCode::kInputOutput},  // study that cannot be read
    {"E0845", ExitCode::kUsage},        // no shard
}};

}  // namespace

ExitCode ExitCodeOf(const Diagnostics& diagnostics) {
  ExitCode worst = ExitCode::kOk;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (diagnostic.severity != Severity::kError) continue;
    ExitCode code = ExitCode::kBadInput;
    std::size_t longest = 0;
    for (const Rule& rule : kRules) {
      if (!diagnostic.code.starts_with(rule.prefix) || rule.prefix.size() < longest) continue;
      longest = rule.prefix.size();
      code = rule.code;
    }
    worst = std::max(worst, code);
  }
  return worst == ExitCode::kOk ? ExitCode::kBadInput : worst;
}

}  // namespace kompono::cli
