// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_INTERVAL_HPP_
#define KOMPONO_ANALYSIS_INTERVAL_HPP_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

/// Interval arithmetic: every result encloses all values that its operands' values can give. Bounds
/// are moved outwards by more than an operation's rounding, so that what is called certain is
/// certain.
namespace kompono::analysis {

struct Interval {
  double lower = 0.0, upper = 0.0;

  constexpr Interval() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): numbers mix freely with intervals.
  constexpr Interval(double value) : lower(value), upper(value) {}
  constexpr Interval(double from, double to) : lower(from), upper(to) {}

  [[nodiscard]] double Middle() const { return 0.5 * lower + 0.5 * upper; }
  [[nodiscard]] double Radius() const { return 0.5 * upper - 0.5 * lower; }
  [[nodiscard]] double Magnitude() const { return std::max(std::abs(lower), std::abs(upper)); }
  [[nodiscard]] bool Contains(double value) const { return lower <= value && value <= upper; }
  [[nodiscard]] bool IsFinite() const { return std::isfinite(lower) && std::isfinite(upper); }

  [[nodiscard]] static Interval Everything() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
};

namespace interval_internal {
/// More than two units in the last place, and than the smallest number.
constexpr double kRelative = 5e-16;
constexpr double kAbsolute = 1e-300;

[[nodiscard]] inline Interval Outward(double lower, double upper) {
  return {lower - std::abs(lower) * kRelative - kAbsolute,
          upper + std::abs(upper) * kRelative + kAbsolute};
}
/// 0 times infinity is 0 here: infinity stands for "any number, however large".
[[nodiscard]] inline double Product(double a, double b) {
  return a == 0.0 || b == 0.0 ? 0.0 : a * b;
}
/// Of a function that rises on the interval.
template <class F>
[[nodiscard]] Interval Rising(const Interval& a, F f) {
  return Outward(f(a.lower), f(a.upper));
}
}  // namespace interval_internal

[[nodiscard]] inline Interval operator-(const Interval& a) {
  return {-a.upper, -a.lower};
}
[[nodiscard]] inline Interval operator+(const Interval& a, const Interval& b) {
  return interval_internal::Outward(a.lower + b.lower, a.upper + b.upper);
}
[[nodiscard]] inline Interval operator-(const Interval& a, const Interval& b) {
  return interval_internal::Outward(a.lower - b.upper, a.upper - b.lower);
}
[[nodiscard]] inline Interval operator*(const Interval& a, const Interval& b) {
  using interval_internal::Product;
  const double p = Product(a.lower, b.lower);
  const double q = Product(a.lower, b.upper);
  const double r = Product(a.upper, b.lower);
  const double s = Product(a.upper, b.upper);
  return interval_internal::Outward(std::min(std::min(p, q), std::min(r, s)),
                                    std::max(std::max(p, q), std::max(r, s)));
}
[[nodiscard]] inline Interval operator/(const Interval& a, const Interval& b) {
  if (b.lower <= 0.0 && b.upper >= 0.0) return Interval::Everything();
  return a * interval_internal::Outward(1.0 / b.upper, 1.0 / b.lower);
}
[[nodiscard]] inline Interval Hull(const Interval& a, const Interval& b) {
  return {std::min(a.lower, b.lower), std::max(a.upper, b.upper)};
}
[[nodiscard]] inline Interval Meet(const Interval& a, const Interval& b) {
  return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)};
}
[[nodiscard]] inline Interval Square(const Interval& a) {
  const double l = a.lower * a.lower;
  const double u = a.upper * a.upper;
  const double least = a.Contains(0.0) ? 0.0 : std::min(l, u);
  const Interval out = interval_internal::Outward(least, std::max(l, u));
  return {std::max(0.0, out.lower), out.upper};
}
/// Of the part that is not negative.
[[nodiscard]] inline Interval Sqrt(const Interval& a) {
  const Interval out = interval_internal::Outward(std::sqrt(std::max(0.0, a.lower)),
                                                  std::sqrt(std::max(0.0, a.upper)));
  return {std::max(0.0, out.lower), out.upper};
}
[[nodiscard]] inline Interval Abs(const Interval& a) {
  if (a.lower >= 0.0) return a;
  if (a.upper <= 0.0) return -a;
  return {0.0, a.Magnitude()};
}
/// cos: extremes at the multiples of pi that lie in the interval.
[[nodiscard]] inline Interval Cos(const Interval& a) {
  if (!a.IsFinite() || a.upper - a.lower >= 2.0 * std::numbers::pi) return {-1.0, 1.0};
  // A little wider than the interval, so that rounding loses no multiple.
  const double slack = 1e-15 * (1.0 + a.Magnitude());
  const double first = std::ceil((a.lower - slack) / std::numbers::pi);
  const double last = std::floor((a.upper + slack) / std::numbers::pi);
  double lower = std::min(std::cos(a.lower), std::cos(a.upper));
  double upper = std::max(std::cos(a.lower), std::cos(a.upper));
  const int multiples = static_cast<int>(last - first) + 1;  // at most 3 in less than a turn
  for (int k = 0; k < multiples; ++k) {
    if (std::fmod(first + k, 2.0) == 0.0) {
      upper = 1.0;
    } else {
      lower = -1.0;
    }
  }
  const Interval out = interval_internal::Outward(lower, upper);
  return {std::max(-1.0, out.lower), std::min(1.0, out.upper)};
}
[[nodiscard]] inline Interval Sin(const Interval& a) {
  return Cos(a - Interval(std::numbers::pi / 2.0 - 1e-16, std::numbers::pi / 2.0 + 2e-16));
}

/// A value over a box with its derivatives by the box's (up to three) directions.
struct Slope {
  static constexpr std::size_t kDirections = 3;
  Interval value;
  std::array<Interval, kDirections> by{};

  Slope() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): numbers mix freely with slopes.
  Slope(double number) : value(number) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  Slope(const Interval& interval) : value(interval) {}
};

/// f(a) with the derivative f'(a).
[[nodiscard]] inline Slope Chained(const Slope& a, const Interval& value, const Interval& factor) {
  Slope out(value);
  for (std::size_t i = 0; i < Slope::kDirections; ++i) out.by[i] = factor * a.by[i];
  return out;
}
[[nodiscard]] inline Slope operator-(const Slope& a) {
  return Chained(a, -a.value, Interval(-1.0));
}
[[nodiscard]] inline Slope operator+(const Slope& a, const Slope& b) {
  Slope out(a.value + b.value);
  for (std::size_t i = 0; i < Slope::kDirections; ++i) out.by[i] = a.by[i] + b.by[i];
  return out;
}
[[nodiscard]] inline Slope operator-(const Slope& a, const Slope& b) {
  Slope out(a.value - b.value);
  for (std::size_t i = 0; i < Slope::kDirections; ++i) out.by[i] = a.by[i] - b.by[i];
  return out;
}
[[nodiscard]] inline Slope operator*(const Slope& a, const Slope& b) {
  Slope out(a.value * b.value);
  for (std::size_t i = 0; i < Slope::kDirections; ++i)
    out.by[i] = a.by[i] * b.value + a.value * b.by[i];
  return out;
}
[[nodiscard]] inline Slope operator/(const Slope& a, const Slope& b) {
  Slope out(a.value / b.value);
  for (std::size_t i = 0; i < Slope::kDirections; ++i)
    out.by[i] = (a.by[i] - out.value * b.by[i]) / b.value;
  return out;
}
[[nodiscard]] inline Slope Square(const Slope& a) {
  return Chained(a, Square(a.value), Interval(2.0) * a.value);
}
/// Of the part that is not negative; where that begins at 0 the derivative has no bound.
[[nodiscard]] inline Slope Sqrt(const Slope& a) {
  const Interval root = Sqrt(a.value);
  const Interval factor = root.lower > 0.0
                              ? Interval(0.5) / root
                              : Interval(root.upper > 0.0 ? 0.4999999999 / root.upper : 0.0,
                                         std::numeric_limits<double>::infinity());
  return Chained(a, root, factor);
}

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_INTERVAL_HPP_
