// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_ISO_FIGURES_HPP_
#define KOMPONO_CALIBRATION_ISO_FIGURES_HPP_

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
#include "kompono/calibration/positioning.hpp"
#include "kompono/kinematics/machine.hpp"

/// Figures as the standards define them, where the rows of a file allow them.
namespace kompono::calibration {

/// ISO 9283, one commanded pose measured again and again: rows of positions or poses with the same
/// readings.
struct RepeatedPose {
  int first_row = 0, repeats = 0;
  double accuracy_before_mm = 0.0;  ///< AP: barycentre to what the nominal geometry predicts
  double accuracy_after_mm = 0.0;   ///< to what the identified one predicts
  double repeatability_mm = 0.0;    ///< RP: mean distance to the barycentre and three deviations
};

/// ISO 230-4, a ball-bar's run about one socket, deviations of its length from the commanded.
struct CircularRun {
  std::string centre;
  int rows = 0;
  double deviation_before_mm = 0.0, deviation_after_mm = 0.0;        ///< G: largest less smallest
  double radial_most_before_mm = 0.0, radial_least_before_mm = 0.0;  ///< Fmax, Fmin
};

/// ISO 230-2, one axis of the datum along one line: rows whose direction of approach is known.
struct AxisTest {
  char axis = 'X';   ///< X, Y, Z, or A, B, C
  std::string line;  ///< where the other coordinates stood: "Y 0, Z 100"
  int first_row = 0, rows = 0, targets = 0;
  double from = 0.0, to = 0.0;       ///< commanded positions, mm or rad
  std::vector<std::string> missing;  ///< what the standard asks for; then there are no figures
  PositioningFigures before;         ///< against what the nominal geometry predicts
  PositioningFigures after;          ///< against what the identified one predicts
  [[nodiscard]] bool rotary() const { return axis < 'X'; }
};

struct IsoFigures {
  std::vector<RepeatedPose> poses;  ///< of at least three repeats
  std::vector<CircularRun> runs;    ///< of at least eight rows
  std::vector<AxisTest> axes;
  [[nodiscard]] bool empty() const { return poses.empty() && runs.empty() && axes.empty(); }
};

/// `identified`: θ with the identified numbers, without fixtures.
[[nodiscard]] IsoFigures IsoFiguresOf(const kinematics::Machine& machine,
                                      const MeasurementSet& set,
                                      const Eigen::VectorXd& identified);

/// Up to three tables; empty if there is nothing to tell.
[[nodiscard]] std::string RenderIso(const IsoFigures& figures);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_ISO_FIGURES_HPP_
