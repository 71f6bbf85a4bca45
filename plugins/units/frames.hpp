// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_UNITS_FRAMES_HPP_
#define KOMPONO_UNITS_FRAMES_HPP_

#include <kompono/sdk/unit.hpp>

#include <cstddef>
#include <span>

/// Small frames that units are put together from.
namespace kompono::units {

template <class T>
[[nodiscard]] Pose<T> Shift(const T& x, const T& y, const T& z) {
  Pose<T> X;
  X.p = {x, y, z};
  return X;
}

template <class T>
[[nodiscard]] Pose<T> Turn(const Matrix3<T>& R) {
  Pose<T> X;
  X.R = R;
  return X;
}

/// Rx(tilt_x) Ry(tilt_y), both numbers at `first` of the parameters.
template <class T>
[[nodiscard]] Pose<T> Tilt(std::span<const T> parameter, std::size_t first) {
  return Turn<T>(RotationXYZ(parameter[first], parameter[first + 1], T(0.0)));
}

/// Half a turn about y, exact: what looks along z looks along -z, and y stays.
template <class T>
[[nodiscard]] Pose<T> FaceAbout() {
  Pose<T> X;
  X.R.setZero();
  X.R(0, 0) = T(-1.0);
  X.R(1, 1) = T(1.0);
  X.R(2, 2) = T(-1.0);
  return X;
}

}  // namespace kompono::units

#endif  // KOMPONO_UNITS_FRAMES_HPP_
