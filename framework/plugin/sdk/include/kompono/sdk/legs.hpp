// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_LEGS_HPP_
#define KOMPONO_SDK_LEGS_HPP_

#include "kompono/geometry/pose.hpp"

/// The two closed forms nearly every parallel machine stands on (domain of KDD eq. 5 and KSM).
/// `p_BQ` is the platform joint in the mechanism's base.
namespace kompono::sdk {

template <class T>
struct LegDrive {
  T position;  ///< mm; not a number when out of reach
  T reach;     ///< mm², negative by how much the joint is too far
};

/// A glide: a strut of constant length whose foot is a carriage on the straight rail through `p_BA`
/// with unit direction `u`. With w = p - a:  d = u·w + σ sqrt(L² - |w - u (u·w)|²), which is KDD
/// eq. 5 with the radicand written as the squared strut less the squared distance from the rail, so
/// that nothing large cancels.
template <class T>
[[nodiscard]] LegDrive<T> GlidePosition(const Vector3<T>& p_BA,
                                        const Vector3<T>& u,
                                        const T& strut,
                                        const T& mode,
                                        const Vector3<T>& p_BQ) {
  using std::sqrt;
  const Vector3<T> w = p_BQ - p_BA;
  const T along = u.dot(w);
  const Vector3<T> across = w - u * along;
  const T reach = strut * strut - across.dot(across);
  return {along + mode * sqrt(reach), reach};
}

/// Loop residual of a glide, mm²: |p - a - u d|² - L².
template <class T>
[[nodiscard]] T GlideClosure(const Vector3<T>& p_BA,
                             const Vector3<T>& u,
                             const T& strut,
                             const T& position,
                             const Vector3<T>& p_BQ) {
  const Vector3<T> leg = p_BQ - p_BA - u * position;
  return leg.dot(leg) - strut * strut;
}

/// A pod: a strut of variable length with a fixed foot.
template <class T>
[[nodiscard]] LegDrive<T> PodLength(const Vector3<T>& p_BA, const Vector3<T>& p_BQ) {
  using std::sqrt;
  const Vector3<T> leg = p_BQ - p_BA;
  const T squared = leg.dot(leg);
  return {sqrt(squared), squared};
}

/// Loop residual of a pod, mm²: |p - a|² - q².
template <class T>
[[nodiscard]] T PodClosure(const Vector3<T>& p_BA, const T& length, const Vector3<T>& p_BQ) {
  const Vector3<T> leg = p_BQ - p_BA;
  return leg.dot(leg) - length * length;
}

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_LEGS_HPP_
