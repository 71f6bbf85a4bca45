// SPDX-License-Identifier: Apache-2.0
#include "diagram.hpp"

#include <algorithm>
#include <utility>

namespace kompono::synthesis {
namespace {

/// States of one layer, equal ones once. Open addressing over the numbers of the states.
class StateTable {
 public:
  StateTable(std::size_t words, std::size_t first_word) : words_(words), first_word_(first_word) {
    slots_.assign(1024, kFree);
  }

  /// The number of an equal state, or of this one as a new one.
  [[nodiscard]] std::uint32_t Number(const Word* state) {
    if (2 * (size_ + 1) > slots_.size()) Grow();
    std::size_t slot = Hash(state) & (slots_.size() - 1);
    while (slots_[slot] != kFree) {
      if (Equal(state, states_.data() + slots_[slot] * words_)) return slots_[slot];
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = static_cast<std::uint32_t>(size_);
    states_.insert(states_.end(), state, state + words_);
    return static_cast<std::uint32_t>(size_++);
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::vector<Word> Take() { return std::move(states_); }

 private:
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  [[nodiscard]] std::size_t Hash(const Word* state) const {
    Word hash = 0x9e3779b97f4a7c15U;
    for (std::size_t i = first_word_; i < words_; ++i) {
      hash = (hash ^ state[i]) * 0xff51afd7ed558ccdU;
      hash ^= hash >> 32U;
    }
    return hash;
  }
  [[nodiscard]] bool Equal(const Word* a, const Word* b) const {
    return std::equal(a + first_word_, a + words_, b + first_word_);
  }
  void Grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::size_t i = 0; i < size_; ++i) {
      std::size_t slot = Hash(states_.data() + i * words_) & (slots_.size() - 1);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<std::uint32_t>(i);
    }
  }

  std::size_t words_;
  std::size_t first_word_;
  std::size_t size_ = 0;
  std::vector<std::uint32_t> slots_;
  std::vector<Word> states_;
};

}  // namespace

Diagram::Diagram(const Compiled& compiled, std::size_t most_nodes) : words_(compiled.words()) {
  if (!compiled.possible() || compiled.features() == 0) return;
  states_.assign(compiled.start().begin(), compiled.start().end());
  layers_.push_back({.arcs = {}, .first_arc = {}, .counts = std::vector<Count>(1)});
  nodes_ = 1;
  while (layers_.size() < compiled.features() &&
         Extend(compiled, most_nodes > nodes_ ? most_nodes - nodes_ : 0)) {
  }
  whole_ = layers_.size() == compiled.features();
  CountAll(compiled);
}

/// One layer more; false, and nothing is changed, if it had more than `room` nodes.
bool Diagram::Extend(const Compiled& compiled, std::size_t room) {
  const std::size_t depth = layers_.size() - 1;
  const std::size_t here = layers_[depth].counts.size();
  StateTable next(words_, compiled.FirstWord(depth + 1));
  std::vector<Word> child(words_, 0);
  std::vector<Arc> arcs;
  std::vector<std::uint32_t> first_arc{0};
  first_arc.reserve(here + 1);
  for (std::uint32_t node = 0; node < here; ++node) {
    const Word* state = StateOf(node);
    compiled.EachAlternative(depth, state, [&](std::size_t alternative) {
      if (!compiled.Choose(depth, alternative, state, child.data())) return true;
      compiled.Forget(depth + 1, child.data());
      arcs.push_back({static_cast<std::uint16_t>(alternative), next.Number(child.data())});
      return next.size() <= room;
    });
    if (next.size() > room) return false;
    first_arc.push_back(static_cast<std::uint32_t>(arcs.size()));
  }
  layers_[depth].arcs = std::move(arcs);
  layers_[depth].first_arc = std::move(first_arc);
  layers_.push_back({.arcs = {}, .first_arc = {}, .counts = std::vector<Count>(next.size())});
  nodes_ += next.size();
  states_ = next.Take();
  return true;
}

/// From the last layer up; arcs that lead to nothing are taken out.
void Diagram::CountAll(const Compiled& compiled) {
  std::vector<Word> scratch = compiled.Scratch();
  std::vector<Count>& last = layers_.back().counts;
  for (std::uint32_t node = 0; node < last.size(); ++node) {
    last[node] = compiled.CountBelow(depth(), StateOf(node), scratch.data());
  }
  for (std::size_t k = layers_.size() - 1; k-- > 0;) {
    Layer& layer = layers_[k];
    const std::vector<Count>& below = layers_[k + 1].counts;
    std::uint32_t kept = 0;
    std::uint32_t begin = 0;
    for (std::size_t node = 0; node < layer.counts.size(); ++node) {
      const std::uint32_t end = layer.first_arc[node + 1];
      Count count = 0;
      for (std::uint32_t arc = begin; arc < end; ++arc) {
        if (below[layer.arcs[arc].node] == 0) continue;
        count = SumOf(count, below[layer.arcs[arc].node]);
        layer.arcs[kept++] = layer.arcs[arc];
      }
      layer.counts[node] = count;
      layer.first_arc[node + 1] = kept;
      begin = end;
    }
    layer.arcs.resize(kept);
  }
}

}  // namespace kompono::synthesis
