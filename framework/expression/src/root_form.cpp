// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/root_form.hpp"

#include "expansion.hpp"
#include "pool.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "kompono/diagnostics/expects.hpp"

namespace kompono {

using expression_internal::Access;
using expression_internal::CollectPolynomial;
using expression_internal::Expansion;
using expression_internal::Graph;
using expression_internal::Group;
using expression_internal::Index;
using expression_internal::Local;

namespace {

/// The factor before a lone root, 0 if the group is anything else.
double FactorOfRoot(const Graph& graph, const Group& group) {
  const bool is_lone_root = group.others.size() == 1 && group.others.front().second == 1 &&
                            graph.Is(group.others.front().first, KOMPONO_SQRT);
  const bool has_number = group.coefficient.size() == 1 && group.coefficient.front().rest < 0;
  for (const int64_t exponent : group.exponents) {
    if (exponent != 0) return 0.0;
  }
  return is_lone_root && has_number ? group.coefficient.front().coefficient : 0.0;
}

}  // namespace

std::optional<RootForm> ExpandRootForm(const Expression& expression,
                                       std::span<const int> variables,
                                       const ExpandOptions& options) {
  KOMPONO_EXPECTS(!expression.IsCondition());
  const Expression simplified = expression.Simplify();
  const Local local = Access::Gather({&simplified, 1});
  Expansion expansion(local.graph, local.roots, variables, options);
  std::vector<Group> polynomial;
  Index root = -1;
  double factor = 0.0;
  for (Group& group : expansion.GroupsOf(0)) {
    if (group.others.empty()) {
      polynomial.push_back(std::move(group));
      continue;
    }
    factor = FactorOfRoot(expansion.result(), group);
    if (root >= 0 || factor == 0.0) return std::nullopt;
    root = group.others.front().first;
  }
  if (root < 0) return std::nullopt;
  const Index radicand = expansion.result().node(root).operand[0];
  const Expression under =
      Access::Wrap(expansion.result(), {&radicand, 1}, local.names).front() * (factor * factor);
  const std::optional<Polynomial> under_root = ExpandPolynomial(under, variables, options);
  if (!under_root) return std::nullopt;
  return RootForm{.outside = CollectPolynomial(expansion, polynomial, variables, local.names),
                  .sign = factor < 0.0 ? -1 : 1,
                  .under = *under_root};
}

}  // namespace kompono
