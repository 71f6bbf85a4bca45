// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_ISO_FIGURES_HPP_
#define KOMPONO_CALIBRATION_ISO_FIGURES_HPP_

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
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

struct IsoFigures {
  std::vector<RepeatedPose> poses;  ///< of at least three repeats
  std::vector<CircularRun> runs;    ///< of at least eight rows
  [[nodiscard]] bool empty() const { return poses.empty() && runs.empty(); }
};

/// `identified`: θ with the identified numbers, without fixtures.
[[nodiscard]] IsoFigures IsoFiguresOf(const kinematics::Machine& machine,
                                      const MeasurementSet& set,
                                      const Eigen::VectorXd& identified);

/// Two tables; empty if there is nothing to tell.
[[nodiscard]] std::string RenderIso(const IsoFigures& figures);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_ISO_FIGURES_HPP_
