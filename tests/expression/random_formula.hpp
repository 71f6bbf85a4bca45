// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_EXPRESSION_RANDOM_FORMULA_HPP_
#define KOMPONO_TESTS_EXPRESSION_RANDOM_FORMULA_HPP_

#include <cstdint>
#include <random>
#include <vector>

#include "kompono/expression/expression.hpp"

/// Random formulas and a way to compute them that shares nothing with the library under test.
namespace kompono::testing_support {

struct RandomFormula {
  std::vector<KomponoExpressionNode> nodes;
  int32_t root = 0;

  [[nodiscard]] Expression Import() const;
};

inline constexpr int kVariableCount = 3;

struct FormulaKind {
  int operations = 20;
  bool smooth = false;  ///< no Select and no absolute value
};

[[nodiscard]] RandomFormula MakeFormula(std::mt19937_64& random, const FormulaKind& kind);

[[nodiscard]] std::vector<double> MakePoint(std::mt19937_64& random);

/// A value with a bound of its rounding error. `decided` is false where rounding decides about the
/// outcome: at the edge of a domain, at the switch of a Select, at a pole, or beyond the range of
/// numbers.
struct BoundedValue {
  double value = 0.0;
  double error = 0.0;
  bool decided = true;
  double size =
      0.0;  ///< sum of the sizes of all terms when everything polynomial is multiplied out
};

enum class Form { kAsWritten, kMultipliedOut };

/// With kMultipliedOut the error covers the cancellation between the terms of expanded products.
[[nodiscard]] BoundedValue ComputeBounded(const RandomFormula& formula,
                                          const std::vector<double>& point,
                                          Form form = Form::kAsWritten);

/// The value and its derivatives by dual numbers.
struct Gradient {
  double value = 0.0;
  double by[kVariableCount] = {};
};

[[nodiscard]] Gradient ComputeGradient(const RandomFormula& formula,
                                       const std::vector<double>& point);

}  // namespace kompono::testing_support

#endif  // KOMPONO_TESTS_EXPRESSION_RANDOM_FORMULA_HPP_
