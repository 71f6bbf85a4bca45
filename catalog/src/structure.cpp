// SPDX-License-Identifier: Apache-2.0
#include "structure.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <variant>

#include "kompono/catalog/search.hpp"
#include "kompono/formula/equivalence.hpp"

namespace kompono::catalog {
namespace {

using formula::Axis;
using formula::Chain;
using formula::Fork;
using formula::Formula;
using formula::Group;
using formula::Item;
using formula::Leaf;
using nlohmann::ordered_json;

const char* Word(formula::Orientation orientation) {
  switch (orientation) {
    case formula::Orientation::kHorizontal:
      return "horizontal";
    case formula::Orientation::kVertical:
      return "vertical";
    case formula::Orientation::kInclined:
      return "inclined";
    case formula::Orientation::kNone:
      break;
  }
  return "";
}

const char* Word(formula::LeafKind kind) {
  switch (kind) {
    case formula::LeafKind::kPart:
      return "part";
    case formula::LeafKind::kTool:
      return "tool";
    case formula::LeafKind::kProcess:
      break;
  }
  return "process";
}

ordered_json ChainJson(const Chain& chain);

ordered_json AxisJson(const Axis& axis) {
  ordered_json json{{"axis", axis.Name()}, {"working", axis.working}};
  if (axis.orientation != formula::Orientation::kNone) json["orientation"] = Word(axis.orientation);
  if (!axis.block.empty()) json["block"] = axis.block;
  return json;
}

struct ItemJson {
  ordered_json operator()(const Axis& axis) const { return AxisJson(axis); }
  ordered_json operator()(const Group& group) const {
    ordered_json axes = ordered_json::array();
    for (const Axis& axis : group.axes) axes.push_back(AxisJson(axis));
    ordered_json json{{"group", std::move(axes)}};
    if (group.orientation != formula::Orientation::kNone)
      json["orientation"] = Word(group.orientation);
    if (!group.block.empty()) json["block"] = group.block;
    return json;
  }
  ordered_json operator()(const Leaf& leaf) const {
    return {{"leaf", leaf.Name()}, {"kind", Word(leaf.kind)}};
  }
  ordered_json operator()(const Fork& fork) const {
    ordered_json branches = ordered_json::array();
    for (const Chain& branch : fork.branches) branches.push_back(ChainJson(branch));
    return {{"fork", std::move(branches)}, {"count", fork.count}};
  }
};

ordered_json ChainJson(const Chain& chain) {
  ordered_json json = ordered_json::array();
  for (const Item& item : chain) json.push_back(std::visit(ItemJson{}, item));
  return json;
}

/// Walks one side of the formula from the workpiece or towards the tool.
class FeatureList {
 public:
  void Add(std::string feature) { features_.push_back(std::move(feature)); }

  void AddChain(const Chain& chain, const std::string& side) {
    std::string before;
    for (const Item& item : chain) {
      std::string name;
      if (const auto* axis = std::get_if<Axis>(&item)) {
        name = AddAxis(*axis, side);
      } else if (const auto* group = std::get_if<Group>(&item)) {
        name = AddGroup(*group, side);
      } else if (const auto* leaf = std::get_if<Leaf>(&item)) {
        Add(side + " ends in " + Word(leaf->kind) + leaf->plane);
      } else if (const auto* fork = std::get_if<Fork>(&item)) {
        for (int i = 0; i < std::min(fork->count, kMostBranches); ++i) {
          Add(side + " branch");
          for (const Chain& branch : fork->branches) AddChain(branch, side);
        }
      }
      if (!name.empty() && !before.empty()) Add(fmt::format("{} {}>{}", side, before, name));
      if (!name.empty()) before = std::move(name);
    }
  }

  [[nodiscard]] std::vector<std::string> Take() {
    std::sort(features_.begin(), features_.end());
    return std::move(features_);
  }

 private:
  static constexpr int kMostBranches = 16;  // "999(part C)" has no more structure than that

  std::string AddAxis(const Axis& axis, const std::string& side) {
    std::string letter(1, axis.letter);
    Add(fmt::format("{} {}", side, letter));
    Add(fmt::format("{} {}", axis.working ? "works" : "sets", letter));
    if (axis.orientation != formula::Orientation::kNone)
      Add(fmt::format("spindle {}", Word(axis.orientation)));
    return letter;
  }
  std::string AddGroup(const Group& group, const std::string& side) {
    std::string letters;
    for (const Axis& axis : group.axes) letters += AddAxis(axis, side);
    std::sort(letters.begin(), letters.end());
    Add(fmt::format("group ({})", letters));
    Add(fmt::format("{} ({})", side, letters));
    return "(" + letters + ")";
  }

  std::vector<std::string> features_;
};

Motion MotionOf(const Axis& axis, Side side, const std::string& block) {
  Axis bare = axis;
  bare.block.clear();
  return {.axis = formula::ItemText(bare), .side = side, .working = axis.working, .block = block};
}

void AddMotions(const Chain& chain, Side side, std::vector<Motion>& motions) {
  for (const Item& item : chain) {
    if (const auto* axis = std::get_if<Axis>(&item)) {
      motions.push_back(MotionOf(*axis, side, axis->block));
    } else if (const auto* group = std::get_if<Group>(&item)) {
      for (const Axis& member : group->axes)
        motions.push_back(MotionOf(member, side, group->block));
    } else if (const auto* fork = std::get_if<Fork>(&item)) {
      for (const Chain& branch : fork->branches) AddMotions(branch, side, motions);
    }
  }
}

}  // namespace

std::string TreeJson(std::string_view text) {
  const Parsed<Formula> formula = formula::ParseFormula(text);
  if (!formula) return "";
  return ordered_json{{"left", ChainJson(formula->left)},
                      {"base", formula->open_base ? "open" : "closed"},
                      {"right", ChainJson(formula->right)}}
      .dump();
}

FormulaFacts FactsOf(std::string_view text) {
  const Parsed<Formula> formula = formula::ParseFormula(text);
  FormulaFacts facts;
  if (!formula) {
    facts.open_base = text.find("O|O") != std::string_view::npos;
    return facts;
  }
  facts.distribution = formula::DistributionKey(*formula);
  facts.relative_motion = formula::RelativeMotionKey(*formula);
  facts.open_base = formula->open_base;
  AddMotions(formula->left, Side::kWorkpiece, facts.motions);
  AddMotions(formula->right, Side::kTool, facts.motions);
  return facts;
}

std::vector<std::string> StructureFeatures(const Formula& formula,
                                           const std::vector<std::string>& modules) {
  FeatureList features;
  features.AddChain(formula.left, "part side");
  features.AddChain(formula.right, "tool side");
  features.Add(formula.open_base ? "base open" : "base closed");
  for (const std::string& module : modules) features.Add("module " + module);
  return features.Take();
}

double Similarity(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::size_t shared = 0;
  for (auto i = a.begin(), k = b.begin(); i != a.end() && k != b.end();) {
    const int order = i->compare(*k);
    shared += order == 0 ? 1 : 0;
    i += order <= 0 ? 1 : 0;
    k += order >= 0 ? 1 : 0;
  }
  const std::size_t together = a.size() + b.size() - shared;
  return together == 0 ? 1.0 : static_cast<double>(shared) / static_cast<double>(together);
}

}  // namespace kompono::catalog
