// SPDX-License-Identifier: Apache-2.0
#include "random_formula.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <ceres/jet.h>

namespace kompono::testing_support {
namespace {

constexpr double kRounding = 4.5e-16;
constexpr double kHuge = 1e100;
constexpr double kTiny = 1e-100;

using Jet = ceres::Jet<double, kVariableCount>;

int Pick(std::mt19937_64& random, std::size_t below) {
  return static_cast<int>(std::uniform_int_distribution<std::size_t>(0, below - 1)(random));
}

/// Grows a list of nodes; numbers and conditions are kept apart.
class Maker {
 public:
  Maker(std::mt19937_64& random, const FormulaKind& kind) : random_(random), kind_(kind) {}

  RandomFormula Make() {
    for (int k = 0; k < kVariableCount; ++k) AddNumber({KOMPONO_VARIABLE, {k, -1, -1}, 0.0});
    constexpr std::array<double, 9> kConstants = {0, 1, -1, 2, -3, 0.5, 4, 9, 0.1};
    for (int k = 0; k < 3; ++k) {
      AddNumber({KOMPONO_CONSTANT,
                 {-1, -1, -1},
                 kConstants[static_cast<std::size_t>(Pick(random_, kConstants.size()))]});
    }
    AddNumber({KOMPONO_CONSTANT, {-1, -1, -1}, std::normal_distribution<double>(0, 3)(random_)});
    for (int k = 0; k < kind_.operations; ++k) AddOperation();
    formula_.root = numbers_.back();
    return std::move(formula_);
  }

 private:
  int32_t Add(const KomponoExpressionNode& node) {
    formula_.nodes.push_back(node);
    return static_cast<int32_t>(formula_.nodes.size()) - 1;
  }
  void AddNumber(const KomponoExpressionNode& node) { numbers_.push_back(Add(node)); }

  // Half of the operands are recent, so that formulas grow deep and not only wide.
  int32_t Number() {
    const std::size_t size = numbers_.size();
    if (Pick(random_, 2) == 0 && size > 4) {
      return numbers_[size - 1 - static_cast<std::size_t>(Pick(random_, 4))];
    }
    return numbers_[static_cast<std::size_t>(Pick(random_, size))];
  }
  int32_t Condition() {
    if (conditions_.empty() || Pick(random_, 2) == 0) {
      conditions_.push_back(Add({Pick(random_, 2) == 0 ? KOMPONO_LESS : KOMPONO_LESS_EQUAL,
                                 {Number(), Number(), -1},
                                 0.0}));
    } else if (Pick(random_, 3) == 0) {
      const int32_t one = conditions_[static_cast<std::size_t>(Pick(random_, conditions_.size()))];
      conditions_.push_back(Add({KOMPONO_NOT, {one, -1, -1}, 0.0}));
    } else if (Pick(random_, 2) == 0) {
      const int32_t one = conditions_[static_cast<std::size_t>(Pick(random_, conditions_.size()))];
      conditions_.push_back(Add(
          {Pick(random_, 2) == 0 ? KOMPONO_AND : KOMPONO_OR, {one, conditions_.front(), -1}, 0.0}));
    }
    return conditions_[static_cast<std::size_t>(Pick(random_, conditions_.size()))];
  }

  void AddOperation() {
    const int choice = Pick(random_, 100);
    if (choice < 75) {
      constexpr std::array<int32_t, 11> kFrequent = {KOMPONO_ADD,
                                                     KOMPONO_ADD,
                                                     KOMPONO_SUBTRACT,
                                                     KOMPONO_SUBTRACT,
                                                     KOMPONO_MULTIPLY,
                                                     KOMPONO_MULTIPLY,
                                                     KOMPONO_MULTIPLY,
                                                     KOMPONO_MULTIPLY,
                                                     KOMPONO_DIVIDE,
                                                     KOMPONO_NEGATE,
                                                     KOMPONO_SUBTRACT};
      const int32_t operation =
          kFrequent[static_cast<std::size_t>(Pick(random_, kFrequent.size()))];
      const int32_t a = Number();
      AddNumber({operation, {a, operation == KOMPONO_NEGATE ? -1 : Number(), -1}, 0.0});
    } else if (choice < 92 || kind_.smooth) {
      int32_t operation = KOMPONO_SQRT + Pick(random_, KOMPONO_LOG - KOMPONO_SQRT + 1);
      if (kind_.smooth && operation == KOMPONO_ABS) operation = KOMPONO_SIN;
      const int32_t a = Number();
      AddNumber({operation, {a, operation == KOMPONO_ATAN2 ? Number() : -1, -1}, 0.0});
    } else {
      const int32_t condition = Condition();
      const int32_t yes = Number();
      AddNumber({KOMPONO_SELECT, {condition, yes, Number()}, 0.0});
    }
  }

  std::mt19937_64& random_;
  FormulaKind kind_;
  RandomFormula formula_;
  std::vector<int32_t> numbers_, conditions_;
};

template <class T>
T Compute(int32_t operation, const T& a, const T& b) {
  using std::abs;
  using std::acos;
  using std::asin;
  using std::atan;
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::log;
  using std::sin;
  using std::sqrt;
  using std::tan;
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
      return sqrt(a);
    case KOMPONO_SIN:
      return sin(a);
    case KOMPONO_COS:
      return cos(a);
    case KOMPONO_TAN:
      return tan(a);
    case KOMPONO_ASIN:
      return asin(a);
    case KOMPONO_ACOS:
      return acos(a);
    case KOMPONO_ATAN:
      return atan(a);
    case KOMPONO_ATAN2:
      return atan2(a, b);
    case KOMPONO_ABS:
      return abs(a);
    case KOMPONO_EXP:
      return exp(a);
    default:
      return log(a);
  }
}

double SizeOf(int32_t operation, const BoundedValue& a, const BoundedValue& b, double value) {
  switch (operation) {
    case KOMPONO_ADD:
    case KOMPONO_SUBTRACT:
      return a.size + b.size;
    case KOMPONO_MULTIPLY:
      return a.size * b.size;
    case KOMPONO_DIVIDE:
      return a.size / std::abs(b.value);
    case KOMPONO_NEGATE:
      return a.size;
    default:
      return std::abs(value);
  }
}

/// First-order bound of the error of one operation; sets `decided` to false where it does not hold.
BoundedValue Bounded(int32_t operation, const BoundedValue& a, const BoundedValue& b, Form form) {
  BoundedValue r;
  r.value = Compute(operation, a.value, b.value);
  r.size = SizeOf(operation, a, b, r.value);
  const double x = a.value;
  const double y = b.value;
  const double own = kRounding * (form == Form::kMultipliedOut ? r.size : std::abs(r.value));
  switch (operation) {
    case KOMPONO_ADD:
    case KOMPONO_SUBTRACT:
      r.error = a.error + b.error + own;
      break;
    case KOMPONO_MULTIPLY:
      r.error = std::abs(x) * b.error + std::abs(y) * a.error + a.error * b.error + own;
      break;
    case KOMPONO_DIVIDE:
      r.decided = std::abs(y) > 1e3 * b.error && y != 0.0;
      r.error = (a.error + std::abs(r.value) * b.error) / (std::abs(y) - b.error) + own;
      break;
    case KOMPONO_SQRT:
      r.decided = std::abs(x) > 1e3 * a.error || (x == 0.0 && a.error == 0.0);
      r.error = a.error > 0.0 ? a.error / r.value + own : own;
      break;
    case KOMPONO_TAN:
      r.decided = std::abs(r.value) < 1e4;
      r.error = a.error * (1.0 + 2.0 * r.value * r.value) + own;
      break;
    case KOMPONO_ASIN:
    case KOMPONO_ACOS: {
      const double inside = 1.0 - std::abs(x);
      r.decided = std::abs(inside) > 1e3 * a.error + 1e-9;
      r.error = a.error / std::sqrt(std::abs(inside)) + own + kRounding;
      break;
    }
    case KOMPONO_ATAN2: {
      const double size = std::hypot(x, y);
      r.decided =
          size > 1e3 * (a.error + b.error) && size > 0.0 && (y > 0.0 || std::abs(x) > a.error);
      r.error = 2.0 * (a.error + b.error) / size + own;
      break;
    }
    case KOMPONO_EXP:
      r.error = 2.0 * r.value * a.error + own;
      break;
    case KOMPONO_LOG:
      r.decided = std::abs(x) > 1e3 * a.error && x != 0.0;
      r.error = 2.0 * a.error / std::abs(x) + own + kRounding;
      break;
    case KOMPONO_NEGATE:
    case KOMPONO_ABS:
      r.error = a.error;
      break;
    default:  // sine, cosine, arctangent
      r.error = a.error + own + kRounding * kRounding * std::abs(x);
      break;
  }
  if (std::isnan(r.value)) r.error = 0.0;
  if (std::isnan(r.error)) r.decided = false;
  if (std::isnan(x) || (operation != KOMPONO_NEGATE && std::isnan(y))) r.decided = true;
  const double size = std::abs(r.value);
  if (size > kHuge || (size < kTiny && size != 0.0)) r.decided = false;
  return r;
}

std::vector<bool> Needed(const RandomFormula& formula) {
  std::vector<bool> needed(formula.nodes.size(), false);
  needed[static_cast<std::size_t>(formula.root)] = true;
  for (std::size_t i = formula.nodes.size(); i-- > 0;) {
    const KomponoExpressionNode& node = formula.nodes[i];
    if (!needed[i] || node.operation <= KOMPONO_VARIABLE) continue;
    for (const int32_t operand : node.operand) {
      if (operand >= 0) needed[static_cast<std::size_t>(operand)] = true;
    }
  }
  return needed;
}

}  // namespace

Expression RandomFormula::Import() const {
  return ImportRecording(nodes, {&root, 1}, kVariableCount, "random").value().front();
}

RandomFormula MakeFormula(std::mt19937_64& random, const FormulaKind& kind) {
  return Maker(random, kind).Make();
}

std::vector<double> MakePoint(std::mt19937_64& random) {
  std::vector<double> point(kVariableCount);
  const double scale = std::exp(std::uniform_real_distribution<double>(-2, 2)(random));
  for (double& x : point) x = std::uniform_real_distribution<double>(-scale, scale)(random);
  return point;
}

BoundedValue ComputeBounded(const RandomFormula& formula,
                            const std::vector<double>& point,
                            Form form) {
  const std::vector<bool> needed = Needed(formula);
  std::vector<BoundedValue> values;
  bool decided = true;
  for (const KomponoExpressionNode& node : formula.nodes) {
    const auto at = [&values, &node](int k) -> const BoundedValue& {
      return values.at(static_cast<std::size_t>(node.operand[k]));
    };
    BoundedValue value;
    switch (node.operation) {
      case KOMPONO_CONSTANT:
        value.value = node.value;
        value.size = std::abs(value.value);
        break;
      case KOMPONO_VARIABLE:
        value.value = point.at(static_cast<std::size_t>(node.operand[0]));
        value.size = std::abs(value.value);
        break;
      case KOMPONO_LESS:
      case KOMPONO_LESS_EQUAL: {
        const double room = 1e3 * (at(0).error + at(1).error);
        const double difference = std::abs(at(0).value - at(1).value);
        value.decided = !(difference <= room) || room == 0.0;
        value.value =
            node.operation == KOMPONO_LESS ? at(0).value < at(1).value : at(0).value <= at(1).value;
        break;
      }
      case KOMPONO_NOT:
        value.value = at(0).value == 0.0;
        break;
      case KOMPONO_AND:
        value.value = at(0).value != 0.0 && at(1).value != 0.0;
        break;
      case KOMPONO_OR:
        value.value = at(0).value != 0.0 || at(1).value != 0.0;
        break;
      case KOMPONO_SELECT:
        value = at(0).value != 0.0 ? at(1) : at(2);
        break;
      default:
        value = Bounded(node.operation, at(0), node.operand[1] < 0 ? BoundedValue{} : at(1), form);
        break;
    }
    decided = decided && (value.decided || !needed[values.size()]);
    values.push_back(value);
  }
  BoundedValue result = values.at(static_cast<std::size_t>(formula.root));
  result.decided = decided;
  return result;
}

Gradient ComputeGradient(const RandomFormula& formula, const std::vector<double>& point) {
  std::vector<Jet> values;
  for (const KomponoExpressionNode& node : formula.nodes) {
    const auto at = [&values, &node](int k) -> const Jet& {
      return values.at(static_cast<std::size_t>(node.operand[k]));
    };
    switch (node.operation) {
      case KOMPONO_CONSTANT:
        values.emplace_back(node.value);
        break;
      case KOMPONO_VARIABLE:
        values.emplace_back(point.at(static_cast<std::size_t>(node.operand[0])), node.operand[0]);
        break;
      case KOMPONO_LESS:
        values.emplace_back(at(0).a < at(1).a ? 1.0 : 0.0);
        break;
      case KOMPONO_LESS_EQUAL:
        values.emplace_back(at(0).a <= at(1).a ? 1.0 : 0.0);
        break;
      case KOMPONO_NOT:
        values.emplace_back(at(0).a == 0.0 ? 1.0 : 0.0);
        break;
      case KOMPONO_AND:
        values.emplace_back(at(0).a != 0.0 && at(1).a != 0.0 ? 1.0 : 0.0);
        break;
      case KOMPONO_OR:
        values.emplace_back(at(0).a != 0.0 || at(1).a != 0.0 ? 1.0 : 0.0);
        break;
      case KOMPONO_SELECT:
        values.push_back(at(0).a != 0.0 ? at(1) : at(2));
        break;
      default:
        values.push_back(Compute(node.operation, at(0), node.operand[1] < 0 ? Jet() : at(1)));
        break;
    }
  }
  const Jet& root = values.at(static_cast<std::size_t>(formula.root));
  Gradient gradient{.value = root.a};
  for (int k = 0; k < kVariableCount; ++k) gradient.by[k] = root.v[k];
  return gradient;
}

}  // namespace kompono::testing_support
