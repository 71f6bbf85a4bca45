// SPDX-License-Identifier: Apache-2.0
// Formulas of about 100 000 nodes: long, deep and heavily shared. None may exhaust the stack, the
// memory or the test's time.
#include <cmath>

#include "kompono/expression/polynomial.hpp"
#include "kompono/expression/printing.hpp"

namespace kompono {
namespace {

constexpr int32_t kLength = 100000;
constexpr int32_t kTerms = kLength / 4;  // of a sum in which each term has four nodes
const std::vector<double> kAt{0.3, 0.7};

/// Builds lists of nodes as recordings are.
class List {
 public:
  int32_t Variable(int number) { return Add(KOMPONO_VARIABLE, number); }
  int32_t Constant(double value) {
    nodes_.push_back({KOMPONO_CONSTANT, {-1, -1, -1}, value});
    return static_cast<int32_t>(nodes_.size()) - 1;
  }
  int32_t Add(KomponoOperation operation, int32_t a, int32_t b = -1) {
    nodes_.push_back({operation, {a, b, -1}, 0.0});
    return static_cast<int32_t>(nodes_.size()) - 1;
  }
  [[nodiscard]] Expression Import(int32_t root) const {
    return ImportRecording(nodes_, {&root, 1}, kLength, "large").value().front();
  }

 private:
  std::vector<KomponoExpressionNode> nodes_;
};

/// sin(sin(sin(… x …)))
Expression DeepChain() {
  List list;
  int32_t at = list.Variable(0);
  for (int k = 0; k < kLength; ++k) at = list.Add(k % 2 == 0 ? KOMPONO_SIN : KOMPONO_COS, at);
  return list.Import(at);
}

/// 0·x0 + 1·x1 + 2·x2 + …, added up from the left or from the right
Expression LongSum(bool from_the_left) {
  List list;
  int32_t at = list.Variable(0);
  for (int k = 1; k < kTerms; ++k) {
    const int32_t term = list.Add(KOMPONO_MULTIPLY, list.Constant(k), list.Variable(k));
    at = from_the_left ? list.Add(KOMPONO_ADD, at, term) : list.Add(KOMPONO_ADD, term, at);
  }
  return list.Import(at);
}

/// x·y·x·y·…, 100 000 factors
Expression LongProduct() {
  List list;
  const int32_t factor[] = {list.Variable(0), list.Variable(1)};
  int32_t at = factor[0];
  for (int k = 1; k < kLength; ++k) at = list.Add(KOMPONO_MULTIPLY, at, factor[k % 2]);
  return list.Import(at);
}

/// Sums whose every partial sum is used once more; written out there are 2^100000 terms.
Expression SharedSums(KomponoOperation operation) {
  List list;
  int32_t before = list.Variable(0);
  int32_t at = list.Variable(1);
  for (int k = 0; k < kLength; ++k) {
    const int32_t next = list.Add(operation, at, before);
    before = at;
    at = k % 50 == 49 ? list.Add(KOMPONO_SIN, next) : next;
  }
  return list.Import(at);
}

/// x ← x² + y, again and again
Expression IteratedSquares(int count) {
  List list;
  const int32_t y = list.Variable(1);
  int32_t at = list.Variable(0);
  for (int k = 0; k < count; ++k) {
    at = list.Add(KOMPONO_ADD, list.Add(KOMPONO_MULTIPLY, at, at), y);
  }
  return list.Import(at);
}

/// Every operation once; the results must have some value, and the texts some length.
void ExerciseAll(const Expression& e, const std::vector<double>& at, bool is_linear = false) {
  const std::vector<int> variables{0, 1};
  const double value = e.Evaluate(at);
  const auto expect_same = [&at, value](const Expression& other) {
    if (std::isfinite(value)) {
      EXPECT_NEAR(other.Evaluate(at), value, 1e-6 * (1.0 + std::abs(value)));
    }
  };
  const Expression simple = e.Simplify();
  expect_same(simple);
  expect_same(ExpandUnderRoots(e, variables, {.most_terms = 100}));
  expect_same(e.Substitute({{0, Expression::Variable(0)}}));
  EXPECT_EQ(e.Derivative(0).Variables().empty(), is_linear);
  EXPECT_GT(ToText(e).size(), 1000U);
  EXPECT_LT(ToText(simple).size(), 20000000U);
  EXPECT_GT(ToLatex(e, {.shared = true}).size(), 1000U);
  const std::vector<NamedExpression> named{{"q", e}};
  EXPECT_GT(ToC(named).value().size(), 1000U);
}

TEST(LargeFormula, DeepChain) {
  ExerciseAll(DeepChain(), kAt);
}

TEST(LargeFormula, LongSumFromTheLeft) {
  std::vector<double> at(kTerms, 1e-3);
  const Expression sum = LongSum(true);
  ExerciseAll(sum, at, true);
  EXPECT_NEAR(sum.Evaluate(at), 1e-3 * (1.0 + 0.5 * kTerms * (kTerms - 1.0)), 1e-3);
}

TEST(LargeFormula, LongSumFromTheRightIsTheSameSum) {
  EXPECT_EQ(LongSum(false).Simplify(), LongSum(true).Simplify());
}

TEST(LargeFormula, LongProductBecomesTwoPowers) {
  const Expression product = LongProduct();
  EXPECT_EQ(ToText(product.Simplify()), "x0^50000*x1^50000");
  EXPECT_EQ(ToText(product), ToText(product.Simplify()));
  EXPECT_LT(product.Simplify().Size().operations, 60U);
}

TEST(LargeFormula, SharedSums) {
  ExerciseAll(SharedSums(KOMPONO_ADD), kAt);
}

TEST(LargeFormula, SharedDifferences) {
  ExerciseAll(SharedSums(KOMPONO_SUBTRACT), kAt);
}

TEST(LargeFormula, SharedProducts) {
  ExerciseAll(SharedSums(KOMPONO_MULTIPLY), kAt);
}

TEST(LargeFormula, SharedQuotients) {
  ExerciseAll(SharedSums(KOMPONO_DIVIDE), kAt);
}

TEST(LargeFormula, IteratedSquares) {
  ExerciseAll(IteratedSquares(kLength / 2), {0.1, -0.5});
}

TEST(LargeFormula, HandlesAppendInConstantTime) {
  const Expression x = Expression::Variable(0);
  Expression sum = x;
  for (int k = 0; k < 20000; ++k) sum = sum + x * static_cast<double>(k);
  EXPECT_EQ(ToText(sum.Simplify()), "199990001*x0");
}

}  // namespace
}  // namespace kompono
