// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_SRC_CANONICAL_HPP_
#define KOMPONO_EXPRESSION_SRC_CANONICAL_HPP_

#include "graph.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// The order and shape in which sums and products are written, shared by Simplify and the expansion
/// of polynomials.
///
/// A product is a number times a fraction: Multiply(number, rest), where rest is a product of
/// powers, or a Divide of two such. A sum is a chain from the left, negative terms subtracted, its
/// number last. Terms are ordered as people do: monomials of variables first, higher degrees before
/// lower ones and x before y, then what is not a monomial, short before long.
namespace kompono::expression_internal {

struct Term {
  double coefficient = 1.0;
  Index rest = -1;  ///< without numeric factor and without sign
};

struct Factor {
  Index base = -1;
  int64_t power = 1;
  bool below = false;  ///< in the denominator
};

/// Sums and products taken apart.
[[nodiscard]] Term SplitCoefficient(Graph& graph, Index i);
[[nodiscard]] bool IsSum(const Graph& graph, Index i);

/// The terms of a sum, or nothing if there are more than `most`. The number is a term whose rest is
/// -1.
[[nodiscard]] bool TermsOf(Graph& graph, Index sum, std::size_t most, std::vector<Term>* terms);

/// Factors of something without numeric factor; false if there are more than `most`, or far more
/// products to open. numbers met on the way are multiplied into `coefficient`.
[[nodiscard]] bool FactorsOf(const Graph& graph,
                             Index product,
                             std::size_t most,
                             double* coefficient,
                             std::vector<Factor>* factors);

/// Exponents of the variables if the node is a product of variables, ascending by variable.
[[nodiscard]] bool MonomialOf(const Graph& graph,
                              Index i,
                              std::vector<std::pair<int, int64_t>>* exponents);

/// `coefficient * rest`.
[[nodiscard]] Index Scale(Graph& graph, double coefficient, Index rest);
[[nodiscard]] Index BuildPower(Graph& graph, Index base, int64_t power);

/// The sum of terms with distinct rests, in the order given. Terms with coefficient zero are
/// dropped if nothing is lost by it.
[[nodiscard]] Index BuildSum(Graph& graph, std::vector<Term> terms, double constant);
void SortTerms(const Graph& graph, std::vector<Term>* terms);
/// Orders and builds terms as TermsOf gives them.
[[nodiscard]] Index BuildSumOf(Graph& graph, std::vector<Term> terms);

/// If the terms of a short sum differ only in sign and in what they multiply, as in 2x - 2y, or are
/// all subtracted, the common number is taken out of `sum` and returned; else 1.
[[nodiscard]] double TakeOutNumber(Graph& graph, Index* sum);

/// The product of factors with distinct (base, below), ordered here.
[[nodiscard]] Index BuildProduct(Graph& graph, double coefficient, std::vector<Factor> factors);

}  // namespace kompono::expression_internal

#endif  // KOMPONO_EXPRESSION_SRC_CANONICAL_HPP_
