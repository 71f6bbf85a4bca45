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
[[nodiscard, gnu::always_inline]] inline Vector3<T> Trilaterate(
    const std::array<Vector3<T>, 3>& centre, const std::array<T, 3>& radius, const T& side) {
  using std::sqrt;
  // Number by number: vectors of three that go through memory in pieces of two and one cost twice
  // the time.
  const T ax = centre[1][0] - centre[0][0];
  const T ay = centre[1][1] - centre[0][1];
  const T az = centre[1][2] - centre[0][2];
  const T bx = centre[2][0] - centre[0][0];
  const T by = centre[2][1] - centre[0][1];
  const T bz = centre[2][2] - centre[0][2];
  const T nx = ay * bz - az * by;
  const T ny = az * bx - ax * bz;
  const T nz = ax * by - ay * bx;
  const T by_area2 = T(1.0) / (nx * nx + ny * ny + nz * nz);
  const T squared0 = radius[0] * radius[0];
  const T ka = (ax * ax + ay * ay + az * az + squared0 - radius[1] * radius[1]) / T(2.0);
  const T kb = (bx * bx + by * by + bz * bz + squared0 - radius[2] * radius[2]) / T(2.0);
  // The point of the centres' plane with foot·a = ka and foot·b = kb.
  const T cx = bx * ka - ax * kb;
  const T cy = by * ka - ay * kb;
  const T cz = bz * ka - az * kb;
  const T fx = (cy * nz - cz * ny) * by_area2;
  const T fy = (cz * nx - cx * nz) * by_area2;
  const T fz = (cx * ny - cy * nx) * by_area2;
  const T height2 = (squared0 - (fx * fx + fy * fy + fz * fz)) * by_area2;
  const T height = side * sqrt(height2);
  return {centre[0][0] + fx + nx * height,
          centre[0][1] + fy + ny * height,
          centre[0][2] + fz + nz * height};
}

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_TRILATERATION_HPP_
