// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_LINEAR_SYSTEM_HPP_
#define KOMPONO_SDK_LINEAR_SYSTEM_HPP_

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "kompono/scalar/select.hpp"

namespace kompono::sdk {

/// LU factors with row exchanges of a small N x N matrix, for double or for a Pack of eight
/// matrices, each with its own exchanges. A singular matrix gives numbers that are not finite.
template <class T, std::size_t N>
class LinearSystem {
 public:
  using Matrix = std::array<T, N * N>;  ///< row-major
  using Vector = std::array<T, N>;
  using Condition = decltype(Less(std::declval<T>(), std::declval<T>()));

  explicit LinearSystem(const Matrix& matrix) : lu_(matrix) {
    using std::abs;
    std::size_t exchange = 0;
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = k + 1; i < N; ++i) {
        const Condition larger = Less(T(abs(lu_[k * N + k])), T(abs(lu_[i * N + k])));
        exchanged_[exchange++] = larger;
        ExchangeRows(larger, k, i);
      }
      inverse_pivot_[k] = T(1.0) / lu_[k * N + k];
      for (std::size_t i = k + 1; i < N; ++i) {
        const T factor = lu_[i * N + k] * inverse_pivot_[k];
        lu_[i * N + k] = factor;
        for (std::size_t j = k + 1; j < N; ++j) lu_[i * N + j] -= factor * lu_[k * N + j];
      }
    }
  }

  [[nodiscard]] Vector Solve(Vector b) const {
    std::size_t exchange = 0;
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = k + 1; i < N; ++i) Exchange(exchanged_[exchange++], b[k], b[i]);
    }
    for (std::size_t i = 1; i < N; ++i) {
      for (std::size_t j = 0; j < i; ++j) b[i] -= lu_[i * N + j] * b[j];
    }
    for (std::size_t i = N; i-- > 0;) {
      for (std::size_t j = i + 1; j < N; ++j) b[i] -= lu_[i * N + j] * b[j];
      b[i] *= inverse_pivot_[i];
    }
    return b;
  }

  /// Its sign is what tells two sides of a singularity apart.
  [[nodiscard]] T Determinant() const {
    T product = sign_;
    for (std::size_t k = 0; k < N; ++k) product *= lu_[k * N + k];
    return product;
  }

 private:
  void ExchangeRows(const Condition& condition, std::size_t k, std::size_t i) {
    if constexpr (std::is_same_v<Condition, bool>) {
      if (!condition) return;  // one matrix: seldom needed, and a branch is cheaper than choices
    }
    for (std::size_t j = 0; j < N; ++j) Exchange(condition, lu_[k * N + j], lu_[i * N + j]);
    sign_ = Select(condition, T(-sign_), sign_);
  }
  static void Exchange(const Condition& condition, T& a, T& b) {
    const T first = Select(condition, b, a);
    b = Select(condition, a, b);
    a = first;
  }

  Matrix lu_;
  Vector inverse_pivot_{};
  std::array<Condition, N*(N - 1) / 2 + 1> exchanged_{};
  T sign_ = T(1.0);
};

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_LINEAR_SYSTEM_HPP_
