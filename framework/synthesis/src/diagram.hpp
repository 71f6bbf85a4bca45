// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_DIAGRAM_HPP_
#define KOMPONO_SYNTHESIS_DIAGRAM_HPP_

#include "compiled.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kompono::synthesis {

/// The layered decision diagram of a compiled space: a node of layer k is what the first k choices
/// leave for the others, so that all ways to the same rest share it. If the nodes come to more than
/// a cap, the diagram ends at a layer above, whose nodes keep their states and are counted
/// depth-first.
class Diagram {
 public:
  struct Arc {
    std::uint16_t alternative = 0;
    std::uint32_t node = 0;  ///< in the next layer
  };

  Diagram(const Compiled& compiled, std::size_t most_nodes);

  [[nodiscard]] Count count() const { return layers_.empty() ? 0 : layers_[0].counts[0]; }
  [[nodiscard]] std::size_t nodes() const { return nodes_; }
  /// The depth of the last layer; its nodes have states and no arcs.
  [[nodiscard]] std::size_t depth() const { return layers_.empty() ? 0 : layers_.size() - 1; }
  /// Whether states of the last layer need no search: only one feature is left.
  [[nodiscard]] bool whole() const { return whole_; }
  [[nodiscard]] Count CountOf(std::size_t layer, std::uint32_t node) const {
    return layers_[layer].counts[node];
  }
  /// Arcs to nodes with candidates, alternatives ascending.
  [[nodiscard]] std::span<const Arc> ArcsOf(std::size_t layer, std::uint32_t node) const {
    const Layer& here = layers_[layer];
    return std::span(here.arcs).subspan(here.first_arc[node],
                                        here.first_arc[node + 1] - here.first_arc[node]);
  }
  /// The state of a node of the last layer.
  [[nodiscard]] const Word* StateOf(std::uint32_t node) const {
    return states_.data() + node * words_;
  }

 private:
  struct Layer {
    std::vector<Arc> arcs;
    std::vector<std::uint32_t> first_arc;  ///< one more than nodes
    std::vector<Count> counts;
  };

  [[nodiscard]] bool Extend(const Compiled& compiled, std::size_t room);
  void CountAll(const Compiled& compiled);

  std::size_t words_ = 0;
  std::size_t nodes_ = 0;
  bool whole_ = false;
  std::vector<Layer> layers_;
  std::vector<Word> states_;  ///< of the last layer, one after the other
};

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_DIAGRAM_HPP_
