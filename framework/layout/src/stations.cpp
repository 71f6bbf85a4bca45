// SPDX-License-Identifier: Apache-2.0
// Station and state of an end against what its unit has; some units count both by a parameter.
#include "reader.hpp"
#include "shape.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::layout {
namespace {

/// 7 of "pocket7"; 0 if the name ends in no digits.
int NumberOfStation(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  int number = 0;
  if (end + 1 < name.size())
    std::from_chars(name.data() + end + 1, name.data() + name.size(), number);
  return number;
}

/// How many stations and states the end's own parameters leave, or nothing without a counter.
std::optional<double> CountOf(const plugin::ModuleDescription& module, const End& end) {
  const plugin::ParameterDescription* counter = module.FindParameter(module.counted_by);
  if (counter == nullptr) return std::nullopt;
  const auto at = static_cast<std::size_t>(counter->offset);
  return at < end.parameters.size() ? std::optional(end.parameters[at]) : std::nullopt;
}

}  // namespace

void LayoutReader::ReadStation(const toml::table& table,
                               const plugin::ModuleDescription& module,
                               End& end) {
  if (!module.stations.empty()) end.station = module.stations.front();
  const auto station = TextAt(table, "station");
  if (!station) return;
  if (std::find(module.stations.begin(), module.stations.end(), *station) !=
      module.stations.end()) {
    end.station = *station;
    return;
  }
  complaints_.Error(codes::kUnknownStation,
                    complaints_.Span(*table.get("station")),
                    fmt::format("'{}' has no station '{}'", module.id, *station),
                    DidYouMean(*station, module.stations));
}

void LayoutReader::JudgeStates(const toml::table& table,
                               const plugin::ModuleDescription& module,
                               const End& end) {
  const auto place = [&](std::string_view key) {
    const toml::node* node = table.get(key);
    return complaints_.Span(node != nullptr ? *node : *table.get("module"));
  };
  int states = module.states;
  if (const auto count = CountOf(module, end)) {
    if (*count != std::floor(*count)) {
      const toml::table* given = TableAt(table, "parameters");
      const toml::node* node = given == nullptr ? nullptr : given->get(module.counted_by);
      complaints_.Error(
          codes::kOutOfRange,
          node == nullptr ? place("parameters") : complaints_.Span(*node),
          fmt::format("'{}' must be a whole number, not {}", module.counted_by, *count),
          module.FindParameter(module.counted_by)->meaning);
      return;
    }
    const int whole = static_cast<int>(*count);
    states = std::min(states, whole + 1);
    if (NumberOfStation(end.station) > whole) {
      complaints_.Error(
          codes::kUnknownStation,
          place("station"),
          fmt::format("'{}' has no station '{}' with {} = {}",
                      module.id,
                      end.station,
                      module.counted_by,
                      whole),
          fmt::format("raise '{}', or name a station up to {}", module.counted_by, whole));
    }
  }
  if (end.state < states) return;
  complaints_.Error(
      codes::kOutOfRange,
      place("state"),
      states == 1 ? fmt::format("'{}' has the state 0 only, not {}", module.id, end.state)
                  : fmt::format("'state' must be between 0 and {}, not {}", states - 1, end.state),
      states == 1 ? "leave 'state' out" : "0: the station itself is in place");
}

}  // namespace kompono::layout
