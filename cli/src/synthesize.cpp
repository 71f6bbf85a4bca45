// SPDX-License-Identifier: Apache-2.0
// kompono synthesize: the space of a study - how many layouts it has, which, and what the rules do.
#include "synthesize.hpp"

#include "codes.hpp"
#include "files.hpp"
#include "synthesize_run.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::cli {
namespace {

using nlohmann::ordered_json;
using synthesis::Count;
using synthesis::CountText;
using synthesis::Enumeration;
using synthesis::GroupedText;
using synthesis::Space;
using synthesis::StudySpace;

constexpr const char* kExamples =
    "  kompono synthesize study.toml                        evaluate all, show the front\n"
    "  kompono synthesize study.toml --catalog study.db     keep every row; again: what is "
    "missing\n"
    "  kompono synthesize study.toml --count                how many layouts, without making them\n"
    "  kompono synthesize study.toml --explain              what each rule costs\n"
    "  kompono synthesize study.toml --list 20 --fix base=open\n"
    "  kompono synthesize study.toml --layout 17 > layout.toml";

struct Options {
  StudyChoice study;
  bool count = false;
  bool explain = false;
  std::uint64_t list = 0;
  std::string from = "0";
  std::string layout;
  SynthesizeRunOptions run;
};

std::string ScientificText(double log10) {
  const double exponent = std::floor(log10);
  return fmt::format("{:.2f}e{:.0f}", std::pow(10.0, log10 - exponent), exponent);
}

ordered_json FeaturesJson(const Space& space) {
  ordered_json features = ordered_json::array();
  for (const synthesis::Feature& feature : space.features()) {
    ordered_json names = ordered_json::array();
    for (const auto& alternative : feature.alternatives) names.push_back(alternative.name);
    features.push_back({{"name", feature.name}, {"alternatives", std::move(names)}});
  }
  return features;
}

ExitCode RunCount(Session& session, const OpenedStudy& opened) {
  const Space& space = opened.space.space();
  const Enumeration all(space, opened.fixed);
  if (session.json) {
    session.console.Json({{"study", opened.space.study().name},
                          {"raw_log10", space.RawLog10()},
                          {"count", CountText(all.count())},
                          {"nodes", all.nodes()},
                          {"features", FeaturesJson(space)}});
    return all.count() > 0 ? ExitCode::kOk : ExitCode::kNegative;
  }
  std::string text = fmt::format("{}\n\n", opened.space.study().name);
  TextTable table({{"feature"}, {"alternatives", true}, {""}});
  for (const synthesis::Feature& feature : space.features()) {
    std::vector<std::string> names;
    for (const auto& alternative : feature.alternatives) names.push_back(alternative.name);
    constexpr std::size_t kShown = 6;
    const std::size_t all_names = names.size();
    if (all_names > kShown) names.resize(kShown);
    table.Row({feature.name,
               std::to_string(all_names),
               Joined(names) + (all_names > kShown ? ", …" : "")});
  }
  text += table.Render();
  text += fmt::format("\nselections  {}\nlayouts     {}\n",
                      ScientificText(space.RawLog10()),
                      GroupedText(all.count()));
  session.console.Out(text);
  return all.count() > 0 ? ExitCode::kOk : ExitCode::kNegative;
}

/// The alternatives that the formula does not show.
std::vector<std::pair<std::string, std::string>> FurtherChoices(
    const StudySpace& opened, const synthesis::Selection& selection) {
  std::vector<std::pair<std::string, std::string>> choices;
  const auto& features = opened.space().features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::string& name = features[f].name;
    const std::string& alternative = features[f].alternatives[selection[f]].name;
    const bool of_module = name.find('.') != std::string::npos;
    const bool of_end = name.ends_with("_end") && features[f].alternatives.size() > 1;
    if ((of_module && alternative != "none") || of_end) choices.emplace_back(name, alternative);
  }
  return choices;
}

ExitCode RunList(Session& session, const OpenedStudy& opened, const Options& options) {
  const Enumeration all(opened.space.space(), opened.fixed);
  const auto from = synthesis::ParseCount(options.from);
  const Count begin = std::min(from.value_or(0), all.count());
  const Count end = std::min(begin + options.list, all.count());
  ordered_json layouts = ordered_json::array();
  std::string text;
  all.Visit(begin, end, [&](Count index, const synthesis::Selection& selection) {
    const auto candidate = opened.space.At(selection);
    const std::string formula = formula::Canonical(opened.space.FormulaOf(candidate));
    const auto choices = FurtherChoices(opened.space, selection);
    if (session.json) {
      ordered_json named = ordered_json::object();
      for (const auto& [feature, alternative] : choices) named[feature] = alternative;
      layouts.push_back({{"index", CountText(index)}, {"formula", formula}, {"choices", named}});
    } else {
      std::vector<std::string> words;
      words.reserve(choices.size());
      for (const auto& [feature, alternative] : choices)
        words.push_back(fmt::format("{}={}", feature, alternative));
      text += fmt::format("{:>10}  {}{}{}\n",
                          CountText(index),
                          formula,
                          words.empty() ? "" : "   ",
                          Joined(words, " "));
    }
    return true;
  });
  if (session.json) {
    session.console.Json({{"count", CountText(all.count())}, {"layouts", std::move(layouts)}});
  } else {
    session.console.Out(text);
    session.console.Say(
        fmt::format("{} of {} layouts\n", CountText(end - begin), GroupedText(all.count())));
  }
  return end > begin ? ExitCode::kOk : ExitCode::kNegative;
}

ExitCode RunLayout(Session& session, const OpenedStudy& opened, const Options& options) {
  const Enumeration all(opened.space.space(), opened.fixed);
  const auto index = synthesis::ParseCount(options.layout);
  if (!index || *index >= all.count()) {
    return session.Refuse({.code = std::string(codes::kUsage.code),
                           .file = "",
                           .span = {},
                           .message = fmt::format("there is no layout '{}'", options.layout),
                           .help = fmt::format("layouts are numbered from 0; there are {}",
                                               GroupedText(all.count()))});
  }
  const auto candidate = opened.space.At(all.Unrank(*index), static_cast<std::uint64_t>(*index));
  const auto settings = synthesis::ReadEvaluationSettings(opened.space.study().text,
                                                          opened.space.study().file.string());
  if (!settings) return session.Refuse(settings.error());
  const std::string text = synthesis::Evaluator(opened.space, *settings).LayoutFile(candidate);
  if (session.json) {
    session.console.Json({{"index", CountText(*index)}, {"layout", text}});
  } else {
    session.console.Out(text);
  }
  return ExitCode::kOk;
}

std::string ChoiceText(const Space& space, const synthesis::Choice& choice) {
  const synthesis::Feature& feature = space.features()[static_cast<std::size_t>(choice.feature)];
  return feature.name + "=" +
         feature.alternatives[static_cast<std::size_t>(choice.alternative)].name;
}

void PrintEffects(Session& session, const OpenedStudy& opened, const synthesis::Effects& effects) {
  const Space& space = opened.space.space();
  std::string text =
      fmt::format("{}\n\nselections         {}\nthat are layouts   {}\nleft by the rules  {}\n",
                  opened.space.study().name,
                  ScientificText(space.RawLog10()),
                  GroupedText(effects.structural),
                  GroupedText(effects.count));
  if (!effects.rules.empty()) {
    text += "\n";
    TextTable table({{"rule"}, {"kind"}, {"pairs", true}, {"without it more", true}, {"author"}});
    for (const synthesis::RuleEffect& effect : effects.rules) {
      const synthesis::RuleTitle& rule = space.rules()[static_cast<std::size_t>(effect.rule)];
      table.Row({rule.name,
                 std::string(NameOf(rule.kind)),
                 std::to_string(effect.pairs),
                 GroupedText(effect.gained),
                 rule.author});
      table.Line("    " + rule.reason);
    }
    text += table.Render();
  }
  if (!effects.pairs.empty()) {
    text += "\nDecisive pairs, and how many layouts each alone keeps out:\n";
    TextTable table({{"pair"}, {"layouts", true}, {"rule"}});
    for (const synthesis::PairEffect& effect : effects.pairs) {
      const bool one = effect.pair.first == effect.pair.second;
      table.Row({ChoiceText(space, effect.pair.first) +
                     (one ? "" : " with " + ChoiceText(space, effect.pair.second)),
                 GroupedText(effect.gained),
                 space.rules()[static_cast<std::size_t>(effect.pair.rule)].name});
    }
    text += table.Render();
  }
  session.console.Out(text);
}

ExitCode RunExplain(Session& session, const OpenedStudy& opened) {
  const Space& space = opened.space.space();
  const synthesis::Effects effects = synthesis::Explain(space, opened.fixed);
  if (!session.json) {
    PrintEffects(session, opened, effects);
    return ExitCode::kOk;
  }
  ordered_json rules = ordered_json::array();
  for (const synthesis::RuleEffect& effect : effects.rules) {
    const synthesis::RuleTitle& rule = space.rules()[static_cast<std::size_t>(effect.rule)];
    rules.push_back({{"rule", rule.name},
                     {"kind", NameOf(rule.kind)},
                     {"reason", rule.reason},
                     {"author", rule.author},
                     {"pairs", effect.pairs},
                     {"gained", CountText(effect.gained)}});
  }
  ordered_json pairs = ordered_json::array();
  for (const synthesis::PairEffect& effect : effects.pairs) {
    pairs.push_back({{"first", ChoiceText(space, effect.pair.first)},
                     {"second", ChoiceText(space, effect.pair.second)},
                     {"rule", space.rules()[static_cast<std::size_t>(effect.pair.rule)].name},
                     {"gained", CountText(effect.gained)}});
  }
  session.console.Json({{"study", opened.space.study().name},
                        {"raw_log10", space.RawLog10()},
                        {"structural", CountText(effects.structural)},
                        {"count", CountText(effects.count)},
                        {"rules", std::move(rules)},
                        {"pairs", std::move(pairs)}});
  return ExitCode::kOk;
}

ExitCode Run(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const auto opened = OpenStudy(session, options.study, code);
  if (!opened) return code;
  if (options.explain) return RunExplain(session, *opened);
  if (options.list > 0) return RunList(session, *opened, options);
  if (!options.layout.empty()) return RunLayout(session, *opened, options);
  if (options.count) return RunCount(session, *opened);
  return RunSynthesis(session, opened->space, opened->fixed, options.run);
}

Diagnostics Narrow(const StudyChoice& choice, OpenedStudy& opened) {
  Diagnostics complaints;
  const auto complain = [&complaints](Diagnostic said) { complaints.push_back(std::move(said)); };
  for (const std::string& text : choice.fix) {
    const auto fixed = opened.space.ParseChoice(text);
    if (fixed) {
      opened.fixed.push_back(*fixed);
    } else {
      complain(fixed.error());
    }
  }
  std::vector<std::string> names;
  for (const auto& rule : opened.space.study().rules) names.push_back(rule.title.name);
  const auto& rules = opened.space.space().rules();
  for (const std::string& name : choice.without) {
    const auto found = std::find_if(rules.begin(), rules.end(), [&name](const auto& rule) {
      return !rule.structural && rule.name == name;
    });
    if (found != rules.end()) {
      opened.space.space().SwitchOff(static_cast<int>(found - rules.begin()));
    } else {
      complain({.code = std::string(codes::kUnknownName.code),
                .file = "",
                .span = {},
                .message = fmt::format("the study has no rule '{}'", name),
                .help = DidYouMean(name, names)});
    }
  }
  if (choice.formula.empty()) return complaints;
  const auto formula = formula::ParseFormula(choice.formula);
  const auto fixing = formula ? opened.space.FixFormula(*formula) : std::nullopt;
  if (fixing) {
    opened.fixed.insert(opened.fixed.end(), fixing->begin(), fixing->end());
  } else if (!formula) {
    complaints.insert(complaints.end(), formula.error().begin(), formula.error().end());
  } else {
    complain({.code = std::string(codes::kUnknownName.code),
              .file = "",
              .span = {},
              .message = fmt::format("'{}' is no layout of this study", choice.formula),
              .help = "--list 20 shows how its layouts are written"});
  }
  return complaints;
}

}  // namespace

void AddStudyChoice(CLI::App& command, Session& session, StudyChoice& choice) {
  session.Hint(command.add_option("STUDY", choice.file, "Study file")->required(),
               ValueHint::Kind::kFile);
  command.add_option("--fix", choice.fix, "Only this alternative of a feature; may be repeated")
      ->type_name("FEATURE=ALTERNATIVE")
      ->allow_extra_args(false);
  command.add_option("--formula", choice.formula, "Only layouts with this formula")
      ->type_name("TEXT");
  command.add_option("--without", choice.without, "Switch a rule off; may be repeated")
      ->type_name("RULE")
      ->allow_extra_args(false);
}

std::optional<OpenedStudy> OpenStudy(Session& session, const StudyChoice& choice, ExitCode& code) {
  const Parsed<std::string> text = ReadWhole(choice.file);
  if (!text) {
    code = session.Refuse(text.error());
    return std::nullopt;
  }
  Diagnostics notes;
  Parsed<synthesis::Study> study = synthesis::ParseStudy(
      *text, choice.file, session.registry(), synthesis::MetricNames(), &notes);
  if (!study) {
    code = session.Refuse(study.error());
    return std::nullopt;
  }
  Parsed<StudySpace> space = StudySpace::Build(std::move(*study), session.registry(), &notes);
  if (!space) {
    code = session.Refuse(space.error());
    return std::nullopt;
  }
  session.console.Report(notes);
  OpenedStudy opened{std::move(*space), {}};
  const Diagnostics complaints = Narrow(choice, opened);
  if (HasErrors(complaints)) {
    code = session.Refuse(complaints);
    return std::nullopt;
  }
  return opened;
}

void AddSynthesize(CLI::App& root, Session& session) {
  CLI::App* command =
      session.Command(root,
                      "synthesize",
                      "The layouts of a study: evaluate, rank, keep; count, list, explain",
                      kExamples);
  const auto options = std::make_shared<Options>();
  AddStudyChoice(*command, session, options->study);
  auto* const count = command->add_flag("--count", options->count, "How many; nothing is made");
  auto* const explain = command->add_flag(
      "--explain", options->explain, "What each rule keeps out, and the decisive pairs");
  auto* const list =
      command->add_option("--list", options->list, "Print so many layouts")->type_name("N");
  command->add_option("--from", options->from, "The first that --list prints; 0")
      ->type_name("INDEX")
      ->needs(list);
  auto* const layout =
      command->add_option("--layout", options->layout, "Print the sized layout file of this one")
          ->type_name("INDEX");
  for (auto* const one : {count, explain, list, layout}) {
    for (auto* const other : {count, explain, list, layout}) {
      if (one != other) one->excludes(other);
    }
  }
  AddRunOptions(*command, session, options->run);
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
