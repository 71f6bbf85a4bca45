// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/root_form.hpp"

#include "pool.hpp"

#include <vector>

namespace kompono {

using expression_internal::Access;
using expression_internal::Index;
using expression_internal::Local;

std::optional<RootForm> ExpandRootForm(const Expression& expression,
                                       std::span<const int> variables,
                                       const ExpandOptions& options) {
  const Expression expanded = ExpandUnderRoots(expression, variables, options);
  Local local = Access::Gather({&expanded, 1});
  std::vector<Index> radicands;
  for (const KomponoExpressionNode& node : local.graph.nodes()) {
    if (node.operation == KOMPONO_SQRT) radicands.push_back(node.operand[0]);
  }
  if (radicands.size() != 1) return std::nullopt;
  const Expression radicand = Access::Wrap(std::move(local.graph), radicands, local.names).front();
  const std::optional<Polynomial> under = ExpandPolynomial(radicand, variables, options);
  for (const int sign : {1, -1}) {
    const Expression rest = expanded - Expression(static_cast<double>(sign)) * sqrt(radicand);
    const std::optional<Polynomial> outside = ExpandPolynomial(rest.Simplify(), variables, options);
    if (under && outside) return RootForm{.outside = *outside, .sign = sign, .under = *under};
  }
  return std::nullopt;
}

}  // namespace kompono
