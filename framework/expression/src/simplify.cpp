// SPDX-License-Identifier: Apache-2.0
#include "canonical.hpp"
#include "graph.hpp"
#include "pool.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "kompono/expression/expression.hpp"

namespace kompono {
namespace {

using expression_internal::Access;
using expression_internal::BuildProduct;
using expression_internal::BuildSum;
using expression_internal::CopyInto;
using expression_internal::Factor;
using expression_internal::FactorsOf;
using expression_internal::Graph;
using expression_internal::Index;
using expression_internal::IsSum;
using expression_internal::Local;
using expression_internal::Node;
using expression_internal::OperandCount;
using expression_internal::Scale;
using expression_internal::SplitCoefficient;
using expression_internal::Term;
using expression_internal::TermsOf;
using expression_internal::UseCounts;

// Sums and products with one user are always opened into it; those with more only up to this
// length, since each opening costs operations.
constexpr std::size_t kOpenAlways = 1000;
constexpr std::size_t kOpenShared = 8;
constexpr int kMostPasses = 4;

enum class Family { kNone, kSum, kProduct };

Family FamilyOf(int32_t operation) {
  switch (operation) {
    case KOMPONO_ADD:
    case KOMPONO_SUBTRACT:
    case KOMPONO_NEGATE:
      return Family::kSum;
    case KOMPONO_MULTIPLY:
    case KOMPONO_DIVIDE:
      return Family::kProduct;
    default:
      return Family::kNone;
  }
}

/// One pass from the operands to the roots. `source` is read, `result` is written.
class SimplifyPass {
 public:
  SimplifyPass(const Graph& source, std::span<const Index> roots, std::size_t open_shared)
      : source_(source),
        open_shared_(open_shared),
        uses_(UseCounts(source.nodes(), roots)),
        absorbed_(source.size(), false),
        places_(source.size(), -1) {
    MarkAbsorbed();
    for (std::size_t i = 0; i < source.size(); ++i) {
      if (uses_[i] != 0 && !absorbed_[i]) places_[i] = Rebuild(static_cast<Index>(i));
    }
    std::vector<Index> new_roots;
    for (const Index root : roots) new_roots.push_back(Place(root));
    roots_ = CopyInto(compact_, result_.nodes(), new_roots);
  }

  Graph TakeGraph() { return std::move(compact_); }
  std::vector<Index> TakeRoots() { return std::move(roots_); }

 private:
  [[nodiscard]] Index Place(Index i) const { return places_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] bool UsedOnce(Index i) const { return uses_[static_cast<std::size_t>(i)] == 1; }
  [[nodiscard]] std::size_t MostToOpen(Index i) const {
    return UsedOnce(i) ? kOpenAlways : open_shared_;
  }

  // Inner links of a chain of additions or multiplications are not rebuilt one by one, or a sum of
  // n terms would cost n² steps.
  void MarkAbsorbed() {
    for (std::size_t i = 0; i < source_.size(); ++i) {
      if (uses_[i] == 0) continue;
      const Node& user = source_.nodes()[i];
      const Family family = FamilyOf(user.operation);
      if (family == Family::kNone) continue;
      for (int k = 0; k < OperandCount(user.operation); ++k) {
        const Index operand = user.operand[k];
        // A denominator is built on its own: a fraction in it must not be turned over.
        const bool is_denominator = user.operation == KOMPONO_DIVIDE && k == 1;
        if (UsedOnce(operand) && FamilyOf(source_.node(operand).operation) == family &&
            !is_denominator) {
          absorbed_[static_cast<std::size_t>(operand)] = true;
        }
      }
    }
  }

  Index Rebuild(Index i) {
    const Node& node = source_.node(i);
    switch (node.operation) {
      case KOMPONO_CONSTANT:
        return result_.Constant(node.value);
      case KOMPONO_VARIABLE:
        return result_.Variable(node.operand[0]);
      default:
        break;
    }
    switch (FamilyOf(node.operation)) {
      case Family::kSum:
        return RebuildSum(i);
      case Family::kProduct:
        return RebuildProduct(i);
      case Family::kNone:
        break;
    }
    if (OperandCount(node.operation) == 1 && expression_internal::IsFunction(node.operation)) {
      return RebuildFunction(node.operation, Place(node.operand[0]));
    }
    const auto place = [this, &node](int k) {
      return node.operand[k] < 0 ? Index{-1} : Place(node.operand[k]);
    };
    return result_.Apply(node.operation, place(0), place(1), place(2));
  }

  // --- sums ---
  struct SumParts {
    std::vector<Term> terms;
    std::unordered_map<Index, std::size_t> where;
    double constant = 0.0;
  };

  Index RebuildSum(Index root) {
    SumParts parts;
    std::vector<std::pair<Index, double>> waiting{{root, 1.0}};
    while (!waiting.empty()) {
      const auto [i, sign] = waiting.back();
      waiting.pop_back();
      if (i != root && !absorbed_[static_cast<std::size_t>(i)]) {
        AddToSum(i, sign, &parts);
        continue;
      }
      const Node& node = source_.node(i);
      if (node.operation == KOMPONO_NEGATE) {
        waiting.emplace_back(node.operand[0], -sign);
      } else {  // the left one next, to keep the order of reading
        waiting.emplace_back(node.operand[1], node.operation == KOMPONO_ADD ? sign : -sign);
        waiting.emplace_back(node.operand[0], sign);
      }
    }
    SortTerms(result_, &parts.terms);
    return BuildSum(result_, std::move(parts.terms), parts.constant);
  }

  void AddToSum(Index i, double sign, SumParts* parts) {
    const Index place = Place(i);
    if (result_.IsConstant(place)) {
      parts->constant += sign * result_.node(place).value;
      return;
    }
    const Term term = SplitCoefficient(result_, place);
    const double coefficient = sign * term.coefficient;
    std::vector<Term> inner;
    if (!IsSum(result_, term.rest) || std::abs(coefficient) != 1.0 ||
        !TermsOf(result_, term.rest, MostToOpen(i), &inner)) {
      AddTerm({coefficient, term.rest}, parts);
      return;
    }
    for (const Term& each : inner) AddTerm({coefficient * each.coefficient, each.rest}, parts);
  }

  static void AddTerm(const Term& term, SumParts* parts) {
    if (term.rest < 0) {
      parts->constant += term.coefficient;
      return;
    }
    const auto [found, is_new] = parts->where.try_emplace(term.rest, parts->terms.size());
    if (is_new) {
      parts->terms.push_back(term);
    } else {
      parts->terms[found->second].coefficient += term.coefficient;
    }
  }

  // --- products ---
  struct ProductParts {
    double coefficient = 1.0;
    std::map<std::pair<Index, bool>, int64_t> powers;
  };

  Index RebuildProduct(Index root) {
    ProductParts parts;
    std::vector<std::pair<Index, bool>> waiting{{root, false}};
    while (!waiting.empty()) {
      const auto [i, below] = waiting.back();
      waiting.pop_back();
      if (i != root && !absorbed_[static_cast<std::size_t>(i)]) {
        AddToProduct(i, below, &parts);
        continue;
      }
      const Node& node = source_.node(i);
      waiting.emplace_back(node.operand[1], node.operation == KOMPONO_DIVIDE);
      waiting.emplace_back(node.operand[0], false);
    }
    std::vector<Factor> factors;
    for (const auto& [place, power] : parts.powers) {
      factors.push_back({place.first, power, place.second});
    }
    return BuildProduct(result_, parts.coefficient, std::move(factors));
  }

  void AddToProduct(Index i, bool below, ProductParts* parts) {
    const Index place = Place(i);
    if (result_.IsConstant(place)) {
      AddNumber(result_.node(place).value, below, parts);
      return;
    }
    Term term = SplitCoefficient(result_, place);
    AddNumber(term.coefficient, below, parts);
    AddNumber(TakeOutNumber(result_, &term.rest), below, parts);
    std::vector<Factor> inner;
    double inner_coefficient = 1.0;
    const bool is_product = result_.Is(term.rest, KOMPONO_MULTIPLY) ||
                            (result_.Is(term.rest, KOMPONO_DIVIDE) && !below);
    const bool opens =
        is_product && FactorsOf(result_, term.rest, MostToOpen(i), &inner_coefficient, &inner) &&
        Multiplications(inner) <= MostToOpen(i) &&
        !(below &&
          std::any_of(inner.begin(), inner.end(), [](const Factor& f) { return f.below; }));
    if (!opens) {
      ++parts->powers[{term.rest, below}];
      return;
    }
    AddNumber(inner_coefficient, below, parts);
    for (const Factor& factor : inner) {
      parts->powers[{factor.base, factor.below || below}] += factor.power;
    }
  }

  /// How many multiplications powers cost, roughly.
  static std::size_t Multiplications(const std::vector<Factor>& factors) {
    std::size_t count = 0;
    for (const Factor& factor : factors) {
      count += static_cast<std::size_t>(std::bit_width(static_cast<uint64_t>(factor.power)));
    }
    return count;
  }

  void AddNumber(double value, bool below, ProductParts* parts) {
    if (!below) {
      parts->coefficient *= value;
    } else if (std::isnormal(1.0 / value)) {
      parts->coefficient /= value;
    } else {
      ++parts->powers[{result_.Constant(value), true}];
    }
  }

  // --- functions ---
  Index RebuildFunction(int32_t operation, Index a) {
    if (result_.IsConstant(a)) return result_.Apply(operation, a);
    if (operation == KOMPONO_ABS && result_.facts(a).nonnegative) return a;
    const Term term = SplitCoefficient(result_, a);
    const double size = std::abs(term.coefficient);
    switch (operation) {
      case KOMPONO_SIN:
      case KOMPONO_TAN:
      case KOMPONO_ASIN:
      case KOMPONO_ATAN: {
        const Index value = result_.Raw(operation, Scale(result_, size, term.rest));
        return term.coefficient < 0.0 ? result_.Negate(value) : value;
      }
      case KOMPONO_COS:
        return result_.Raw(operation, Scale(result_, size, term.rest));
      case KOMPONO_ABS:
        return Scale(result_, size, RebuildAbs(term.rest));
      case KOMPONO_SQRT: {
        const double root = std::sqrt(size);
        const bool is_square = std::fma(root, root, -size) == 0.0;  // exactly
        if (term.coefficient > 0.0 && is_square && std::isnormal(root)) {
          return Scale(result_, root, result_.Raw(operation, term.rest));
        }
        return result_.Raw(operation, a);
      }
      default:
        return result_.Raw(operation, a);
    }
  }

  Index RebuildAbs(Index a) {
    return result_.facts(a).nonnegative ? a : result_.Raw(KOMPONO_ABS, a);
  }

  const Graph& source_;
  std::size_t open_shared_;
  std::vector<uint32_t> uses_;
  std::vector<bool> absorbed_;
  std::vector<Index> places_;
  Graph result_;
  Graph compact_;
  std::vector<Index> roots_;
};

/// Passes until the formula does not become shorter.
Local SimplifyRepeatedly(const Local& original, std::size_t open_shared) {
  Local best;
  best.names = original.names;
  SimplifyPass first(original.graph, original.roots, open_shared);
  best.graph = first.TakeGraph();
  best.roots = first.TakeRoots();
  std::size_t operations = SizeOf(best.graph, best.roots).operations;
  for (int pass = 1; pass < kMostPasses; ++pass) {
    SimplifyPass next(best.graph, best.roots, open_shared);
    Graph graph = next.TakeGraph();
    std::vector<Index> roots = next.TakeRoots();
    const std::size_t shorter = SizeOf(graph, roots).operations;
    if (shorter >= operations) break;
    operations = shorter;
    best.graph = std::move(graph);
    best.roots = std::move(roots);
  }
  return best;
}

}  // namespace

Simplified Simplify(std::span<const Expression> roots) {
  const Local original = Access::Gather(roots);
  Simplified simplified;
  simplified.before = SizeOf(original.graph, original.roots);
  // Opening shared parts finds more like terms, keeping them closed keeps more sharing: the shorter
  // outcome counts.
  Local opened = SimplifyRepeatedly(original, kOpenShared);
  Local closed = SimplifyRepeatedly(original, 1);
  simplified.after = SizeOf(opened.graph, opened.roots);
  const ExpressionSize other = SizeOf(closed.graph, closed.roots);
  Local& better = other.operations < simplified.after.operations ? closed : opened;
  if (&better == &closed) simplified.after = other;
  simplified.expressions =
      Access::Wrap(std::move(better.graph), better.roots, std::move(better.names));
  return simplified;
}

}  // namespace kompono
