// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/polynomial.hpp"

#include "kompono/expression/printing.hpp"
#include "kompono/expression/root_form.hpp"

namespace kompono {
namespace {

const Expression kX = Expression::Variable(0, "x");
const Expression kY = Expression::Variable(1, "y");
const Expression kL = Expression::Variable(2, "L");
const std::vector<int> kXY{0, 1};

std::string Written(const Polynomial& polynomial) {
  std::string text;
  for (const Monomial& term : polynomial.terms) {
    text += ToText(term.coefficient) + " [";
    for (const int exponent : term.exponents) text += std::to_string(exponent);
    text += "] ";
  }
  return text;
}

TEST(ExpandPolynomial, MultipliesOutAndCollects) {
  const auto p = ExpandPolynomial((kX + 2 * kY + 1) * (kX - kY) + kY * kX, kXY);
  ASSERT_TRUE(p);
  EXPECT_EQ(Written(*p), "1 [20] 2 [11] -2 [02] 1 [10] -1 [01] ");
  EXPECT_EQ(p->Coefficient(std::vector<int>{1, 1}).ConstantValue(), 2.0);
  EXPECT_EQ(p->Coefficient(std::vector<int>{0, 0}).ConstantValue(), 0.0);
}

TEST(ExpandPolynomial, OrdersTermsAsAsked) {
  const Expression e = (kX + kY + 1) * (kX + kY + 1);
  const auto graded = ExpandPolynomial(e, kXY);
  EXPECT_EQ(Written(*graded), "1 [20] 2 [11] 1 [02] 2 [10] 2 [01] 1 [00] ");
  const auto lexicographic = ExpandPolynomial(e, kXY, {.order = MonomialOrder::kLexicographic});
  EXPECT_EQ(Written(*lexicographic), "1 [20] 2 [11] 2 [10] 1 [02] 2 [01] 1 [00] ");
  const auto y_first = ExpandPolynomial(e, std::vector<int>{1, 0});
  EXPECT_EQ(Written(*y_first), "1 [20] 2 [11] 1 [02] 2 [10] 2 [01] 1 [00] ");
}

TEST(ExpandPolynomial, LeavesOtherVariablesInTheCoefficients) {
  const Expression e = (kX + kL) * (kX - kL) + 3 * kX * kL + kL * kX + sqrt(kL) * kX / kL;
  const auto p = ExpandPolynomial(e, std::vector<int>{0});
  ASSERT_TRUE(p);
  EXPECT_EQ(Written(*p), "1 [2] 4*L + sqrt(L)/L [1] -L^2 [0] ");
}

TEST(ExpandPolynomial, DropsWhatCancels) {
  const auto p = ExpandPolynomial((kX + 0.1) * (kX + 0.1) - kX * kX - 0.2 * kX, kXY);
  ASSERT_TRUE(p);
  ASSERT_EQ(p->terms.size(), 1U) << Written(*p);
  EXPECT_NEAR(*p->terms[0].coefficient.ConstantValue(), 0.01, 1e-17);
  const auto zero = ExpandPolynomial(kX - kX, kXY);
  ASSERT_TRUE(zero);
  EXPECT_TRUE(zero->terms.empty());
}

TEST(ExpandPolynomial, KeepsSmallCoefficientsThatAreNotLeftovers) {
  const auto p = ExpandPolynomial(1e-20 * kX + kY, kXY);
  ASSERT_TRUE(p);
  EXPECT_EQ(Written(*p), "1e-20 [10] 1 [01] ");
}

TEST(ExpandPolynomial, GivesNothingForWhatIsNoPolynomial) {
  EXPECT_FALSE(ExpandPolynomial(sqrt(kX), kXY));
  EXPECT_FALSE(ExpandPolynomial(1 / kX, kXY));
  EXPECT_FALSE(ExpandPolynomial(kX * sin(kY), kXY));
  EXPECT_FALSE(ExpandPolynomial(Select(Less(kX, 0), kX, kY), kXY));
  EXPECT_FALSE(ExpandPolynomial(kX / kX, kXY)) << "has a hole at 0";
  EXPECT_TRUE(ExpandPolynomial(kX * sin(kY), std::vector<int>{0}));
  EXPECT_TRUE(ExpandPolynomial(kX / 4 + 1 / kL, kXY));
}

TEST(ExpandPolynomial, GivesNothingBeyondTheMostTerms) {
  Expression power = kX + kY + 1;
  for (int k = 0; k < 5; ++k) power = power * power;
  EXPECT_FALSE(ExpandPolynomial(power, kXY, {.most_terms = 100}));
  const auto p = ExpandPolynomial(power, kXY, {.most_terms = 100000});
  ASSERT_TRUE(p);
  EXPECT_EQ(p->terms.size(), 33U * 34U / 2U);
  EXPECT_EQ(p->Coefficient(std::vector<int>{32, 0}).ConstantValue(), 1.0);
  EXPECT_EQ(p->Coefficient(std::vector<int>{31, 1}).ConstantValue(), 32.0);
}

TEST(ExpandUnderRoots, ExpandsOutsideAndInside) {
  const Expression e = (kX + 1) * (kX - 1) + sqrt((kX + kY) * (kX + kY));
  EXPECT_EQ(ToText(ExpandUnderRoots(e, kXY)), "x^2 + sqrt(x^2 + 2*x*y + y^2) - 1");
}

TEST(ExpandUnderRoots, ReachesEveryArgument) {
  const auto expanded = [](const Expression& e) { return ToText(ExpandUnderRoots(e, kXY)); };
  EXPECT_EQ(expanded(sin(2 * (kX + 1)) * 3 + 1), "3*sin(2*x + 2) + 1");
  EXPECT_EQ(expanded((kX * (kX + 1)) / (kY * (kY - 1))), "(x^2 + x)/(y^2 - y)");
  EXPECT_EQ(expanded(Select(Less(kX * (kX + 1), 0), kX * (kX + 2), 1)),
            "if(x^2 + x < 0, x^2 + 2*x, 1)");
  EXPECT_EQ(expanded((kX + sqrt(kY)) * (kX - sqrt(kY))), "x^2 - sqrt(y)^2");
  EXPECT_EQ(expanded(sqrt(1 - sqrt(kX * (kX + 1)))), "sqrt(1 - sqrt(x^2 + x))");
}

TEST(ExpandUnderRoots, LeavesWhatIsFreeOfTheVariablesTogether) {
  const Expression free = (kL + 1) * (kL + 2);
  EXPECT_EQ(ToText(ExpandUnderRoots(kX * free + kX * kL + free, kXY)),
            "x*(L + (L + 1)*(L + 2)) + (L + 1)*(L + 2)");
}

TEST(ExpandUnderRoots, IsWellDefinedForLongProducts) {
  Expression product = kX + 1;
  for (int k = 2; k < 40; ++k) product = product * (kX + static_cast<double>(k) * kY);
  const Expression expanded = ExpandUnderRoots(product, kXY, {.most_terms = 50});
  const std::vector<double> at{0.7, 0.1};
  EXPECT_NEAR(expanded.Evaluate(at) / product.Evaluate(at), 1.0, 1e-9);
}

TEST(ExpandRootForm, TakesGlidesAndPodsApart) {
  const Expression glide = kX - 2 * sqrt(kL * kL - kY * (kY + 1));
  const auto form = ExpandRootForm(glide, kXY);
  ASSERT_TRUE(form);
  EXPECT_EQ(form->sign, -1);
  EXPECT_EQ(Written(form->outside), "1 [10] ");
  EXPECT_EQ(Written(form->under), "-4 [02] -4 [01] 4*L^2 [00] ");
  const auto pod = ExpandRootForm(sqrt((kX - 1) * (kX - 1) + kY * kY), kXY);
  ASSERT_TRUE(pod);
  EXPECT_EQ(pod->sign, 1);
  EXPECT_TRUE(pod->outside.terms.empty());
}

TEST(ExpandRootForm, GivesNothingForOtherForms) {
  EXPECT_FALSE(ExpandRootForm(kX + kY, kXY));
  EXPECT_FALSE(ExpandRootForm(sqrt(kX) + sqrt(kY), kXY));
  EXPECT_FALSE(ExpandRootForm(kX * sqrt(kY), kXY));
  EXPECT_FALSE(ExpandRootForm(sqrt(1 + sqrt(kX)), kXY));
  EXPECT_FALSE(ExpandRootForm(sqrt(kX) + sin(kY), kXY));
}

}  // namespace
}  // namespace kompono
