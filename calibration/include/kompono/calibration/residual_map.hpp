// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_RESIDUAL_MAP_HPP_
#define KOMPONO_CALIBRATION_RESIDUAL_MAP_HPP_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// What an identified geometry leaves, as a smooth map over the linear coordinates: guideways that
/// bend, frames that sag, all that is no number of the model. The map is worth something only if it
/// tells the errors of poses that it has not seen; otherwise it is refused.
namespace kompono::calibration {

/// One coordinate of the map's grid; mm, or rad for a rotary one.
struct MapAxis {
  std::string coordinate;
  std::vector<double> values;  ///< ascending, at least two
};

/// Where the tool point really is less where the identified geometry says, in the workpiece datum.
/// Multilinear between the nodes of a grid; outside the grid as at its border.
struct ResidualMap {
  std::vector<MapAxis> axes;
  std::vector<Eigen::Vector3d> error_mm;  ///< of the nodes, the last axis running fastest

  /// At coordinates of `machine`, which has those of the axes.
  [[nodiscard]] Eigen::Vector3d At(const kinematics::Machine& machine,
                                   const Eigen::VectorXd& coordinates) const;
  /// Whether the coordinates lie within the grid.
  [[nodiscard]] bool Covers(const kinematics::Machine& machine,
                            const Eigen::VectorXd& coordinates) const;
};

/// Errors of the tool point (lengths of the measured components, RMS, mm) without and with the map.
struct MapGain {
  int rows = 0;
  double without_mm = 0.0, with_mm = 0.0;
};

struct MapJudgement {
  bool kept = false;
  std::string verdict;  ///< in words
  int nodes = 0;        ///< of each axis
  double smoothing = 0.0;
  MapGain fitted;     ///< rows that made the map
  MapGain validated;  ///< each row by geometry, map and smoothing found without it
  /// Rows that the file holds out.
  std::optional<MapGain> held_out;
};

struct MappedResiduals {
  ResidualMap map;  ///< of the fitted rows; to be used only if kept
  MapJudgement judged;
};

struct MapOptions {
  int folds = 5;
  std::uint64_t seed = 1;  ///< of the folds
};

/// From the rows that measure the tool point itself in the datum (positions, poses, heights).
/// `report`: of an identification with `identify`. E0470 when there are too few of them.
[[nodiscard]] Parsed<MappedResiduals> MapResiduals(const kinematics::Machine& machine,
                                                   const MeasurementSet& set,
                                                   const CalibrationReport& report,
                                                   const IdentifyOptions& identify,
                                                   const MapOptions& options = {});

/// The map as TOML that ReadResidualMap reads; lengths in mm, angles in deg. `source`: what it was
/// found from.
[[nodiscard]] std::string WriteResidualMap(const kinematics::Machine& machine,
                                           const MappedResiduals& mapped,
                                           std::string_view source);

/// All problems of the text at once, E0471.
[[nodiscard]] Parsed<ResidualMap> ParseResidualMap(std::string_view text,
                                                   std::string_view file,
                                                   const kinematics::Machine& machine);

/// A few lines for the report.
[[nodiscard]] std::string RenderText(const MapJudgement& judged);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_RESIDUAL_MAP_HPP_
