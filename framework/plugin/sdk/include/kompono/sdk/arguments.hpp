// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_ARGUMENTS_HPP_
#define KOMPONO_SDK_ARGUMENTS_HPP_

#include <cstddef>
#include <span>
#include <string_view>

#include "kompono/geometry/pose.hpp"

/// What the templates of a mechanism's author read and write.
namespace kompono::sdk {

/// Numbers of things; must agree with the sidecar. Lengths are mm, angles rad.
struct MechanismSpec {
  std::string_view letters;  ///< local coordinates in order
  int drives = 0;
  int parameters = 0;  ///< numbers in all: a point counts three
  int modes = 0;
  int closures = 0;
  int points = 0;
  /// The closure is f(x) - h(q), as with pods: its derivatives by x do not depend on q, which saves
  /// forward kinematics an evaluation.
  bool separable = false;
};

/// What the author's templates read.
template <class T>
struct Arguments {
  std::span<const T> x;          ///< local coordinates
  std::span<const T> q;          ///< drive positions
  std::span<const T> parameter;  ///< in the order of the sidecar
  std::span<const T> mode;       ///< each +1 or -1

  [[nodiscard]] Vector3<T> Point(std::size_t first) const {
    return {parameter[first], parameter[first + 1], parameter[first + 2]};
  }
};

/// What Drives writes: positions, and per drive a margin in mm² (or rad²) that is negative when out
/// of reach.
template <class T>
struct DriveValues {
  std::span<T> q;
  std::span<T> reach;
};

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_ARGUMENTS_HPP_
