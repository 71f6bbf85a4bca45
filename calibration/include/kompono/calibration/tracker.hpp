// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_TRACKER_HPP_
#define KOMPONO_CALIBRATION_TRACKER_HPP_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/geometry/pose.hpp"
#include "kompono/kinematics/machine.hpp"

/// Points as laser trackers and measuring arms export them, joined with the machine's readings.
namespace kompono::calibration {

struct TrackerPoint {
  std::string name;  ///< empty if the line has none
  Eigen::Vector3d p_mm = Eigen::Vector3d::Zero();
  int line = 0;
};

/// Lines "x y z" or "name x y z", separated by blanks, tabs, semicolons or commas; what follows on
/// a line is passed over, as are comments (#, //) and a heading without numbers. With tabs or
/// semicolons decimals may have commas. `mm_per_unit`: 1000 for a file in metres.
/// E0466 for lines that are no points, all of them, and E0402 for a file without any.
[[nodiscard]] Parsed<std::vector<TrackerPoint>> ReadTrackerPoints(std::string_view text,
                                                                  std::string_view file,
                                                                  double mm_per_unit = 1.0);

struct TrackerOptions {
  std::optional<double> sigma_mm;  ///< of every length
  /// Turns and shifts the points into the workpiece datum by the best fit to the nominal machine.
  /// Otherwise the tracker is taken to measure in that datum.
  bool align = false;
};

struct TrackerMeasurements {
  MeasurementSet set;  ///< positions in the datum, or in the tracker's frame without `align`
  std::optional<Pose<double>> X_WL;  ///< tracker frame L in the datum W, if aligned
  double fit_rms_mm = 0.0;           ///< what the best fit leaves: the machine's errors
  Diagnostics warnings;              ///< W0474: not aligned, and in another frame than the datum
};

/// Joins the points with a table of readings (columns as in measurement files): by name if both
/// have names, else line by line. E0467 if they do not match or cannot be aligned, else as
/// ParseMeasurements.
[[nodiscard]] Parsed<TrackerMeasurements> JoinTracker(const std::vector<TrackerPoint>& points,
                                                      std::string_view points_file,
                                                      std::string_view readings_text,
                                                      std::string_view readings_file,
                                                      const kinematics::Machine& machine,
                                                      const TrackerOptions& options);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_TRACKER_HPP_
