// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_ZONE_ACCURACY_HPP_
#define KOMPONO_CALIBRATION_ZONE_ACCURACY_HPP_

#include <array>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

namespace kompono::calibration {

/// How well the tool is known at one place after an identification.
struct ZonePoint {
  Eigen::VectorXd coordinates;  ///< mm, rad
  kinematics::PoseNumbers pose;
  Eigen::Vector3d sigma_mm = Eigen::Vector3d::Zero();  ///< of the tool point in X, Y, Z
  double length_mm = 0.0;                              ///< root of the sum of their squares
  double sigma_rad = 0.0;                              ///< of the rotation vector, likewise
};

struct ZoneAccuracy {
  std::vector<ZonePoint> points;  ///< those the machine reaches
  int out_of_reach = 0;
  double rms_mm = 0.0, max_mm = 0.0, max_rad = 0.0;
};

/// The covariance of `report` mapped to the tool over a grid of `steps` values of every linear
/// coordinate, rotary ones at home: within `region`, else the layout's ranges, else what the rows
/// of `set` span. Drives are kept at their readings; numbers of fixtures do not move the tool.
/// E0432 for a report without a covariance.
[[nodiscard]] Parsed<ZoneAccuracy> ToolOverZone(
    const kinematics::Machine& machine,
    const MeasurementSet& set,
    const CalibrationReport& report,
    int steps,
    const std::map<std::string, std::array<double, 2>>& region = {});

/// A line for every point: coordinates, pose, deviations in mm and deg.
[[nodiscard]] std::string ZoneCsv(const kinematics::Machine& machine, const ZoneAccuracy& zone);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_ZONE_ACCURACY_HPP_
