// SPDX-License-Identifier: Apache-2.0
#include "compiled.hpp"
#include "diagram.hpp"

#include <utility>

#include "kompono/diagnostics/expects.hpp"
#include "kompono/synthesis/space.hpp"

namespace kompono::synthesis {

struct Enumeration::State {
  State(const Space& space, const Fixing& fixed, const Judgement& judgement, std::size_t most_nodes)
      : compiled(space, fixed, judgement), diagram(compiled, most_nodes) {}
  Compiled compiled;
  Diagram diagram;
};

namespace {

Judgement JudgementOf(const Space& space) {
  Judgement judgement;
  for (std::size_t rule = 0; rule < space.rules().size(); ++rule) {
    judgement.off.push_back(space.off(static_cast<int>(rule)));
  }
  return judgement;
}

/// Goes through candidates in order: along the arcs of the diagram, below it depth-first.
class Walk {
 public:
  Walk(const Compiled& compiled, const Diagram& diagram, const Enumeration::Visitor& visit)
      : compiled_(compiled),
        diagram_(diagram),
        visit_(visit),
        scratch_(compiled.Scratch()),
        selection_(compiled.features()) {}

  /// From the candidate `first`, whose index is `begin`, to before `end`.
  void Run(const Selection& first, Count begin, Count end) {
    first_ = first;
    index_ = begin;
    end_ = end;
    Node(0, 0, true);
  }

 private:
  /// `on_path`: all choices so far are those of the first candidate, smaller ones are left out.
  bool Node(std::size_t layer, std::uint32_t node, bool on_path) {
    if (layer == diagram_.depth()) return Search(layer, diagram_.StateOf(node), 0, on_path);
    for (const Diagram::Arc& arc : diagram_.ArcsOf(layer, node)) {
      if (on_path && arc.alternative < first_[layer]) continue;
      selection_[layer] = arc.alternative;
      if (!Node(layer + 1, arc.node, on_path && arc.alternative == first_[layer])) return false;
    }
    return true;
  }

  bool Search(std::size_t depth, const Word* state, std::size_t used, bool on_path) {
    const bool last = depth + 1 == compiled_.features();
    Word* child = scratch_.data() + used;
    return compiled_.EachAlternative(depth, state, [&](std::size_t alternative) {
      if (on_path && alternative < first_[depth]) return true;
      selection_[depth] = static_cast<std::uint16_t>(alternative);
      if (last) {
        if (index_ == end_) return false;
        return visit_(index_++, selection_);
      }
      if (!compiled_.Choose(depth, alternative, state, child)) return true;
      return Search(
          depth + 1, child, used + compiled_.words(), on_path && alternative == first_[depth]);
    });
  }

  const Compiled& compiled_;
  const Diagram& diagram_;
  const Enumeration::Visitor& visit_;
  std::vector<Word> scratch_;
  Selection selection_, first_;
  Count index_ = 0;
  Count end_ = 0;
};

/// The alternatives from `depth` on of candidate number `index` below the state.
void UnrankBelow(const Compiled& compiled,
                 std::size_t depth,
                 const Word* from,
                 Count index,
                 Selection& selection) {
  std::vector<Word> scratch = compiled.Scratch();
  std::vector<Word> state(from, from + compiled.words());
  std::vector<Word> child(compiled.words());
  for (; depth < compiled.features(); ++depth) {
    compiled.EachAlternative(depth, state.data(), [&](std::size_t alternative) {
      if (!compiled.Choose(depth, alternative, state.data(), child.data())) return true;
      const Count count = compiled.CountBelow(depth + 1, child.data(), scratch.data());
      if (index >= count) {
        index -= count;
        return true;
      }
      selection[depth] = static_cast<std::uint16_t>(alternative);
      return false;
    });
    std::swap(state, child);
  }
}

/// The reverse; nothing if the selection leads nowhere.
std::optional<Count> RankBelow(const Compiled& compiled,
                               std::size_t depth,
                               const Word* from,
                               const Selection& selection) {
  std::vector<Word> scratch = compiled.Scratch();
  std::vector<Word> state(from, from + compiled.words());
  std::vector<Word> child(compiled.words());
  Count rank = 0;
  for (; depth < compiled.features(); ++depth) {
    if (!compiled.Allows(depth, state.data(), selection[depth])) return std::nullopt;
    compiled.EachAlternative(depth, state.data(), [&](std::size_t alternative) {
      if (alternative >= selection[depth]) return false;
      if (compiled.Choose(depth, alternative, state.data(), child.data())) {
        rank += compiled.CountBelow(depth + 1, child.data(), scratch.data());
      }
      return true;
    });
    if (!compiled.Choose(depth, selection[depth], state.data(), child.data())) return std::nullopt;
    std::swap(state, child);
  }
  return rank;
}

}  // namespace

Enumeration::Enumeration(const Space& space, const Fixing& fixed, EnumerationOptions options)
    : state_(std::make_unique<State>(space, fixed, JudgementOf(space), options.most_nodes)) {}
Enumeration::Enumeration(Enumeration&&) noexcept = default;
Enumeration& Enumeration::operator=(Enumeration&&) noexcept = default;
Enumeration::~Enumeration() = default;

Count Enumeration::count() const {
  return state_->diagram.count();
}
std::size_t Enumeration::nodes() const {
  return state_->diagram.nodes();
}
bool Enumeration::whole() const {
  return state_->diagram.whole();
}

Selection Enumeration::Unrank(Count index) const {
  KOMPONO_EXPECTS(index < count() && count() != kTooMany);
  const Diagram& diagram = state_->diagram;
  Selection selection(state_->compiled.features());
  std::uint32_t node = 0;
  for (std::size_t layer = 0; layer < diagram.depth(); ++layer) {
    for (const Diagram::Arc& arc : diagram.ArcsOf(layer, node)) {
      const Count count = diagram.CountOf(layer + 1, arc.node);
      if (index >= count) {
        index -= count;
        continue;
      }
      selection[layer] = arc.alternative;
      node = arc.node;
      break;
    }
  }
  UnrankBelow(state_->compiled, diagram.depth(), diagram.StateOf(node), index, selection);
  return selection;
}

std::optional<Count> Enumeration::Rank(const Selection& selection) const {
  KOMPONO_EXPECTS(selection.size() == state_->compiled.features());
  const Diagram& diagram = state_->diagram;
  if (diagram.count() == 0) return std::nullopt;
  Count rank = 0;
  std::uint32_t node = 0;
  for (std::size_t layer = 0; layer < diagram.depth(); ++layer) {
    bool found = false;
    for (const Diagram::Arc& arc : diagram.ArcsOf(layer, node)) {
      if (arc.alternative > selection[layer]) break;
      if (arc.alternative == selection[layer]) {
        found = true;
        node = arc.node;
        break;
      }
      rank += diagram.CountOf(layer + 1, arc.node);
    }
    if (!found) return std::nullopt;
  }
  const auto below = RankBelow(state_->compiled, diagram.depth(), diagram.StateOf(node), selection);
  if (!below) return std::nullopt;
  return rank + *below;
}

void Enumeration::Visit(Count begin, Count end, const Visitor& visit) const {
  KOMPONO_EXPECTS(begin <= end && end <= count() && count() != kTooMany);
  if (begin == end) return;
  Walk(state_->compiled, state_->diagram, visit).Run(Unrank(begin), begin, end);
}

Count CountDepthFirst(const Space& space, const Fixing& fixed) {
  const Compiled compiled(space, fixed, JudgementOf(space));
  if (!compiled.possible() || compiled.features() == 0) return 0;
  std::vector<Word> scratch = compiled.Scratch();
  return compiled.CountBelow(0, compiled.start().data(), scratch.data());
}

}  // namespace kompono::synthesis
