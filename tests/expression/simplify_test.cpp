// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "kompono/expression/expression.hpp"
#include "kompono/expression/printing.hpp"

namespace kompono {
namespace {

const Expression kX = Expression::Variable(0, "x");
const Expression kY = Expression::Variable(1, "y");
const Expression kZ = Expression::Variable(2, "z");

std::string Simple(const Expression& e) {
  return ToText(e.Simplify());
}

TEST(Simplify, CollectsLikeTermsAndEqualFactors) {
  EXPECT_EQ(Simple(kX + kX), "2*x");
  EXPECT_EQ(Simple(kX * 3 - 2 * kX), "x");
  EXPECT_EQ(Simple(kX - kX), "0");
  EXPECT_EQ(Simple(2 * kX * kY + kY * kX * 3), "5*x*y");
  EXPECT_EQ(Simple(kX * kY * kX), "x^2*y");
  EXPECT_EQ(Simple(sin(kX) * sin(kX)), "sin(x)^2");
  EXPECT_EQ(Simple(kX + 1 + kY + 2), "x + y + 3");
  EXPECT_EQ(Simple(kX / kY + 2 * kX / kY), "3*x/y");
  EXPECT_EQ(Simple((kX + kY) - (kY - kZ)), "x + z");
}

TEST(Simplify, OrdersAsPeopleDo) {
  EXPECT_EQ(Simple(5 + kZ + kY * kY + kX), "y^2 + x + z + 5");
  EXPECT_EQ(Simple(sqrt(kX) - 1 + kY), "y + sqrt(x) - 1");
  EXPECT_EQ(Simple(kY * kX + kX * kX + kY * kY), "x^2 + x*y + y^2");
  EXPECT_EQ(Simple(cos(kX) * kY * 2), "2*y*cos(x)");
  EXPECT_EQ(Simple(sin(kZ) * kZ + sin(kX) * kX), "x*sin(x) + z*sin(z)");
}

TEST(Simplify, MovesSignsOutwards) {
  EXPECT_EQ(Simple(kX + (-kY)), "x - y");
  EXPECT_EQ(Simple(kY * (-1) + kX), "x - y");
  EXPECT_EQ(Simple(-kX + kY), "y - x");
  EXPECT_EQ(Simple(1 - kX * kX), "1 - x^2");
  EXPECT_EQ(Simple(-(kX - kY)), "y - x");
  EXPECT_EQ(Simple(-(-kX)), "x");
  EXPECT_EQ(Simple((-kX) * kY * (-kZ)), "x*y*z");
  EXPECT_EQ(Simple((-kX) / kY), "-x/y");
  EXPECT_EQ(Simple(kX - (-3)), "x + 3");
  EXPECT_EQ(Simple(sin(-kX)), "-sin(x)");
  EXPECT_EQ(Simple(cos(-kX)), "cos(x)");
  EXPECT_EQ(Simple(abs(-2 * kX)), "2*abs(x)");
  EXPECT_EQ(Simple((-kX - kY) * kZ), "-z*(x + y)");
}

TEST(Simplify, TurnsDivisionByNumbersIntoMultiplication) {
  EXPECT_EQ(Simple(kX / 4), "0.25*x");
  EXPECT_EQ(Simple((kX + kY) / 2), "0.5*(x + y)");
  EXPECT_EQ(Simple(2 * (3 * kX)), "6*x");
  EXPECT_EQ(Simple((2 * kX - 2 * kY) * kZ), "2*z*(x - y)");
  EXPECT_EQ(Simple(1 / (2 * kX)), "0.5/x");
}

TEST(Simplify, TakesSquareNumbersOutOfRoots) {
  EXPECT_EQ(Simple(sqrt(Expression(9))), "3");
  EXPECT_EQ(Simple(sqrt(4 * kX)), "2*sqrt(x)");
  EXPECT_EQ(Simple(sqrt(kX * 2.25)), "1.5*sqrt(x)");
  EXPECT_EQ(Simple(sqrt(3 * kX)), "sqrt(3*x)");
  EXPECT_EQ(Simple(sqrt(-4 * kX)), "sqrt(-4*x)");
  EXPECT_EQ(Simple(abs(sqrt(kX))), "sqrt(x)");
  EXPECT_EQ(Simple(abs(kX * kX + 1)), "x^2 + 1");
}

TEST(Simplify, DecidesKnownConditions) {
  EXPECT_EQ(Simple(Select(Less(2 * kX - kX - kX, 1), kY, kZ)), "y");
  EXPECT_EQ(Simple(Select(Or(Less(kX, 0), Less(Expression(0), 1)), kY, kZ)), "y");
  EXPECT_EQ(Simple(Select(Not(Less(kX, 0)), kY, kZ)), "if(x < 0, z, y)");
  EXPECT_EQ(Simple(Select(Less(kX, 0), kY + kZ, kZ + kY)), "y + z");
}

struct DomainCase {
  Expression formula;
  double x;  // where it has no finite value
};

TEST(Simplify, InventsNoValues) {
  const std::vector<DomainCase> cases{
      {kX / kX, 0},
      {(kX * kX) / kX, 0},
      {0 / kX, 0},
      {sqrt(kX) * sqrt(kX), -1},
      {sqrt(kX) - sqrt(kX), -1},
      {0 * log(kX), -1},
      {0 * (1 / kX), 0},
      {1 / (1 / kX), 0},
      {log(kX) * (kX - kX), -2},
      {asin(kX) + acos(kX) - asin(kX), 2},
      {exp(log(kX)), -1},
      {tan(kX) / tan(kX), 0},
      {sqrt(-4 * kX), 1},
      {kX / (kX - kX), 3},
  };
  for (const DomainCase& each : cases) {
    const std::vector<double> at{each.x};
    const Expression simple = each.formula.Simplify();
    if (ToText(each.formula) == "1/(1/x)") {  // infinite inside, but finite in the end: stays so
      EXPECT_EQ(simple.Evaluate(at), each.formula.Evaluate(at));
      continue;
    }
    ASSERT_FALSE(std::isfinite(each.formula.Evaluate(at))) << ToText(each.formula);
    EXPECT_FALSE(std::isfinite(simple.Evaluate(at)))
        << ToText(each.formula) << " became " << ToText(simple);
  }
}

TEST(Simplify, LosesNoValues) {
  const Expression root_of_square = sqrt(kX * kX);
  EXPECT_EQ(root_of_square.Simplify().Evaluate(std::vector<double>{-3}), 3.0);
  EXPECT_EQ(Simple(root_of_square), "sqrt(x^2)");
  const Expression fraction = kX / (kY / kZ);
  EXPECT_EQ(Simple(fraction), "x/(y/z)");
  const Expression nested = kX / (kZ * (kY / (kX + 1)));
  const std::vector<double> at{2, 3, 5};
  EXPECT_NEAR(nested.Simplify().Evaluate(at), nested.Evaluate(at), 1e-15);
  const Expression tiny = kX / 1e-310;
  EXPECT_EQ(tiny.Simplify().Evaluate(std::vector<double>{1e-310}), 1.0);
}

TEST(Simplify, DropsZeroOnlyWhereNothingIsLost) {
  EXPECT_EQ(Simple(0 * (kX * kY + sin(kZ))), "0");
  EXPECT_EQ(Simple(0 * sqrt(kX * kX + kY * kY)), "0") << "the root always exists";
  EXPECT_EQ(Simple(0 * sqrt(kX)), "0*sqrt(x)");
}

TEST(Simplify, SharesPartsBetweenFormulas) {
  const Expression w = kX + 60.6325;
  const std::vector<Expression> roots{w * kY, kZ * (60.6325 + kX), sqrt(w * w)};
  const Simplified simplified = Simplify(roots);
  EXPECT_EQ(simplified.before.operations, 6U) << "two ways to write the sum";
  EXPECT_EQ(simplified.after.operations, 5U);
  EXPECT_EQ(simplified.after.operations, SizeOf(simplified.expressions).operations);
}

TEST(Simplify, KeepsSharedProductsShared) {
  // Opening sin(x)*cos(y) into each of the three would cost three more multiplications.
  const Expression shared = sin(kX) * cos(kY);
  const std::vector<Expression> roots{kX * shared, kY * shared, kZ * shared};
  EXPECT_EQ(Simplify(roots).after.operations, 6U);
}

TEST(Simplify, PowersAreComputedBySquaring) {
  Expression power = kX;
  for (int k = 1; k < 64; ++k) power = power * kX;
  const Expression simple = power.Simplify();
  EXPECT_EQ(ToText(simple), "x^64");
  EXPECT_EQ(simple.Size().operations, 6U);
}

}  // namespace
}  // namespace kompono
