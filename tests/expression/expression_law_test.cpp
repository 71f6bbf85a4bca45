// SPDX-License-Identifier: Apache-2.0
#include "random_formula.hpp"

#include <cmath>
#include <numeric>
#include <optional>
#include <random>

#include "kompono/expression/expression.hpp"
#include "kompono/expression/polynomial.hpp"

namespace kompono {
namespace {

using testing_support::BoundedValue;
using testing_support::ComputeBounded;
using testing_support::ComputeGradient;
using testing_support::Form;
using testing_support::Gradient;
using testing_support::kVariableCount;
using testing_support::MakeFormula;
using testing_support::MakePoint;
using testing_support::RandomFormula;

constexpr int kFormulas = 1500;
constexpr int kPoints = 6;

struct Comparison {
  int compared = 0;
  int undefined = 0;  // of the compared: no finite value on either side
  int skipped = 0;    // rounding decides
  std::optional<std::vector<double>> differs_at;
};

/// Does `expression` have the value of `formula` wherever that is well defined, and none where it
/// has none?
Comparison Compare(const RandomFormula& formula,
                   const Expression& expression,
                   Form form,
                   std::mt19937_64& random) {
  Comparison result;
  for (int k = 0; k < kPoints; ++k) {
    const std::vector<double> point = MakePoint(random);
    const BoundedValue expected = ComputeBounded(formula, point, form);
    if (!expected.decided) {
      ++result.skipped;
      continue;
    }
    ++result.compared;
    const double value = expression.Evaluate(point);
    if (!std::isfinite(expected.value)) {
      ++result.undefined;
      if (std::isfinite(value)) result.differs_at = point;
      continue;
    }
    const double room = 1e-12 * std::abs(expected.value) + 100.0 * expected.error;
    if (!(std::abs(value - expected.value) <= room)) result.differs_at = point;
  }
  return result;
}

/// `transform` must leave values and domain of random formulas alone.
template <class Transform>
void ExpectSameValues(uint64_t seed, const Transform& transform, Form form = Form::kAsWritten) {
  std::mt19937_64 random(seed);
  Comparison total;
  for (int k = 0; k < kFormulas; ++k) {
    const RandomFormula formula =
        MakeFormula(random, {.operations = 3 + k % 40, .smooth = k % 3 == 0});
    const Expression original = formula.Import();
    const Comparison one = Compare(formula, transform(original), form, random);
    ASSERT_FALSE(one.differs_at) << "seed " << seed << ", formula " << k << " at "
                                 << testing::PrintToString(*one.differs_at);
    total.compared += one.compared;
    total.undefined += one.undefined;
    total.skipped += one.skipped;
  }
  EXPECT_GT(total.compared, kFormulas * kPoints / 2);
  EXPECT_GT(total.undefined, kFormulas * kPoints / 50) << "the domain must be tested, too";
  testing::Test::RecordProperty("compared", total.compared);
  testing::Test::RecordProperty("skipped", total.skipped);
}

TEST(ExpressionLaw, ImportKeepsTheValue) {
  ExpectSameValues(11, [](const Expression& e) { return e; });
}

TEST(ExpressionLaw, SimplifyKeepsValueAndDomain) {
  ExpectSameValues(12, [](const Expression& e) { return e.Simplify(); });
}

TEST(ExpressionLaw, SimplifyTwiceKeepsValueAndDomain) {
  ExpectSameValues(13, [](const Expression& e) { return e.Simplify().Simplify(); });
}

TEST(ExpressionLaw, ExpansionKeepsValueAndDomain) {
  const std::vector<int> all{0, 1, 2};
  ExpectSameValues(
      14, [&all](const Expression& e) { return ExpandUnderRoots(e, all); }, Form::kMultipliedOut);
}

TEST(ExpressionLaw, ExpansionInSomeVariablesKeepsValueAndDomain) {
  const std::vector<int> some{2, 0};
  ExpectSameValues(
      15,
      [&some](const Expression& e) {
        return ExpandUnderRoots(
            e, some, {.order = MonomialOrder::kLexicographic, .most_terms = 20});
      },
      Form::kMultipliedOut);
}

TEST(ExpressionLaw, SubstitutingVariablesAndBackKeepsTheValue) {
  ExpectSameValues(16, [](const Expression& e) {
    const Expression x = Expression::Variable(0);
    const Expression y = Expression::Variable(1);
    const Expression z = Expression::Variable(2);
    const Expression turned = e.Substitute({{0, y}, {1, z}, {2, x}});
    return turned.Substitute({{0, z}, {1, x}, {2, y}});
  });
}

TEST(ExpressionLaw, TheComparisonNoticesASmallFalsification) {
  std::mt19937_64 random(17);
  int noticed = 0;
  for (int k = 0; k < 100; ++k) {
    const RandomFormula formula = MakeFormula(random, {.operations = 10});
    const Expression wrong = formula.Import() + 1e-6 * Expression::Variable(0);
    if (Compare(formula, wrong, Form::kAsWritten, random).differs_at) ++noticed;
  }
  EXPECT_GT(noticed, 60);
}

TEST(ExpressionLaw, SimplifyMakesNoFormulaMuchLongerAndMostShorter) {
  std::mt19937_64 random(18);
  std::size_t before = 0;
  std::size_t after = 0;
  for (int k = 0; k < kFormulas; ++k) {
    const Expression e = MakeFormula(random, {.operations = 30}).Import();
    const Simplified simplified = Simplify({&e, 1});
    EXPECT_EQ(simplified.before.operations, e.Size().operations);
    EXPECT_EQ(simplified.after.operations, simplified.expressions[0].Size().operations);
    // A common order, and signs and numbers moved outwards, may cost operations where parts are
    // shared.
    EXPECT_LE(simplified.after.operations, simplified.before.operations * 3 / 2 + 4)
        << "formula " << k;
    before += simplified.before.operations;
    after += simplified.after.operations;
  }
  EXPECT_LT(static_cast<double>(after), 0.8 * static_cast<double>(before));
}

TEST(ExpressionLaw, TheOrderOfWritingDoesNotMatterAfterSimplify) {
  std::mt19937_64 random(19);
  int equal = 0;
  for (int k = 0; k < kFormulas; ++k) {
    RandomFormula formula = MakeFormula(random, {.operations = 12});
    const Expression one = formula.Import().Simplify();
    for (KomponoExpressionNode& node : formula.nodes) {
      if (node.operation == KOMPONO_ADD || node.operation == KOMPONO_MULTIPLY) {
        std::swap(node.operand[0], node.operand[1]);
      }
    }
    const Expression other = formula.Import().Simplify();
    if (one == other) ++equal;
  }
  // The rest: numbers collected in another order differ in the last digit, and so do the formulas.
  EXPECT_GT(equal, kFormulas * 98 / 100);
}

TEST(ExpressionLaw, DerivativesAgreeWithDualNumbers) {
  constexpr uint64_t kSeed = 21;
  std::mt19937_64 random(kSeed);
  int compared = 0;
  for (int k = 0; k < kFormulas; ++k) {
    const RandomFormula formula =
        MakeFormula(random, {.operations = 3 + k % 25, .smooth = k % 2 == 0});
    const Expression original = formula.Import();
    std::vector<int> variables(kVariableCount);
    std::iota(variables.begin(), variables.end(), 0);
    const std::vector<Expression> derivatives = Derivatives({&original, 1}, variables);
    const std::vector<Expression> simplified = Simplify(derivatives).expressions;
    for (int p = 0; p < kPoints; ++p) {
      const std::vector<double> point = MakePoint(random);
      const BoundedValue value = ComputeBounded(formula, point);
      const Gradient expected = ComputeGradient(formula, point);
      // Where the value is badly conditioned, so is its derivative.
      if (!value.decided || !std::isfinite(value.value) || value.error > 1e-12) continue;
      for (const int v : variables) {
        const double by_dual = expected.by[v];
        if (!std::isfinite(by_dual) || std::abs(by_dual) > 1e4) continue;
        ++compared;
        const auto j = static_cast<std::size_t>(v);
        const double room = 1e-8 * (1.0 + std::abs(by_dual));
        EXPECT_NEAR(derivatives[j].Evaluate(point), by_dual, room)
            << "seed " << kSeed << ", formula " << k << " by " << v;
        EXPECT_NEAR(simplified[j].Evaluate(point), by_dual, room)
            << "seed " << kSeed << ", simplified formula " << k << " by " << v;
      }
    }
  }
  EXPECT_GT(compared, kFormulas * kPoints);
  testing::Test::RecordProperty("compared", compared);
}

TEST(ExpressionLaw, DerivativesAgreeWithCentralDifferences) {
  constexpr uint64_t kSeed = 22;
  std::mt19937_64 random(kSeed);
  int compared = 0;
  for (int k = 0; k < kFormulas; ++k) {
    const RandomFormula formula = MakeFormula(random, {.operations = 3 + k % 15, .smooth = true});
    const Expression original = formula.Import();
    const Expression derivative = original.Derivative(0);
    for (int p = 0; p < kPoints; ++p) {
      const std::vector<double> point = MakePoint(random);
      // The root of what is always zero is a constant, but has no derivative.
      const bool has_derivative = std::isfinite(ComputeGradient(formula, point).by[0]);
      const BoundedValue value = ComputeBounded(formula, point);
      if (!value.decided || !has_derivative || !(value.error < 1e-13)) continue;
      const auto difference = [&original, &point](double step) {
        std::vector<double> right = point;
        std::vector<double> left = point;
        right[0] += step;
        left[0] -= step;
        return (original.Evaluate(right) - original.Evaluate(left)) / (right[0] - left[0]);
      };
      const double coarse = difference(2e-5);
      const double fine = difference(1e-5);
      // Differences are only worth comparing with where they have converged.
      if (!(std::abs(coarse - fine) < 1e-7 * (1.0 + std::abs(fine)))) continue;
      ++compared;
      EXPECT_NEAR(derivative.Evaluate(point), fine, 1e-6 * (1.0 + std::abs(fine)))
          << "seed " << kSeed << ", formula " << k;
    }
  }
  EXPECT_GT(compared, kFormulas * kPoints / 3);
  testing::Test::RecordProperty("compared", compared);
}

}  // namespace
}  // namespace kompono
