// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_IDENTIFICATION_HPP_
#define KOMPONO_CALIBRATION_IDENTIFICATION_HPP_

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// Finds the real geometry of a machine from measurements.
///
/// Unknowns are the free numbers of the machine's geometry θ: lengths, joints, drive zeros, mounts,
/// the pose of an open base, the tool. With the readings of measurement k the machine predicts the
/// tool pose X_WT(readings_k, θ); the fit minimises the squared differences from what was measured,
/// each divided by its standard deviation:
///
///     C(θ) = 1/2 Σ_k |r_k(θ) / σ_k|² + 1/2 Σ_i ((θ_i - θ_i nominal) / prior σ_i)²
///
/// The derivatives are exact (automatic, through the closures by the implicit function theorem);
/// therefore the rank of the Jacobian tells what the measurements can determine. Directions that
/// they cannot are reported in words and get the smallest change in units of the manufacturing
/// tolerances, so that predictions are not disturbed and parameters do not wander.
namespace kompono::calibration {

/// What becomes of rows that stand out of the others.
enum class Outliers {
  kAutomatic,  ///< rejected, unless the rows carry only relative weights
  kReject,     ///< two-stage robust fit on whole rows; what stands out is left out and listed
  kKeep,       ///< plain least squares over all rows
};

/// How combinations that the measurements cannot see are settled.
enum class Gauge {
  kMinimumNorm,  ///< the smallest change, every number in units of its tolerance
  kFreeze,       ///< one number of each combination stays at its start
  kPrior,        ///< numbers with a tolerance are expected at their nominal value within it
};

/// Kinds of numbers, so that a part of a calibration can be repeated: after a crash the offsets,
/// after a move of the machine the frames.
enum class ParameterGroup {
  kOffsets,   ///< zeros of drives
  kFrames,    ///< where blocks, axes, tool and open base stand
  kGeometry,  ///< what the modules are made of: lengths, joints
  kAll,
};
[[nodiscard]] std::string_view Name(ParameterGroup group);
/// Which of the first three a number is of, by its name.
[[nodiscard]] ParameterGroup GroupOf(std::string_view parameter);

struct IdentifyOptions {
  /// What may change, as patterns (layout::MatchesPattern): "struts.base[*]", "*.zero",
  /// "open_base". Without: the layout's [calibration] free, or all parameters marked identifiable,
  /// and of these only what the measurement format fits if it says so.
  std::vector<std::string> free;
  /// Added to `free` if that is given, else in place of the layout's: the numbers of these groups.
  /// Of offsets and geometry those marked identifiable, all frames.
  std::vector<ParameterGroup> groups;
  /// What may not. Added to the layout's lock, which holds unless `free` above is given.
  std::vector<std::string> lock;
  std::map<std::string, double> prior_sigma;  ///< over the layout's; mm, rad
  /// Free numbers without another prior are expected within so many manufacturing tolerances of
  /// their nominal value; 0: not.
  double prior_tolerances = 0.0;
  std::map<std::string, std::array<double, 2>> bounds;  ///< over the layout's; mm, rad
  double default_sigma_mm = 0.01;                       ///< for rows without their own
  double default_sigma_rad = 1e-5;                      ///< for rows without their own
  double held_out_fraction = 0.0;  ///< of the rows not held out by the file, drawn by `seed`
  std::uint64_t seed = 1;
  int max_iterations = 100;
  double rank_threshold = 1e-9;  ///< relative to the largest singular value, columns of unit length
  /// Combinations whose predicted deviation is more than so many manufacturing tolerances are held
  /// like those that are not seen at all, and named; 0: followed however weakly they are seen.
  double weak_tolerances = 100.0;
  double correlation_threshold = 0.95;  ///< pairs above it are reported
  Outliers outliers = Outliers::kAutomatic;
  Gauge gauge = Gauge::kMinimumNorm;
  /// Deviations of the drive readings themselves. 0: the scales are exact beside the instrument.
  double drive_sigma_mm = 0.0, drive_sigma_rad = 0.0;
  std::optional<Eigen::VectorXd> start;  ///< θ to start from; the layout's if not given
};

enum class IdentifyStatus {
  kConverged,
  kRankDeficient,       ///< converged; some combinations of parameters are not determined
  kIterationLimit,      ///< the parameters are not to be trusted
  kTooFewMeasurements,  ///< no more numbers than they can explain
  kForwardFailed,       ///< a row has readings at which the machine has no pose
  kBadInput,            ///< the options do not fit the machine
};
[[nodiscard]] std::string_view Name(IdentifyStatus status);

/// Errors of one measured quantity, before and after. Of a position or orientation the error is the
/// length of the difference vector (measured components only); RMS and maximum are over the rows.
struct ErrorStatistics {
  std::string quantity;  ///< "height", "distance", "position", "orientation"
  bool angle = false;    ///< rad instead of mm
  bool held_out = false;
  int count = 0;
  double rms_before = 0.0, rms_after = 0.0;
  double max_before = 0.0, max_after = 0.0;
};

struct IdentifiedParameter {
  std::string name;
  bool angle = false;
  double before = 0.0, after = 0.0;  ///< mm or rad
  std::optional<double> sigma;       ///< standard deviation; none if it is not determined
  double tolerance = 0.0;            ///< of manufacturing; 0 if none is known
  bool at_bound = false;
  bool determined = true;  ///< false: part of a combination that the measurements cannot see
  [[nodiscard]] double change() const { return after - before; }
};

/// What the identified changes of a group of numbers do at the tool, over the fitted rows.
struct GroupEffect {
  std::string group;       ///< "open_base", "struts", "P_z", ...
  double change_mm = 0.0;  ///< RMS of the tool's motion by the group's changes
  double sigma_mm = 0.0;   ///< RMS of its predicted deviation by the group's covariance
};

struct CorrelatedPair {
  std::string first, second;
  double correlation = 0.0;
};

/// A combination of parameters that can change without any effect on the measurements.
struct NullDirection {
  /// Change of each parameter, the largest being ±1 (mm or rad).
  std::vector<std::pair<std::string, double>> parts;
  bool weak = false;   ///< seen, but worth less than the drawing: IdentifyOptions::weak_tolerances
  std::string words;   ///< "open_base.x and part.datum.x can only be told apart up to their sum"
  std::string remedy;  ///< "lock one of them, or measure the orientation too"
};

/// One row of the file.
struct RowResidual {
  int row = 0, line = 0;
  MeasurementKind kind = MeasurementKind::kPosition;
  bool held_out = false;
  bool rejected = false;  ///< stood out and was left out of the fit
  double before_mm = 0.0, after_mm = 0.0;
  double before_rad = 0.0, after_rad = 0.0;  ///< poses only
  double after_sigmas = 0.0;  ///< RMS of the row's residuals after, in their standard deviations
};

/// The story of one identification.
/// Numbers that were not free and would explain errors larger than the deviations allow, most
/// effective first; empty where the deviations do allow them.
struct LockedSuspects {
  std::vector<std::string> names;  ///< three at most
  double share = 0.0;              ///< of the squares left that freeing these would explain
  double share_of_all = 0.0;       ///< that all numbers of the machine together would
};

struct CalibrationReport {
  IdentifyStatus status = IdentifyStatus::kBadInput;
  Diagnostics diagnostics;  ///< errors that made it fail, warnings about data and result
  std::string solver_message;
  int iterations = 0;
  int rows_fitted = 0, rows_held_out = 0;
  int numbers = 0;                             ///< measured numbers in the fit
  int rank = 0;                                ///< of the Jacobian of measurements and priors
  int dof = 0;                                 ///< numbers + priors - rank
  double cost_before = 0.0, cost_after = 0.0;  ///< C(θ)
  double chi_squared = 0.0;                    ///< 2 C(θ) after
  double sigma0 =
      0.0;  ///< sqrt(chi²/dof): 1 when the standard deviations were right; 0 without dof
  bool sigma_assumed = false;  ///< deviations were not given; those of the parameters are scaled by
                               ///< sigma0 instead
  double scaled_condition = 0.0;  ///< of the determined part, columns of unit length
  /// Observability of the determined part, every number in units of its tolerance: O1 geometric
  /// mean of the singular values over sqrt(rows), O2 smallest over largest, O3 smallest, O4
  /// smallest squared over largest, O5 harmonic mean.
  std::array<double, 5> observability{};
  std::string verdict;              ///< what chi² says of the errors left, in words
  std::vector<std::string> frozen;  ///< kept at their start to settle unseen combinations
  double solver_ms = 0.0;           ///< the least-squares solver
  double total_ms = 0.0;            ///< with statistics, rank and covariance
  /// Predicted standard deviation of the tool point over the fitted rows, from the parameters'
  /// covariance: RMS and maximum of the length.
  double tool_sigma_rms_mm = 0.0, tool_sigma_max_mm = 0.0;
  Eigen::VectorXd theta_before, theta_after;    ///< all of the machine's parameters
  std::vector<int> free;                        ///< indices into them
  Eigen::MatrixXd covariance;                   ///< of the free ones; mm, rad
  std::vector<IdentifiedParameter> parameters;  ///< the free ones
  std::vector<CorrelatedPair> correlated;
  std::vector<GroupEffect> groups;
  std::vector<NullDirection> unidentifiable;
  std::vector<ErrorStatistics> statistics;
  std::vector<RowResidual> rows;
  LockedSuspects suspects;
  std::vector<int> rejected;  ///< numbers of the rows that stood out and were left out of the fit

  /// The parameters may be used.
  [[nodiscard]] bool ok() const {
    return status == IdentifyStatus::kConverged || status == IdentifyStatus::kRankDeficient;
  }
};

[[nodiscard]] CalibrationReport Identify(const kinematics::Machine& machine,
                                         const MeasurementSet& set,
                                         const IdentifyOptions& options = {});

/// Σ |r_k / σ_k|² over the rows not held out, rows without their own σ taking that of `options`;
/// not a number if a row has no pose.
[[nodiscard]] double WeightedSquares(const kinematics::Machine& machine,
                                     const MeasurementSet& set,
                                     const Eigen::VectorXd& theta,
                                     const IdentifyOptions& options = {});

/// What is wrong with the options themselves for this machine and these rows, such as patterns that
/// name no number (E0431 to E0435); nothing is solved.
[[nodiscard]] Diagnostics JudgeOptions(const kinematics::Machine& machine,
                                       const MeasurementSet& set,
                                       const IdentifyOptions& options);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_IDENTIFICATION_HPP_
