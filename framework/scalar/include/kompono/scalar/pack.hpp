// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SCALAR_PACK_HPP_
#define KOMPONO_SCALAR_PACK_HPP_

#include <experimental/simd>

#include <cstddef>
#include <utility>

#include <Eigen/Core>

/// Eight doubles that are computed together. A template over the scalar that is given `Pack`
/// evaluates eight poses at once; what the processor offers (SSE2, AVX2, AVX-512) is the compiler's
/// business.
///
/// It is an array of the processor's own registers, not fixed_size_simd<double, 8>: g++ 12 keeps
/// that one in memory wherever a register holds fewer than eight doubles, which cost a factor of
/// ten on AVX2.
///
/// A Pack never leaves the library that was compiled with it: its layout depends on compiler flags.
namespace kompono {

inline constexpr std::size_t kPackLanes = 8;

class Pack;

/// The answers to a comparison of Packs, lane by lane.
class PackMask {
 public:
  using Part = std::experimental::native_simd<double>::mask_type;
  static constexpr std::size_t kParts = kPackLanes / Part::size();

  friend PackMask operator&&(const PackMask& a, const PackMask& b) {
    PackMask out;
    for (std::size_t i = 0; i < kParts; ++i) out.part_[i] = a.part_[i] && b.part_[i];
    return out;
  }
  friend PackMask operator||(const PackMask& a, const PackMask& b) {
    PackMask out;
    for (std::size_t i = 0; i < kParts; ++i) out.part_[i] = a.part_[i] || b.part_[i];
    return out;
  }
  friend PackMask operator!(const PackMask& a) {
    PackMask out;
    for (std::size_t i = 0; i < kParts; ++i) out.part_[i] = !a.part_[i];
    return out;
  }
  [[nodiscard]] bool operator[](std::size_t lane) const {
    return part_[lane / Part::size()][lane % Part::size()];
  }
  [[nodiscard]] bool All() const {
    bool all = true;
    for (const Part& part : part_) all = all && std::experimental::all_of(part);
    return all;
  }
  [[nodiscard]] bool Any() const {
    bool any = false;
    for (const Part& part : part_) any = any || std::experimental::any_of(part);
    return any;
  }

 private:
  friend class Pack;
  Part part_[kParts]{};
};

class Pack {
 public:
  using Part = std::experimental::native_simd<double>;
  static constexpr std::size_t kParts = kPackLanes / Part::size();

  Pack() = default;  ///< uninitialised, like a double: zeros would cost a third of a batch's time
  /// Numbers mix freely with packs in formulas.
  // NOLINTNEXTLINE(google-explicit-constructor,cppcoreguidelines-pro-type-member-init)
  [[gnu::always_inline]] Pack(double value) {
    for (Part& part : part_) part = value;
  }
  [[nodiscard, gnu::always_inline]] static Pack Load(const double* from) {
    return Map([from](std::size_t i) {
      return Part(from + i * Part::size(), std::experimental::element_aligned);
    });
  }
  [[gnu::always_inline]] void Store(double* to) const {
    for (std::size_t i = 0; i < kParts; ++i) {
      part_[i].copy_to(to + i * Part::size(), std::experimental::element_aligned);
    }
  }
  [[nodiscard]] double operator[](std::size_t lane) const {
    return part_[lane / Part::size()][lane % Part::size()];
  }

  [[gnu::always_inline]] Pack& operator+=(const Pack& b) { return *this = *this + b; }
  [[gnu::always_inline]] Pack& operator-=(const Pack& b) { return *this = *this - b; }
  [[gnu::always_inline]] Pack& operator*=(const Pack& b) { return *this = *this * b; }
  [[gnu::always_inline]] Pack& operator/=(const Pack& b) { return *this = *this / b; }

  [[gnu::always_inline]] friend Pack operator+(const Pack& a, const Pack& b) {
    return Map([&](std::size_t i) { return a.part_[i] + b.part_[i]; });
  }
  [[gnu::always_inline]] friend Pack operator-(const Pack& a, const Pack& b) {
    return Map([&](std::size_t i) { return a.part_[i] - b.part_[i]; });
  }
  [[gnu::always_inline]] friend Pack operator*(const Pack& a, const Pack& b) {
    return Map([&](std::size_t i) { return a.part_[i] * b.part_[i]; });
  }
  [[gnu::always_inline]] friend Pack operator/(const Pack& a, const Pack& b) {
    return Map([&](std::size_t i) { return a.part_[i] / b.part_[i]; });
  }
  [[gnu::always_inline]] friend Pack operator-(const Pack& a) {
    return Map([&](std::size_t i) { return -a.part_[i]; });
  }

  friend PackMask operator<(const Pack& a, const Pack& b) {
    return Compare([&](std::size_t i) { return a.part_[i] < b.part_[i]; });
  }
  friend PackMask operator<=(const Pack& a, const Pack& b) {
    return Compare([&](std::size_t i) { return a.part_[i] <= b.part_[i]; });
  }
  friend PackMask operator>(const Pack& a, const Pack& b) { return b < a; }
  friend PackMask operator>=(const Pack& a, const Pack& b) { return b <= a; }
  friend PackMask operator==(const Pack& a, const Pack& b) {
    return Compare([&](std::size_t i) { return a.part_[i] == b.part_[i]; });
  }
  friend PackMask operator!=(const Pack& a, const Pack& b) { return !(a == b); }

  /// Lane by lane `yes` where the condition holds, else `no`.
  [[nodiscard]] static Pack Choose(const PackMask& condition, const Pack& yes, const Pack& no) {
    Pack out = no;
    for (std::size_t i = 0; i < kParts; ++i) {
      where(condition.part_[i], out.part_[i]) = yes.part_[i];
    }
    return out;
  }

#define KOMPONO_PACK_FUNCTION(function)                                                 \
  [[gnu::always_inline]] friend Pack function(const Pack& a) {                          \
    return Map([&](std::size_t i) { return std::experimental::function(a.part_[i]); }); \
  }
  KOMPONO_PACK_FUNCTION(sqrt)
  KOMPONO_PACK_FUNCTION(abs)
  KOMPONO_PACK_FUNCTION(sin)
  KOMPONO_PACK_FUNCTION(cos)
  KOMPONO_PACK_FUNCTION(tan)
  KOMPONO_PACK_FUNCTION(asin)
  KOMPONO_PACK_FUNCTION(acos)
  KOMPONO_PACK_FUNCTION(atan)
  KOMPONO_PACK_FUNCTION(exp)
  KOMPONO_PACK_FUNCTION(log)
#undef KOMPONO_PACK_FUNCTION
  friend Pack atan2(const Pack& y, const Pack& x) {
    return Map([&](std::size_t i) { return std::experimental::atan2(y.part_[i], x.part_[i]); });
  }
  friend Pack hypot(const Pack& x, const Pack& y) {
    return sqrt(x * x + y * y);
  }

 private:
  /// One part at a time, written out: a loop would be left a loop by -O2.
  template <class F>
  [[nodiscard, gnu::always_inline]] static Pack Map(const F& part) {
    Pack out;  // NOLINT(cppcoreguidelines-pro-type-member-init): every part is written
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((out.part_[I] = part(I)), ...);
    }
    (std::make_index_sequence<kParts>());
    return out;
  }
  template <class F>
  [[nodiscard, gnu::always_inline]] static PackMask Compare(const F& part) {
    PackMask out;
    for (std::size_t i = 0; i < kParts; ++i) out.part_[i] = part(i);
    return out;
  }

  Part part_[kParts];
};

}  // namespace kompono

namespace Eigen {

template <>
struct NumTraits<kompono::Pack> : GenericNumTraits<kompono::Pack> {
  using Real = kompono::Pack;
  using NonInteger = kompono::Pack;
  using Nested = kompono::Pack;
  using Literal = double;
  // NOLINTBEGIN(readability-identifier-naming): Eigen's names
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 4,
    MulCost = 4
  };
  // NOLINTEND(readability-identifier-naming)
};

/// Eigen would ask for the alignment of its own largest packets, which is less than a Pack needs
/// and therefore an error to clang. A Pack aligns itself.
template <int Size>
requires(Size != Dynamic) struct internal::compute_default_alignment<kompono::Pack, Size> {
  enum { value = 0 };  // NOLINT(readability-identifier-naming): Eigen's name
};

}  // namespace Eigen

#endif  // KOMPONO_SCALAR_PACK_HPP_
