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
  kBallBar,   ///< distance from the target to a centre that stands still in the datum
  kPlane,     ///< height of the target above a plane: touch probe on a face
  kHole,      ///< x and y of the jet in the coordinates of a sheet that lies somewhere on the table
  kRelative,  ///< pose at the second readings as seen from the tool at the first
};
[[nodiscard]] std::string_view Name(MeasurementKind kind);

/// What belongs to the instrument and not to the machine: where a reflector sits on the tool, where
/// a ball-bar's socket stands, how a probed face lies, where a sheet was put. Three numbers each;
/// those that are not known are identified with the geometry.
enum class FixtureKind {
  kTarget,  ///< x, y, z of the target in the tool frame, mm
  kCentre,  ///< x, y, z in the datum, mm
  kPlane,   ///< two tilts of the normal (rad) and the offset along it (mm)
  kSheet,   ///< x, y of the sheet's origin in the datum (mm) and its turn about z (rad)
};
[[nodiscard]] std::string_view Name(FixtureKind kind);

struct Fixture {
  FixtureKind kind = FixtureKind::kTarget;
  std::string name;                                   ///< "A": its numbers are "centre.A.x", ...
  std::array<double, 3> value{};                      ///< start value where not known
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of a plane without tilts
  bool known = true;
};

/// How a row's position was approached: along which axis of the datum, and in which direction.
struct Approach {
  char axis = 'X';  ///< X, Y, Z, or A, B, C for a turn about them
  bool positive = true;
  [[nodiscard]] bool rotary() const { return axis < 'X'; }
  /// 0, 1, 2 for the datum's x, y, z.
  [[nodiscard]] int component() const { return rotary() ? axis - 'A' : axis - 'X'; }
};

/// One row. mm, rad.
struct Measurement {
  MeasurementKind kind = MeasurementKind::kPosition;
  Eigen::VectorXd readings;                            ///< of all drives, in the machine's order
  Eigen::VectorXd second_readings;                     ///< of a distance, else empty
  double value_mm = 0.0;                               ///< height, distance, ball-bar or plane
  std::array<std::optional<double>, 3> position_mm;    ///< position and pose
  Eigen::Matrix3d R_WT = Eigen::Matrix3d::Identity();  ///< pose
  std::optional<double> sigma_mm;                      ///< standard deviation of each length
  std::optional<double> sigma_rad;  ///< standard deviation of each component of the rotation vector
  int target = -1;                  ///< into the set's fixtures; -1: the tool point itself
  int fixture = -1;                 ///< centre, plane or sheet
  std::optional<Approach> approach;
  bool held_out = false;  ///< not used in the fit, only to judge it
  int row = 0;            ///< counted from 1 in the file's data rows
  int line = 0;           ///< in `MeasurementSet::text`; 0 if there is no text

  /// How many numbers it gives to the fit.
  [[nodiscard]] int Numbers() const;
};

struct MeasurementSet {
  std::string file;  ///< as the user named it
  std::string text;  ///< for complaints about single rows
  std::vector<Measurement> measurements;
  std::vector<Fixture> fixtures;
  /// What the format itself says may be fitted; empty if it says nothing.
  std::vector<std::string> suggested_free;
  std::string origin;  ///< "klipper_delta" or empty
  bool relative_weights =
      false;  ///< the sigmas tell the rows' weights against each other, not real deviations

  [[nodiscard]] std::size_t Count(bool held_out) const;
};

/// The machine's numbers and behind them three for every fixture: "target.A.x", "centre.A.y",
/// "plane.A.tilt_1", "plane.A.offset", "sheet.A.c". Of fixtures the unknown are identifiable.
[[nodiscard]] std::vector<kinematics::Parameter> AllParameters(const kinematics::Machine& machine,
                                                               const MeasurementSet& set);
/// Their values in the layout and in the set.
[[nodiscard]] Eigen::VectorXd AllNominal(const kinematics::Machine& machine,
                                         const MeasurementSet& set);

struct ReadOptions {
  /// Compares with what the nominal machine predicts and refuses data that fit far better after a
  /// factor of 1000 (metres for millimetres) or of degrees for radians.
  bool check_units = true;
  /// Rows so far from the nominal machine that only a slip explains them are named (W0427) and not
  /// refused (E0473): the fit will leave them out.
  bool keep_slips = false;
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
