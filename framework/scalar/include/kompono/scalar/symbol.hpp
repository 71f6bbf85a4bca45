// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SCALAR_SYMBOL_HPP_
#define KOMPONO_SCALAR_SYMBOL_HPP_

#include <atomic>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "kompono/scalar/expression_node.h"

/// A scalar that writes down what is done with it.
///
/// Geometry written as a template over the scalar, instantiated with Symbol, leaves its own formula
/// behind:
///
///     Recording recording;
///     const Symbol x = Recording::Variable(0), y = Recording::Variable(1);
///     const int32_t root = recording.Index(sqrt(x * x + y * y));
///     Send(recording.nodes(), root);
///
/// A Symbol is either a plain number, folded at once and costing no node, or a place in the
/// recording that is active on this thread. It has no value to branch on: `if (x < y)` does not
/// compile, `Select(x < y, a, b)` records both ways. Symbols are Eigen scalars and may be the base
/// of ceres::Jet, which then records derivatives.
///
/// Zero times anything is folded to zero and a zero summand is dropped, because Jets are full of
/// both; a number divided by a Symbol never is, so that poles stay.
namespace kompono {

class SymbolCondition;

template <class T>
concept PlainNumber = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

class Symbol {
 public:
  constexpr Symbol() = default;

  template <PlainNumber Number>
  // NOLINTNEXTLINE(google-explicit-constructor): numbers mix freely with Symbols in formulas.
  constexpr Symbol(Number value) : value_(static_cast<double>(value)) {}

  [[nodiscard]] constexpr bool IsConstant() const { return place_ < 0; }
  /// The number, if IsConstant(); a place in a recording has none.
  [[nodiscard]] constexpr double ConstantValue() const {
    return IsConstant() ? value_ : std::numeric_limits<double>::quiet_NaN();
  }

  Symbol& operator+=(const Symbol& other) { return *this = *this + other; }
  Symbol& operator-=(const Symbol& other) { return *this = *this - other; }
  Symbol& operator*=(const Symbol& other) { return *this = *this * other; }
  Symbol& operator/=(const Symbol& other) { return *this = *this / other; }

  friend Symbol operator+(const Symbol& a) { return a; }
  friend Symbol operator-(const Symbol& a);
  friend Symbol operator+(const Symbol& a, const Symbol& b);
  friend Symbol operator-(const Symbol& a, const Symbol& b);
  friend Symbol operator*(const Symbol& a, const Symbol& b);
  friend Symbol operator/(const Symbol& a, const Symbol& b);

  friend SymbolCondition operator<(const Symbol& a, const Symbol& b);
  friend SymbolCondition operator<=(const Symbol& a, const Symbol& b);
  friend SymbolCondition operator>(const Symbol& a, const Symbol& b);
  friend SymbolCondition operator>=(const Symbol& a, const Symbol& b);
  friend Symbol Select(const SymbolCondition& condition, const Symbol& a, const Symbol& b);

  // Functions live inside the class so that only Symbols find them: a sqrt(2.0) in namespace
  // kompono must not turn into a Symbol.
  friend Symbol sqrt(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::sqrt(a.value_)) : Record(KOMPONO_SQRT, a);
  }
  friend Symbol sin(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::sin(a.value_)) : Record(KOMPONO_SIN, a);
  }
  friend Symbol cos(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::cos(a.value_)) : Record(KOMPONO_COS, a);
  }
  friend Symbol tan(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::tan(a.value_)) : Record(KOMPONO_TAN, a);
  }
  friend Symbol asin(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::asin(a.value_)) : Record(KOMPONO_ASIN, a);
  }
  friend Symbol acos(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::acos(a.value_)) : Record(KOMPONO_ACOS, a);
  }
  friend Symbol atan(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::atan(a.value_)) : Record(KOMPONO_ATAN, a);
  }
  friend Symbol abs(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::abs(a.value_)) : Record(KOMPONO_ABS, a);
  }
  friend Symbol exp(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::exp(a.value_)) : Record(KOMPONO_EXP, a);
  }
  friend Symbol log(const Symbol& a) {
    return a.IsConstant() ? Symbol(std::log(a.value_)) : Record(KOMPONO_LOG, a);
  }
  friend Symbol atan2(const Symbol& y, const Symbol& x) {
    if (y.IsConstant() && x.IsConstant()) return std::atan2(y.value_, x.value_);
    return Record(KOMPONO_ATAN2, y, x);
  }
  friend Symbol hypot(const Symbol& a, const Symbol& b) { return sqrt(a * a + b * b); }
  friend Symbol hypot(const Symbol& a, const Symbol& b, const Symbol& c) {
    return sqrt(a * a + b * b + c * c);
  }
  /// |magnitude| with the sign of `sign`; a zero counts as positive whatever its sign bit.
  friend Symbol copysign(const Symbol& magnitude, const Symbol& sign) {
    return CopySign(magnitude, sign);
  }
  /// A power with a whole constant exponent becomes products (a negative one their reciprocal), 1/2
  /// a root; any other becomes exp(exponent * log(base)), which needs a positive base.
  friend Symbol pow(const Symbol& base, const Symbol& exponent) { return Power(base, exponent); }

 private:
  friend class Recording;

  constexpr Symbol(int32_t place, uint32_t recording) : place_(place), recording_(recording) {}

  static Symbol Record(KomponoOperation operation, const Symbol& a);
  static Symbol Record(KomponoOperation operation, const Symbol& a, const Symbol& b);
  static Symbol CopySign(const Symbol& magnitude, const Symbol& sign);
  static Symbol Power(const Symbol& base, const Symbol& exponent);
  [[nodiscard]] constexpr bool Is(double value) const { return IsConstant() && value_ == value; }

  double value_ = 0.0;
  int32_t place_ = -1;      // in the recording; negative for a plain number
  uint32_t recording_ = 0;  // which recording the place belongs to
};

/// The outcome of comparing Symbols: known only when the formula is evaluated, hence not a bool.
class SymbolCondition {
 public:
  template <std::same_as<bool> Bool>  // nothing that merely converts to bool
  // NOLINTNEXTLINE(google-explicit-constructor): a known outcome serves as well.
  constexpr SymbolCondition(Bool value) : value_(value) {}

  [[nodiscard]] constexpr bool IsConstant() const { return place_ < 0; }

  friend SymbolCondition operator!(const SymbolCondition& a);
  friend SymbolCondition operator&&(const SymbolCondition& a, const SymbolCondition& b);
  friend SymbolCondition operator||(const SymbolCondition& a, const SymbolCondition& b);
  /// `a` where the condition holds, else `b`.
  friend Symbol Select(const SymbolCondition& condition, const Symbol& a, const Symbol& b) {
    return Choose(condition, a, b);
  }

 private:
  friend class Recording;

  constexpr SymbolCondition(int32_t place, uint32_t recording)
      : place_(place), recording_(recording) {}

  static Symbol Choose(const SymbolCondition& condition, const Symbol& a, const Symbol& b);

  bool value_ = false;
  int32_t place_ = -1;
  uint32_t recording_ = 0;
};

/// Collects what is done with Symbols on this thread, from construction to destruction. A second
/// recording on the same thread takes over until it ends. A Symbol belongs to its recording: to use
/// it in another one, or after the end, throws std::logic_error. Equal operations on equal operands
/// share one node.
class Recording {
 public:
  Recording() : number_(++Count()), previous_(Active()) { Active() = this; }
  ~Recording() { Unlink(); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  Recording(Recording&&) = delete;
  Recording& operator=(Recording&&) = delete;

  /// The variable with this number (from 0) in the recording active on this thread.
  /// @throws std::logic_error without an active recording or for a negative number.
  [[nodiscard]] static Symbol Variable(int number);

  /// All nodes so far, operands before users. Valid until something more is recorded.
  [[nodiscard]] std::span<const KomponoExpressionNode> nodes() const { return nodes_; }

  /// The place of a Symbol in nodes(); a plain number gets a node now.
  /// @throws std::logic_error if it belongs to another recording.
  [[nodiscard]] int32_t Index(const Symbol& symbol);
  [[nodiscard]] int32_t Index(const SymbolCondition& condition);

 private:
  friend class Symbol;
  friend class SymbolCondition;
  friend Symbol operator-(const Symbol& a);
  friend SymbolCondition operator<(const Symbol& a, const Symbol& b);
  friend SymbolCondition operator<=(const Symbol& a, const Symbol& b);
  friend SymbolCondition operator!(const SymbolCondition& a);
  friend SymbolCondition operator&&(const SymbolCondition& a, const SymbolCondition& b);
  friend SymbolCondition operator||(const SymbolCondition& a, const SymbolCondition& b);

  /// Notes an operation in the active recording, without any folding.
  [[nodiscard]] static Symbol Record(KomponoOperation operation, const Symbol& a);
  [[nodiscard]] static Symbol Record(KomponoOperation operation, const Symbol& a, const Symbol& b);
  [[nodiscard]] static SymbolCondition RecordCondition(KomponoOperation operation,
                                                       const Symbol& a,
                                                       const Symbol& b);
  [[nodiscard]] static SymbolCondition RecordCondition(KomponoOperation operation,
                                                       const SymbolCondition& a,
                                                       const SymbolCondition& b);
  [[nodiscard]] static SymbolCondition RecordNot(const SymbolCondition& a);
  [[nodiscard]] static Symbol RecordSelect(const SymbolCondition& condition,
                                           const Symbol& a,
                                           const Symbol& b);

  /// The operand of `symbol` if it is a negation of the active recording, else null.
  [[nodiscard]] static bool IsNegation(const Symbol& symbol, Symbol* operand);
  [[nodiscard]] static bool Same(const Symbol& a, const Symbol& b);

  struct NodeHash {
    std::size_t operator()(const KomponoExpressionNode& node) const {
      uint64_t hash = std::bit_cast<uint64_t>(node.value);
      for (const int32_t part :
           {node.operation, node.operand[0], node.operand[1], node.operand[2]}) {
        hash = (hash ^ static_cast<uint32_t>(part)) + 0x9E3779B97F4A7C15ULL;  // splitmix64
        hash = (hash ^ (hash >> 30U)) * 0xBF58476D1CE4E5B9ULL;
        hash = (hash ^ (hash >> 27U)) * 0x94D049BB133111EBULL;
        hash ^= hash >> 31U;
      }
      return static_cast<std::size_t>(hash);
    }
  };
  struct NodeEqual {
    bool operator()(const KomponoExpressionNode& a, const KomponoExpressionNode& b) const {
      return a.operation == b.operation && a.operand[0] == b.operand[0] &&
             a.operand[1] == b.operand[1] && a.operand[2] == b.operand[2] &&
             std::bit_cast<uint64_t>(a.value) == std::bit_cast<uint64_t>(b.value);
    }
  };

  // Trivial, so that no thread-exit code stays behind when a plugin library is unmapped.
  static Recording*& Active() {
    static thread_local Recording* active = nullptr;
    return active;
  }
  static std::atomic<uint32_t>& Count() {
    static std::atomic<uint32_t> count{0};
    return count;
  }
  static Recording& Current() {
    if (Active() == nullptr) {
      throw std::logic_error("Symbol: no recording is active on this thread");
    }
    return *Active();  // NOLINT(clang-analyzer-cplusplus.NewDelete): a recording unlinks itself
  }

  void Unlink() {
    for (Recording** link = &Active(); *link != nullptr; link = &(*link)->previous_) {
      if (*link == this) {
        *link = previous_;
        return;
      }
    }
  }

  int32_t Add(KomponoOperation operation,
              int32_t a = -1,
              int32_t b = -1,
              int32_t c = -1,
              double value = 0.0);

  Symbol Place(int32_t place) const { return Symbol(place, number_); }
  SymbolCondition ConditionPlace(int32_t place) const { return SymbolCondition(place, number_); }

  std::vector<KomponoExpressionNode> nodes_;
  std::unordered_map<KomponoExpressionNode, int32_t, NodeHash, NodeEqual> places_;
  uint32_t number_;
  Recording* previous_;
};

inline int32_t Recording::Add(
    KomponoOperation operation, int32_t a, int32_t b, int32_t c, double value) {
  const KomponoExpressionNode node{static_cast<int32_t>(operation), {a, b, c}, value};
  const auto [found, is_new] = places_.try_emplace(node, static_cast<int32_t>(nodes_.size()));
  if (is_new) nodes_.push_back(node);
  return found->second;
}

inline Symbol Recording::Variable(int number) {
  if (number < 0) throw std::logic_error("Recording::Variable: expects number >= 0");
  Recording& recording = Current();
  return recording.Place(recording.Add(KOMPONO_VARIABLE, number));
}

inline int32_t Recording::Index(const Symbol& symbol) {
  if (symbol.IsConstant()) return Add(KOMPONO_CONSTANT, -1, -1, -1, symbol.value_);
  if (symbol.recording_ != number_) {
    throw std::logic_error("Symbol: belongs to another recording");
  }
  return symbol.place_;
}

inline int32_t Recording::Index(const SymbolCondition& condition) {
  if (condition.IsConstant()) {  // conditions have no constant node: 0 < 1, or 1 < 0
    const int32_t zero = Index(Symbol(0.0));
    const int32_t one = Index(Symbol(1.0));
    return condition.value_ ? Add(KOMPONO_LESS, zero, one) : Add(KOMPONO_LESS, one, zero);
  }
  if (condition.recording_ != number_) {
    throw std::logic_error("SymbolCondition: belongs to another recording");
  }
  return condition.place_;
}

inline Symbol Recording::Record(KomponoOperation operation, const Symbol& a) {
  Recording& recording = Current();
  return recording.Place(recording.Add(operation, recording.Index(a)));
}

inline Symbol Recording::Record(KomponoOperation operation, const Symbol& a, const Symbol& b) {
  Recording& recording = Current();
  const int32_t place_a = recording.Index(a);
  return recording.Place(recording.Add(operation, place_a, recording.Index(b)));
}

inline SymbolCondition Recording::RecordCondition(KomponoOperation operation,
                                                  const Symbol& a,
                                                  const Symbol& b) {
  Recording& recording = Current();
  const int32_t place_a = recording.Index(a);
  return recording.ConditionPlace(recording.Add(operation, place_a, recording.Index(b)));
}

inline SymbolCondition Recording::RecordCondition(KomponoOperation operation,
                                                  const SymbolCondition& a,
                                                  const SymbolCondition& b) {
  Recording& recording = Current();
  const int32_t place_a = recording.Index(a);
  return recording.ConditionPlace(recording.Add(operation, place_a, recording.Index(b)));
}

inline SymbolCondition Recording::RecordNot(const SymbolCondition& a) {
  Recording& recording = Current();
  return recording.ConditionPlace(recording.Add(KOMPONO_NOT, recording.Index(a)));
}

inline Symbol Recording::RecordSelect(const SymbolCondition& condition,
                                      const Symbol& a,
                                      const Symbol& b) {
  Recording& recording = Current();
  const int32_t place_condition = recording.Index(condition);
  const int32_t place_a = recording.Index(a);
  return recording.Place(
      recording.Add(KOMPONO_SELECT, place_condition, place_a, recording.Index(b)));
}

inline bool Recording::IsNegation(const Symbol& symbol, Symbol* operand) {
  if (symbol.IsConstant()) return false;
  Recording& recording = Current();
  const KomponoExpressionNode& node =
      recording.nodes_[static_cast<std::size_t>(recording.Index(symbol))];
  if (node.operation != KOMPONO_NEGATE) return false;
  *operand = recording.Place(node.operand[0]);
  return true;
}

inline bool Recording::Same(const Symbol& a, const Symbol& b) {
  if (a.IsConstant() != b.IsConstant()) return false;
  if (a.IsConstant()) {
    return std::bit_cast<uint64_t>(a.value_) == std::bit_cast<uint64_t>(b.value_);
  }
  return a.place_ == b.place_ && a.recording_ == b.recording_;
}

inline Symbol Symbol::Record(KomponoOperation operation, const Symbol& a) {
  return Recording::Record(operation, a);
}
inline Symbol Symbol::Record(KomponoOperation operation, const Symbol& a, const Symbol& b) {
  return Recording::Record(operation, a, b);
}

inline Symbol operator-(const Symbol& a) {
  if (a.IsConstant()) return -a.value_;
  Symbol operand;
  if (Recording::IsNegation(a, &operand)) return operand;
  return Symbol::Record(KOMPONO_NEGATE, a);
}

inline Symbol operator+(const Symbol& a, const Symbol& b) {
  if (a.IsConstant() && b.IsConstant()) return a.value_ + b.value_;
  if (a.Is(0.0)) return b;
  if (b.Is(0.0)) return a;
  return Symbol::Record(KOMPONO_ADD, a, b);
}

inline Symbol operator-(const Symbol& a, const Symbol& b) {
  if (a.IsConstant() && b.IsConstant()) return a.value_ - b.value_;
  if (a.Is(0.0)) return -b;
  if (b.Is(0.0)) return a;
  return Symbol::Record(KOMPONO_SUBTRACT, a, b);
}

inline Symbol operator*(const Symbol& a, const Symbol& b) {
  if (a.IsConstant() && b.IsConstant()) return a.value_ * b.value_;
  if (a.Is(0.0) || b.Is(0.0)) return 0.0;
  if (a.Is(1.0)) return b;
  if (b.Is(1.0)) return a;
  if (a.Is(-1.0)) return -b;
  if (b.Is(-1.0)) return -a;
  return Symbol::Record(KOMPONO_MULTIPLY, a, b);
}

inline Symbol operator/(const Symbol& a, const Symbol& b) {
  if (a.IsConstant() && b.IsConstant()) return a.value_ / b.value_;
  if (b.Is(1.0)) return a;
  if (b.Is(-1.0)) return -a;
  return Symbol::Record(KOMPONO_DIVIDE, a, b);
}

inline SymbolCondition operator<(const Symbol& a, const Symbol& b) {
  if (a.IsConstant() && b.IsConstant()) return a.value_ < b.value_;
  return Recording::RecordCondition(KOMPONO_LESS, a, b);
}
inline SymbolCondition operator<=(const Symbol& a, const Symbol& b) {
  if (a.IsConstant() && b.IsConstant()) return a.value_ <= b.value_;
  return Recording::RecordCondition(KOMPONO_LESS_EQUAL, a, b);
}
inline SymbolCondition operator>(const Symbol& a, const Symbol& b) {
  return b < a;
}
inline SymbolCondition operator>=(const Symbol& a, const Symbol& b) {
  return b <= a;
}

inline SymbolCondition operator!(const SymbolCondition& a) {
  if (a.IsConstant()) return !a.value_;
  return Recording::RecordNot(a);
}
inline SymbolCondition operator&&(const SymbolCondition& a, const SymbolCondition& b) {
  if (a.IsConstant()) return a.value_ ? b : SymbolCondition(false);
  if (b.IsConstant()) return b.value_ ? a : SymbolCondition(false);
  return Recording::RecordCondition(KOMPONO_AND, a, b);
}
inline SymbolCondition operator||(const SymbolCondition& a, const SymbolCondition& b) {
  if (a.IsConstant()) return a.value_ ? SymbolCondition(true) : b;
  if (b.IsConstant()) return b.value_ ? SymbolCondition(true) : a;
  return Recording::RecordCondition(KOMPONO_OR, a, b);
}

inline Symbol SymbolCondition::Choose(const SymbolCondition& condition,
                                      const Symbol& a,
                                      const Symbol& b) {
  if (condition.IsConstant()) return condition.value_ ? a : b;
  if (Recording::Same(a, b)) return a;
  return Recording::RecordSelect(condition, a, b);
}

inline Symbol Symbol::CopySign(const Symbol& magnitude, const Symbol& sign) {
  const Symbol size = abs(magnitude);
  return Select(sign < Symbol(0.0), -size, size);
}

inline Symbol Symbol::Power(const Symbol& base, const Symbol& exponent) {
  if (base.IsConstant() && exponent.IsConstant()) return std::pow(base.value_, exponent.value_);
  if (!exponent.IsConstant()) return exp(exponent * log(base));
  const double value = exponent.value_;
  if (value == 0.5) return sqrt(base);
  if (value != std::trunc(value) || std::abs(value) > 1e6) return exp(exponent * log(base));
  Symbol power = 1.0;
  Symbol square = base;
  for (auto rest = static_cast<uint32_t>(std::abs(value)); rest != 0; rest >>= 1U) {
    if ((rest & 1U) != 0) power = power * square;
    if (rest > 1) square = square * square;
  }
  return value < 0 ? Symbol(1.0) / power : power;
}

}  // namespace kompono

template <>
struct std::numeric_limits<kompono::Symbol> : std::numeric_limits<double> {};

namespace Eigen {

template <>
struct NumTraits<kompono::Symbol> : NumTraits<double> {
  using Real = kompono::Symbol;
  using NonInteger = kompono::Symbol;
  using Nested = kompono::Symbol;
  using Literal = double;

  // NOLINTBEGIN(readability-identifier-naming): Eigen's names
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 8,
    MulCost = 8
  };
  // NOLINTEND(readability-identifier-naming)
};

template <class BinaryOp>
struct ScalarBinaryOpTraits<kompono::Symbol, double, BinaryOp> {
  using ReturnType = kompono::Symbol;
};
template <class BinaryOp>
struct ScalarBinaryOpTraits<double, kompono::Symbol, BinaryOp> {
  using ReturnType = kompono::Symbol;
};

}  // namespace Eigen

#endif  // KOMPONO_SCALAR_SYMBOL_HPP_
