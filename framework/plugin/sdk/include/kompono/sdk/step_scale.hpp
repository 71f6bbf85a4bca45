// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_STEP_SCALE_HPP_
#define KOMPONO_SDK_STEP_SCALE_HPP_

#include <array>
#include <cmath>
#include <cstddef>

#include "kompono/geometry/pose.hpp"
#include "kompono/scalar/select.hpp"

namespace kompono::sdk {

/// Steps are measured in mm: angles by the length that makes a column of A for a turn as large as
/// one for a translation.
template <class T, class Equations>
class StepScale {
 public:
  static constexpr std::size_t kSize = Equations::kLetters.size();
  using Vector = std::array<T, kSize>;

  T length2{1.0};  ///< that length squared
  T size{0.0};     ///< of the numbers, what a rounding error is measured against
  T row{1.0};      ///< of A, mean square over the rows

  StepScale(const std::array<T, kSize * kSize>& A,
            const Vector& x,
            const std::array<T, Equations::kDrives>& q) {
    using std::abs;
    using std::sqrt;
    T linear(0.0);
    T rotary(0.0);
    double linear_count = 0.0;
    for (std::size_t j = 0; j < kSize; ++j) {
      const bool turns = IsRotaryLetter(Equations::kLetters[j]);
      linear_count += turns ? 0.0 : 1.0;
      T& sum = turns ? rotary : linear;
      for (std::size_t i = 0; i < kSize; ++i) sum += A[i * kSize + j] * A[i * kSize + j];
    }
    const double rotary_count = static_cast<double>(kSize) - linear_count;
    if (linear_count > 0.0 && rotary_count > 0.0) {
      length2 = rotary * T(linear_count) / (linear * T(rotary_count));
    }
    if (rotary_count > 0.0) size = sqrt(length2);
    row = sqrt((linear_count > 0.0 ? linear : rotary) / T(static_cast<double>(kSize)));
    for (std::size_t j = 0; j < kSize; ++j) {
      if (!IsRotaryLetter(Equations::kLetters[j])) Raise(size, abs(x[j]));
    }
    for (const T& drive : q) Raise(size, abs(drive));
  }
  [[nodiscard]] T Length(const Vector& step) const {
    using std::sqrt;
    T sum(0.0);
    for (std::size_t j = 0; j < kSize; ++j) {
      const T square = step[j] * step[j];
      sum += IsRotaryLetter(Equations::kLetters[j]) ? T(length2 * square) : square;
    }
    return sqrt(sum);
  }
  /// The metric of Length: length² = step · Weigh(step).
  void Weigh(Vector& step) const {
    for (std::size_t j = 0; j < kSize; ++j) {
      if (IsRotaryLetter(Equations::kLetters[j])) step[j] *= length2;
    }
  }
  static void Divide(Vector& vector, const T& by) {
    for (T& number : vector) number /= by;
  }
  /// Whether loop residuals are nothing but rounding.
  [[nodiscard]] auto IsRounding(const Vector& g) const {
    using std::abs;
    T largest(0.0);
    for (const T& residual : g) Raise(largest, abs(residual));
    return Less(largest, T(size * row * 2e-15));
  }
  static void Raise(T& size, const T& to) { size = Select(Less(size, to), to, size); }
};

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_STEP_SCALE_HPP_
