// SPDX-License-Identifier: Apache-2.0
#include "canonical.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace kompono::expression_internal {
namespace {

// Beyond this a power is no longer gathered across products: it costs more than it gathers.
constexpr int64_t kMostPower = int64_t{1} << 17;
constexpr std::size_t kMostFactors = 64;
// Sums up to this length have a minus sign carried into them.
constexpr std::size_t kShortSum = 8;

struct TermKey {
  bool is_monomial = false;
  int64_t degree = 0;
  int length = 0;  // rough, so that terms of like length follow the order of their variables
  std::vector<std::pair<int, int64_t>> exponents;
  const Facts* facts = nullptr;
  int32_t operation = 0;
  Term term;
};

bool Before(const TermKey& a, const TermKey& b) {
  if (a.is_monomial != b.is_monomial) return a.is_monomial;
  if (a.is_monomial) {
    if (a.degree != b.degree) return a.degree > b.degree;
    return std::lexicographical_compare(a.exponents.begin(),
                                        a.exponents.end(),
                                        b.exponents.begin(),
                                        b.exponents.end(),
                                        [](const auto& p, const auto& q) {
                                          return p.first != q.first ? p.first < q.first
                                                                    : p.second > q.second;
                                        });
  }
  return std::tuple(a.facts->complexity,
                    a.facts->first_variable,
                    a.operation,
                    a.facts->hash,
                    a.term.rest) <
         std::tuple(
             b.facts->complexity, b.facts->first_variable, b.operation, b.facts->hash, b.term.rest);
}

bool FactorBefore(const Graph& graph, const Factor& a, const Factor& b) {
  const auto key = [&graph](const Factor& f) {
    const Facts& facts = graph.facts(f.base);
    return std::tuple(facts.complexity > 0,
                      graph.Is(f.base, KOMPONO_VARIABLE) ? 0U : facts.complexity,
                      facts.first_variable,
                      graph.node(f.base).operation,
                      facts.hash,
                      f.base);
  };
  return key(a) < key(b);
}

/// The factors without which a term would have a larger domain: denominators, and what is not
/// defined everywhere.
std::vector<std::pair<Index, bool>> PartialFactors(const Graph& graph, Index rest) {
  std::vector<Factor> factors;
  double ignored = 1.0;
  std::vector<std::pair<Index, bool>> partial;
  if (!FactorsOf(graph, rest, kMostFactors, &ignored, &factors)) return {{rest, false}};
  for (const Factor& factor : factors) {
    if (factor.below || !graph.facts(factor.base).total) {
      partial.emplace_back(factor.base, factor.below);
    }
  }
  return partial;
}

/// Drops zero times something where the something is defined everywhere, or where it is not but
/// other terms have the same gaps.
void DropZeros(const Graph& graph, std::vector<Term>* terms) {
  std::erase_if(*terms, [&graph](const Term& term) {
    return term.coefficient == 0.0 && graph.facts(term.rest).total;
  });
  const auto is_zero = [](const Term& term) { return term.coefficient == 0.0; };
  if (std::none_of(terms->begin(), terms->end(), is_zero)) return;
  std::set<std::pair<Index, bool>> gaps;
  for (const Term& term : *terms) {
    if (is_zero(term)) continue;
    for (const auto& gap : PartialFactors(graph, term.rest)) gaps.insert(gap);
  }
  std::erase_if(*terms, [&](const Term& term) {
    if (!is_zero(term)) return false;
    const auto own = PartialFactors(graph, term.rest);
    return std::all_of(
        own.begin(), own.end(), [&gaps](const auto& gap) { return gaps.contains(gap); });
  });
}

bool IsUnit(double value) {
  return value == 1.0 || value == -1.0;
}

}  // namespace

bool IsSum(const Graph& graph, Index i) {
  return graph.Is(i, KOMPONO_ADD) || graph.Is(i, KOMPONO_SUBTRACT);
}

Term SplitCoefficient(Graph& graph, Index i) {
  double sign = 1.0;
  while (graph.Is(i, KOMPONO_NEGATE)) {
    sign = -sign;
    i = graph.node(i).operand[0];
  }
  const Node node = graph.node(i);
  if (node.operation == KOMPONO_MULTIPLY && graph.IsConstant(node.operand[0]) &&
      !graph.IsConstant(node.operand[1])) {
    return {sign * graph.node(node.operand[0]).value, node.operand[1]};
  }
  if (node.operation == KOMPONO_DIVIDE && graph.IsConstant(node.operand[0]) &&
      !graph.IsConstant(node.operand[0], 1.0)) {
    const double value = graph.node(node.operand[0]).value;
    return {sign * value, graph.Raw(KOMPONO_DIVIDE, graph.Constant(1.0), node.operand[1])};
  }
  return {sign, i};
}

bool TermsOf(Graph& graph, Index sum, std::size_t most, std::vector<Term>* terms) {
  terms->clear();
  const auto take = [&graph, terms](double sign, Index i) {
    if (graph.IsConstant(i)) {
      terms->push_back({sign * graph.node(i).value, -1});
    } else {
      Term term = SplitCoefficient(graph, i);
      term.coefficient *= sign;
      terms->push_back(term);
    }
  };
  while (IsSum(graph, sum)) {
    if (terms->size() + 1 >= most) return false;
    const Node node = graph.node(sum);
    take(node.operation == KOMPONO_ADD ? 1.0 : -1.0, node.operand[1]);
    sum = node.operand[0];
  }
  take(1.0, sum);
  std::reverse(terms->begin(), terms->end());
  return true;
}

bool FactorsOf(const Graph& graph,
               Index product,
               std::size_t most,
               double* coefficient,
               std::vector<Factor>* factors) {
  factors->clear();
  // Users before operands, so that each node is taken apart once however often it occurs.
  std::map<std::pair<Index, bool>, int64_t, std::greater<>> waiting{{{product, false}, 1}};
  std::size_t looked_at = 0;
  while (!waiting.empty()) {
    if (++looked_at > 64 + 4 * most) return false;
    const auto [place, power] = *waiting.begin();
    const auto [i, below] = place;
    waiting.erase(waiting.begin());
    const Node& node = graph.node(i);
    const bool may_open = power < kMostPower;
    if (node.operation == KOMPONO_MULTIPLY && may_open) {
      waiting[{node.operand[0], below}] += power;
      waiting[{node.operand[1], below}] += power;
    } else if (node.operation == KOMPONO_DIVIDE && !below && may_open) {
      waiting[{node.operand[0], false}] += power;
      waiting[{node.operand[1], true}] += power;
    } else if (node.operation == KOMPONO_NEGATE) {
      if (power % 2 != 0) *coefficient = -*coefficient;
      waiting[{node.operand[0], below}] += power;
    } else if (node.operation == KOMPONO_CONSTANT && !below) {
      *coefficient *= std::pow(node.value, static_cast<double>(power));
    } else {
      if (factors->size() >= most) return false;
      factors->push_back({i, power, below});
    }
  }
  return true;
}

bool MonomialOf(const Graph& graph, Index i, std::vector<std::pair<int, int64_t>>* exponents) {
  exponents->clear();
  if (graph.Is(i, KOMPONO_VARIABLE)) {
    exponents->emplace_back(graph.node(i).operand[0], 1);
    return true;
  }
  if (!graph.Is(i, KOMPONO_MULTIPLY)) return false;
  std::map<Index, int64_t, std::greater<>> waiting{{i, 1}};
  while (!waiting.empty()) {
    const auto [place, power] = *waiting.begin();
    waiting.erase(waiting.begin());
    const Node& node = graph.node(place);
    if (node.operation == KOMPONO_VARIABLE) {
      exponents->emplace_back(node.operand[0], power);
    } else if (node.operation == KOMPONO_MULTIPLY && power < kMostPower) {
      waiting[node.operand[0]] += power;
      waiting[node.operand[1]] += power;
    } else {
      return false;
    }
  }
  std::sort(exponents->begin(), exponents->end());
  return true;
}

Index Scale(Graph& graph, double coefficient, Index rest) {
  if (coefficient == 1.0) return rest;
  if (coefficient == -1.0) {
    std::vector<Term> terms;
    if (!IsSum(graph, rest) || !TermsOf(graph, rest, kShortSum, &terms)) return graph.Negate(rest);
    for (Term& term : terms) term.coefficient = -term.coefficient;
    return BuildSumOf(graph, std::move(terms));
  }
  const Node node = graph.node(rest);
  if (node.operation == KOMPONO_DIVIDE && graph.IsConstant(node.operand[0], 1.0)) {
    return graph.Raw(KOMPONO_DIVIDE, graph.Constant(coefficient), node.operand[1]);
  }
  return graph.Raw(KOMPONO_MULTIPLY, graph.Constant(coefficient), rest);
}

Index BuildPower(Graph& graph, Index base, int64_t power) {
  Index result = -1;
  for (Index square = base; power > 0; power /= 2) {
    if (power % 2 != 0) {
      result = result < 0 ? square : graph.Raw(KOMPONO_MULTIPLY, square, result);
    }
    if (power > 1) square = graph.Raw(KOMPONO_MULTIPLY, square, square);
  }
  return result;
}

void SortTerms(const Graph& graph, std::vector<Term>* terms) {
  std::vector<TermKey> keys;
  keys.reserve(terms->size());
  for (const Term& term : *terms) {
    TermKey key;
    key.term = term;
    key.facts = &graph.facts(term.rest);
    for (uint32_t length = key.facts->complexity; length >= 8; length /= 8) ++key.length;
    key.operation = graph.node(term.rest).operation;
    key.is_monomial = MonomialOf(graph, term.rest, &key.exponents);
    for (const auto& [variable, power] : key.exponents) key.degree += power;
    keys.push_back(std::move(key));
  }
  std::sort(keys.begin(), keys.end(), Before);
  for (std::size_t i = 0; i < keys.size(); ++i) (*terms)[i] = keys[i].term;
}

Index BuildSum(Graph& graph, std::vector<Term> terms, double constant) {
  DropZeros(graph, &terms);
  if (terms.empty()) return graph.Constant(constant);
  Index sum = -1;
  // "y - x" rather than "-x + y", "-1 - x" rather than "-x - 1": it saves the change of sign.
  if (terms.front().coefficient == -1.0) {
    const auto positive = std::find_if(
        terms.begin(), terms.end(), [](const Term& term) { return term.coefficient > 0.0; });
    if (positive != terms.end()) {
      std::rotate(terms.begin(), positive, positive + 1);
    } else if (constant != 0.0) {
      sum = graph.Constant(constant);
      constant = 0.0;
    }
  }
  for (const Term& term : terms) {
    if (sum < 0) {
      sum = IsUnit(term.coefficient) && term.coefficient < 0.0
                ? graph.Negate(term.rest)
                : Scale(graph, term.coefficient, term.rest);
    } else if (term.coefficient < 0.0) {
      sum = graph.Raw(KOMPONO_SUBTRACT, sum, Scale(graph, -term.coefficient, term.rest));
    } else {
      sum = graph.Raw(KOMPONO_ADD, sum, Scale(graph, term.coefficient, term.rest));
    }
  }
  if (constant < 0.0) return graph.Raw(KOMPONO_SUBTRACT, sum, graph.Constant(-constant));
  if (constant != 0.0) return graph.Raw(KOMPONO_ADD, sum, graph.Constant(constant));
  return sum;
}

Index BuildSumOf(Graph& graph, std::vector<Term> terms) {
  double constant = 0.0;
  std::erase_if(terms, [&constant](const Term& term) {
    if (term.rest < 0) constant += term.coefficient;
    return term.rest < 0;
  });
  SortTerms(graph, &terms);
  return BuildSum(graph, std::move(terms), constant);
}

double TakeOutNumber(Graph& graph, Index* sum) {
  std::vector<Term> terms;
  if (!IsSum(graph, *sum) || !TermsOf(graph, *sum, kShortSum, &terms)) return 1.0;
  const double size = std::abs(terms.front().coefficient);
  const bool all_alike = std::all_of(terms.begin(), terms.end(), [size](const Term& term) {
    return std::abs(term.coefficient) == size;
  });
  const bool all_subtracted = std::all_of(
      terms.begin(), terms.end(), [](const Term& term) { return term.coefficient < 0.0; });
  if (!all_alike || !std::isnormal(size) || (size == 1.0 && !all_subtracted)) return 1.0;
  const double number = all_subtracted ? -size : size;
  for (Term& term : terms) term.coefficient /= number;
  *sum = BuildSumOf(graph, std::move(terms));
  return number;
}

Index BuildProduct(Graph& graph, double coefficient, std::vector<Factor> factors) {
  if (coefficient == 0.0) {
    const bool all_total = std::all_of(factors.begin(), factors.end(), [&graph](const Factor& f) {
      return graph.facts(f.base).total && !f.below;
    });
    if (all_total) return graph.Constant(0.0);
  }
  std::sort(factors.begin(), factors.end(), [&graph](const Factor& a, const Factor& b) {
    return FactorBefore(graph, a, b);
  });
  Index above = -1;
  Index below = -1;
  for (const Factor& factor : factors) {
    const Index power = BuildPower(graph, factor.base, factor.power);
    Index& side = factor.below ? below : above;
    side = side < 0 ? power : graph.Raw(KOMPONO_MULTIPLY, side, power);
  }
  if (above < 0 && below < 0) return graph.Constant(coefficient);
  if (below < 0) return Scale(graph, coefficient, above);
  if (above < 0) above = graph.Constant(1.0);
  return Scale(graph, coefficient, graph.Raw(KOMPONO_DIVIDE, above, below));
}

}  // namespace kompono::expression_internal
