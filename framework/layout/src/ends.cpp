// SPDX-License-Identifier: Apache-2.0
// Workpieces, tools and processes: [part], [tool2], [process].
#include "keys.hpp"
#include "reader.hpp"
#include "shape.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace kompono::layout {
namespace {

struct Place {
  std::string end;                ///< name of the end
  std::vector<std::string> keys;  ///< tables that may describe it, the first being its own
};

std::string NameWithoutPlane(formula::Leaf leaf) {
  leaf.plane.clear();
  return leaf.Name();
}

/// Every end of the formula and the tables it may be described in.
std::vector<Place> PlacesOf(formula::Formula& formula) {
  std::vector<formula::Leaf> leaves;
  ForEachItem(formula, [&leaves](formula::Item& item) {
    if (const auto* leaf = std::get_if<formula::Leaf>(&item)) leaves.push_back(*leaf);
  });
  const auto count = [&leaves](formula::LeafKind kind) {
    return std::count_if(
        leaves.begin(), leaves.end(), [kind](const auto& l) { return l.kind == kind; });
  };
  const bool lone_process = count(formula::LeafKind::kProcess) == 1;
  const bool no_tool = count(formula::LeafKind::kTool) == 0;
  std::vector<Place> places;
  for (const formula::Leaf& leaf : leaves) {
    Place place{.end = NameWithoutPlane(leaf), .keys = {NameWithoutPlane(leaf)}};
    if (leaf.kind == formula::LeafKind::kProcess && lone_process) {
      place.keys.emplace_back("process");
      if (no_tool) place.keys.emplace_back("tool");
    }
    const bool seen = std::any_of(
        places.begin(), places.end(), [&place](const Place& p) { return p.end == place.end; });
    if (!seen) places.push_back(std::move(place));
  }
  return places;
}

bool IsEndKey(std::string_view key) {
  const KeyRule* rule = FileRule().Find(key);
  return rule != nullptr && rule->table == FileRule().Find("tool")->table;
}

}  // namespace

void LayoutReader::ReadEnds() {
  std::vector<Place> places;
  if (formula_good_) places = PlacesOf(layout_.formula);
  std::map<std::string, std::string> end_of;  // table -> end
  for (const Place& place : places) {
    for (const std::string& key : place.keys) end_of[key] = place.end;
  }
  std::map<std::string, std::string> found;  // end -> table
  for (const auto& [key, node] : root_) {
    const std::string name(key.str());
    if (!IsEndKey(name) || !node.is_table()) continue;
    const auto of = end_of.find(name);
    if (of == end_of.end()) {
      static_cast<void>(ReadEnd(name, node.as_table()));  // its own faults count all the same
      if (!formula_good_) continue;
      std::vector<std::string> known;
      known.reserve(end_of.size());
      for (const auto& [table, end] : end_of) known.push_back(table);
      complaints_.Error(codes::kUnknownEnd,
                        complaints_.Span(key.source()),
                        fmt::format("the formula has no '{}'", name),
                        fmt::format("its ends are described in: {}", fmt::join(known, ", ")));
    } else if (!found.emplace(of->second, name).second) {
      complaints_.Error(
          codes::kUnknownEnd,
          complaints_.Span(key.source()),
          fmt::format("'{}' is described in [{}] already", of->second, found[of->second]),
          "leave one of the two tables");
    }
  }
  for (const Place& place : places) {
    const auto table = found.find(place.end);
    End end = ReadEnd(place.end, table == found.end() ? nullptr : TableAt(root_, table->second));
    end.table = table == found.end() ? place.keys.back() : table->second;
    layout_.ends.push_back(std::move(end));
  }
}

End LayoutReader::ReadEnd(const std::string& name, const toml::table* table) {
  End end;
  end.name = name;
  if (table == nullptr) return end;
  end.mount = ReadPlacement(TableAt(*table, "mount"));
  if (const toml::node* state = table->get("state"))
    end.state =
        static_cast<int>(std::max<std::int64_t>(0, state->value_exact<std::int64_t>().value_or(0)));
  if (!table->contains("module")) {
    for (const std::string_view key : {"parameters", "station", "state"}) {
      if (!table->contains(key)) continue;
      complaints_.Error(codes::kNeedsModule,
                        complaints_.Span(table->find(key)->first.source()),
                        fmt::format("'{}' means nothing without a 'module'", key),
                        "add the unit, as in module = \"tool\"; 'kompono plugins' lists them");
    }
    return end;
  }
  const plugin::ModuleDescription* module = ReadModule(*table, plugin::ModuleKind::kUnit);
  if (module == nullptr) {
    names_known_ = false;
    return end;
  }
  end.module = module->id;
  if (auto parameters = ReadParameters(*table, *module, units_, complaints_))
    end.parameters = std::move(*parameters);
  ReadStation(*table, *module, end);
  JudgeStates(*table, *module, end);
  return end;
}

}  // namespace kompono::layout
