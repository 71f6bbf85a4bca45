// SPDX-License-Identifier: Apache-2.0
#include "graph.hpp"
#include "pool.hpp"

#include <array>
#include <utility>

#include "kompono/diagnostics/expects.hpp"
#include "kompono/expression/expression.hpp"

namespace kompono {
namespace {

using expression_internal::Access;
using expression_internal::CopyInto;
using expression_internal::Facts;
using expression_internal::Graph;
using expression_internal::Index;
using expression_internal::Local;
using expression_internal::Node;
using expression_internal::OperandCount;

/// Derivatives by one variable of all nodes of a graph, appended to it. A node that does not depend
/// on the variable has no derivative node at all, so nothing is multiplied by zeros.
class Differentiation {
 public:
  static constexpr Index kZero = -1;

  Differentiation(Graph& graph, std::size_t count, int variable)
      : graph_(graph), derivatives_(count, kZero) {
    for (std::size_t i = 0; i < count; ++i) {
      derivatives_[i] = Of(static_cast<Index>(i), variable);
    }
  }

  [[nodiscard]] Index operator[](Index i) const {
    return derivatives_[static_cast<std::size_t>(i)];
  }

 private:
  Index Of(Index i, int variable) {
    const Node node = graph_.node(i);  // a copy: the graph grows below
    if (node.operation == KOMPONO_VARIABLE) {
      return node.operand[0] == variable ? graph_.Constant(1.0) : kZero;
    }
    if (OperandCount(node.operation) == 0 || expression_internal::GivesCondition(node.operation)) {
      return kZero;
    }
    const Index a = node.operand[0];
    const Index b = node.operand[1];
    switch (node.operation) {
      case KOMPONO_ADD:
        return Sum((*this)[a], (*this)[b]);
      case KOMPONO_SUBTRACT:
        return Sum((*this)[a], Minus((*this)[b]));
      case KOMPONO_MULTIPLY:
        return Sum(Product((*this)[a], b), Product((*this)[b], a));
      case KOMPONO_DIVIDE:  // (a' - (a/b) b') / b
        return Quotient(Sum((*this)[a], Minus(Product((*this)[b], i))), b);
      case KOMPONO_NEGATE:
        return Minus((*this)[a]);
      case KOMPONO_ATAN2:
        return Quotient(Sum(Product((*this)[a], b), Minus(Product((*this)[b], a))),
                        graph_.Add(graph_.Multiply(a, a), graph_.Multiply(b, b)));
      case KOMPONO_SELECT:
        return Choice(a, (*this)[b], (*this)[node.operand[2]]);
      default:
        return (*this)[a] == kZero ? kZero : OfFunction(node.operation, i, a);
    }
  }

  Index OfFunction(int32_t operation, Index value, Index a) {
    const Index da = (*this)[a];
    switch (operation) {
      case KOMPONO_SQRT:
        return Quotient(da, graph_.Multiply(graph_.Constant(2.0), value));
      case KOMPONO_SIN:
        return Product(da, graph_.Apply(KOMPONO_COS, a));
      case KOMPONO_COS:
        return Minus(Product(da, graph_.Apply(KOMPONO_SIN, a)));
      case KOMPONO_TAN:
        return Product(da, graph_.Add(graph_.Constant(1.0), graph_.Multiply(value, value)));
      case KOMPONO_ASIN:
        return Quotient(da, RootOfOneMinusSquare(a));
      case KOMPONO_ACOS:
        return Minus(Quotient(da, RootOfOneMinusSquare(a)));
      case KOMPONO_ATAN:
        return Quotient(da, graph_.Add(graph_.Constant(1.0), graph_.Multiply(a, a)));
      case KOMPONO_ABS:
        return Choice(graph_.Apply(KOMPONO_LESS, a, graph_.Constant(0.0)), Minus(da), da);
      case KOMPONO_EXP:
        return Product(da, value);
      default:  // KOMPONO_LOG
        return Quotient(da, a);
    }
  }

  Index RootOfOneMinusSquare(Index a) {
    return graph_.Apply(KOMPONO_SQRT, graph_.Subtract(graph_.Constant(1.0), graph_.Multiply(a, a)));
  }
  Index Minus(Index a) { return a == kZero ? kZero : graph_.Negate(a); }
  Index Sum(Index a, Index b) {
    if (a == kZero || b == kZero) return a == kZero ? b : a;
    return graph_.Is(b, KOMPONO_NEGATE) ? graph_.Subtract(a, graph_.node(b).operand[0])
                                        : graph_.Add(a, b);
  }
  Index Product(Index a, Index b) { return a == kZero ? kZero : graph_.Multiply(a, b); }
  Index Quotient(Index a, Index b) { return a == kZero ? kZero : graph_.Divide(a, b); }
  Index Choice(Index condition, Index a, Index b) {
    if (a == kZero && b == kZero) return kZero;
    const Index zero = graph_.Constant(0.0);
    return graph_.Apply(KOMPONO_SELECT, condition, a == kZero ? zero : a, b == kZero ? zero : b);
  }

  Graph& graph_;
  std::vector<Index> derivatives_;
};

}  // namespace

std::vector<Expression> Substitute(std::span<const Expression> roots,
                                   const std::map<int, Expression>& values) {
  Local local = Access::Gather(roots);
  std::vector<Expression> replacements;
  replacements.reserve(values.size());
  for (const auto& [number, value] : values) {
    KOMPONO_EXPECTS(!value.IsCondition());
    replacements.push_back(value);
  }
  Local result = Access::Gather(replacements);
  std::map<int, Index> places;
  for (const auto& [number, value] : values) places.emplace(number, result.roots[places.size()]);

  std::vector<Index> copy(local.graph.size(), -1);
  for (std::size_t i = 0; i < copy.size(); ++i) {
    const Node& node = local.graph.nodes()[i];
    if (node.operation == KOMPONO_CONSTANT) {
      copy[i] = result.graph.Constant(node.value);
    } else if (node.operation == KOMPONO_VARIABLE) {
      const auto found = places.find(node.operand[0]);
      copy[i] = found == places.end() ? result.graph.Variable(node.operand[0]) : found->second;
    } else {
      std::array<Index, 3> operand{-1, -1, -1};
      for (int k = 0; k < OperandCount(node.operation); ++k) {
        operand[static_cast<std::size_t>(k)] = copy[static_cast<std::size_t>(node.operand[k])];
      }
      copy[i] = result.graph.Apply(node.operation, operand[0], operand[1], operand[2]);
    }
  }
  std::vector<Index> new_roots;
  for (const Index root : local.roots) new_roots.push_back(copy[static_cast<std::size_t>(root)]);
  // Names of what was put in come first: they are names of variables that remain.
  result.names.insert(local.names.begin(), local.names.end());
  return Access::Wrap(std::move(result.graph), new_roots, std::move(result.names));
}

std::vector<Expression> Derivatives(std::span<const Expression> roots,
                                    std::span<const int> variables) {
  for (const Expression& root : roots) KOMPONO_EXPECTS(!root.IsCondition());
  Local local = Access::Gather(roots);
  const std::size_t count = local.graph.size();
  std::vector<Index> places(roots.size() * variables.size(), -1);
  for (std::size_t j = 0; j < variables.size(); ++j) {
    const Differentiation derivatives(local.graph, count, variables[j]);
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const Index derivative = derivatives[local.roots[i]];
      places[i * variables.size() + j] =
          derivative == Differentiation::kZero ? local.graph.Constant(0.0) : derivative;
    }
  }
  return Access::Wrap(std::move(local.graph), places, std::move(local.names));
}

}  // namespace kompono
