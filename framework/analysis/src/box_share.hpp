// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_BOX_SHARE_HPP_
#define KOMPONO_ANALYSIS_BOX_SHARE_HPP_

#include <algorithm>
#include <array>
#include <cmath>

namespace kompono::analysis {

/// Bounds of a share between 0 and 1.
struct ShareBounds {
  double least = 0.0, most = 1.0;
};

/// Share of the unit cube |u_i| <= 1/2 on which value + Σ slope_i u_i >= 0 for some value within
/// ±slack: the volume under a plane, by inclusion and exclusion over the cube's corners. Directions
/// with hardly any slope go into the slack, because the formula divides by the slopes.
[[nodiscard]] inline ShareBounds ShareAbovePlane(double value,
                                                 std::array<double, 3> slope,
                                                 double slack) {
  constexpr double kFlat = 1e-4;
  constexpr double kRounding = 1e-7;
  double steepest = 0.0;
  for (double& s : slope) {
    s = std::abs(s);
    steepest = std::max(steepest, s);
  }
  std::array<double, 3> steep{};
  int n = 0;
  for (const double s : slope) {
    if (s > kFlat * steepest) {
      steep[static_cast<std::size_t>(n++)] = s;
    } else {
      slack += 0.5 * s;
    }
  }
  const auto share = [&](double at) {
    if (n == 0) return at >= 0.0 ? 1.0 : 0.0;
    double sum = 0.0;
    double divisor = 1.0;
    double half = 0.0;
    for (int i = 0; i < n; ++i) {
      divisor *= steep[static_cast<std::size_t>(i)] * (i + 1);
      half += 0.5 * steep[static_cast<std::size_t>(i)];
    }
    const double reach = at + half;
    if (reach <= 0.0) return 0.0;
    if (reach >= 2.0 * half) return 1.0;
    for (int corner = 0; corner < (1 << n); ++corner) {
      double rest = reach;
      double sign = 1.0;
      for (int i = 0; i < n; ++i) {
        if ((corner & (1 << i)) == 0) continue;
        rest -= steep[static_cast<std::size_t>(i)];
        sign = -sign;
      }
      if (rest > 0.0) sum += sign * std::pow(rest, n);
    }
    return std::clamp(sum / divisor, 0.0, 1.0);
  };
  return {std::max(0.0, share(value - slack) - kRounding),
          std::min(1.0, share(value + slack) + kRounding)};
}

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_BOX_SHARE_HPP_
