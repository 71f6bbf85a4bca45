// SPDX-License-Identifier: Apache-2.0
#include "compiled.hpp"
#include "diagram.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "kompono/synthesis/space.hpp"

namespace kompono::synthesis {
namespace {

using Pair = std::pair<Choice, Choice>;

Count CountUnder(const Space& space, const Fixing& fixed, const Judgement& judgement) {
  return Diagram(Compiled(space, fixed, judgement), EnumerationOptions{}.most_nodes).count();
}

/// Only this choice of its feature; nothing if `fixed` does not let it through.
std::optional<Fixing> Narrowed(const Fixing& fixed, Choice choice) {
  Fixing narrowed;
  bool named = false;
  bool among = false;
  for (const Choice& other : fixed) {
    if (other.feature != choice.feature) {
      narrowed.push_back(other);
    } else {
      named = true;
      among = among || other == choice;
    }
  }
  if (named && !among) return std::nullopt;
  narrowed.push_back(choice);
  return narrowed;
}

/// Selections whose only fault is this pair.
Count Gained(const Space& space, const Fixing& fixed, Judgement judgement, const Pair& pair) {
  auto narrowed = Narrowed(fixed, pair.first);
  if (narrowed && pair.second != pair.first) narrowed = Narrowed(*narrowed, pair.second);
  if (!narrowed) return 0;
  judgement.lifted = pair;
  return CountUnder(space, *narrowed, judgement);
}

void ExplainPairs(const Space& space,
                  const Fixing& fixed,
                  const Judgement& judgement,
                  std::size_t most_pairs,
                  Effects& effects) {
  std::set<Pair> structural;
  std::set<Pair> seen;
  for (const Space::Conflict& conflict : space.conflicts()) {
    if (space.rules()[static_cast<std::size_t>(conflict.rule)].structural) {
      structural.emplace(conflict.first, conflict.second);
    }
  }
  for (const Space::Conflict& conflict : space.conflicts()) {
    const Pair pair{conflict.first, conflict.second};
    if (judgement.off[static_cast<std::size_t>(conflict.rule)] || structural.contains(pair)) {
      continue;
    }
    if (!seen.insert(pair).second) continue;
    const Count gained = Gained(space, fixed, judgement, pair);
    if (gained > 0) effects.pairs.push_back({conflict, gained});
  }
  std::stable_sort(effects.pairs.begin(), effects.pairs.end(), [](const auto& a, const auto& b) {
    return a.gained > b.gained;
  });
  if (effects.pairs.size() > most_pairs) effects.pairs.resize(most_pairs);
}

}  // namespace

Effects Explain(const Space& space, const Fixing& fixed, std::size_t most_pairs) {
  Judgement active;
  Judgement structural;
  for (std::size_t rule = 0; rule < space.rules().size(); ++rule) {
    active.off.push_back(space.off(static_cast<int>(rule)));
    structural.off.push_back(!space.rules()[rule].structural);
  }
  Effects effects;
  effects.raw = space.Raw();
  effects.structural = CountUnder(space, fixed, structural);
  effects.count = CountUnder(space, fixed, active);
  for (std::size_t rule = 0; rule < space.rules().size(); ++rule) {
    if (active.off[rule] || space.rules()[rule].structural) continue;
    std::set<Pair> pairs;
    for (const Space::Conflict& conflict : space.conflicts()) {
      if (static_cast<std::size_t>(conflict.rule) == rule) {
        pairs.emplace(conflict.first, conflict.second);
      }
    }
    Judgement without = active;
    without.off[rule] = true;
    const Count gained =
        effects.count == kTooMany ? 0 : CountUnder(space, fixed, without) - effects.count;
    effects.rules.push_back({static_cast<int>(rule), pairs.size(), gained});
  }
  std::stable_sort(effects.rules.begin(), effects.rules.end(), [](const auto& a, const auto& b) {
    return a.gained > b.gained;
  });
  ExplainPairs(space, fixed, active, most_pairs, effects);
  return effects;
}

}  // namespace kompono::synthesis
