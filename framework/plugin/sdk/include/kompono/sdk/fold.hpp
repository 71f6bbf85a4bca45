// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_FOLD_HPP_
#define KOMPONO_SDK_FOLD_HPP_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "kompono/geometry/pose.hpp"
#include "kompono/sdk/linear_system.hpp"
#include "kompono/sdk/step_scale.hpp"

/// Near a singularity of type 2 two poses share their drives: one on either side, a fold. From the
/// drives alone nobody can tell which of them the machine is in.
namespace kompono::sdk {

/// Either both empty or one number per coordinate; infinite where a coordinate has no limit.
struct CoordinateLimits {
  std::span<const double> lower;
  std::span<const double> upper;

  template <std::size_t N>
  [[nodiscard]] bool Hold(const std::array<double, N>& x) const {
    for (std::size_t i = 0; i < lower.size(); ++i) {
      if (x[i] < lower[i] || x[i] > upper[i]) return false;
    }
    return true;
  }
};

/// The fold's other pose, found from the second-order form of the loops along the direction v in
/// which A nearly vanishes: with u A = σ v, g(x + τ v) has the component τ u·A v + τ²/2 u·(dA/dv) v
/// along u, so the other zero is near τ = -2 u·A v / u·(dA/dv) v.
template <class Equations>
class Fold {
 public:
  static constexpr std::size_t kSize = Equations::kLetters.size();
  using Vector = std::array<double, kSize>;
  using Matrix = std::array<double, kSize * kSize>;
  using DriveVector = std::array<double, Equations::kDrives>;

  Fold(const Equations& equations, const Vector& x, const DriveVector& q)
      : equations_(equations), q_(q), A_(At(x)), scale_(A_, x, q) {}

  /// Whether there is another pose; then it stands in `other`.
  [[nodiscard]] bool Cross(const Vector& x, Vector& other) const {
    Vector u{};
    Vector v{};
    Weakest(u, v);
    const double reach = kDifference * scale_.size;
    Vector ahead = x;
    Vector behind = x;
    for (std::size_t i = 0; i < kSize; ++i) {
      ahead[i] += reach * v[i];
      behind[i] -= reach * v[i];
    }
    const double slope = Dot(u, Times(A_, v));
    const double bend =
        (Dot(u, Times(At(ahead), v)) - Dot(u, Times(At(behind), v))) / (2.0 * reach);
    const double far = -2.0 * slope / bend;
    if (!(std::abs(far) < kFarthest * scale_.size)) return false;
    other = x;
    for (std::size_t i = 0; i < kSize; ++i) other[i] += far * v[i];
    return Improve(other) && Distance(x, other) > 0.1 * std::abs(far);
  }

  [[nodiscard]] double Determinant() const { return LinearSystem<double, kSize>(A_).Determinant(); }
  /// mm
  [[nodiscard]] double Distance(const Vector& a, const Vector& b) const {
    Vector difference = a;
    for (std::size_t i = 0; i < kSize; ++i) difference[i] -= b[i];
    return scale_.Length(difference);
  }

 private:
  static constexpr double kDifference = 1e-4;
  static constexpr double kFarthest = 0.5;
  static constexpr int kNewtonSteps = 15;

  [[nodiscard]] Matrix At(const Vector& x) const {
    Matrix A{};
    Vector g{};
    equations_.Linearise(x, q_, g, A);
    return A;
  }

  /// The directions u of the loops and v of the coordinates in which A is weakest, A v = σ u, by
  /// inverse iteration; v is 1 mm long.
  void Weakest(Vector& u, Vector& v) const {
    const LinearSystem<double, kSize> forward(A_);
    const LinearSystem<double, kSize> backward(Transposed(A_));
    for (std::size_t i = 0; i < kSize; ++i) u[i] = 1.0 + 0.25 * static_cast<double>(i);
    for (int again = 0; again < 3; ++again) {
      v = forward.Solve(u);
      scale_.Divide(v, scale_.Length(v));
      Vector weighted = v;
      scale_.Weigh(weighted);
      u = backward.Solve(weighted);
      scale_.Divide(u, std::sqrt(Dot(u, u)));
    }
  }

  /// Newton without proofs; the answer is only asked whether it closes the loops.
  [[nodiscard]] bool Improve(Vector& x) const {
    for (int count = 0; count < kNewtonSteps; ++count) {
      Matrix A{};
      Vector g{};
      equations_.Linearise(x, q_, g, A);
      const Vector step = LinearSystem<double, kSize>(A).Solve(g);
      const double length = scale_.Length(step);
      if (!(length < scale_.size)) return false;
      for (std::size_t i = 0; i < kSize; ++i) x[i] -= step[i];
      if (length < 1e-9 * scale_.size) return true;
    }
    return false;
  }

  [[nodiscard]] static Matrix Transposed(const Matrix& A) {
    Matrix out{};
    for (std::size_t i = 0; i < kSize; ++i) {
      for (std::size_t j = 0; j < kSize; ++j) out[j * kSize + i] = A[i * kSize + j];
    }
    return out;
  }
  [[nodiscard]] static Vector Times(const Matrix& A, const Vector& v) {
    Vector out{};
    for (std::size_t i = 0; i < kSize; ++i) {
      for (std::size_t j = 0; j < kSize; ++j) out[i] += A[i * kSize + j] * v[j];
    }
    return out;
  }
  [[nodiscard]] static double Dot(const Vector& a, const Vector& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kSize; ++i) sum += a[i] * b[i];
    return sum;
  }

  const Equations& equations_;
  const DriveVector& q_;
  Matrix A_;
  StepScale<double, Equations> scale_;
};

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_FOLD_HPP_
