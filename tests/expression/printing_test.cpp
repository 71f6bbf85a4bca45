// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/printing.hpp"

#include <limits>

#include "kompono/expression/polynomial.hpp"

namespace kompono {
namespace {

using testing::HasSubstr;

const Expression kX = Expression::Variable(0, "x");
const Expression kY = Expression::Variable(1, "y");
const Expression kZ = Expression::Variable(2, "z");

TEST(ToText, NeedsNoMoreBracketsThanAPersonWould) {
  EXPECT_EQ(ToText((kX + kY) * kZ), "(x + y)*z");
  EXPECT_EQ(ToText(kX + kY * kZ), "x + y*z");
  EXPECT_EQ(ToText(kX + (kY + kZ)), "x + y + z");
  EXPECT_EQ(ToText(kX - (kY + kZ)), "x - (y + z)");
  EXPECT_EQ(ToText(kX - (kY - kZ)), "x - (y - z)");
  EXPECT_EQ(ToText(kX * (kY * kZ)), "x*y*z");
  EXPECT_EQ(ToText(kX / kY / kZ), "x/(y*z)");
  EXPECT_EQ(ToText(kX / (kY / kZ)), "x/(y/z)");
  EXPECT_EQ(ToText(kX / (kY + kZ)), "x/(y + z)");
  EXPECT_EQ(ToText((kX + kY) * (kX + kY)), "(x + y)^2");
  EXPECT_EQ(ToText((kX * kY) * (kX * kY)), "x^2*y^2");
  EXPECT_EQ(ToText(-(kX + kY)), "-(x + y)");
  EXPECT_EQ(ToText(-kX * kY), "-x*y");
  EXPECT_EQ(ToText(sqrt(kX + 1) * 2), "2*sqrt(x + 1)");
  EXPECT_EQ(ToText(atan2(-kY, kX - 1)), "atan2(-y, x - 1)");
  EXPECT_EQ(ToText(1 / kX), "1/x");
  EXPECT_EQ(ToText(kX / -2.0), "x/(-2)");
}

TEST(ToText, WritesSignsBetweenTerms) {
  EXPECT_EQ(ToText(kX + (-kY)), "x - y");
  EXPECT_EQ(ToText(kX + -2.0 * kY), "x - 2*y");
  EXPECT_EQ(ToText(kX + Expression(-3)), "x - 3");
  EXPECT_EQ(ToText(kX - (-kY)), "x + y");
  EXPECT_EQ(ToText(-kX - kY), "-x - y");
  EXPECT_EQ(ToText(kX - (-2.0) * (kY + kZ)), "x + 2*(y + z)");
}

TEST(ToText, WritesConditionsAndChoices) {
  const Expression a = Less(kX, kY);
  const Expression b = LessEqual(kY, kZ + 1);
  EXPECT_EQ(ToText(Select(And(a, Not(b)), kX, kY)), "if(x < y and not (y <= z + 1), x, y)");
  EXPECT_EQ(ToText(And(Or(a, b), a)), "(x < y or y <= z + 1) and x < y");
  EXPECT_EQ(ToText(Or(And(a, b), a)), "x < y and y <= z + 1 or x < y");
}

TEST(ToText, WritesNumbersAsAskedFor) {
  const Expression e = 0.296184512 * kX - 160.12934 + 25641 * kY;
  EXPECT_EQ(ToText(e), "0.296185*x - 160.129 + 25641*y");
  EXPECT_EQ(ToText(e, {.digits = 3}), "0.296*x - 160 + 25641*y");
  EXPECT_EQ(ToText(e, {.decimals = 4}), "0.2962*x - 160.1293 + 25641*y");
  EXPECT_EQ(ToText(Expression(0.00001234) * kX, {.digits = 3, .decimals = 2}), "1.23e-05*x")
      << "a number is not rounded away";
  EXPECT_EQ(ToText(Expression(2.5), {.decimals = 4}), "2.5");
  EXPECT_EQ(ToText(Expression(1e20)), "1e+20");
  EXPECT_EQ(ToText(Expression(std::numeric_limits<double>::quiet_NaN())), "nan");
  EXPECT_EQ(ToText(Expression(-std::numeric_limits<double>::infinity())), "-inf");
  EXPECT_EQ(ToText(Expression(-0.0)), "0");
}

TEST(ToText, LeavesOutTheMultiplicationSignWhereItCanBe) {
  const TextOptions tight{
      .names = {"x", "y", "q1"}, .times = "", .powers = PowerStyle::kSuperscript};
  EXPECT_EQ(ToText(0.5 * kX * kY, tight), "0.5xy");
  EXPECT_EQ(ToText(2 * kX * kX * kY, tight), "2x²y");
  EXPECT_EQ(ToText(2 * kX * kZ, tight), "2x q1") << "names must not run together";
  EXPECT_EQ(ToText(2 * sqrt(kX) * (kX + 1), tight), "2sqrt(x) (x + 1)");
  EXPECT_EQ(ToText(kX * kX * kY, {.times = ""}), "x^2 y");
  EXPECT_EQ(ToText(2 * kX, {.names = {"e1"}, .times = ""}), "2 e1") << "2e1 would be twenty";
  EXPECT_EQ(ToText(3 * kX * kY, {.times = "·"}), "3·x·y");
}

TEST(ToText, WritesPowersInThreeStyles) {
  Expression power = kX;
  for (int k = 1; k < 12; ++k) power = power * kX;
  EXPECT_EQ(ToText(power), "x^12");
  EXPECT_EQ(ToText(power, {.powers = PowerStyle::kSuperscript}), "x¹²");
  EXPECT_EQ(ToText(kX * kX * kX * kY, {.powers = PowerStyle::kProduct}), "x*x*x*y");
  EXPECT_EQ(ToText(power.Simplify() * (kX + 1) * (kX + 1)), "x^12*(x + 1)^2");
}

TEST(ToText, NamesSharedPartsOnRequest) {
  const Expression w = kX * kY + 1;
  const Expression e = w + sqrt(w * kZ);
  EXPECT_EQ(ToText(e), "x*y + 1 + sqrt((x*y + 1)*z)");
  EXPECT_EQ(ToText(e, {.shared = true}), "t1 = x*y + 1\nt1 + sqrt(t1*z)");
  const std::vector<NamedExpression> both{{"q1", w}, {"q2", w * w - 3}};
  EXPECT_EQ(ToText(both, {.shared = true}), "t1 = x*y + 1\nq1 = t1\nq2 = t1^2 - 3");
  EXPECT_EQ(ToText(both), "q1 = x*y + 1\nq2 = (x*y + 1)^2 - 3");
}

TEST(ToText, PartNamesAvoidTheVariables) {
  const Expression w = kX * kY + 1;
  EXPECT_EQ(ToText(w + sqrt(w * kZ), {.names = {"t1", "y", "t3"}, .shared = true}),
            "t2 = t1*y + 1\nt2 + sqrt(t2*t3)");
}

TEST(ToText, NamesPartsByItselfBeforeTheTextExplodes) {
  Expression e = kX;
  for (int k = 0; k < 60; ++k) e = e * sin(e) + 1;
  const std::string text = ToText(e);
  EXPECT_LT(text.size(), 5000U);
  EXPECT_TRUE(text.starts_with("t1 = x*sin(x) + 1\nt2 = t1*sin(t1) + 1\n")) << text;
}

TEST(ToText, ExpandsOnRequest) {
  EXPECT_EQ(ToText(sqrt((kX + 1) * (kX + 1)) * 2, {.expand = true}), "2*sqrt(x^2 + 2*x + 1)");
}

TEST(ToLatex, SetsFractionsRootsAndNames) {
  const LatexOptions options{.names = {"q1", "theta", "drive_z"}};
  EXPECT_EQ(ToLatex(kX / (2 * kY), options), "\\frac{q_{1}}{2 \\theta}");
  EXPECT_EQ(ToLatex(sqrt(kX * kX - 0.5 * kZ), options),
            "\\sqrt{q_{1}^{2} - 0.5 \\mathrm{drive\\_z}}");
  EXPECT_EQ(ToLatex((kX + kY) * sin(kX) * sin(kX), options),
            "\\left(q_{1} + \\theta\\right) \\sin\\left(q_{1}\\right)^{2}");
  EXPECT_EQ(ToLatex(abs(kX) + asin(kY) + log(kX), options),
            "\\left|q_{1}\\right| + \\arcsin\\left(\\theta\\right) + \\ln\\left(q_{1}\\right)");
  EXPECT_EQ(ToLatex(1.5e-7 * kX, options), "1.5 \\cdot 10^{-7} q_{1}");
  EXPECT_EQ(ToLatex(atan2(kY, kX), options), "\\operatorname{atan2}\\left(\\theta, q_{1}\\right)");
  EXPECT_EQ(ToLatex(Select(And(Less(kX, 0), LessEqual(0, kY)), kX, kY), options),
            "\\begin{cases} q_{1} & \\text{if } q_{1} < 0 \\land 0 \\le \\theta \\\\ \\theta & "
            "\\text{otherwise} \\end{cases}");
}

TEST(ToLatex, AlignsSeveralLines) {
  const Expression w = kX * kY + 1;
  EXPECT_EQ(ToLatex(w + sqrt(w), {.shared = true}),
            "\\begin{aligned}\nt_{1} &= x y + 1 \\\\\n&t_{1} + \\sqrt{t_{1}}\n\\end{aligned}");
  const std::vector<NamedExpression> one{{"d", kX}};
  EXPECT_EQ(ToLatex(one), "d = x");
}

TEST(ToC, WritesACompleteFunction) {
  const Expression w = kX - 1.5;
  const std::vector<NamedExpression> roots{{"drive.q1", w + sqrt(w * w + 4)}, {"q2", kY}};
  const Parsed<std::string> text = ToC(roots, {.function_name = "drives"});
  ASSERT_TRUE(text);
  EXPECT_EQ(*text,
            "#include <math.h>\n"
            "\n"
            "void drives(const double in[], double out[]) {\n"
            "  const double x = in[0];\n"
            "  const double y = in[1];\n"
            "  const double t1 = x - 1.5;\n"
            "  out[0] = t1 + sqrt(t1 * t1 + 4.0);  /* drive.q1 */\n"
            "  out[1] = y;  /* q2 */\n"
            "}\n");
}

TEST(ToC, WritesStatementsForATemplateOfTheCaller) {
  const std::vector<NamedExpression> roots{{"joints[0]", kX + 0.1}};
  const COptions options{.function_name = "", .names = {"pos->tran.x"}, .indent = "    "};
  EXPECT_EQ(*ToC(roots, options), "    joints[0] = pos->tran.x + 0.1;\n");
}

TEST(ToC, ComplainsAboutFunctionsTheTargetLacks) {
  const std::vector<NamedExpression> roots{
      {"q", exp(kX) + abs(kY) + std::numeric_limits<double>::infinity() * kX}};
  const Parsed<std::string> text = ToC(roots, {.functions = {"sqrt", "sin"}});
  ASSERT_FALSE(text);
  ASSERT_EQ(text.error().size(), 3U);
  for (const Diagnostic& each : text.error()) EXPECT_EQ(each.code, "E0286");
  EXPECT_THAT(text.error()[0].message, HasSubstr("'INFINITY'"));
  EXPECT_THAT(text.error()[1].message, HasSubstr("'exp'"));
  EXPECT_THAT(text.error()[2].message, HasSubstr("'fabs'"));
  EXPECT_EQ(text.error()[2].help, "the target has: sqrt, sin");
}

TEST(ToC, MakesIdentifiersOutOfAnyNames) {
  const std::vector<NamedExpression> roots{{"evil */ name", kX + kY + kZ}};
  const COptions options{.names = {"drive.x", "1 y", "double"}};
  const std::string text = *ToC(roots, options);
  EXPECT_THAT(text, HasSubstr("const double drive_x = in[0];"));
  EXPECT_THAT(text, HasSubstr("const double v1_y = in[1];"));
  EXPECT_THAT(text, HasSubstr("const double double_ = in[2];"));
  EXPECT_THAT(text, HasSubstr("/* evil __ name */"));
}

TEST(ToC, IsTheSameTextEveryTime) {
  const auto make = [] {
    const Expression w = sin(kX) * kY + sqrt(kZ);
    const std::vector<NamedExpression> roots{{"a", (w * w + w).Simplify()},
                                             {"b", (w * w + w).Derivative(0).Simplify()}};
    return *ToC(roots);
  };
  EXPECT_EQ(make(), make());
}

}  // namespace
}  // namespace kompono
