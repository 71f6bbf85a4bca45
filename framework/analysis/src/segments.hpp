// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_SEGMENTS_HPP_
#define KOMPONO_ANALYSIS_SEGMENTS_HPP_

#include <algorithm>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kompono::analysis {

/// Shortest distance between the segments a0 a1 and b0 b1; points and parallel segments included.
struct SegmentMeeting {
  double distance = 0.0;
  double along_a = 0.0, along_b = 0.0;  ///< 0 … 1: where on each
};
[[nodiscard]] inline SegmentMeeting MeetSegments(const Eigen::Vector3d& a0,
                                                 const Eigen::Vector3d& a1,
                                                 const Eigen::Vector3d& b0,
                                                 const Eigen::Vector3d& b1) {
  const Eigen::Vector3d u = a1 - a0;
  const Eigen::Vector3d v = b1 - b0;
  const Eigen::Vector3d w = a0 - b0;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double uw = u.dot(w);
  const double vw = v.dot(w);
  const auto clamp = [](double t) { return std::clamp(t, 0.0, 1.0); };
  const double area2 = uu * vv - uv * uv;
  // The nearest points of the lines, then of what the ends leave: s first, t for it, s again if t
  // was cut.
  double s = area2 > 1e-14 * uu * vv ? clamp((uv * vw - vv * uw) / area2) : 0.0;
  double t = vv > 0.0 ? (uv * s + vw) / vv : 0.0;
  if (t < 0.0 || t > 1.0 || vv == 0.0) {
    t = clamp(t);
    s = uu > 0.0 ? clamp((uv * t - uw) / uu) : 0.0;
  }
  return {(w + s * u - t * v).norm(), s, t};
}
[[nodiscard]] inline double SegmentDistance(const Eigen::Vector3d& a0,
                                            const Eigen::Vector3d& a1,
                                            const Eigen::Vector3d& b0,
                                            const Eigen::Vector3d& b1) {
  return MeetSegments(a0, a1, b0, b1).distance;
}

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_SEGMENTS_HPP_
