// SPDX-License-Identifier: Apache-2.0
#include "ways.hpp"

#include <algorithm>

#include "kompono/plugin/capability_words.hpp"

namespace kompono::analysis {
namespace {

/// What all ends of a chain share.
struct Trunk {
  std::set<std::string> moves;
  bool main_motion = false;
};

bool Realises(const layout::Block& block, const formula::Group& group) {
  if (!group.block.empty()) return block.name == group.block;
  return block.letters.size() == group.axes.size() &&
         std::all_of(group.axes.begin(), group.axes.end(), [&block](const formula::Axis& axis) {
           return std::any_of(block.letters.begin(),
                              block.letters.end(),
                              [&axis](const auto& letter) { return letter.axis == axis.Name(); });
         });
}

class Walk {
 public:
  Walk(const layout::Layout& layout, const plugin::Registry& registry)
      : layout_(layout), registry_(registry) {}

  void Chain(const formula::Chain& chain, Trunk trunk) {
    for (const formula::Item& item : chain) Collect(item, trunk);
    for (const formula::Item& item : chain) {
      if (const auto* leaf = std::get_if<formula::Leaf>(&item)) {
        ways_.push_back(WayTo(*leaf, trunk));
      } else if (const auto* fork = std::get_if<formula::Fork>(&item)) {
        for (const formula::Chain& branch : fork->branches) Chain(branch, trunk);
      }
    }
  }

  [[nodiscard]] std::vector<Way> Take() { return std::move(ways_); }

 private:
  void Collect(const formula::Item& item, Trunk& trunk) const {
    if (const auto* axis = std::get_if<formula::Axis>(&item)) {
      if (!axis->block.empty()) {
        CollectGroup({.axes = {*axis}, .orientation = {}, .block = axis->block}, trunk);
        return;
      }
      const layout::Axis* plain = layout_.FindAxis(axis->Name());
      if (axis->orientation != formula::Orientation::kNone) trunk.main_motion = true;
      if (plain != nullptr && !plain->main_motion && axis->working)
        trunk.moves.insert(axis->Name());
    } else if (const auto* group = std::get_if<formula::Group>(&item)) {
      CollectGroup(*group, trunk);
    }
  }

  void CollectGroup(const formula::Group& group, Trunk& trunk) const {
    for (const layout::Block& block : layout_.blocks) {
      if (!Realises(block, group)) continue;
      for (const formula::Axis& axis : group.axes) {
        if (axis.working) trunk.moves.insert(block.name + "." + axis.Name());
      }
      return;
    }
  }

  [[nodiscard]] Way WayTo(formula::Leaf leaf, const Trunk& trunk) const {
    Way way{.leaf = leaf.Name(), .moves = trunk.moves, .main_motion = trunk.main_motion};
    leaf.plane.clear();
    way.end = leaf.Name();
    const layout::End* end = layout_.FindEnd(way.end);
    const plugin::ModuleDescription* module =
        end == nullptr ? nullptr : registry_.Find(end->module);
    if (module != nullptr)
      way.facts.insert(module->capabilities.begin(), module->capabilities.end());
    way.main_motion = way.main_motion || way.Is(plugin::words::kMainMotion);
    // A bare frame is what its word in the formula says.
    if (module == nullptr)
      way.facts.insert(std::string(leaf.kind == formula::LeafKind::kPart
                                       ? plugin::words::kCarriesPart
                                       : plugin::words::kCarriesTool));
    return way;
  }

  const layout::Layout& layout_;
  const plugin::Registry& registry_;
  std::vector<Way> ways_;
};

}  // namespace

std::vector<Way> WaysOf(const formula::Chain& side,
                        const layout::Layout& layout,
                        const plugin::Registry& registry) {
  Walk walk(layout, registry);
  walk.Chain(side, {});
  return walk.Take();
}

}  // namespace kompono::analysis
