// SPDX-License-Identifier: Apache-2.0
#include "kompono/layout/numbers.hpp"

#include "number_places.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kompono/geometry/pose.hpp"

namespace kompono::layout {
namespace {

using Path = std::vector<std::string>;

Path Below(Path path, std::string key) {
  path.push_back(std::move(key));
  return path;
}

class Collector {
 public:
  Collector(const Layout& layout, const plugin::Registry& registry)
      : layout_(layout), registry_(registry) {}

  std::vector<ValuePlace> Collect() {
    for (const Block& block : layout_.blocks) AddBlock(block);
    for (const Axis& axis : layout_.axes) {
      const Path path{"axis", axis.name};
      AddPlacement(axis.name, axis.frame, path, false);
      AddZero(axis.name, axis.drive, IsRotaryLetter(axis.letter), path);
    }
    if (layout_.formula.open_base)
      AddPlacement("open_base", layout_.open_base, {"open_base"}, true);
    for (const End& end : layout_.ends) AddEnd(end);
    return std::move(places_);
  }

 private:
  void AddBlock(const Block& block) {
    const Path path{"block", block.name};
    AddParameters(block.name, block.module, block.parameters, path);
    AddPlacement(block.name + ".mount", block.mount, Below(path, "mount"), true);
    const plugin::ModuleDescription* module = registry_.Find(block.module);
    if (module == nullptr) return;
    for (std::size_t i = 0; i < block.drives.size() && i < module->drives.size(); ++i) {
      const auto& drive = module->drives[i];
      AddZero(block.name + "." + drive.name,
              block.drives[i],
              drive.rotary,
              Below(Below(path, "drive"), drive.name));
    }
  }

  void AddEnd(const End& end) {
    const std::size_t first = places_.size();
    const Path path{end.table};
    AddParameters(end.name, end.module, end.parameters, path);
    AddPlacement(end.name + ".mount", end.mount, Below(path, "mount"), true);
    if (end.table == end.name) return;
    for (std::size_t i = first; i < places_.size(); ++i) {
      for (Number& number : places_[i].numbers) {
        std::vector<std::string> others{number.name};
        others.insert(others.end(), number.other_names.begin(), number.other_names.end());
        for (const std::string& name : others)
          number.other_names.push_back(end.table + name.substr(end.name.size()));
      }
    }
  }

  void AddParameters(const std::string& owner,
                     const std::string& module_id,
                     const std::vector<double>& values,
                     const Path& path) {
    const plugin::ModuleDescription* module = registry_.Find(module_id);
    if (module == nullptr) return;
    std::size_t at = 0;
    for (const plugin::ParameterDescription& parameter : module->parameters) {
      const bool listed = parameter.shape != plugin::ParameterShape::kNumber;
      ValuePlace place{.path = Below(Below(path, "parameters"), parameter.name),
                       .columns = parameter.shape == plugin::ParameterShape::kNumbers
                                      ? static_cast<std::size_t>(parameter.count)
                                  : listed ? 3U
                                           : 0U,
                       .points = parameter.shape == plugin::ParameterShape::kPoints,
                       .numbers = {}};
      for (const std::string& name : parameter.NumberNames()) {
        place.numbers.push_back({.name = fmt::format("{}.{}", owner, name),
                                 .other_names = {},
                                 .value = at < values.size() ? values[at] : 0.0,
                                 .angle = parameter.angle(),
                                 .pure = parameter.unit == "1"});
        ++at;
      }
      if (!parameter.fixed) places_.push_back(std::move(place));
    }
  }

  void AddPlacement(const std::string& owner,
                    const Placement& placement,
                    const Path& path,
                    bool short_names) {
    for (const bool angle : {false, true}) {
      const std::string key = angle ? "rotation" : "position";
      ValuePlace place{.path = Below(path, key), .columns = 3, .points = false, .numbers = {}};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::string letter(1, (angle ? "abc" : "xyz")[i]);
        std::string brief = fmt::format("{}.{}", owner, letter);
        std::string full = fmt::format("{}.{}.{}", owner, key, letter);
        if (!short_names) std::swap(brief, full);
        place.numbers.push_back(
            {.name = std::move(brief),
             .other_names = {std::move(full)},
             .value = angle ? placement.rotation_rad[i] : placement.position_mm[i],
             .angle = angle});
      }
      places_.push_back(std::move(place));
    }
  }

  void AddZero(const std::string& owner, const Drive& drive, bool rotary, const Path& path) {
    const Number zero{
        .name = owner + ".zero", .other_names = {}, .value = drive.zero, .angle = rotary};
    places_.push_back({Below(path, "zero"), 0, false, {zero}});
  }

  const Layout& layout_;
  const plugin::Registry& registry_;
  std::vector<ValuePlace> places_;
};

/// Which beginnings of `name` the pattern matches, by length.
std::vector<bool> MatchedLengths(std::string_view pattern, std::string_view name) {
  std::vector<bool> matched(name.size() + 1, false);
  matched[0] = true;
  for (const char c : pattern) {
    if (c == '*') {
      for (std::size_t i = 1; i < matched.size(); ++i) matched[i] = matched[i] || matched[i - 1];
      continue;
    }
    for (std::size_t i = name.size(); i > 0; --i) matched[i] = matched[i - 1] && name[i - 1] == c;
    matched[0] = false;
  }
  return matched;
}

}  // namespace

std::vector<ValuePlace> ValuePlacesOf(const Layout& layout, const plugin::Registry& registry) {
  return Collector(layout, registry).Collect();
}

std::vector<Number> NumbersOf(const Layout& layout, const plugin::Registry& registry) {
  std::vector<Number> numbers;
  for (ValuePlace& place : ValuePlacesOf(layout, registry)) {
    for (Number& number : place.numbers) numbers.push_back(std::move(number));
  }
  return numbers;
}

bool MatchesPattern(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return false;
  const std::vector<bool> matched = MatchedLengths(pattern, name);
  if (matched[name.size()]) return true;
  for (std::size_t i = 1; i < name.size(); ++i) {
    if (matched[i] && (name[i] == '.' || name[i] == '[')) return true;
  }
  return false;
}

}  // namespace kompono::layout
