// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_EXPRESSION_HPP_
#define KOMPONO_EXPRESSION_EXPRESSION_HPP_

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/scalar/expression_node.h"

/// Formulas as values: what a plugin recorded through Symbol, to be given numbers, simplified,
/// differentiated, evaluated and printed (printing.hpp), or multiplied out (polynomial.hpp).
///
///     Parsed<std::vector<Expression>> drives = ImportRecording(nodes, roots, variable_count,
///     "lambda"); const Expression q1 = drives->front().Substitute({{2, 1200.0}, {3,
///     820.0}}).Simplify(); std::cout << ToText(q1, {.names = {"x", "y"}});
///
/// An Expression is a cheap handle to an immutable formula in which equal parts exist once.
/// Variables are numbered from 0; the number is what identifies them. No operation recurses over
/// the formula, so length and depth are limited by memory alone. Handles may be shared between
/// threads.
namespace kompono {

namespace expression_internal {
class Pool;
struct Access;
}  // namespace expression_internal

struct ExpressionSize {
  std::size_t operations = 0;  ///< equal parts counted once: what the C text computes
  double written =
      0.0;  ///< every use counted again: what a formula without names for parts contains
  std::size_t depth = 0;  ///< longest chain of operations
};

class Expression {
 public:
  Expression() = default;  ///< zero
  // NOLINTNEXTLINE(google-explicit-constructor): numbers mix freely with expressions in formulas.
  Expression(double value) : value_(value) {}

  /// The variable with this number, from 0. A name given here is what the printers use unless told
  /// otherwise; it does not make a different variable. @throws std::logic_error for a negative
  /// number.
  [[nodiscard]] static Expression Variable(int number, std::string_view name = {});

  [[nodiscard]] bool IsConstant() const;
  [[nodiscard]] std::optional<double> ConstantValue() const;
  /// A comparison or a combination of comparisons: may be evaluated (1 or 0) and given to Select,
  /// not calculated with.
  [[nodiscard]] bool IsCondition() const;
  /// Numbers of the variables it depends on, ascending.
  [[nodiscard]] std::vector<int> Variables() const;
  [[nodiscard]] ExpressionSize Size() const;

  /// `variables[k]` is the value of variable k. Outside its domain a formula gives NaN or infinity
  /// as C's math.h does.
  /// @throws std::logic_error if a variable it depends on has no value.
  [[nodiscard]] double Evaluate(std::span<const double> variables) const;
  /// Replaces all the variables named at once; numbers are folded.
  [[nodiscard]] Expression Substitute(const std::map<int, Expression>& values) const;
  /// The partial derivative. |x| counts as rising at 0; a Select is differentiated branch by
  /// branch.
  [[nodiscard]] Expression Derivative(int variable) const;
  /// See the function Simplify below.
  [[nodiscard]] Expression Simplify() const;

  /// The same formula, part by part (x + y and y + x become the same by Simplify()).
  [[nodiscard]] bool operator==(const Expression& other) const;

  friend Expression operator-(const Expression& a) { return Apply(KOMPONO_NEGATE, a); }
  friend Expression operator+(const Expression& a, const Expression& b) {
    return Apply(KOMPONO_ADD, a, b);
  }
  friend Expression operator-(const Expression& a, const Expression& b) {
    return Apply(KOMPONO_SUBTRACT, a, b);
  }
  friend Expression operator*(const Expression& a, const Expression& b) {
    return Apply(KOMPONO_MULTIPLY, a, b);
  }
  friend Expression operator/(const Expression& a, const Expression& b) {
    return Apply(KOMPONO_DIVIDE, a, b);
  }

  friend Expression sqrt(const Expression& a) { return Apply(KOMPONO_SQRT, a); }
  friend Expression sin(const Expression& a) { return Apply(KOMPONO_SIN, a); }
  friend Expression cos(const Expression& a) { return Apply(KOMPONO_COS, a); }
  friend Expression tan(const Expression& a) { return Apply(KOMPONO_TAN, a); }
  friend Expression asin(const Expression& a) { return Apply(KOMPONO_ASIN, a); }
  friend Expression acos(const Expression& a) { return Apply(KOMPONO_ACOS, a); }
  friend Expression atan(const Expression& a) { return Apply(KOMPONO_ATAN, a); }
  friend Expression abs(const Expression& a) { return Apply(KOMPONO_ABS, a); }
  friend Expression exp(const Expression& a) { return Apply(KOMPONO_EXP, a); }
  friend Expression log(const Expression& a) { return Apply(KOMPONO_LOG, a); }
  friend Expression atan2(const Expression& y, const Expression& x) {
    return Apply(KOMPONO_ATAN2, y, x);
  }

  friend Expression Less(const Expression& a, const Expression& b) {
    return Apply(KOMPONO_LESS, a, b);
  }
  friend Expression LessEqual(const Expression& a, const Expression& b) {
    return Apply(KOMPONO_LESS_EQUAL, a, b);
  }
  friend Expression Not(const Expression& a) { return Apply(KOMPONO_NOT, a); }
  friend Expression And(const Expression& a, const Expression& b) {
    return Apply(KOMPONO_AND, a, b);
  }
  friend Expression Or(const Expression& a, const Expression& b) { return Apply(KOMPONO_OR, a, b); }
  friend Expression Select(const Expression& condition, const Expression& a, const Expression& b) {
    return Apply3(KOMPONO_SELECT, condition, a, b);
  }

 private:
  friend struct expression_internal::Access;

  Expression(std::shared_ptr<expression_internal::Pool> pool, int32_t place);

  /// @throws std::logic_error if a number is wanted and a condition given, or the other way round.
  static Expression Apply(KomponoOperation operation, const Expression& a);
  static Expression Apply(KomponoOperation operation, const Expression& a, const Expression& b);
  static Expression Apply3(KomponoOperation operation,
                           const Expression& a,
                           const Expression& b,
                           const Expression& c);

  std::shared_ptr<expression_internal::Pool> pool_;  // null: the plain number value_
  int32_t place_ = -1;
  double value_ = 0.0;
};

/// The formulas at `roots` in a recorded list. `variable_count` is how many variables the recording
/// may use; `source` names the plugin in complaints. The list is checked completely, for it comes
/// from outside: unknown operations E0281, operands that are missing or not before their user
/// E0282, numbers where conditions belong or the other way round E0283, variables out of range
/// E0284, roots that do not exist or are conditions E0285. At most twenty complaints.
[[nodiscard]] Parsed<std::vector<Expression>> ImportRecording(
    std::span<const KomponoExpressionNode> nodes,
    std::span<const int32_t> roots,
    int variable_count,
    std::string_view source);

/// All values in one pass; parts the roots share are computed once. For many points make an
/// ExpressionProgram.
[[nodiscard]] std::vector<double> Evaluate(std::span<const Expression> roots,
                                           std::span<const double> variables);

/// Formulas laid out for repeated evaluation. Immutable; may be used from several threads.
class ExpressionProgram {
 public:
  explicit ExpressionProgram(std::span<const Expression> roots);

  [[nodiscard]] std::size_t RootCount() const { return roots_.size(); }
  /// How many values `variables` must hold at least.
  [[nodiscard]] std::size_t VariableCount() const { return variable_count_; }
  /// @throws std::logic_error if a span has the wrong size.
  void Evaluate(std::span<const double> variables, std::span<double> results) const;

 private:
  std::vector<KomponoExpressionNode> nodes_;
  std::vector<int32_t> roots_;
  std::size_t variable_count_ = 0;
};

[[nodiscard]] std::vector<Expression> Substitute(std::span<const Expression> roots,
                                                 const std::map<int, Expression>& values);

/// ∂roots[i]/∂variables[j] at [i * variables.size() + j].
[[nodiscard]] std::vector<Expression> Derivatives(std::span<const Expression> roots,
                                                  std::span<const int> variables);

struct Simplified {
  std::vector<Expression> expressions;
  ExpressionSize before, after;
};

/// Folds constants; drops zeros and ones; collects like terms and equal factors; orders sums and
/// products so that equal ones become the same part; moves signs outwards; turns division by a
/// number into multiplication.
///
/// The value changes by rounding only, and the domain not at all: x/x, sqrt(x)*sqrt(x) and 0/x
/// stay, because the short forms would also have a value where these have none. Roots are taken
/// together, so parts they share stay shared. The form is the same for every order in which sums
/// and products were written.
[[nodiscard]] Simplified Simplify(std::span<const Expression> roots);

/// Size of several formulas together, shared parts once.
[[nodiscard]] ExpressionSize SizeOf(std::span<const Expression> roots);

}  // namespace kompono

#endif  // KOMPONO_EXPRESSION_EXPRESSION_HPP_
