// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/expression.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "kompono/expression/printing.hpp"
#include "kompono/scalar/symbol.hpp"

namespace kompono {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const Expression kX = Expression::Variable(0, "x");
const Expression kY = Expression::Variable(1, "y");
const Expression kZ = Expression::Variable(2, "z");

std::vector<std::string> Codes(const Diagnostics& diagnostics) {
  std::vector<std::string> codes;
  for (const Diagnostic& each : diagnostics) codes.push_back(each.code);
  return codes;
}

Parsed<std::vector<Expression>> Import(const std::vector<KomponoExpressionNode>& nodes,
                                       const std::vector<int32_t>& roots) {
  return ImportRecording(nodes, roots, 2, "lambda");
}

TEST(ImportRecording, TakesOverWhatSymbolRecorded) {
  Recording recording;
  const Symbol x = Recording::Variable(0);
  const Symbol y = Recording::Variable(1);
  const std::vector<int32_t> roots{recording.Index(hypot(x, y)),
                                   recording.Index(Select(x < y, x, Symbol(7)))};
  const auto imported = ImportRecording(recording.nodes(), roots, 2, "test");
  ASSERT_TRUE(imported);
  const std::vector<double> point{3, -4};
  EXPECT_THAT(Evaluate(*imported, point), ElementsAre(5.0, 7.0));
  EXPECT_THAT((*imported)[0].Variables(), ElementsAre(0, 1));
}

TEST(ImportRecording, RefusesEveryBadNodeWithItsCode) {
  const KomponoExpressionNode x{KOMPONO_VARIABLE, {0, -1, -1}, 0};
  const auto codes_of = [&x](const KomponoExpressionNode& bad) {
    const auto imported = Import({x, {KOMPONO_LESS, {0, 0, -1}, 0}, bad}, {0});
    return imported ? std::vector<std::string>{} : Codes(imported.error());
  };
  EXPECT_THAT(codes_of({99, {0, 0, 0}, 0}), ElementsAre("E0281"));
  EXPECT_THAT(codes_of({-1, {0, 0, 0}, 0}), ElementsAre("E0281"));
  EXPECT_THAT(codes_of({std::numeric_limits<int32_t>::min(), {0, 0, 0}, 0}), ElementsAre("E0281"));
  EXPECT_THAT(codes_of({KOMPONO_ADD, {0, 2, -1}, 0}), ElementsAre("E0282")) << "itself";
  EXPECT_THAT(codes_of({KOMPONO_ADD, {0, 5, -1}, 0}), ElementsAre("E0282")) << "a later one";
  EXPECT_THAT(codes_of({KOMPONO_SQRT, {-1, -1, -1}, 0}), ElementsAre("E0282"));
  EXPECT_THAT(codes_of({KOMPONO_SELECT, {1, -7, 2000000000}, 0}), ElementsAre("E0282", "E0282"));
  EXPECT_THAT(codes_of({KOMPONO_SQRT, {1, -1, -1}, 0}), ElementsAre("E0283")) << "of a condition";
  EXPECT_THAT(codes_of({KOMPONO_NOT, {0, -1, -1}, 0}), ElementsAre("E0283")) << "of a number";
  EXPECT_THAT(codes_of({KOMPONO_SELECT, {0, 0, 0}, 0}), ElementsAre("E0283"));
  EXPECT_THAT(codes_of({KOMPONO_VARIABLE, {2, -1, -1}, 0}), ElementsAre("E0284"));
  EXPECT_THAT(codes_of({KOMPONO_VARIABLE, {-3, -1, -1}, 0}), ElementsAre("E0284"));
  EXPECT_THAT(codes_of({KOMPONO_SELECT, {1, 0, 0}, 0}), testing::IsEmpty());
}

TEST(ImportRecording, RefusesBadRoots) {
  const std::vector<KomponoExpressionNode> nodes{{KOMPONO_VARIABLE, {0, -1, -1}, 0},
                                                 {KOMPONO_LESS, {0, 0, -1}, 0}};
  const auto imported = Import(nodes, {0, 1, 2, -1});
  ASSERT_FALSE(imported);
  EXPECT_THAT(Codes(imported.error()), ElementsAre("E0285", "E0285", "E0285"));
  EXPECT_EQ(imported.error()[1].message,
            "result 2 of the recorded formula is node 2, but there are 2 nodes");
  EXPECT_EQ(imported.error()[1].file, "lambda");
  EXPECT_TRUE(Import(nodes, {}));
  EXPECT_FALSE(Import({}, {0}));
}

TEST(ImportRecording, StopsComplainingAfterTwenty) {
  const std::vector<KomponoExpressionNode> nodes(1000, {77, {0, 0, 0}, 0});
  const auto imported = Import(nodes, {});
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().size(), 20U);
}

TEST(Expression, ComputesLikeDouble) {
  const Expression e = Select(And(Less(kX, kY), Not(LessEqual(kY, 0))), atan2(kX, kY), abs(kX)) +
                       exp(kX) * log(kY) - asin(kX) / acos(kX) + tan(atan(kX)) - -kX;
  const auto expected = [](double x, double y) {
    return (x < y && !(y <= 0) ? std::atan2(x, y) : std::abs(x)) + std::exp(x) * std::log(y) -
           std::asin(x) / std::acos(x) + std::tan(std::atan(x)) + x;
  };
  for (const auto& [x, y] : {std::pair(0.3, 0.7), std::pair(0.9, 0.2), std::pair(-0.5, 3.0)}) {
    EXPECT_DOUBLE_EQ(e.Evaluate(std::vector<double>{x, y}), expected(x, y));
  }
}

TEST(Expression, FoldsNumbersButKeepsWhatTheyLeaveUndefined) {
  EXPECT_EQ((Expression(2) + 3 * Expression(4)).ConstantValue(), 14.0);
  EXPECT_EQ(sqrt(Expression(16)).ConstantValue(), 4.0);
  EXPECT_FALSE(sqrt(Expression(-1)).IsConstant()) << "stays visible in the text";
  EXPECT_FALSE((Expression(1) / 0.0).IsConstant());
  EXPECT_EQ(Select(Less(Expression(1), 2), kX, kY), kX);
}

TEST(Expression, EqualFormulasAreEqualWhereverTheyWereMade) {
  const Expression a = sin(kX) + kY * kY;
  const Expression b =
      sin(Expression::Variable(0)) + Expression::Variable(1) * Expression::Variable(1);
  EXPECT_EQ(a, b);
  EXPECT_FALSE(a == b + 1);
  EXPECT_FALSE(kX == kY);
  EXPECT_EQ(Expression(2.0), Expression(2.0));
}

TEST(Expression, KeepsPartsSharedWhenHandlesAreCombined) {
  const Expression w = sin(kX) + kY;
  EXPECT_EQ((w * w + w).Size().operations, 4U);
  EXPECT_EQ((w * w + w).Size().written, 8.0);
  EXPECT_EQ((w * w + w).Size().depth, 4U);
}

TEST(Expression, RefusesConditionsAsNumbers) {
  EXPECT_THROW((void)(Less(kX, kY) + 1), std::logic_error);
  EXPECT_THROW((void)Not(kX), std::logic_error);
  EXPECT_THROW((void)Select(kX, kX, kX), std::logic_error);
  EXPECT_THROW((void)Expression::Variable(-1), std::logic_error);
  EXPECT_THROW((void)Less(kX, kY).Derivative(0), std::logic_error);
  EXPECT_EQ(Less(kX, kY).Evaluate(std::vector<double>{1, 2}), 1.0);
  EXPECT_EQ(ToText(Less(kX, kY)), "x < y");
}

TEST(Expression, RefusesTooFewValues) {
  EXPECT_THROW((void)kZ.Evaluate(std::vector<double>{1, 2}), std::logic_error);
  EXPECT_EQ(kZ.Evaluate(std::vector<double>{1, 2, 3}), 3.0);
}

TEST(Expression, SubstitutesAllAtOnce) {
  const Expression e = kX - kY;
  EXPECT_EQ(ToText(e.Substitute({{0, kY}, {1, kX}})), "y - x");
  EXPECT_EQ(e.Substitute({{0, 5.0}, {1, 3.0}}).ConstantValue(), 2.0);
  EXPECT_EQ(ToText((kX * kZ).Substitute({{0, kX + kY}})), "(x + y)*z");
}

TEST(Expression, NamesFollowTheVariables) {
  const Expression inner = Expression::Variable(4, "beta") * 2;
  EXPECT_EQ(ToText((kX + kY).Substitute({{1, inner}})), "x + 2*beta");
  EXPECT_EQ(ToText(Expression::Variable(7) + kX), "x7 + x");
}

TEST(Expression, DerivativesOfEachFunction) {
  const auto derivative = [](const Expression& e) { return ToText(e.Derivative(0).Simplify()); };
  EXPECT_EQ(derivative(kX * kX * kX), "3*x^2");
  EXPECT_EQ(derivative(kY), "0");
  EXPECT_EQ(derivative(1 / kX), "-1/x^2");
  EXPECT_EQ(derivative(sqrt(kX)), "0.5/sqrt(x)");
  EXPECT_EQ(derivative(sin(2 * kX)), "2*cos(2*x)");
  EXPECT_EQ(derivative(cos(kX)), "-sin(x)");
  EXPECT_EQ(derivative(tan(kX)), "tan(x)^2 + 1");
  EXPECT_EQ(derivative(asin(kX)), "1/sqrt(1 - x^2)");
  EXPECT_EQ(derivative(acos(kX)), "-1/sqrt(1 - x^2)");
  EXPECT_EQ(derivative(atan(kX)), "1/(x^2 + 1)");
  EXPECT_EQ(derivative(atan2(kX, kY)), "y/(x^2 + y^2)");
  EXPECT_EQ(derivative(atan2(kY, kX)), "-y/(x^2 + y^2)");
  EXPECT_EQ(derivative(abs(kX)), "if(x < 0, -1, 1)");
  EXPECT_EQ(derivative(exp(3 * kX)), "3*exp(3*x)");
  EXPECT_EQ(derivative(log(kX)), "1/x");
  EXPECT_EQ(derivative(Select(Less(kX, 1), kX * kY, kY)), "if(x < 1, y, 0)");
}

TEST(Expression, HandlesMayBeSharedBetweenThreads) {
  const Expression common = sin(kX) * kY;
  std::vector<std::thread> threads;
  std::vector<double> results(4);
  for (std::size_t t = 0; t < results.size(); ++t) {
    threads.emplace_back([t, &common, &results] {
      Expression sum = common;
      for (int k = 0; k < 200; ++k) sum = sum + common * static_cast<double>(k * (t + 1));
      results[t] = sum.Simplify().Evaluate(std::vector<double>{1, 2});
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < results.size(); ++t) {
    const double factor = 1.0 + 199.0 * 100.0 * static_cast<double>(t + 1);
    EXPECT_NEAR(results[t], std::sin(1.0) * 2.0 * factor, 1e-9 * factor);
  }
}

TEST(ExpressionProgram, EvaluatesManyPointsAndChecksSizes) {
  const std::vector<Expression> roots{kX * kY, kX * kY + 1, 5};
  const ExpressionProgram program(roots);
  EXPECT_EQ(program.RootCount(), 3U);
  EXPECT_EQ(program.VariableCount(), 2U);
  std::vector<double> results(3);
  program.Evaluate(std::vector<double>{2, 3}, results);
  EXPECT_THAT(results, ElementsAre(6, 7, 5));
  std::vector<double> too_short(2);
  EXPECT_THROW(program.Evaluate(std::vector<double>{2, 3}, too_short), std::logic_error);
  EXPECT_THROW(program.Evaluate(std::vector<double>{2}, results), std::logic_error);
}

}  // namespace
}  // namespace kompono
