// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_SRC_EXPANSION_HPP_
#define KOMPONO_EXPRESSION_SRC_EXPANSION_HPP_

#include "canonical.hpp"
#include "graph.hpp"
#include "pool.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "kompono/expression/polynomial.hpp"

namespace kompono::expression_internal {

/// A number with the size of what was summed up to it, which tells cancellation from smallness.
struct Sized {
  double value = 0.0;
  double size = 0.0;
};

/// Powers of generators, ascending by generator. A generator is a node of the result: a chosen
/// variable, something free of them, or something not polynomial in them.
using Powers = std::vector<std::pair<Index, int64_t>>;
using Poly = std::map<Powers, Sized>;

/// One monomial in the chosen variables and in what is not polynomial, with its coefficient taken
/// apart.
struct Group {
  std::vector<int64_t> exponents;  ///< of the chosen variables
  Powers others;                   ///< dependent on them, but not polynomial
  std::vector<Term> coefficient;   ///< free of them; the plain number has rest -1
};

/// Multiplies out all nodes of a graph from the operands to the roots.
class Expansion {
 public:
  Expansion(const Graph& source,
            std::span<const Index> roots,
            std::span<const int> variables,
            const ExpandOptions& options);

  [[nodiscard]] Graph& result() { return result_; }
  /// The groups of root `k` in the order asked for.
  [[nodiscard]] std::vector<Group> GroupsOf(std::size_t k) { return Grouped(root_polys_[k]); }
  /// Root `k` as expression in result().
  [[nodiscard]] Index ComposeRoot(std::size_t k) { return Compose(root_polys_[k]); }
  [[nodiscard]] Index BuildCoefficient(std::vector<Term> terms);

 private:
  [[nodiscard]] bool Depends(Index i) const { return depends_[static_cast<std::size_t>(i)]; }
  void Expand(Index i);
  Poly ExpandDependent(const Node& node);
  Poly Take(Index i);
  Index ComposeOperand(Index i);
  Poly Generator(Index place, bool dependent);
  Poly Sum(Poly a, Poly b, double sign_b);
  Poly Product(const Poly& a, const Poly& b);
  Poly Quotient(Poly above, Index below, bool below_depends);
  Index Compose(const Poly& poly);
  /// The product of powers; signs and numbers in it are multiplied into `coefficient`.
  Index BuildProductOf(const Powers& powers, double* coefficient);
  std::vector<Group> Grouped(const Poly& poly);
  [[nodiscard]] bool IsTotal(const Powers& powers) const;
  [[nodiscard]] bool GroupBefore(const Group& a, const Group& b) const;

  const Graph& source_;
  ExpandOptions options_;
  std::vector<int> variables_;
  std::map<int, std::size_t> positions_;  // of a variable's number in variables_
  std::vector<bool> depends_;             // of a source node: on a chosen variable
  std::vector<uint32_t> remaining_uses_;
  std::vector<Poly> polys_;    // of dependent source nodes
  std::vector<Index> places_;  // of free source nodes, in the result
  std::map<Index, bool> generator_depends_;
  Graph result_;
  std::vector<Poly> root_polys_;
};

/// What `groups` without `others` make up as polynomial, their coefficients simplified together.
[[nodiscard]] Polynomial CollectPolynomial(Expansion& expansion,
                                           std::span<const Group> groups,
                                           std::span<const int> variables,
                                           const Names& names);

}  // namespace kompono::expression_internal

#endif  // KOMPONO_EXPRESSION_SRC_EXPANSION_HPP_
