// SPDX-License-Identifier: Apache-2.0
#include "interval.hpp"

#include "box_share.hpp"
#include "shipped_machines.hpp"

#include <functional>

namespace kompono::analysis {
namespace {

Interval RandomInterval(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-4.0, 4.0);
  const double a = uniform(random);
  const double b = uniform(random);
  return {std::min(a, b), std::max(a, b)};
}

double PointIn(const Interval& a, std::mt19937& random) {
  return std::uniform_real_distribution<double>(a.lower, a.upper)(random);
}

TEST(Interval, HoldsTheResultsOfAllItsPoints) {
  std::mt19937 random(tests::Seed());
  for (int trial = 0; trial < 20000; ++trial) {
    const Interval a = RandomInterval(random);
    const Interval b = RandomInterval(random);
    const double x = PointIn(a, random);
    const double y = PointIn(b, random);
    EXPECT_TRUE((a + b).Contains(x + y));
    EXPECT_TRUE((a - b).Contains(x - y));
    EXPECT_TRUE((a * b).Contains(x * y));
    EXPECT_TRUE((a / b).Contains(x / y));
    EXPECT_TRUE(Square(a).Contains(x * x));
    EXPECT_TRUE(Abs(a).Contains(std::abs(x)));
    EXPECT_TRUE(Sin(a).Contains(std::sin(x))) << a.lower << " " << a.upper << " " << x;
    EXPECT_TRUE(Cos(a).Contains(std::cos(x))) << a.lower << " " << a.upper << " " << x;
    if (x >= 0.0) {
      EXPECT_TRUE(Sqrt(a).Contains(std::sqrt(x)));
    }
  }
}

TEST(Slope, HoldsTheDifferenceQuotientsOfAllPairsOfPoints) {
  std::mt19937 random(tests::Seed());
  const auto f = [](auto x, auto y) { return Sqrt(Square(x) + Square(y) + decltype(x)(1.0)) / y; };
  const auto g = [](double x, double y) { return std::sqrt(x * x + y * y + 1.0) / y; };
  for (int trial = 0; trial < 5000; ++trial) {
    const Interval a = RandomInterval(random);
    const Interval b(0.5, 0.5 + std::abs(PointIn({0.0, 2.0}, random)));
    Slope x(a);
    x.by[0] = Interval(1.0);
    Slope y(b);
    y.by[1] = Interval(1.0);
    const Slope value = f(x, y);
    const double x0 = PointIn(a, random);
    const double x1 = PointIn(a, random);
    const double y0 = PointIn(b, random);
    EXPECT_TRUE(value.value.Contains(g(x0, y0)));
    const double quotient = (g(x1, y0) - g(x0, y0)) / (x1 - x0);
    EXPECT_GE(quotient, value.by[0].lower - 1e-6);
    EXPECT_LE(quotient, value.by[0].upper + 1e-6);
  }
}

TEST(Sqrt, OfWhatMayBeNegativeHasNoUpperSlope) {
  Slope x(Interval(-1.0, 4.0));
  x.by[0] = Interval(1.0);
  const Slope root = Sqrt(x);
  EXPECT_EQ(root.value.lower, 0.0);
  EXPECT_GE(root.value.upper, 2.0);
  EXPECT_FALSE(root.by[0].IsFinite());
  EXPECT_LE(root.by[0].lower, 0.25);
}

TEST(ShareAbovePlane, IsTheVolumeThatSamplesFind) {
  std::mt19937 random(tests::Seed());
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 60; ++trial) {
    const std::array<double, 3> slope{
        uniform(random), trial % 3 == 0 ? 0.0 : uniform(random), trial % 2 == 0 ? 0.0 : 1e-6};
    const double value = 0.6 * uniform(random);
    const double slack = trial % 5 == 0 ? 0.05 : 0.0;
    const ShareBounds share = ShareAbovePlane(value, slope, slack);
    const int n = 120;
    double inside = 0.0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double u = (i + 0.5) / n - 0.5;
        const double v = (j + 0.5) / n - 0.5;
        inside += value + slope[0] * u + slope[1] * v >= 0.0 ? 1.0 : 0.0;
      }
    }
    inside /= n * n;
    EXPECT_LE(share.least, inside + 0.012);
    EXPECT_GE(share.most, inside - 0.012);
    if (slack == 0.0) {
      EXPECT_LT(share.most - share.least, 1e-4);
    }
  }
}

}  // namespace
}  // namespace kompono::analysis
