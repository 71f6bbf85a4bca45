// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_POLYNOMIAL_HPP_
#define KOMPONO_EXPRESSION_POLYNOMIAL_HPP_

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kompono/expression/expression.hpp"

/// Formulas multiplied out and collected, the form in which control formulas are printed and put
/// into controllers:
///
///     (x + 1)·(x - 1) + sqrt((x + y)·(x + y))   becomes   x² + sqrt(x² + 2·x·y + y²) - 1
namespace kompono {

enum class MonomialOrder {
  kGraded,         ///< higher total degree first: x², x·y, y², x, y, 1
  kLexicographic,  ///< higher powers of the first variable first: x², x·y, x, y², y, 1
};

struct ExpandOptions {
  MonomialOrder order = MonomialOrder::kGraded;
  /// A coefficient smaller than this part of what was added and subtracted to form it is a leftover
  /// of rounding and is dropped. 0 drops only exact zeros.
  double leftover = 1e-14;
  /// A product of sums stays a product if their numbers of terms multiply to more than this.
  std::size_t most_terms = 4096;
};

struct Monomial {
  std::vector<int> exponents;  ///< of Polynomial::variables, in their order
  Expression coefficient;      ///< free of these variables
};

struct Polynomial {
  std::vector<int> variables;
  std::vector<Monomial> terms;  ///< in the order asked for, each exponent vector once

  /// The coefficient of one monomial, zero if it does not occur.
  [[nodiscard]] Expression Coefficient(std::span<const int> exponents) const;
};

/// The expression as polynomial in the given variables, or nothing if it is none (or would exceed
/// `most_terms`). What does not contain the variables is a coefficient and is left as it is, but
/// simplified.
[[nodiscard]] std::optional<Polynomial> ExpandPolynomial(const Expression& expression,
                                                         std::span<const int> variables,
                                                         const ExpandOptions& options = {});

/// The whole expression with everything polynomial in the given variables multiplied out and
/// collected: outside, under roots, in arguments of functions, in numerators and denominators.
/// Terms stand in the order asked for, first monomials, then those with roots and other functions,
/// last what is free of the variables.
[[nodiscard]] Expression ExpandUnderRoots(const Expression& expression,
                                          std::span<const int> variables,
                                          const ExpandOptions& options = {});

}  // namespace kompono

#endif  // KOMPONO_EXPRESSION_POLYNOMIAL_HPP_
