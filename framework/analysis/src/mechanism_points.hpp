// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_MECHANISM_POINTS_HPP_
#define KOMPONO_ANALYSIS_MECHANISM_POINTS_HPP_

#include <vector>

#include "kompono/analysis/pose_judge.hpp"
#include "kompono/geometry/pose.hpp"

/// A mechanism at one pose: its points, its platform, and which body carries which point.
namespace kompono::analysis {

/// Which body's directions a point shares: carriages only translate, so they share the base's.
enum class PointBody { kBase, kPlatform, kOther };

struct StrutEnds {
  int from = 0, to = 0;  ///< skeleton points
};

struct MechanismPoints {
  std::vector<Eigen::Vector3d> point;  ///< in the mechanism's base, mm
  std::vector<PointBody> body;
  std::vector<StrutEnds> struts;  ///< links of kind "strut"
  Pose<double> platform;
  /// The same point by name or by place.
  [[nodiscard]] bool ShareAJoint(const StrutEnds& a, const StrutEnds& b) const;
};

/// Code, numbers and places of one mechanism; no ranges or checks yet.
[[nodiscard]] PoseJudge::Mechanism DescribeMechanism(const Machine::BlockView& view,
                                                     const VectorXd& theta);

/// x of the mechanism at the machine's coordinates z.
[[nodiscard]] VectorXd LocalAt(const PoseJudge::Mechanism& mechanism, const VectorXd& z);

/// Values and, if asked for, derivatives by x or q of one quantity at one pose. NaN where the
/// module has none.
struct Values {
  VectorXd value;
  MatrixXd by_coordinates, by_drives;
};
[[nodiscard]] Values ValuesAt(const PoseJudge::Mechanism& mechanism,
                              plugin::Quantity quantity,
                              const VectorXd& x,
                              const VectorXd& q,
                              bool derivatives);

[[nodiscard]] MechanismPoints PointsAt(const PoseJudge::Mechanism& mechanism, const VectorXd& z);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_MECHANISM_POINTS_HPP_
