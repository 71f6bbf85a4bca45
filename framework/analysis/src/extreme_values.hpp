// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_EXTREME_VALUES_HPP_
#define KOMPONO_ANALYSIS_EXTREME_VALUES_HPP_

#include "lanes.hpp"

#include <array>
#include <cstddef>
#include <limits>

/// The smallest and the largest eigenvalue of small symmetric matrices, two to a register. Only
/// these two: a condition number needs no more, and all values with their rotations cost ten times
/// as much.
namespace kompono::analysis::lanes {

template <std::size_t N>
using Symmetric = std::array<std::array<Number, N>, N>;  ///< the lower half counts

/// d on the diagonal; e2 the squares beside it, e2[0] = 0.
template <std::size_t N>
struct Tridiagonal {
  std::array<Number, N> d{};
  std::array<Number, N> e2{};
};

/// Householder's reflections, the first column last to be touched.
template <std::size_t N>
[[nodiscard]] Tridiagonal<N> MakeTridiagonal(Symmetric<N>& a) {
  const Number zero = Broadcast(0.0);
  Tridiagonal<N> out;
  for (std::size_t k = 0; k + 2 < N; ++k) {
    std::array<Number, N> v{};
    std::array<Number, N> w{};
    Number square = zero;
    for (std::size_t i = k + 1; i < N; ++i) {
      v[i] = a[i][k];
      square += v[i] * v[i];
    }
    const Number norm = Sqrt(square);
    const Number first = v[k + 1];
    const Number size = Select(first < zero, -first, first);
    v[k + 1] = Select(first < zero, first - norm, first + norm);
    const Number below = norm * (norm + size);
    const Number beta = Select(below > zero, Broadcast(1.0) / below, zero);
    Number along = zero;
    for (std::size_t i = k + 1; i < N; ++i) {
      Number sum = zero;
      for (std::size_t j = k + 1; j < N; ++j) sum += (i < j ? a[j][i] : a[i][j]) * v[j];
      w[i] = beta * sum;
      along += w[i] * v[i];
    }
    along *= Broadcast(0.5) * beta;
    for (std::size_t i = k + 1; i < N; ++i) w[i] -= along * v[i];
    for (std::size_t i = k + 1; i < N; ++i) {
      for (std::size_t j = k + 1; j <= i; ++j) a[i][j] -= v[i] * w[j] + w[i] * v[j];
    }
    out.e2[k + 1] = square;
  }
  if constexpr (N > 1) out.e2[N - 1] = a[N - 1][N - 2] * a[N - 1][N - 2];
  for (std::size_t i = 0; i < N; ++i) out.d[i] = a[i][i];
  return out;
}

/// Laguerre's step for the characteristic polynomial p from `at`, which lies outside all roots, to
/// the nearest of them; it never passes it. n p / (p' ± sqrt((n-1) ((n-1) p'² - n p p''))).
template <std::size_t N>
[[nodiscard]] Number LaguerreStep(const Tridiagonal<N>& t, Number at) {
  const Number zero = Broadcast(0.0);
  Number p = Broadcast(1.0);
  Number p1 = zero;  // its derivatives
  Number p2 = zero;
  Number last = zero;
  Number last1 = zero;
  Number last2 = zero;
  for (std::size_t i = 0; i < N; ++i) {
    const Number x = t.d[i] - at;
    const Number next = x * p - t.e2[i] * last;
    const Number next1 = x * p1 - p - t.e2[i] * last1;
    const Number next2 = x * p2 - (p1 + p1) - t.e2[i] * last2;
    last = p;
    last1 = p1;
    last2 = p2;
    p = next;
    p1 = next1;
    p2 = next2;
  }
  constexpr auto kN = static_cast<double>(N);
  const Number inner =
      Broadcast(kN - 1.0) * (Broadcast(kN - 1.0) * p1 * p1 - Broadcast(kN) * p * p2);
  const Number root = Sqrt(Select(inner > zero, inner, zero));
  const Number below = Select(p1 < zero, p1 - root, p1 + root);
  const Mask flat = below == zero;
  return Select(flat, zero, Broadcast(kN) * p / Select(flat, Broadcast(1.0), below));
}

/// Extreme eigenvalues of a matrix without negative ones, to about 1e-15 of the largest. False
/// where they were not found (many equal ones, or what is no number): the caller needs another way.
template <std::size_t N>
[[nodiscard]] bool ExtremeValues(Symmetric<N>& a, Number& least, Number& most) {
  constexpr int kSteps = 20;
  constexpr double kEnough = 1e-7;  // the step after it is at most a third of the one before
  const Number zero = Broadcast(0.0);
  Number trace = zero;
  for (std::size_t i = 0; i < N; ++i) trace += a[i][i];
  const Number scale = Broadcast(1.0) / trace;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j <= i; ++j) a[i][j] *= scale;
  }
  const Tridiagonal<N> t = MakeTridiagonal<N>(a);
  least = zero;
  most = Broadcast(1.0);
  for (int count = 0; count < kSteps; ++count) {
    const Number up = LaguerreStep(t, least);
    const Number down = LaguerreStep(t, most);
    least -= up;
    most -= down;
    const Mask open = (-up > Broadcast(kEnough) * least) | (down > Broadcast(kEnough) * most);
    if (open[0] == 0 && open[1] == 0) {
      least *= trace;
      most *= trace;
      return trace[0] > 0.0 && trace[1] > 0.0 &&
             trace[0] < std::numeric_limits<double>::infinity() &&
             trace[1] < std::numeric_limits<double>::infinity();
    }
  }
  return false;
}

}  // namespace kompono::analysis::lanes

#endif  // KOMPONO_ANALYSIS_EXTREME_VALUES_HPP_
