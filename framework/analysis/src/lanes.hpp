// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_LANES_HPP_
#define KOMPONO_ANALYSIS_LANES_HPP_

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// Two doubles in one register: what every x86-64 and every ARM64 has. The compiler's own vectors,
/// because g++ 12 leaves loops over columns scalar at -O2.
namespace kompono::analysis::lanes {

inline constexpr std::size_t kCount = 2;
using Number = double __attribute__((vector_size(16)));
using Mask = std::int64_t __attribute__((vector_size(16)));  ///< per lane 0 or -1

[[nodiscard]] inline Number Load(const double* from) {
  Number out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
inline void Store(double* to, Number value) {
  std::memcpy(to, &value, sizeof value);
}
[[nodiscard]] inline Mask Load(const std::int64_t* from) {
  Mask out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
inline void Store(std::int64_t* to, Mask value) {
  std::memcpy(to, &value, sizeof value);
}
[[nodiscard]] inline Number Broadcast(double value) {
  return Number{value, value};
}
[[nodiscard]] inline Number Sqrt(Number a) {
#ifdef __SSE2__
  return _mm_sqrt_pd(a);
#else
  return Number{std::sqrt(a[0]), std::sqrt(a[1])};
#endif
}
[[nodiscard]] inline Number Select(Mask condition, Number yes, Number no) {
  Mask a;
  Mask b;
  std::memcpy(&a, &yes, sizeof a);
  std::memcpy(&b, &no, sizeof b);
  const Mask chosen = (a & condition) | (b & ~condition);
  Number out;
  std::memcpy(&out, &chosen, sizeof out);
  return out;
}

}  // namespace kompono::analysis::lanes

#endif  // KOMPONO_ANALYSIS_LANES_HPP_
