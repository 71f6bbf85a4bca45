// SPDX-License-Identifier: Apache-2.0
#include "graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace kompono::expression_internal {
namespace {

/// One step of splitmix64. Weaker mixing collides in lists of like nodes with small numbers.
uint64_t Mix(uint64_t hash, uint64_t part) {
  hash = (hash ^ part) + 0x9E3779B97F4A7C15ULL;
  hash = (hash ^ (hash >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  hash = (hash ^ (hash >> 27U)) * 0x94D049BB133111EBULL;
  return hash ^ (hash >> 31U);
}

uint64_t HashOf(const Node& node) {
  uint64_t hash = Mix(static_cast<uint32_t>(node.operation), std::bit_cast<uint64_t>(node.value));
  for (const int32_t operand : node.operand) hash = Mix(hash, static_cast<uint32_t>(operand));
  return hash;
}

bool AreEqual(const Node& a, const Node& b) {
  return a.operation == b.operation && std::equal(a.operand, a.operand + 3, b.operand) &&
         std::bit_cast<uint64_t>(a.value) == std::bit_cast<uint64_t>(b.value);
}

constexpr uint32_t kMost = std::numeric_limits<uint32_t>::max();

}  // namespace

int OperandCount(int32_t operation) {
  return KomponoOperandCount(operation);
}

bool GivesCondition(int32_t operation) {
  return operation >= KOMPONO_LESS && operation <= KOMPONO_OR;
}

bool WantsCondition(int32_t operation, int k) {
  return (operation >= KOMPONO_NOT && operation <= KOMPONO_OR) ||
         (operation == KOMPONO_SELECT && k == 0);
}

bool IsFunction(int32_t operation) {
  return operation >= KOMPONO_SQRT && operation <= KOMPONO_LOG;
}

double Compute(int32_t operation, double a, double b, double c) {
  switch (operation) {
    case KOMPONO_ADD:
      return a + b;
    case KOMPONO_SUBTRACT:
      return a - b;
    case KOMPONO_MULTIPLY:
      return a * b;
    case KOMPONO_DIVIDE:
      return a / b;
    case KOMPONO_NEGATE:
      return -a;
    case KOMPONO_SQRT:
      return std::sqrt(a);
    case KOMPONO_SIN:
      return std::sin(a);
    case KOMPONO_COS:
      return std::cos(a);
    case KOMPONO_TAN:
      return std::tan(a);
    case KOMPONO_ASIN:
      return std::asin(a);
    case KOMPONO_ACOS:
      return std::acos(a);
    case KOMPONO_ATAN:
      return std::atan(a);
    case KOMPONO_ATAN2:
      return std::atan2(a, b);
    case KOMPONO_ABS:
      return std::abs(a);
    case KOMPONO_EXP:
      return std::exp(a);
    case KOMPONO_LOG:
      return std::log(a);
    case KOMPONO_LESS:
      return a < b ? 1.0 : 0.0;
    case KOMPONO_LESS_EQUAL:
      return a <= b ? 1.0 : 0.0;
    case KOMPONO_NOT:
      return a == 0.0 ? 1.0 : 0.0;
    case KOMPONO_AND:
      return a != 0.0 && b != 0.0 ? 1.0 : 0.0;
    case KOMPONO_OR:
      return a != 0.0 || b != 0.0 ? 1.0 : 0.0;
    case KOMPONO_SELECT:
      return a != 0.0 ? b : c;
    default:
      throw std::logic_error("Compute: not an operation");
  }
}

std::size_t Graph::SlotOf(const Node& node) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(HashOf(node)) & mask;
  while (slots_[slot] >= 0 && !AreEqual(this->node(slots_[slot]), node)) slot = (slot + 1) & mask;
  return slot;
}

void Graph::GrowSlots() {
  slots_.assign(std::max<std::size_t>(16, 2 * slots_.size()), -1);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    slots_[SlotOf(nodes_[i])] = static_cast<Index>(i);
  }
}

Index Graph::Insert(const Node& node) {
  if (2 * (nodes_.size() + 1) > slots_.size()) GrowSlots();
  Index& place = slots_[SlotOf(node)];
  if (place < 0) {
    facts_.push_back(FactsOf(node));
    nodes_.push_back(node);
    place = static_cast<Index>(nodes_.size()) - 1;
  }
  return place;
}

Facts Graph::FactsOf(const Node& node) const {
  Facts result;
  result.hash = Mix(static_cast<uint32_t>(node.operation) + 1, std::bit_cast<uint64_t>(node.value));
  if (node.operation == KOMPONO_CONSTANT) {
    result.total = std::isfinite(node.value);
    result.nonnegative = node.value >= 0.0;
    return result;
  }
  if (node.operation == KOMPONO_VARIABLE) {
    result.hash = Mix(result.hash, static_cast<uint32_t>(node.operand[0]));
    result.first_variable = node.operand[0];
    result.total = true;
    return result;
  }
  result.nonnegative = true;
  result.total = true;
  uint64_t complexity = 1;
  for (int k = 0; k < OperandCount(node.operation); ++k) {
    const Facts& operand = facts(node.operand[k]);
    result.hash = Mix(result.hash, operand.hash);
    complexity += operand.complexity;
    result.depth = std::max(result.depth, operand.depth + 1);
    result.first_variable = std::min(result.first_variable, operand.first_variable);
    result.total = result.total && operand.total;
    result.nonnegative = result.nonnegative && operand.nonnegative;
  }
  result.complexity = static_cast<uint32_t>(std::min<uint64_t>(complexity, kMost));
  JudgeRange(node, &result);
  return result;
}

void Graph::JudgeRange(const Node& node, Facts* result) const {
  switch (node.operation) {
    case KOMPONO_ADD:
      break;
    case KOMPONO_MULTIPLY:
      result->nonnegative = result->nonnegative || node.operand[0] == node.operand[1];
      break;
    case KOMPONO_DIVIDE:
      result->total =
          result->total && IsConstant(node.operand[1]) && !IsConstant(node.operand[1], 0.0);
      break;
    case KOMPONO_SQRT:
      result->total = result->total && result->nonnegative;
      result->nonnegative = true;
      break;
    case KOMPONO_ABS:
    case KOMPONO_EXP:
      result->nonnegative = true;
      break;
    case KOMPONO_TAN:
    case KOMPONO_ASIN:
    case KOMPONO_ACOS:
    case KOMPONO_LOG:
      result->total = false;
      result->nonnegative = false;
      break;
    case KOMPONO_SELECT:
      result->nonnegative =
          facts(node.operand[1]).nonnegative && facts(node.operand[2]).nonnegative;
      break;
    default:
      result->nonnegative = false;
      break;
  }
}

Index Graph::Constant(double value) {
  return Insert({KOMPONO_CONSTANT, {-1, -1, -1}, value});
}

Index Graph::Variable(int number) {
  return Insert({KOMPONO_VARIABLE, {number, -1, -1}, 0.0});
}

Index Graph::Raw(int32_t operation, Index a, Index b, Index c) {
  return Insert({operation, {a, b, c}, 0.0});
}

Index Graph::KnownCondition(bool holds) {
  const Index zero = Constant(0.0);
  const Index one = Constant(1.0);
  return holds ? Raw(KOMPONO_LESS, zero, one) : Raw(KOMPONO_LESS, one, zero);
}

bool Graph::IsKnownCondition(Index i, bool holds) const {
  const Node& known = node(i);
  return known.operation == KOMPONO_LESS && IsConstant(known.operand[0], holds ? 0.0 : 1.0) &&
         IsConstant(known.operand[1], holds ? 1.0 : 0.0);
}

Index Graph::Apply(int32_t operation, Index a, Index b, Index c) {
  if (GivesCondition(operation)) return ApplyCondition(operation, a, b);
  if (operation == KOMPONO_SELECT) return ApplySelect(a, b, c);
  const int count = OperandCount(operation);
  if (IsConstant(a) && (count < 2 || IsConstant(b))) {
    const double first = node(a).value;
    const double second = count < 2 ? 0.0 : node(b).value;
    const double value = Compute(operation, first, second, 0.0);
    // What numbers make infinite or undefined stays visible as it was written.
    if (std::isfinite(value) || !std::isfinite(first) || !std::isfinite(second)) {
      return Constant(value);
    }
    return Raw(operation, a, b);
  }
  switch (operation) {
    case KOMPONO_NEGATE:
      return Is(a, KOMPONO_NEGATE) ? node(a).operand[0] : Raw(operation, a);
    case KOMPONO_ADD:
    case KOMPONO_SUBTRACT:
      return ApplySum(operation, a, b);
    case KOMPONO_MULTIPLY:
    case KOMPONO_DIVIDE:
      return ApplyProduct(operation, a, b);
    default:
      return Raw(operation, a, b);
  }
}

Index Graph::ApplySum(int32_t operation, Index a, Index b) {
  if (IsConstant(b, 0.0)) return a;
  if (IsConstant(a, 0.0)) return operation == KOMPONO_ADD ? b : Negate(b);
  return Raw(operation, a, b);
}

Index Graph::ApplyProduct(int32_t operation, Index a, Index b) {
  if (IsConstant(b, 1.0)) return a;
  if (IsConstant(b, -1.0)) return Negate(a);
  if (operation == KOMPONO_MULTIPLY) {
    if (IsConstant(a, 1.0)) return b;
    if (IsConstant(a, -1.0)) return Negate(b);
    if ((IsConstant(a, 0.0) && facts(b).total) || (IsConstant(b, 0.0) && facts(a).total)) {
      return Constant(0.0);
    }
  }
  return Raw(operation, a, b);
}

Index Graph::ApplyCondition(int32_t operation, Index a, Index b) {
  switch (operation) {
    case KOMPONO_NOT:
      if (IsKnownCondition(a, true)) return KnownCondition(false);
      if (IsKnownCondition(a, false)) return KnownCondition(true);
      return Is(a, KOMPONO_NOT) ? node(a).operand[0] : Raw(operation, a);
    case KOMPONO_AND:
    case KOMPONO_OR: {
      const bool decisive = operation == KOMPONO_OR;
      if (IsKnownCondition(a, decisive) || IsKnownCondition(b, decisive)) {
        return KnownCondition(decisive);
      }
      if (IsKnownCondition(a, !decisive) || a == b) return b;
      return IsKnownCondition(b, !decisive) ? a : Raw(operation, a, b);
    }
    default:
      if (IsConstant(a) && IsConstant(b)) {
        return KnownCondition(Compute(operation, node(a).value, node(b).value, 0.0) != 0.0);
      }
      if (a == b && operation == KOMPONO_LESS) return KnownCondition(false);
      if (a == b && facts(a).total) return KnownCondition(true);
      return Raw(operation, a, b);
  }
}

Index Graph::ApplySelect(Index condition, Index a, Index b) {
  if (IsKnownCondition(condition, true) || a == b) return a;
  if (IsKnownCondition(condition, false)) return b;
  if (Is(condition, KOMPONO_NOT)) return Raw(KOMPONO_SELECT, node(condition).operand[0], b, a);
  return Raw(KOMPONO_SELECT, condition, a, b);
}

std::vector<bool> Reachable(std::span<const Node> nodes, std::span<const Index> roots) {
  std::vector<bool> reached(nodes.size(), false);
  for (const Index root : roots) reached[static_cast<std::size_t>(root)] = true;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (!reached[i]) continue;
    for (int k = 0; k < OperandCount(nodes[i].operation); ++k) {
      reached[static_cast<std::size_t>(nodes[i].operand[k])] = true;
    }
  }
  return reached;
}

std::vector<uint32_t> UseCounts(std::span<const Node> nodes, std::span<const Index> roots) {
  std::vector<uint32_t> uses(nodes.size(), 0);
  for (const Index root : roots) ++uses[static_cast<std::size_t>(root)];
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (uses[i] == 0) continue;
    for (int k = 0; k < OperandCount(nodes[i].operation); ++k) {
      ++uses[static_cast<std::size_t>(nodes[i].operand[k])];
    }
  }
  return uses;
}

std::vector<Index> CopyInto(Graph& to, std::span<const Node> from, std::span<const Index> roots) {
  const std::vector<bool> reached = Reachable(from, roots);
  std::vector<Index> copy(from.size(), -1);
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (!reached[i]) continue;
    const Node& node = from[i];
    if (node.operation == KOMPONO_CONSTANT) {
      copy[i] = to.Constant(node.value);
    } else if (node.operation == KOMPONO_VARIABLE) {
      copy[i] = to.Variable(node.operand[0]);
    } else {
      std::array<Index, 3> operand{-1, -1, -1};
      for (int k = 0; k < OperandCount(node.operation); ++k) {
        operand[static_cast<std::size_t>(k)] = copy[static_cast<std::size_t>(node.operand[k])];
      }
      copy[i] = to.Raw(node.operation, operand[0], operand[1], operand[2]);
    }
  }
  std::vector<Index> result;
  result.reserve(roots.size());
  for (const Index root : roots) result.push_back(copy[static_cast<std::size_t>(root)]);
  return result;
}

}  // namespace kompono::expression_internal
