// SPDX-License-Identifier: Apache-2.0
#include "formula_tape.hpp"

#include <algorithm>
#include <cmath>

namespace kompono::analysis {
namespace {

constexpr Interval kUnknown{0.0, 1.0};  ///< a condition that holds in part of the box

Interval LessThan(const Interval& a, const Interval& b, bool or_equal) {
  if (or_equal ? a.upper <= b.lower : a.upper < b.lower) return Interval(1.0);
  if (or_equal ? a.lower > b.upper : a.lower >= b.upper) return Interval(0.0);
  return kUnknown;
}

/// Functions that fall or rise on their whole domain, cut to it.
Slope Inverse(std::int32_t operation, const Slope& a) {
  using interval_internal::Rising;
  if (operation == KOMPONO_ATAN) {
    return Chained(a,
                   Rising(a.value, [](double v) { return std::atan(v); }),
                   Interval(1.0) / (Interval(1.0) + Square(a.value)));
  }
  const Interval cut = Meet(a.value, {-1.0, 1.0});
  const Interval cut_to = cut.lower <= cut.upper ? cut : Interval(-1.0, 1.0);
  const Interval asin = Rising(cut_to, [](double v) { return std::asin(v); });
  const Slope root = Sqrt(Slope(Interval(1.0) - Square(cut_to)));
  const Interval factor = root.value.lower > 0.0
                              ? Interval(1.0) / root.value
                              : Interval(0.9999999999, std::numeric_limits<double>::infinity());
  if (operation == KOMPONO_ASIN) return Chained(a, asin, factor);
  const double quarter = std::numbers::pi / 2.0;
  return Chained(a, Interval(quarter - 1e-15, quarter + 1e-15) - asin, -factor);
}

Slope ArcTangent2(const Slope& y, const Slope& x) {
  const double pi = std::numbers::pi;
  Interval value(-pi - 1e-15, pi + 1e-15);
  // Where the box of (x, y) does not meet the negative x axis the angle is continuous and its
  // extremes stand in corners.
  if (x.value.lower > 0.0 || y.value.lower > 0.0 || y.value.upper < 0.0) {
    double lower = pi;
    double upper = -pi;
    for (const double v : {y.value.lower, y.value.upper}) {
      for (const double h : {x.value.lower, x.value.upper}) {
        lower = std::min(lower, std::atan2(v, h));
        upper = std::max(upper, std::atan2(v, h));
      }
    }
    value = interval_internal::Outward(lower, upper);
  }
  const Interval square = Square(x.value) + Square(y.value);
  Slope out(value);
  for (std::size_t i = 0; i < Slope::kDirections; ++i)
    out.by[i] = (x.value * y.by[i] - y.value * x.by[i]) / square;
  return out;
}

Slope Unary(std::int32_t operation, const Slope& a) {
  using interval_internal::Rising;
  switch (operation) {
    case KOMPONO_NEGATE:
      return -a;
    case KOMPONO_SQRT:
      return Sqrt(a);
    case KOMPONO_SIN:
      return Chained(a, Sin(a.value), Cos(a.value));
    case KOMPONO_COS:
      return Chained(a, Cos(a.value), -Sin(a.value));
    case KOMPONO_TAN: {
      const Slope sine = Chained(a, Sin(a.value), Cos(a.value));
      const Slope cosine = Chained(a, Cos(a.value), -Sin(a.value));
      return sine / cosine;
    }
    case KOMPONO_ABS: {
      const Interval factor = a.value.lower >= 0.0   ? Interval(1.0)
                              : a.value.upper <= 0.0 ? Interval(-1.0)
                                                     : Interval(-1.0, 1.0);
      return Chained(a, Abs(a.value), factor);
    }
    case KOMPONO_EXP: {
      const Interval value = Rising(a.value, [](double v) { return std::exp(v); });
      return Chained(a, value, value);
    }
    case KOMPONO_LOG: {
      if (a.value.lower <= 0.0) return Chained(a, Interval::Everything(), Interval::Everything());
      return Chained(
          a, Rising(a.value, [](double v) { return std::log(v); }), Interval(1.0) / a.value);
    }
    case KOMPONO_NOT:
      return Slope(Interval(1.0) - a.value);
    default:
      return Inverse(operation, a);
  }
}

Slope Choose(const Interval& condition, const Slope& yes, const Slope& no) {
  if (condition.lower > 0.5) return yes;
  if (condition.upper < 0.5) return no;
  Slope out(Hull(yes.value, no.value));
  out.by.fill(Interval::Everything());  // where the branches meet there may be a jump
  return out;
}

struct Recording {
  std::vector<KomponoExpressionNode> nodes;
  std::vector<std::int32_t> roots;
};

}  // namespace

FormulaTape::Slot FormulaTape::Add(const Instruction& instruction, double constant) {
  const auto slot = static_cast<Slot>(instructions_.size());
  if (instruction.operation == KOMPONO_CONSTANT) {
    const auto [found, added] = known_constants_.try_emplace(constant, slot);
    if (!added) return found->second;
  } else {
    const auto [found, added] = known_.try_emplace({instruction.operation,
                                                    instruction.operand[0],
                                                    instruction.operand[1],
                                                    instruction.operand[2]},
                                                   slot);
    if (!added) return found->second;
  }
  instructions_.push_back(instruction);
  constants_.emplace_back(constant);
  if (instruction.active) {
    active_.push_back(slot);
  } else if (instruction.operation != KOMPONO_CONSTANT) {
    Apply(instruction, true, constants_, slot);
  }
  return slot;
}

FormulaTape::Slot FormulaTape::Varied(std::size_t direction) {
  const Slot slot = Add({.operation = KOMPONO_VARIABLE,
                         .operand = {static_cast<Slot>(direction), -1, -1},
                         .active = true});
  if (varied_.size() <= direction) varied_.resize(direction + 1, -1);
  varied_[direction] = slot;
  return slot;
}

FormulaTape::Slot FormulaTape::Constant(double value) {
  return Add({.operation = KOMPONO_CONSTANT}, value);
}

FormulaTape::Slot FormulaTape::Negative(Slot a) {
  return Add({.operation = KOMPONO_NEGATE,
              .operand = {a, -1, -1},
              .active = instructions_[static_cast<std::size_t>(a)].active});
}

std::vector<FormulaTape::Slot> FormulaTape::Record(const plugin::Mechanism& mechanism,
                                                   plugin::Quantity quantity,
                                                   bool with_derivatives,
                                                   std::span<const Slot> variables) {
  Recording recording;
  const plugin::FormulaReceiver receiver{.context = &recording,
                                         .take = [](void* context,
                                                    const KomponoExpressionNode* nodes,
                                                    std::size_t node_count,
                                                    const std::int32_t* roots,
                                                    std::size_t root_count) {
                                           auto& to = *static_cast<Recording*>(context);
                                           to.nodes.assign(nodes, nodes + node_count);
                                           to.roots.assign(roots, roots + root_count);
                                         }};
  std::vector<Slot> out;
  if (mechanism.Record(quantity, with_derivatives, receiver) != plugin::Status::kOk ||
      !Import(recording.nodes, recording.roots, variables, out))
    out.clear();
  return out;
}

bool FormulaTape::Import(std::span<const KomponoExpressionNode> nodes,
                         std::span<const std::int32_t> roots,
                         std::span<const Slot> variables,
                         std::vector<Slot>& out) {
  std::vector<Slot> slot(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const KomponoExpressionNode& node = nodes[i];
    const int operands = KomponoOperandCount(node.operation);
    if (operands < 0) return false;
    if (node.operation == KOMPONO_CONSTANT) {
      slot[i] = Constant(node.value);
      continue;
    }
    if (node.operation == KOMPONO_VARIABLE) {
      if (node.operand[0] < 0 || static_cast<std::size_t>(node.operand[0]) >= variables.size())
        return false;
      slot[i] = variables[static_cast<std::size_t>(node.operand[0])];
      continue;
    }
    Instruction instruction{.operation = node.operation};
    for (std::size_t k = 0; k < static_cast<std::size_t>(operands); ++k) {
      if (node.operand[k] < 0 || static_cast<std::size_t>(node.operand[k]) >= i) return false;
      instruction.operand[k] = slot[static_cast<std::size_t>(node.operand[k])];
      const auto of = static_cast<std::size_t>(instruction.operand[k]);
      instruction.active = instruction.active || instructions_[of].active;
    }
    slot[i] = Add(instruction);
  }
  for (const std::int32_t root : roots) {
    if (root < 0 || static_cast<std::size_t>(root) >= nodes.size()) return false;
    out.push_back(slot[static_cast<std::size_t>(root)]);
  }
  return true;
}

void FormulaTape::Apply(const Instruction& instruction, bool slopes, Values& values, Slot to) {
  const auto operand = [&](std::size_t k) -> const Slope& {
    return values[static_cast<std::size_t>(instruction.operand[k])];
  };
  Slope& out = values[static_cast<std::size_t>(to)];
  if (!slopes) {  // the four operations that formulas are mostly made of
    switch (instruction.operation) {
      case KOMPONO_ADD:
        out.value = operand(0).value + operand(1).value;
        return;
      case KOMPONO_SUBTRACT:
        out.value = operand(0).value - operand(1).value;
        return;
      case KOMPONO_MULTIPLY:
        out.value = instruction.operand[0] == instruction.operand[1]
                        ? Square(operand(0).value)
                        : operand(0).value * operand(1).value;
        return;
      case KOMPONO_SQRT:
        out.value = Sqrt(operand(0).value);
        return;
      default:
        break;
    }
  }
  switch (instruction.operation) {
    case KOMPONO_ADD:
      out = operand(0) + operand(1);
      break;
    case KOMPONO_SUBTRACT:
      out = operand(0) - operand(1);
      break;
    case KOMPONO_MULTIPLY:
      out = instruction.operand[0] == instruction.operand[1] ? Square(operand(0))
                                                             : operand(0) * operand(1);
      break;
    case KOMPONO_DIVIDE:
      out = operand(0) / operand(1);
      break;
    case KOMPONO_ATAN2:
      out = ArcTangent2(operand(0), operand(1));
      break;
    case KOMPONO_LESS:
    case KOMPONO_LESS_EQUAL:
      out = Slope(LessThan(
          operand(0).value, operand(1).value, instruction.operation == KOMPONO_LESS_EQUAL));
      break;
    case KOMPONO_AND:
      out = Slope(Interval(std::min(operand(0).value.lower, operand(1).value.lower),
                           std::min(operand(0).value.upper, operand(1).value.upper)));
      break;
    case KOMPONO_OR:
      out = Slope(Interval(std::max(operand(0).value.lower, operand(1).value.lower),
                           std::max(operand(0).value.upper, operand(1).value.upper)));
      break;
    case KOMPONO_SELECT:
      out = Choose(operand(0).value, operand(1), operand(2));
      break;
    default:
      out = Unary(instruction.operation, operand(0));
      break;
  }
}

FormulaTape::Values FormulaTape::MakeValues() const {
  return constants_;
}

void FormulaTape::Evaluate(std::span<const Interval> at, bool slopes, Values& values) const {
  for (std::size_t i = 0; i < varied_.size(); ++i) {
    if (varied_[i] < 0) continue;
    Slope& own = values[static_cast<std::size_t>(varied_[i])];
    own = Slope(at[i]);
    if (i < Slope::kDirections) own.by[i] = Interval(1.0);
  }
  for (const Slot slot : active_) {
    const Instruction& instruction = instructions_[static_cast<std::size_t>(slot)];
    if (instruction.operation == KOMPONO_VARIABLE) continue;
    Apply(instruction, slopes, values, slot);
  }
}

}  // namespace kompono::analysis
