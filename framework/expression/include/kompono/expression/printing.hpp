// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_PRINTING_HPP_
#define KOMPONO_EXPRESSION_PRINTING_HPP_

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/expression/expression.hpp"

/// Formulas as text for people, as LaTeX, and as C for controllers.
namespace kompono {

enum class PowerStyle {
  kCaret,        ///< x^2
  kSuperscript,  ///< x²
  kProduct,      ///< x*x
};

struct TextOptions {
  /// Names of the variables by number; where missing or empty the name given to
  /// Expression::Variable counts, else x0, x1, …
  std::vector<std::string> names;
  int digits = 6;  ///< significant digits of numbers; whole numbers below 1e15 are printed whole
  int decimals =
      -1;  ///< if not negative: this many decimals at most instead, unless nothing would be left
  std::string times =
      "*";  ///< between factors; empty: 0.1012xy, with a space where names would run together
  PowerStyle powers = PowerStyle::kCaret;
  bool expand = false;  ///< multiply out and collect first, see ExpandUnderRoots
  bool shared = false;  ///< one line `t1 = …` for each part that occurs more than once
  std::string part_name = "t";
  /// A formula that would need more operations than this when written out is printed as if `shared`
  /// were set.
  double most_operations = 5000;
};

/// A formula and what it gives: a drive's name, or the C lvalue it is assigned to.
struct NamedExpression {
  std::string name;
  Expression expression;
};

/// In infix notation with as few brackets as possible: `0.29618*x + 0.17095*y + sqrt(x^2 - 4) -
/// 160.1293`. A choice is `if(a < b, yes, no)`. Intermediate lines, if any, come first; the last
/// line is the formula, without a name. No line feed at the end.
[[nodiscard]] std::string ToText(const Expression& expression, const TextOptions& options = {});
/// A line `name = …` for each; parts that several of them share are named once.
[[nodiscard]] std::string ToText(std::span<const NamedExpression> expressions,
                                 const TextOptions& options = {});

struct LatexOptions {
  std::vector<std::string> names;  ///< q1 becomes q_{1}, theta \theta, other long names upright
  int digits = 6;
  int decimals = -1;
  bool expand = false;
  bool shared = false;
  std::string part_name = "t";
  double most_operations = 5000;
};

/// For math mode. Several lines (shared parts, or several formulas) are set as `aligned`.
[[nodiscard]] std::string ToLatex(const Expression& expression, const LatexOptions& options = {});
[[nodiscard]] std::string ToLatex(std::span<const NamedExpression> expressions,
                                  const LatexOptions& options = {});

struct COptions {
  /// `void name(const double in[], double out[])`, complete with its include; in[k] is variable k,
  /// out[k] formula k. Empty: only the statements, in which the names of variables are used as they
  /// are and the formulas' names are assigned to.
  std::string function_name = "formula";
  std::string real_type = "double";
  std::vector<std::string> names;  ///< of the variables, as in TextOptions
  std::string part_name = "t";
  std::string indent = "  ";
  std::string include = "<math.h>";  ///< empty: no include line
  /// What the target's math.h has.
  std::vector<std::string> functions = {"sqrt",
                                        "sin",
                                        "cos",
                                        "tan",
                                        "asin",
                                        "acos",
                                        "atan",
                                        "atan2",
                                        "fabs",
                                        "exp",
                                        "log",
                                        "NAN",
                                        "INFINITY"};
};

/// C99, the same text for the same formulas. Computes in the order of the formula, each shared part
/// once, in constants t1, t2, …; numbers read back exactly. Complains (E0286) about each function
/// the target does not have.
[[nodiscard]] Parsed<std::string> ToC(std::span<const NamedExpression> expressions,
                                      const COptions& options = {});

}  // namespace kompono

#endif  // KOMPONO_EXPRESSION_PRINTING_HPP_
