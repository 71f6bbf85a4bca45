// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_STATISTICS_HPP_
#define KOMPONO_CALIBRATION_SRC_STATISTICS_HPP_

#include "identifiability.hpp"
#include "pose_rows.hpp"
#include "residuals.hpp"
#include "selection.hpp"

#include <vector>

#include "kompono/calibration/identification.hpp"

namespace kompono::calibration {

/// What is known of a row besides its measurement.
struct JudgedRow {
  bool held_out = false;
  bool rejected = false;
  RowErrors before;
};

/// Errors of every row at `theta`, into the report's rows and tables. A row without a pose becomes
/// a complaint and the status kForwardFailed.
void JudgeRows(const MeasurementSet& set,
               const std::vector<JudgedRow>& rows,
               const Eigen::VectorXd& theta,
               PoseRows* poses,
               CalibrationReport* report);

/// Parameters with deviations, bounds and correlations; the tool's predicted deviation.
void JudgeParameters(const Selection& selection,
                     const Eigen::VectorXd& theta_before,
                     const Eigen::VectorXd& theta_after,
                     const RankAnalysis& analysis,
                     const std::vector<bool>& at_bound,
                     const IdentifyOptions& options,
                     CalibrationReport* report);

/// The tool's predicted deviation over some of the rows in `fitted`.
void JudgeTool(const std::vector<std::size_t>& fitted,
               const Eigen::VectorXd& theta,
               PoseRows* poses,
               CalibrationReport* report);

/// What chance says of the errors left, in words.
[[nodiscard]] std::string Verdict(const CalibrationReport& report);

/// The errors left are larger than the given deviations allow (0.1 %).
[[nodiscard]] bool Contradicts(const CalibrationReport& report);

/// Fitting struts to heights alone is warned of, also where it fails.
void WarnOfArms(const MeasurementSet& set, CalibrationReport* report);

/// Warnings about a result that can be used but should be looked at.
void WarnOfDoubts(const MeasurementSet& set, const Selection& selection, CalibrationReport* report);

/// A complaint about one row, with the row's line under it if the set has its text.
[[nodiscard]] Diagnostic AboutRow(const MeasurementSet& set,
                                  const Measurement& measurement,
                                  Severity severity,
                                  std::string code,
                                  std::string message,
                                  std::string help);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_STATISTICS_HPP_
