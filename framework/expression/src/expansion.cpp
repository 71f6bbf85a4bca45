// SPDX-License-Identifier: Apache-2.0
#include "expansion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace kompono::expression_internal {
namespace {

constexpr std::size_t kMostFactors = 8;
constexpr int64_t kMostPower = 1000;  // products of higher degree stay products

int64_t LargestPower(const Poly& poly) {
  int64_t largest = 0;
  for (const auto& [powers, coefficient] : poly) {
    for (const auto& [generator, power] : powers) largest = std::max(largest, power);
  }
  return largest;
}

}  // namespace

Expansion::Expansion(const Graph& source,
                     std::span<const Index> roots,
                     std::span<const int> variables,
                     const ExpandOptions& options)
    : source_(source),
      options_(options),
      variables_(variables.begin(), variables.end()),
      depends_(source.size(), false),
      remaining_uses_(UseCounts(source.nodes(), roots)),
      polys_(source.size()),
      places_(source.size(), -1) {
  for (std::size_t k = 0; k < variables_.size(); ++k) positions_.emplace(variables_[k], k);
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (remaining_uses_[i] != 0) Expand(static_cast<Index>(i));
  }
  for (const Index root : roots) root_polys_.push_back(Take(root));
}

void Expansion::Expand(Index i) {
  const Node& node = source_.node(i);
  const auto at = static_cast<std::size_t>(i);
  if (node.operation == KOMPONO_VARIABLE) {
    depends_[at] = positions_.contains(node.operand[0]);
    const Index place = result_.Variable(node.operand[0]);
    if (depends_[at]) {
      polys_[at] = Generator(place, true);
    } else {
      places_[at] = place;
    }
    return;
  }
  if (node.operation == KOMPONO_CONSTANT) {
    places_[at] = result_.Constant(node.value);
    return;
  }
  const int count = OperandCount(node.operation);
  for (int k = 0; k < count; ++k) depends_[at] = depends_[at] || Depends(node.operand[k]);
  if (depends_[at] && !GivesCondition(node.operation)) {
    polys_[at] = ExpandDependent(node);
    return;
  }
  std::array<Index, 3> operand{-1, -1, -1};
  for (int k = 0; k < count; ++k) {
    operand[static_cast<std::size_t>(k)] = ComposeOperand(node.operand[k]);
  }
  places_[at] = result_.Apply(node.operation, operand[0], operand[1], operand[2]);
}

Poly Expansion::ExpandDependent(const Node& node) {
  const Index a = node.operand[0];
  const Index b = node.operand[1];
  switch (node.operation) {
    case KOMPONO_ADD: {
      Poly first = Take(a);
      return Sum(std::move(first), Take(b), 1.0);
    }
    case KOMPONO_SUBTRACT: {
      Poly first = Take(a);
      return Sum(std::move(first), Take(b), -1.0);
    }
    case KOMPONO_NEGATE:
      return Sum({}, Take(a), -1.0);
    case KOMPONO_MULTIPLY: {
      const Poly first = Take(a);
      return a == b ? (Take(b), Product(first, first)) : Product(first, Take(b));
    }
    case KOMPONO_DIVIDE: {
      Poly first = Take(a);
      return Quotient(std::move(first), ComposeOperand(b), Depends(b));
    }
    default: {
      std::array<Index, 3> operand{-1, -1, -1};
      for (int k = 0; k < OperandCount(node.operation); ++k) {
        operand[static_cast<std::size_t>(k)] = ComposeOperand(node.operand[k]);
      }
      return Generator(result_.Apply(node.operation, operand[0], operand[1], operand[2]), true);
    }
  }
}

Poly Expansion::Take(Index i) {
  const auto at = static_cast<std::size_t>(i);
  uint32_t& uses = remaining_uses_[at];
  if (uses > 0) --uses;
  if (!Depends(i)) return Generator(places_[at], false);
  if (uses == 0) return std::move(polys_[at]);
  // A long sum with many users would be copied for each of them; it becomes one thing instead.
  if (polys_[at].size() > options_.most_terms) polys_[at] = Generator(Compose(polys_[at]), true);
  return polys_[at];
}

Index Expansion::ComposeOperand(Index i) {
  const auto at = static_cast<std::size_t>(i);
  if (places_[at] >= 0) {
    if (remaining_uses_[at] > 0) --remaining_uses_[at];
    return places_[at];
  }
  return Compose(Take(i));
}

Poly Expansion::Generator(Index place, bool dependent) {
  if (result_.IsConstant(place)) {
    const double value = result_.node(place).value;
    return {{Powers{}, {value, std::abs(value)}}};
  }
  const Term term = SplitCoefficient(result_, place);
  generator_depends_.emplace(term.rest, dependent);
  return {{Powers{{term.rest, 1}}, {term.coefficient, std::abs(term.coefficient)}}};
}

bool Expansion::IsTotal(const Powers& powers) const {
  return std::all_of(powers.begin(), powers.end(), [this](const auto& each) {
    return result_.facts(each.first).total;
  });
}

Poly Expansion::Sum(Poly a, Poly b, double sign_b) {
  double sign_a = 1.0;
  if (a.size() < b.size()) {
    a.swap(b);
    std::swap(sign_a, sign_b);
  }
  if (sign_a < 0.0) {
    for (auto& [powers, coefficient] : a) coefficient.value = -coefficient.value;
  }
  for (const auto& [powers, coefficient] : b) {
    Sized& sum = a[powers];
    sum.value += sign_b * coefficient.value;
    sum.size += coefficient.size;
    if (sum.value == 0.0 && IsTotal(powers)) a.erase(powers);
  }
  return a;
}

Poly Expansion::Product(const Poly& a, const Poly& b) {
  // Nothing times what may be undefined is not nothing.
  if (a.empty() != b.empty()) {
    const Poly zero{{Powers{}, {0.0, 0.0}}};
    return a.empty() ? Product(zero, b) : Product(a, zero);
  }
  const bool too_long = a.size() > 1 && b.size() > 1 && a.size() * b.size() > options_.most_terms;
  if (too_long || LargestPower(a) + LargestPower(b) > kMostPower) {
    const Index first = Compose(a);
    return Generator(
        BuildProduct(result_,
                     1.0,
                     &a == &b ? std::vector<Factor>{{first, 2, false}}
                              : std::vector<Factor>{{first, 1, false}, {Compose(b), 1, false}}),
        true);
  }
  Poly product;
  for (const auto& [powers_a, coefficient_a] : a) {
    for (const auto& [powers_b, coefficient_b] : b) {
      Powers powers;
      auto p = powers_a.begin();
      auto q = powers_b.begin();
      while (p != powers_a.end() || q != powers_b.end()) {
        if (q == powers_b.end() || (p != powers_a.end() && p->first < q->first)) {
          powers.push_back(*p++);
        } else if (p == powers_a.end() || q->first < p->first) {
          powers.push_back(*q++);
        } else {
          powers.emplace_back(p->first, p->second + q->second);
          ++p;
          ++q;
        }
      }
      Sized& sum = product[powers];
      sum.value += coefficient_a.value * coefficient_b.value;
      sum.size += coefficient_a.size * coefficient_b.size;
    }
  }
  std::erase_if(product, [this](const auto& each) {
    return each.second.value == 0.0 && IsTotal(each.first);
  });
  return product;
}

Poly Expansion::Quotient(Poly above, Index below, bool below_depends) {
  if (result_.IsConstant(below)) {
    const double divisor = result_.node(below).value;
    if (std::isnormal(1.0 / divisor)) {
      for (auto& [powers, coefficient] : above) {
        coefficient.value /= divisor;
        coefficient.size /= std::abs(divisor);
      }
      return above;
    }
  }
  if (!below_depends || above.size() == 1) {
    const Index reciprocal = result_.Divide(result_.Constant(1.0), below);
    return Product(above, Generator(reciprocal, below_depends));
  }
  return Generator(result_.Divide(Compose(above), below), true);
}

Index Expansion::BuildProductOf(const Powers& powers, double* coefficient) {
  std::map<std::pair<Index, bool>, int64_t> opened;
  for (const auto& [base, power] : powers) {
    std::vector<Factor> factors;
    double inner = 1.0;
    // Fractions and products among the generators are opened, so that a·(1/b) is written a/b.
    if (!FactorsOf(result_, base, kMostFactors, &inner, &factors) || inner != 1.0) {
      opened[{base, false}] += power;
      continue;
    }
    for (const Factor& factor : factors) {
      opened[{factor.base, factor.below}] += power * factor.power;
    }
  }
  std::vector<Factor> factors;
  factors.reserve(opened.size());
  for (const auto& [place, power] : opened) factors.push_back({place.first, power, place.second});
  const Term term = SplitCoefficient(result_, BuildProduct(result_, 1.0, std::move(factors)));
  *coefficient *= term.coefficient;
  return term.rest;
}

std::vector<Group> Expansion::Grouped(const Poly& poly) {
  std::map<std::pair<std::vector<int64_t>, Powers>, std::vector<Term>> groups;
  for (const auto& [powers, coefficient] : poly) {
    const bool is_leftover =
        std::abs(coefficient.value) <= options_.leftover * coefficient.size && IsTotal(powers);
    if (is_leftover) continue;
    std::vector<int64_t> exponents(variables_.size(), 0);
    Powers others;
    Powers free;
    for (const auto& [generator, power] : powers) {
      const Node& node = result_.node(generator);
      const auto variable =
          node.operation == KOMPONO_VARIABLE ? positions_.find(node.operand[0]) : positions_.end();
      if (variable != positions_.end()) {
        exponents[variable->second] = power;
      } else {
        (generator_depends_.at(generator) ? others : free).emplace_back(generator, power);
      }
    }
    Term term{coefficient.value, -1};
    if (!free.empty()) term.rest = BuildProductOf(free, &term.coefficient);
    groups[{std::move(exponents), std::move(others)}].push_back(term);
  }
  std::vector<Group> result;
  result.reserve(groups.size());
  for (auto& [key, coefficient] : groups) {
    result.push_back({key.first, key.second, std::move(coefficient)});
  }
  std::stable_sort(result.begin(), result.end(), [this](const Group& a, const Group& b) {
    return GroupBefore(a, b);
  });
  return result;
}

bool Expansion::GroupBefore(const Group& a, const Group& b) const {
  const auto key = [this](const Group& group) {
    const int64_t degree =
        std::accumulate(group.exponents.begin(), group.exponents.end(), int64_t{0});
    const bool is_constant = degree == 0 && group.others.empty();
    uint64_t complexity = 0;
    uint64_t hash = 0;
    for (const auto& [generator, power] : group.others) {
      complexity += result_.facts(generator).complexity;
      hash += result_.facts(generator).hash * static_cast<uint64_t>(power);
    }
    // Groups that rank alike are ordered by their exponents, the higher ones first.
    return std::tuple(is_constant,
                      !group.others.empty(),
                      options_.order == MonomialOrder::kGraded ? -degree : 0,
                      complexity,
                      hash);
  };
  const auto [constant_a, others_a, degree_a, complexity_a, hash_a] = key(a);
  const auto [constant_b, others_b, degree_b, complexity_b, hash_b] = key(b);
  return std::tie(constant_a, others_a, degree_a, b.exponents, complexity_a, hash_a, a.others) <
         std::tie(constant_b, others_b, degree_b, a.exponents, complexity_b, hash_b, b.others);
}

Index Expansion::BuildCoefficient(std::vector<Term> terms) {
  return BuildSumOf(result_, std::move(terms));
}

Index Expansion::Compose(const Poly& poly) {
  std::vector<Term> terms;
  double constant = 0.0;
  for (Group& group : Grouped(poly)) {
    Powers powers = group.others;
    for (std::size_t k = 0; k < variables_.size(); ++k) {
      if (group.exponents[k] > 0) {
        powers.emplace_back(result_.Variable(variables_[k]), group.exponents[k]);
      }
    }
    if (powers.empty()) {  // free of the variables: no brackets around it
      for (const Term& term : group.coefficient) {
        if (term.rest >= 0) terms.push_back(term);
        if (term.rest < 0) constant += term.coefficient;
      }
      continue;
    }
    Term term;
    if (group.coefficient.size() == 1) {
      term.coefficient = group.coefficient.front().coefficient;
      if (group.coefficient.front().rest >= 0) {
        powers.emplace_back(group.coefficient.front().rest, 1);
      }
    } else {
      const Index sum = BuildCoefficient(std::move(group.coefficient));
      powers.emplace_back(sum, 1);
    }
    term.rest = BuildProductOf(powers, &term.coefficient);
    terms.push_back(term);
  }
  return BuildSum(result_, std::move(terms), constant);
}

}  // namespace kompono::expression_internal
