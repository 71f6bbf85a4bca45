// SPDX-License-Identifier: Apache-2.0
// The control formula of one glide of a table-top pyramid machine as printed by Kuznetsov,
// Stepanenko, Manzhola (KSM),
//
//   0.2961x + 0.1709y + 0.9397z + sqrt(0.1012xy - 0.9122x² + 0.5566xz - 216.1161x - 0.9707y² +
//   0.3213yz
//     - 124.7167y - 0.1169z² + 90.8119z + 25641.3446) - 160.1293
//
// against the geometry it comes from. The printed xx of the first term under the root is xy (docs:
// corrections to the printed papers); printed digits are partly cut, not rounded.
#include <cmath>
#include <map>
#include <numbers>

#include "kompono/expression/polynomial.hpp"
#include "kompono/expression/printing.hpp"
#include "kompono/expression/root_form.hpp"
#include "kompono/scalar/symbol.hpp"

namespace kompono {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kStrutLengthMm = 208.010;  // known to the digits given
constexpr double kConstantUnderRoot = 25641.3446;

/// Carriage position of a glide (KDD 5): p platform joint and a rail foot with w = p - a, direction
/// u, length L.
template <class T>
T GlidePosition(const Eigen::Matrix<T, 3, 1>& w, const T& azimuth, const T& elevation, const T& L) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const Eigen::Matrix<T, 3, 1> u(
      cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation));
  const T along = u.dot(w);
  return along + sqrt(along * along - w.squaredNorm() + L * L);
}

enum Variable { kX, kY, kZ, kWx, kWy, kWz, kAzimuth, kElevation, kLength, kVariableCount };
const std::vector<int> kPosition{kX, kY, kZ};

/// The formula through Symbol, as a plugin delivers it, with the machine's numbers put in.
Expression Formula(double strut_length_mm) {
  Recording recording;
  const auto v = [](Variable number) { return Recording::Variable(number); };
  const Eigen::Matrix<Symbol, 3, 1> w(v(kX) + v(kWx), v(kY) + v(kWy), v(kZ) + v(kWz));
  const int32_t root =
      recording.Index(GlidePosition<Symbol>(w, v(kAzimuth), v(kElevation), v(kLength)));
  const auto imported = ImportRecording(recording.nodes(), {&root, 1}, kVariableCount, "pyramid");
  return imported.value().front().Substitute({{kWx, 60.6325},
                                              {kWy, 34.9855},
                                              {kWz, -195.8773},
                                              {kAzimuth, 29.9925 * kRadPerDeg},
                                              {kElevation, 70.003 * kRadPerDeg},
                                              {kLength, strut_length_mm}});
}

using Coefficients = std::map<std::vector<int>, double>;

const Coefficients kPrintedOutside{
    {{1, 0, 0}, 0.2961}, {{0, 1, 0}, 0.1709}, {{0, 0, 1}, 0.9397}, {{0, 0, 0}, -160.1293}};
const Coefficients kPrintedUnderRoot{{{2, 0, 0}, -0.9122},
                                     {{1, 1, 0}, 0.1012},
                                     {{1, 0, 1}, 0.5566},
                                     {{0, 2, 0}, -0.9707},
                                     {{0, 1, 1}, 0.3213},
                                     {{0, 0, 2}, -0.1169},
                                     {{1, 0, 0}, -216.1161},
                                     {{0, 1, 0}, -124.7167},
                                     {{0, 0, 1}, 90.8119},
                                     {{0, 0, 0}, kConstantUnderRoot}};

/// 1e-4 for the direction and the quadratic terms, 1e-2 for linear terms under the root, 1e-3 for
/// constants.
double Room(const std::vector<int>& exponents, bool under_root) {
  const int degree = exponents[0] + exponents[1] + exponents[2];
  if (degree == 0) return 1e-3;
  return degree == 1 && under_root ? 1e-2 : 1e-4;
}

void ExpectPrinted(const Polynomial& polynomial, const Coefficients& printed, bool under_root) {
  EXPECT_EQ(polynomial.terms.size(), printed.size());
  for (const auto& [exponents, coefficient] : printed) {
    EXPECT_NEAR(polynomial.Coefficient(exponents).ConstantValue().value(),
                coefficient,
                Room(exponents, under_root))
        << testing::PrintToString(exponents);
  }
}

/// The length that gives the printed constant exactly. Half a unit of its last digit moves the
/// constant by 0.2, so the constant knows the length better than the length's own digits do.
double StrutLengthFromConstant() {
  const auto form = ExpandRootForm(Formula(kStrutLengthMm), kPosition);
  const double constant =
      form.value().under.Coefficient(std::vector<int>{0, 0, 0}).ConstantValue().value();
  return std::sqrt(kStrutLengthMm * kStrutLengthMm + kConstantUnderRoot - constant);
}

TEST(GlideGolden, TheStrutLengthBehindThePrintedConstantHasTheKnownDigits) {
  EXPECT_NEAR(StrutLengthFromConstant(), kStrutLengthMm, 5e-5);
}

TEST(GlideGolden, ThePrintedCoefficientsComeBack) {
  const auto form = ExpandRootForm(Formula(StrutLengthFromConstant()), kPosition);
  ASSERT_TRUE(form);
  EXPECT_EQ(form->sign, 1);
  ExpectPrinted(form->outside, kPrintedOutside, false);
  ExpectPrinted(form->under, kPrintedUnderRoot, true);
}

TEST(GlideGolden, ThePrintedFormGivesTheSameCarriagePositions) {
  const Expression formula = Formula(kStrutLengthMm);
  const Expression expanded = ExpandUnderRoots(formula, kPosition);
  for (const std::vector<double>& p :
       {std::vector<double>{0, 0, 0}, {30, -20, 15}, {-40, 25, -35}, {5, 60, 80}}) {
    const Eigen::Vector3d w(p[0] + 60.6325, p[1] + 34.9855, p[2] - 195.8773);
    const double expected =
        GlidePosition<double>(w, 29.9925 * kRadPerDeg, 70.003 * kRadPerDeg, kStrutLengthMm);
    EXPECT_NEAR(formula.Evaluate(p), expected, 1e-11);
    EXPECT_NEAR(expanded.Evaluate(p), expected, 1e-10);
  }
}

TEST(GlideGolden, TheTextReadsLikeThePrintedOne) {
  const Expression expanded = ExpandUnderRoots(
      Formula(StrutLengthFromConstant()), kPosition, {.order = MonomialOrder::kLexicographic});
  EXPECT_EQ(ToText(expanded,
                   {.names = {"x", "y", "z"},
                    .decimals = 4,
                    .times = "",
                    .powers = PowerStyle::kSuperscript}),
            "0.2962x + 0.1709y + 0.9397z + sqrt(-0.9123x² + 0.1013xy + 0.5566xz - 216.1185x - "
            "0.9708y² + 0.3213yz - 124.7182y - 0.1169z² + 90.8042z + 25641.3446) - 160.1293");
  EXPECT_EQ(ToText(Formula(kStrutLengthMm), {.names = {"x", "y", "z"}, .expand = true}),
            "0.296178*x + 0.170947*y + 0.939711*z + sqrt(-0.912279*x^2 + 0.101261*x*y + "
            "0.556643*x*z - 0.970777*y^2 + 0.321281*y*z - 0.116944*z^2 - 216.119*x - 124.718*y + "
            "90.8042*z + 25641.4) - 160.129");
}

TEST(GlideGolden, SimplifyFindsTheSharedParts) {
  // 3 sums in w; 3 products and 2 sums in u·w; its square and 3 more; 4 sums under the root; root;
  // sum.
  const Expression formula = Formula(kStrutLengthMm);
  EXPECT_LE(formula.Simplify().Size().operations, formula.Size().operations);
  EXPECT_LE(formula.Simplify().Size().operations, 18U);
}

}  // namespace
}  // namespace kompono
