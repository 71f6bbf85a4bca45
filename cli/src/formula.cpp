// SPDX-License-Identifier: Apache-2.0
// kompono formula: what a structural formula says.
#include "kompono/formula/formula.hpp"

#include "files.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

#include "kompono/formula/equivalence.hpp"

namespace kompono::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono formula 'part X Y Z O C_v tool'              a knee mill\n"
    "  kompono formula 'part_xy (XY):drive O|O Z P_z'       an open base\n"
    "  kompono formula \"[w X' b Y Z (C) t]\"                 ISO 230-1, read and rewritten\n"
    "  kompono formula 'XYZOC_v' --counts                   how many layouts the same motions have";

/// 9 motions are 3.6 million layouts, some seconds; one more would be ten times that.
constexpr std::size_t kMostCounted = 9;

struct Options {
  std::string text;
  bool counts = false;
};

/// The letters of a serial formula for CountClasses; nothing when groups or forks make its order
/// mean something else.
std::optional<std::string> SerialLetters(const formula::Formula& formula) {
  std::string letters;
  for (const formula::Chain* chain : {&formula.left, &formula.right}) {
    for (const formula::Item& item : *chain) {
      if (std::holds_alternative<formula::Group>(item) ||
          std::holds_alternative<formula::Fork>(item)) {
        return std::nullopt;
      }
      if (const auto* axis = std::get_if<formula::Axis>(&item)) letters += axis->Name();
    }
  }
  return letters;
}

std::optional<formula::ClassCounts> Counts(const formula::Formula& formula) {
  const std::optional<std::string> letters = SerialLetters(formula);
  const std::size_t motions = formula::AxesOf(formula).size();
  if (!letters || motions == 0 || motions > kMostCounted) return std::nullopt;
  return formula::CountClasses(*letters);
}

ordered_json ResultJson(const formula::Formula& formula,
                        const std::optional<formula::ClassCounts>& counts) {
  ordered_json out{{"formula", formula::Canonical(formula)},
                   {"open_base", formula.open_base},
                   {"explanation", ordered_json::array()},
                   {"keys",
                    {{"string", formula::StringKey(formula)},
                     {"distribution", formula::DistributionKey(formula)},
                     {"relative_motion", formula::RelativeMotionKey(formula)}}}};
  for (const formula::Explanation& line : formula::Explain(formula)) {
    out["explanation"].push_back(
        {{"text", line.text}, {"meaning", line.meaning}, {"depth", line.depth}});
  }
  if (counts) {
    out["counts"] = {{"strings", counts->strings},
                     {"distributions", counts->distributions},
                     {"relative_motions", counts->relative_motions}};
  }
  return out;
}

void Print(Console& console,
           const formula::Formula& formula,
           const std::optional<formula::ClassCounts>& counts) {
  console.Out(console.Paint(formula::Canonical(formula), Hue::kBold) + "\n\n");
  TextTable lines({{""}, {""}});
  for (const formula::Explanation& line : formula::Explain(formula)) {
    lines.Row(
        {std::string(static_cast<std::size_t>(2 * line.depth), ' ') + line.text, line.meaning});
  }
  console.Out(lines.Render());
  TextTable keys({{""}, {""}});
  keys.Row({"same string", formula::StringKey(formula)});
  keys.Row({"same distribution", formula::DistributionKey(formula)});
  keys.Row({"same relative motion", formula::RelativeMotionKey(formula)});
  console.Out("\nequivalence keys\n" + keys.Render());
  if (!counts) return;
  console.Out(fmt::format(
      "\nlayouts of the same motions: {} strings, {} distributions, {} relative motions\n",
      counts->strings,
      counts->distributions,
      counts->relative_motions));
}

ExitCode Run(Session& session, const Options& options) {
  std::string text = options.text;
  if (text == "-") {
    Parsed<std::string> input = ReadWhole("-");
    if (!input) return session.Refuse(input.error());
    text = std::string(Trimmed(*input));
  }
  Diagnostics notes;
  const Parsed<formula::Formula> formula = formula::ParseFormula(text, "formula", &notes);
  if (!formula) {
    notes.insert(notes.end(), formula.error().begin(), formula.error().end());
    return session.Refuse(notes);
  }
  session.console.Report(notes);
  std::optional<formula::ClassCounts> counts;
  if (options.counts) {
    counts = Counts(*formula);
    if (!counts) {
      session.console.Say(fmt::format(
          "layouts are counted for serial formulas with 1 to {} motions only", kMostCounted));
    }
  }
  if (session.json) {
    session.console.Json(ResultJson(*formula, counts));
  } else {
    Print(session.console, *formula, counts);
  }
  return ExitCode::kOk;
}

}  // namespace

void AddFormula(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "formula", "Explain a structural formula and bring it into canonical form", kExamples);
  const auto options = std::make_shared<Options>();
  command->add_option("TEXT", options->text, "The formula in quotes; - reads it from stdin")
      ->required();
  command->add_flag(
      "--counts", options->counts, "Count the layouts of the same motions under each equivalence");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
