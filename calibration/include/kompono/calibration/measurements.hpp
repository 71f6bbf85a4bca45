// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_MEASUREMENTS_HPP_
#define KOMPONO_CALIBRATION_MEASUREMENTS_HPP_

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// What was measured on a machine: drive readings and what an instrument said about the tool point
/// T in the workpiece datum W. File format: docs/calibration.md.
namespace kompono::calibration {

enum class MeasurementKind {
  kHeight,    ///< z of the tool point: a probe, a feeler under the nozzle
  kDistance,  ///< between the tool points at two sets of readings: ball-bar, calliper
  kPosition,  ///< x, y, z of the tool point, or some of them: tracker, holes in a sheet
  kPose,      ///< position and orientation
};
[[nodiscard]] std::string_view Name(MeasurementKind kind);

/// One row. mm, rad.
struct Measurement {
  MeasurementKind kind = MeasurementKind::kPosition;
  Eigen::VectorXd readings;                            ///< of all drives, in the machine's order
  Eigen::VectorXd second_readings;                     ///< of a distance, else empty
  double value_mm = 0.0;                               ///< height or distance
  std::array<std::optional<double>, 3> position_mm;    ///< position and pose
  Eigen::Matrix3d R_WT = Eigen::Matrix3d::Identity();  ///< pose
  std::optional<double> sigma_mm;                      ///< standard deviation of each length
  std::optional<double> sigma_rad;  ///< standard deviation of each component of the rotation vector
  bool held_out = false;            ///< not used in the fit, only to judge it
  int row = 0;                      ///< counted from 1 in the file's data rows
  int line = 0;                     ///< in `MeasurementSet::text`; 0 if there is no text

  /// How many numbers it gives to the fit.
  [[nodiscard]] int Numbers() const;
};

struct MeasurementSet {
  std::string file;  ///< as the user named it
  std::string text;  ///< for complaints about single rows
  std::vector<Measurement> measurements;
  /// What the format itself says may be fitted; empty if it says nothing.
  std::vector<std::string> suggested_free;
  std::string origin;  ///< "klipper_delta" or empty
  bool relative_weights =
      false;  ///< the sigmas tell the rows' weights against each other, not real deviations

  [[nodiscard]] std::size_t Count(bool held_out) const;
};

struct ReadOptions {
  /// Compares with what the nominal machine predicts and refuses data that fit far better after a
  /// factor of 1000 (metres for millimetres) or of degrees for radians.
  bool check_units = true;
};

/// Reads and judges a measurement file; every problem of the file in one run (codes E04xx).
/// Klipper's delta runs are known by their header. `notes` receives warnings and notes of a good
/// file, if not null.
[[nodiscard]] Parsed<MeasurementSet> ParseMeasurements(std::string_view text,
                                                       std::string_view file,
                                                       const kinematics::Machine& machine,
                                                       const ReadOptions& options = {},
                                                       Diagnostics* notes = nullptr);
[[nodiscard]] Parsed<MeasurementSet> ReadMeasurements(const std::filesystem::path& file,
                                                      const kinematics::Machine& machine,
                                                      const ReadOptions& options = {},
                                                      Diagnostics* notes = nullptr);

/// The set as a file that ParseMeasurements reads back to the same numbers. `comments` become lines
/// that start with '#'.
[[nodiscard]] std::string WriteMeasurements(const MeasurementSet& set,
                                            const kinematics::Machine& machine,
                                            const std::vector<std::string>& comments);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_MEASUREMENTS_HPP_
