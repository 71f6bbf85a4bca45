// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_SRC_GRAPH_HPP_
#define KOMPONO_EXPRESSION_SRC_GRAPH_HPP_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kompono/scalar/expression_node.h"

namespace kompono::expression_internal {

using Node = KomponoExpressionNode;
using Index = int32_t;

inline constexpr int kNoVariable = std::numeric_limits<int>::max();

/// How many operands an operation takes, or -1 for a number that is none. Constants and variables
/// take none.
[[nodiscard]] int OperandCount(int32_t operation);
/// Does the operation give a condition?
[[nodiscard]] bool GivesCondition(int32_t operation);
/// Must operand `k` of the operation be a condition?
[[nodiscard]] bool WantsCondition(int32_t operation, int k);
[[nodiscard]] bool IsFunction(int32_t operation);

/// The value of one operation on numbers; conditions are 1 and 0.
[[nodiscard]] double Compute(int32_t operation, double a, double b, double c);

/// What is known of a node without evaluating it.
struct Facts {
  uint64_t hash = 0;        ///< of the structure, the same in every graph
  uint32_t complexity = 0;  ///< operations when written out; stops at the largest number
  uint32_t depth = 0;
  int first_variable = kNoVariable;  ///< smallest variable number inside
  bool total = false;                ///< finite for all finite variables, but for overflow
  bool nonnegative = false;          ///< never below zero where defined
};

/// A growing list of nodes, operands before users, in which equal nodes exist once.
class Graph {
 public:
  Graph() = default;

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] const Node& node(Index i) const { return nodes_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Facts& facts(Index i) const { return facts_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }

  [[nodiscard]] bool IsConstant(Index i) const { return node(i).operation == KOMPONO_CONSTANT; }
  [[nodiscard]] bool IsConstant(Index i, double value) const {
    return IsConstant(i) && node(i).value == value;
  }
  [[nodiscard]] bool Is(Index i, KomponoOperation operation) const {
    return node(i).operation == operation;
  }

  Index Constant(double value);
  Index Variable(int number);
  /// The operation as it is.
  Index Raw(int32_t operation, Index a, Index b = -1, Index c = -1);
  /// The operation with numbers folded and zeros and ones dropped, where neither value nor domain
  /// change.
  Index Apply(int32_t operation, Index a, Index b = -1, Index c = -1);

  Index Add(Index a, Index b) { return Apply(KOMPONO_ADD, a, b); }
  Index Subtract(Index a, Index b) { return Apply(KOMPONO_SUBTRACT, a, b); }
  Index Multiply(Index a, Index b) { return Apply(KOMPONO_MULTIPLY, a, b); }
  Index Divide(Index a, Index b) { return Apply(KOMPONO_DIVIDE, a, b); }
  Index Negate(Index a) { return Apply(KOMPONO_NEGATE, a); }

  /// Conditions have no constants: always is 0 < 1, never 1 < 0.
  Index KnownCondition(bool holds);
  [[nodiscard]] bool IsKnownCondition(Index i, bool holds) const;

 private:
  Index Insert(const Node& node);
  /// The slot that holds the node, or the free one it belongs into.
  [[nodiscard]] std::size_t SlotOf(const Node& node) const;
  void GrowSlots();
  [[nodiscard]] Facts FactsOf(const Node& node) const;
  /// From whether all operands are total and not negative to whether the node is.
  void JudgeRange(const Node& node, Facts* result) const;
  Index ApplySum(int32_t operation, Index a, Index b);
  Index ApplyProduct(int32_t operation, Index a, Index b);
  Index ApplyCondition(int32_t operation, Index a, Index b);
  Index ApplySelect(Index condition, Index a, Index b);

  std::vector<Node> nodes_;
  std::vector<Facts> facts_;
  // Places of nodes by hash, open addressing; the size is a power of two, at most half of it used.
  std::vector<Index> slots_;
};

/// Copies what `roots` need from `from` into `to`, through Raw; returns where the roots are there.
std::vector<Index> CopyInto(Graph& to, std::span<const Node> from, std::span<const Index> roots);

/// Which of the nodes the roots need.
[[nodiscard]] std::vector<bool> Reachable(std::span<const Node> nodes,
                                          std::span<const Index> roots);

/// How often each node is an operand of a reachable node or a root.
[[nodiscard]] std::vector<uint32_t> UseCounts(std::span<const Node> nodes,
                                              std::span<const Index> roots);

}  // namespace kompono::expression_internal

#endif  // KOMPONO_EXPRESSION_SRC_GRAPH_HPP_
