// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_GEOMETRY_POSE_HPP_
#define KOMPONO_GEOMETRY_POSE_HPP_

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rigid-body poses templated on the scalar. Frames are in the names: `X_AB` is the pose of frame B
/// in frame A, `p_AQ` a point Q in A, and letters that touch are equal: `X_AC = X_AB * X_BC`.
/// Millimetres and radians.
namespace kompono {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;

template <class T>
struct Pose {
  Matrix3<T> R = Matrix3<T>::Identity();
  Vector3<T> p = Vector3<T>::Zero();

  [[nodiscard]] Pose operator*(const Pose& other) const { return {R * other.R, R * other.p + p}; }
  [[nodiscard]] Vector3<T> operator*(const Vector3<T>& point) const { return R * point + p; }
  [[nodiscard]] Pose Inverse() const { return {R.transpose(), -(R.transpose() * p)}; }

  /// Rows of [R | p], 12 numbers: the form in which poses cross library boundaries.
  void Write(std::span<T> rows) const {
    std::size_t at = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) rows[at++] = R(i, j);
      rows[at++] = p[i];
    }
  }
  [[nodiscard]] static Pose Read(std::span<const T> rows) {
    Pose X;
    std::size_t at = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) X.R(i, j) = rows[at++];
      X.p[i] = rows[at++];
    }
    return X;
  }
};

template <class T>
[[nodiscard]] Matrix3<T> RotationX(const T& angle) {
  using std::cos;
  using std::sin;
  const T c = cos(angle);
  const T s = sin(angle);
  Matrix3<T> R;
  R << T(1), T(0), T(0), T(0), c, -s, T(0), s, c;
  return R;
}

template <class T>
[[nodiscard]] Matrix3<T> RotationY(const T& angle) {
  using std::cos;
  using std::sin;
  const T c = cos(angle);
  const T s = sin(angle);
  Matrix3<T> R;
  R << c, T(0), s, T(0), T(1), T(0), -s, T(0), c;
  return R;
}

template <class T>
[[nodiscard]] Matrix3<T> RotationZ(const T& angle) {
  using std::cos;
  using std::sin;
  const T c = cos(angle);
  const T s = sin(angle);
  Matrix3<T> R;
  R << c, -s, T(0), s, c, T(0), T(0), T(0), T(1);
  return R;
}

/// Rx(phi) Ry(psi) Rz(theta), the order of GIP eq. 2 and of every angle triple in layout files;
/// written out, because in packs the product of three sparse matrices would cost twice as much.
template <class T>
[[nodiscard]] Matrix3<T> RotationXYZ(const T& phi, const T& psi, const T& theta) {
  using std::cos;
  using std::sin;
  const T ca = cos(phi), sa = sin(phi);
  const T cb = cos(psi), sb = sin(psi);
  const T cc = cos(theta), sc = sin(theta);
  Matrix3<T> R;
  R << cb * cc, -(cb * sc), sb,                                    //
      ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -(sa * cb),  //
      sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb;
  return R;
}

/// What a letter of ISO 841 moves: 0, 1 or 2 for x, y, z, or -1 for a letter that is no motion. X U
/// P, Y V Q and Z W R translate; A and D turn about x, B and E about y, C about z.
[[nodiscard]] constexpr int AxisOfLetter(char letter) {
  switch (letter) {
    case 'X':
    case 'U':
    case 'P':
    case 'A':
    case 'D':
      return 0;
    case 'Y':
    case 'V':
    case 'Q':
    case 'B':
    case 'E':
      return 1;
    case 'Z':
    case 'W':
    case 'R':
    case 'C':
      return 2;
    default:
      return -1;
  }
}
[[nodiscard]] constexpr bool IsRotaryLetter(char letter) {
  return letter >= 'A' && letter <= 'E';
}

/// The motion of one letter by `value` (mm or rad) along or about its own axis.
template <class T>
[[nodiscard]] Pose<T> LetterMotion(char letter, const T& value) {
  Pose<T> X;
  const int axis = AxisOfLetter(letter);
  if (!IsRotaryLetter(letter)) {
    X.p[axis] = value;
  } else {
    X.R = axis == 0 ? RotationX(value) : axis == 1 ? RotationY(value) : RotationZ(value);
  }
  return X;
}

}  // namespace kompono

#endif  // KOMPONO_GEOMETRY_POSE_HPP_
