// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_PLANNING_HPP_
#define KOMPONO_CALIBRATION_PLANNING_HPP_

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "kompono/analysis/pose_judge.hpp"
#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/simulation.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// Where to measure: poses chosen before anything is measured.
namespace kompono::calibration {

enum class PlanCriterion {
  kDOptimal,   ///< the largest determinant of the information about the free numbers
  kToolError,  ///< the smallest predicted deviation of the tool point over the work zone
};

struct PlanOptions {
  int points = 20;
  int candidates = 600;  ///< reachable, regular poses to choose from
  int judged = 120;      ///< poses of the zone over which the tool's deviation is predicted
  PlanCriterion criterion = PlanCriterion::kToolError;
  /// Kind of measurement, its deviations, fixtures, region and seed; counts are not used.
  SimulateOptions instrument;
  IdentifyOptions identify;  ///< what is free, priors, bounds
  /// Poses with a smaller singularity margin are not offered.
  double least_margin = 0.02;
  /// What poses must keep besides reach and ranges: swings of joints, clearance between struts;
  /// those of the layout unless told otherwise.
  analysis::Limits limits;
};

struct Plan {
  MeasurementSet set;  ///< the chosen rows in the order of their worth, with nominal measurements
  /// Predicted deviation of the tool point over the zone (RMS of its length, mm) of the first n
  /// rows; infinite while they do not determine what moves the tool.
  std::vector<double> tool_sigma_mm;
  double random_tool_sigma_mm = 0.0;  ///< median of 200 random sets of as many rows
  int rank = 0;                       ///< of the chosen rows
  int free = 0;                       ///< free numbers
  int drawn = 0;                      ///< poses looked at to get the candidates
  int near_singular = 0;              ///< of them: nearer to a singularity than allowed
  int obstructed = 0;                 ///< of them: a joint swings too far, or struts touch
};

/// E044x when poses cannot be drawn or too few may be taken; E0721 for a swing that matches no
/// joint.
[[nodiscard]] Parsed<Plan> PlanMeasurements(const kinematics::Machine& machine,
                                            const PlanOptions& options);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_PLANNING_HPP_
