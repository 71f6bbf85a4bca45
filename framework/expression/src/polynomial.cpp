// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/polynomial.hpp"

#include "expansion.hpp"
#include "pool.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "kompono/diagnostics/expects.hpp"

namespace kompono {

using expression_internal::Access;
using expression_internal::Expansion;
using expression_internal::Group;
using expression_internal::Index;
using expression_internal::Local;

Expression Polynomial::Coefficient(std::span<const int> exponents) const {
  KOMPONO_EXPECTS(exponents.size() == variables.size());
  const auto found = std::find_if(terms.begin(), terms.end(), [exponents](const Monomial& term) {
    return std::equal(exponents.begin(), exponents.end(), term.exponents.begin());
  });
  return found == terms.end() ? Expression() : found->coefficient;
}

Polynomial expression_internal::CollectPolynomial(Expansion& expansion,
                                                  std::span<const Group> groups,
                                                  std::span<const int> variables,
                                                  const Names& names) {
  Polynomial polynomial;
  polynomial.variables.assign(variables.begin(), variables.end());
  std::vector<Index> coefficients;
  for (const Group& group : groups) {
    polynomial.terms.push_back({{group.exponents.begin(), group.exponents.end()}, {}});
    coefficients.push_back(expansion.BuildCoefficient(group.coefficient));
  }
  const Simplified collected = Simplify(Access::Wrap(expansion.result(), coefficients, names));
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    polynomial.terms[k].coefficient = collected.expressions[k];
  }
  return polynomial;
}

std::optional<Polynomial> ExpandPolynomial(const Expression& expression,
                                           std::span<const int> variables,
                                           const ExpandOptions& options) {
  KOMPONO_EXPECTS(!expression.IsCondition());
  const Expression simplified = expression.Simplify();
  const Local local = Access::Gather({&simplified, 1});
  Expansion expansion(local.graph, local.roots, variables, options);
  const std::vector<Group> groups = expansion.GroupsOf(0);
  const bool is_polynomial = std::all_of(
      groups.begin(), groups.end(), [](const Group& group) { return group.others.empty(); });
  if (!is_polynomial) return std::nullopt;
  return CollectPolynomial(expansion, groups, variables, local.names);
}

Expression ExpandUnderRoots(const Expression& expression,
                            std::span<const int> variables,
                            const ExpandOptions& options) {
  KOMPONO_EXPECTS(!expression.IsCondition());
  const Expression simplified = expression.Simplify();
  Local local = Access::Gather({&simplified, 1});
  Expansion expansion(local.graph, local.roots, variables, options);
  const Index root = expansion.ComposeRoot(0);
  return Access::Wrap(std::move(expansion.result()), {&root, 1}, std::move(local.names)).front();
}

}  // namespace kompono
