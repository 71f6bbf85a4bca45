// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_GEOMETRY_NUMBERS_HPP_
#define KOMPONO_ANALYSIS_GEOMETRY_NUMBERS_HPP_

#include <optional>
#include <string>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// Numbers of a machine at one pose that its designer asks for (KDD, section 8): points, struts,
/// how near struts come to one another, angles between links. All in the workpiece-side base; mm,
/// rad.
namespace kompono::analysis {

struct StrutNumbers {
  std::string from, to;  ///< skeleton points
  double length_mm = 0.0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  /// Euler angles of the strut as a body of revolution: Rz(precession) Ry(nutation) turns z into
  /// its direction; its turn about itself is not defined.
  double precession_rad = 0.0, nutation_rad = 0.0;
};

/// Shortest distance between two struts as capsules.
struct StrutDistance {
  std::size_t first = 0, second = 0;  ///< struts
  double centre_lines_mm = 0.0;
  double clearance_mm = 0.0;  ///< less both radii; negative: they overlap
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_second = Eigen::Vector3d::Zero();
};

/// Between two links that meet in a point, 0 when they point the same way from there.
struct LinkAngle {
  std::string at;             ///< the common point
  std::string first, second;  ///< the other ends
  double angle_rad = 0.0;
};

struct GeometryNumbers {
  std::vector<kinematics::Machine::SkeletonPoint> points;
  std::vector<StrutNumbers> struts;
  std::vector<StrutDistance> distances;  ///< of struts that share no joint, nearest first
  std::vector<LinkAngle> angles;
};
/// Struts have the radius given, or else half the diameter that the layout gives, or 0.
[[nodiscard]] GeometryNumbers GeometryAt(const kinematics::Machine& machine,
                                         const kinematics::VectorXd& z,
                                         const kinematics::VectorXd& theta,
                                         const std::optional<double>& strut_radius_mm = {});

/// Where a point is at each pose. `point` is a skeleton point, "struts.joint1", or a place on a
/// link between two of them, "struts.base1:struts.joint1:0.25" for a quarter of the way. E0726: no
/// such point, or not of that form.
[[nodiscard]] Parsed<std::vector<Eigen::Vector3d>> PathOfPoint(
    const kinematics::Machine& machine,
    const std::vector<kinematics::VectorXd>& poses,
    const kinematics::VectorXd& theta,
    const std::string& point);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_GEOMETRY_NUMBERS_HPP_
