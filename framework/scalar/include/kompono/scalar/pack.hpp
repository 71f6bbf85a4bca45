// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SCALAR_PACK_HPP_
#define KOMPONO_SCALAR_PACK_HPP_

#include <experimental/simd>

#include <cstddef>

#include <Eigen/Core>

/// Eight doubles that are computed together. A template over the scalar that is given `Pack`
/// evaluates eight poses at once; what the processor offers (SSE2, AVX2, AVX-512) is the compiler's
/// business.
///
/// A Pack never leaves the library that was compiled with it: its layout may depend on compiler
/// flags.
namespace kompono {

inline constexpr std::size_t kPackLanes = 8;
using Pack = std::experimental::fixed_size_simd<double, kPackLanes>;
using PackMask = Pack::mask_type;

}  // namespace kompono

namespace Eigen {

template <>
struct NumTraits<kompono::Pack> : GenericNumTraits<kompono::Pack> {
  using Real = kompono::Pack;
  using NonInteger = kompono::Pack;
  using Nested = kompono::Pack;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 4,
    MulCost = 4
  };
};

/// Eigen would ask for the alignment of its own largest packets, which is less than a Pack needs
/// and therefore an error to clang. A Pack aligns itself.
template <int Size>
requires(Size != Dynamic) struct internal::compute_default_alignment<kompono::Pack, Size> {
  enum { value = 0 };
};

}  // namespace Eigen

#endif  // KOMPONO_SCALAR_PACK_HPP_
