// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_TRILATERATION_HPP_
#define KOMPONO_SDK_TRILATERATION_HPP_

#include <array>

#include "kompono/geometry/pose.hpp"

namespace kompono::sdk {

/// The point at the distances `radius` from three centres; there are two, mirrored in the centres'
/// plane, and `side` = +1 takes the one on the side of the normal (c1 - c0) x (c2 - c0). Not a
/// number when the spheres do not meet. This is the forward kinematics of everything that
/// translates on three legs (KDD eq. 8, 9 in vector form).
template <class T>
[[nodiscard]] Vector3<T> Trilaterate(const std::array<Vector3<T>, 3>& centre,
                                     const std::array<T, 3>& radius,
                                     const T& side) {
  using std::sqrt;
  const Vector3<T> d1 = centre[1] - centre[0];
  const Vector3<T> d2 = centre[2] - centre[0];
  const Vector3<T> normal = d1.cross(d2);
  const T area2 = normal.dot(normal);
  const T squared0 = radius[0] * radius[0];
  const T k1 = (d1.dot(d1) + squared0 - radius[1] * radius[1]) / T(2.0);
  const T k2 = (d2.dot(d2) + squared0 - radius[2] * radius[2]) / T(2.0);
  // The point of the centres' plane with foot·d1 = k1 and foot·d2 = k2.
  const Vector3<T> across = d2 * k1 - d1 * k2;
  const Vector3<T> foot = across.cross(normal) / area2;
  const T height2 = (squared0 - foot.dot(foot)) / area2;
  return centre[0] + foot + normal * (side * sqrt(height2));
}

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_TRILATERATION_HPP_
