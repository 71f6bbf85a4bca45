// SPDX-License-Identifier: Apache-2.0
// Parameters of modules: fixed, in levels, or in a range for sizing.
#include "study_reader.hpp"
#include <fmt/format.h>

#include <algorithm>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::synthesis {
namespace {

using plugin::ParameterDescription;

const ParameterDescription& HomeDescription() {
  static const ParameterDescription kHome = [] {
    ParameterDescription home;
    home.name = "home";
    home.unit = "mm";
    return home;
  }();
  return kHome;
}

/// Whether a table such as { levels = […] } stands where a value might.
bool IsChoice(const toml::node& node) {
  return node.is_table();
}

}  // namespace

void StudyReader::ReadParameters(const toml::table& table,
                                 const plugin::ModuleDescription& description,
                                 StudyModule& module) {
  const toml::node* node = table.get("parameters");
  const toml::table* given = node == nullptr ? nullptr : node->as_table();
  if (node != nullptr && given == nullptr) {
    complaints_.Error(codes::kWrongType,
                      complaints_.Span(*node),
                      fmt::format("'parameters' must be a table, not {}", TypeName(*node)));
    return;
  }
  std::vector<std::string> names;
  for (const ParameterDescription& parameter : description.parameters) {
    if (!parameter.fixed) names.push_back(parameter.name);
  }
  if (given != nullptr) {
    for (const auto& [key, value] : *given) {
      if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
      complaints_.Error(
          codes::kUnknownParameter,
          complaints_.Span(key.source()),
          fmt::format("'{}' lets no parameter '{}' be chosen", description.id, key.str()),
          DidYouMean(key.str(), names));
    }
  }
  for (const ParameterDescription& parameter : description.parameters) {
    std::vector<double> numbers(static_cast<std::size_t>(parameter.Numbers()), 0.0);
    for (std::size_t i = 0; i < parameter.default_value.size(); ++i) {
      numbers[i] = parameter.default_value[i] * parameter.ToInternal();
    }
    const toml::node* value =
        given == nullptr || parameter.fixed ? nullptr : given->get(parameter.name);
    if (value != nullptr) {
      StudyParameter read{.name = parameter.name,
                          .offset = static_cast<int>(module.defaults.size()),
                          .count = parameter.Numbers(),
                          .angle = parameter.angle()};
      if (ReadValues(*value, parameter, read)) {
        if (read.levels.size() == 1) numbers = read.levels[0].numbers;
        if (read.range) std::fill(numbers.begin(), numbers.end(), read.start);
        module.parameters.push_back(std::move(read));
      }
    } else if (parameter.default_value.empty()) {
      complaints_.Error(codes::kMissingParameter,
                        given != nullptr ? complaints_.Span(*given) : module.place,
                        fmt::format("'{}' needs the parameter '{}': {}",
                                    description.id,
                                    parameter.name,
                                    parameter.meaning),
                        fmt::format("a value, {{ levels = […] }} or {{ range = [a, b] }}"));
    }
    module.defaults.insert(module.defaults.end(), numbers.begin(), numbers.end());
  }
}

void StudyReader::ReadHome(const toml::table& table,
                           const plugin::ModuleDescription& description,
                           StudyModule& module) {
  module.home.assign(description.letters.size(), 0.0);
  const toml::node* node = table.get("home");
  if (node == nullptr) return;
  const toml::table* given = node->as_table();
  if (given == nullptr) {
    complaints_.Error(codes::kWrongType,
                      complaints_.Span(*node),
                      fmt::format("'home' must be a table, not {}", TypeName(*node)));
    return;
  }
  std::vector<std::string> translations;
  for (const char letter : description.letters) {
    if (!formula::Axis{.letter = letter}.rotary()) translations.emplace_back(1, letter);
  }
  for (const auto& [key, value] : *given) {
    if (std::find(translations.begin(), translations.end(), key.str()) == translations.end()) {
      complaints_.Error(
          codes::kBadHome,
          complaints_.Span(key.source()),
          fmt::format("'{}' is no translation of '{}'", key.str(), description.id),
          translations.empty() ? "" : fmt::format("known are: {}", fmt::join(translations, ", ")));
      continue;
    }
    StudyParameter read{.name = fmt::format("home.{}", key.str()),
                        .coordinate = static_cast<int>(description.letters.find(key.str()))};
    if (!ReadValues(value, HomeDescription(), read)) continue;
    double& home = module.home[static_cast<std::size_t>(read.coordinate)];
    if (read.levels.size() == 1) home = read.levels[0].numbers[0];
    if (read.range) home = read.start;
    module.parameters.push_back(std::move(read));
  }
}

bool StudyReader::ReadValues(const toml::node& node,
                             const ParameterDescription& description,
                             StudyParameter& parameter) {
  if (IsChoice(node)) return ReadChoices(*node.as_table(), description, parameter);
  auto level = ReadLevel(node, description);
  if (!level) return false;
  parameter.levels.push_back(std::move(*level));
  return true;
}

bool StudyReader::ReadChoices(const toml::table& table,
                              const ParameterDescription& description,
                              StudyParameter& parameter) {
  const toml::node* levels = table.get("levels");
  const toml::node* range = table.get("range");
  static const std::vector<std::string> kKnown{"levels", "range", "start"};
  for (const auto& [key, value] : table) {
    if (std::find(kKnown.begin(), kKnown.end(), key.str()) != kKnown.end()) continue;
    complaints_.Error(codes::kUnknownKey,
                      complaints_.Span(key.source()),
                      fmt::format("unknown key '{}' of '{}'", key.str(), description.name),
                      DidYouMean(key.str(), kKnown));
  }
  if ((levels == nullptr) == (range == nullptr)) {
    complaints_.Error(codes::kMissingKey,
                      complaints_.Span(table),
                      fmt::format("'{}' needs either 'levels' or 'range'", description.name),
                      "levels = [700, 820] to choose from, range = [600, 900] to size");
    return false;
  }
  if (range != nullptr) {
    const auto interval = JudgeInterval(*range, "'range'", complaints_);
    if (!interval) return false;
    const double start = NumberAt(table, "start").value_or(0.5 * ((*interval)[0] + (*interval)[1]));
    const bool low = description.lower && (*interval)[0] < *description.lower;
    const bool high = description.upper && (*interval)[1] > *description.upper;
    if (low || high || start < (*interval)[0] || start > (*interval)[1]) {
      complaints_.Error(
          codes::kOutOfRange,
          complaints_.Span(low || high ? *range : *table.get("start")),
          low || high ? fmt::format("'{}' cannot go so far", description.name)
                      : fmt::format("'start' of '{}' lies outside its range", description.name),
          description.meaning);
      return false;
    }
    const double unit = description.ToInternal();
    parameter.range = Interval{(*interval)[0] * unit, (*interval)[1] * unit};
    parameter.start = start * unit;
    return true;
  }
  const toml::array* list = levels->as_array();
  if (list == nullptr || list->empty()) {
    complaints_.Error(codes::kWrongType,
                      complaints_.Span(*levels),
                      fmt::format("'levels' of '{}' must be a list of values", description.name));
    return false;
  }
  for (const toml::node& element : *list) {
    auto level = ReadLevel(element, description);
    if (!level) return false;
    if (!element.is_number()) level->name = std::to_string(parameter.levels.size() + 1);
    const bool twice = std::any_of(parameter.levels.begin(),
                                   parameter.levels.end(),
                                   [&](const Level& other) { return other.name == level->name; });
    if (twice) {
      complaints_.Error(codes::kNameTaken,
                        complaints_.Span(element),
                        fmt::format("level {} stands twice", level->name));
      return false;
    }
    parameter.levels.push_back(std::move(*level));
  }
  return true;
}

std::optional<Level> StudyReader::ReadLevel(const toml::node& node,
                                            const ParameterDescription& description) {
  Level level;
  if (!Flatten(node, description, level.numbers)) return std::nullopt;
  const auto wanted = static_cast<std::size_t>(description.Numbers());
  const bool for_all = node.is_number() && description.shape == plugin::ParameterShape::kNumbers;
  if (for_all) level.numbers.assign(wanted, level.numbers[0]);
  if (level.numbers.size() != wanted) {
    complaints_.Error(
        codes::kWrongCount,
        complaints_.Span(node),
        fmt::format(
            "'{}' needs {} numbers, not {}", description.name, wanted, level.numbers.size()),
        description.meaning);
    return std::nullopt;
  }
  level.name = node.is_number() ? fmt::format("{}", *NumberOf(&node)) : "1";
  return level;
}

bool StudyReader::Flatten(const toml::node& node,
                          const ParameterDescription& description,
                          std::vector<double>& numbers) {
  if (const toml::array* list = node.as_array()) {
    return std::all_of(list->begin(), list->end(), [&](const toml::node& element) {
      return Flatten(element, description, numbers);
    });
  }
  const auto value = JudgeNumber(node, fmt::format("'{}'", description.name), complaints_);
  if (!value) return false;
  const bool low = description.lower && *value < *description.lower;
  const bool high = description.upper && *value > *description.upper;
  if (low || high) {
    complaints_.Error(codes::kOutOfRange,
                      complaints_.Span(node),
                      fmt::format("'{}' must be at {} {} {}, not {}",
                                  description.name,
                                  low ? "least" : "most",
                                  low ? *description.lower : *description.upper,
                                  description.unit,
                                  *value),
                      description.meaning);
    return false;
  }
  numbers.push_back(*value * description.ToInternal());
  return true;
}

}  // namespace kompono::synthesis
