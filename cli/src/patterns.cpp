// SPDX-License-Identifier: Apache-2.0
#include "patterns.hpp"

#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/layout/numbers.hpp"

namespace kompono::cli {
namespace {

/// Whether what the pattern names are angles; nothing, with a complaint, if that is no question.
std::optional<bool> NamesAngles(const Argument& argument,
                                const Assignment& assignment,
                                const kinematics::Machine& machine,
                                const GeometryForms& forms,
                                Diagnostics& problems) {
  std::size_t lengths = 0;
  std::size_t angles = 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    names.push_back(forms[i].front());
    const bool named = std::any_of(forms[i].begin(), forms[i].end(), [&](const auto& form) {
      return layout::MatchesPattern(assignment.name, form);
    });
    if (named) (machine.parameters()[i].angle ? angles : lengths) += 1;
  }
  const auto complain = [&](const CodeTitle& code, std::string message, std::string help) {
    problems.push_back(argument.Complaint(
        code, assignment.name_begin, assignment.name.size(), std::move(message), std::move(help)));
  };
  if (lengths + angles == 0) {
    complain(codes::kUnknownName,
             fmt::format("'{}' names no number of the geometry", assignment.name),
             DidYouMean(assignment.name, names, 24));
    return std::nullopt;
  }
  if (lengths > 0 && angles > 0) {
    complain(codes::kMixedUnits,
             fmt::format("'{}' names lengths and angles, which cannot have the same value",
                         assignment.name),
             "give them one by one");
    return std::nullopt;
  }
  return angles > 0;
}

void ComplainIfRepeated(const Argument& argument,
                        const Assignment& assignment,
                        bool inserted,
                        Diagnostics& problems) {
  if (inserted) return;
  problems.push_back(argument.Complaint(codes::kRepeatedName,
                                        assignment.name_begin,
                                        assignment.name.size(),
                                        fmt::format("'{}' is given twice", assignment.name),
                                        "give it once"));
}

}  // namespace

GeometryForms FormsOf(const kinematics::Machine& machine, const plugin::Registry& registry) {
  std::map<std::string, std::vector<std::string>> known;  // by each form
  for (const layout::Number& number : layout::NumbersOf(machine.layout(), registry)) {
    std::vector<std::string> forms{number.name};
    forms.insert(forms.end(), number.other_names.begin(), number.other_names.end());
    for (const std::string& form : forms) known[form] = forms;
  }
  GeometryForms out;
  for (const kinematics::Parameter& parameter : machine.parameters()) {
    const auto found = known.find(parameter.name);
    // What a preset has fixed is no number of the layout.
    out.push_back(found == known.end() ? std::vector<std::string>{parameter.name} : found->second);
  }
  return out;
}

std::map<std::string, double> ReadPatternNumbers(const Argument& argument,
                                                 const kinematics::Machine& machine,
                                                 const GeometryForms& forms,
                                                 Diagnostics& problems) {
  std::map<std::string, double> out;
  for (const Assignment& assignment : argument.Split(problems)) {
    const std::optional<bool> angle = NamesAngles(argument, assignment, machine, forms, problems);
    const std::optional<double> number = argument.Number(assignment, problems);
    if (!angle || !number) continue;
    const bool inserted = out.emplace(assignment.name, Inward(*number, *angle)).second;
    ComplainIfRepeated(argument, assignment, inserted, problems);
  }
  return out;
}

std::map<std::string, std::array<double, 2>> ReadPatternRanges(const Argument& argument,
                                                               const kinematics::Machine& machine,
                                                               const GeometryForms& forms,
                                                               Diagnostics& problems) {
  std::map<std::string, std::array<double, 2>> out;
  for (const Assignment& assignment : argument.Split(problems)) {
    const std::optional<bool> angle = NamesAngles(argument, assignment, machine, forms, problems);
    const std::optional<Argument::Interval> range = argument.Range(assignment, problems);
    if (!angle || !range) continue;
    const std::array<double, 2> limits{Inward(range->lower, *angle), Inward(range->upper, *angle)};
    const bool inserted = out.emplace(assignment.name, limits).second;
    ComplainIfRepeated(argument, assignment, inserted, problems);
  }
  return out;
}

std::vector<std::string> SplitWords(const std::vector<std::string>& uses) {
  std::vector<std::string> out;
  for (const std::string& use : uses) {
    std::size_t begin = 0;
    while (begin <= use.size()) {
      const std::size_t end = std::min(use.find(',', begin), use.size());
      const std::string_view word = Trimmed(std::string_view(use).substr(begin, end - begin));
      if (!word.empty()) out.emplace_back(word);
      begin = end + 1;
    }
  }
  return out;
}

}  // namespace kompono::cli
