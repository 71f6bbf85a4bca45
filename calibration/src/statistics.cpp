// SPDX-License-Identifier: Apache-2.0
#include "statistics.hpp"

#include "distributions.hpp"
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
/// Normal deviates larger than this happen once in 3.5 million.
constexpr double kSurelyWrongSigmas = 5.0;
constexpr double kFarFromNominalTolerances = 20.0;
using Groups = std::vector<std::pair<std::string, std::vector<Eigen::Index>>>;

constexpr std::size_t kMostToolRows = 200;  ///< enough for a root mean square

struct Sums {
  int count = 0;
  double before = 0.0, after = 0.0;
  double max_before = 0.0, max_after = 0.0;
  void Add(double error_before, double error_after) {
    ++count;
    before += error_before * error_before;
    after += error_after * error_after;
    max_before = std::max(max_before, error_before);
    max_after = std::max(max_after, error_after);
  }
};

std::string_view LengthQuantity(MeasurementKind kind) {
  return HasRotation(kind) ? "position" : Name(kind);
}

void AddStatistics(const std::map<std::pair<bool, std::string>, Sums>& sums,
                   CalibrationReport* report) {
  for (const auto& [key, sum] : sums) {
    report->statistics.push_back({.quantity = key.second,
                                  .angle = key.second == "orientation",
                                  .held_out = key.first,
                                  .count = sum.count,
                                  .rms_before = std::sqrt(sum.before / sum.count),
                                  .rms_after = std::sqrt(sum.after / sum.count),
                                  .max_before = sum.max_before,
                                  .max_after = sum.max_after});
  }
}

/// Median of the absolute values, as a standard deviation.
double RobustSigma(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return 1.4826 * *middle;
}

Diagnostic Warning(const MeasurementSet& set,
                   std::string code,
                   std::string message,
                   std::string help = "") {
  return {.severity = Severity::kWarning,
          .code = std::move(code),
          .file = set.file,
          .message = std::move(message),
          .help = std::move(help)};
}

/// What freeing further numbers would do about the errors left.
std::string WordsOf(const LockedSuspects& suspects) {
  if (suspects.names.empty()) {
    return "no locked number of the machine explains them alone: look at the rows with the largest "
           "residuals, or give larger deviations";
  }
  return fmt::format(
      "freeing {} too would explain {:.0f} % of their squares, all numbers of the "
      "machine {:.0f} %; else look at the rows with the largest residuals, or give "
      "larger deviations",
      fmt::join(suspects.names, ", "),
      100.0 * suspects.share,
      100.0 * suspects.share_of_all);
}

void WarnOfContradiction(const MeasurementSet& set, CalibrationReport* report) {
  if (!Contradicts(*report)) return;
  const double ratio = report->chi_squared / report->dof;
  report->diagnostics.push_back(
      Warning(set,
              codes::kContradiction.code,
              fmt::format("the errors left are {:.3g} times what the given deviations allow: the "
                          "measurements contradict each other or this model of the machine",
                          std::sqrt(ratio)),
              WordsOf(report->suspects)));
}

/// Rows that stand out of the others, judged by a scale that they do not influence.
void WarnOfOutliers(const MeasurementSet& set, CalibrationReport* report) {
  std::vector<double> sigmas;
  for (const RowResidual& row : report->rows) {
    if (!row.held_out && !row.rejected) sigmas.push_back(row.after_sigmas);
  }
  const double scale = std::max(RobustSigma(sigmas), 1e-9);
  if (report->dof < 3) return;
  for (std::size_t i = 0; i < report->rows.size(); ++i) {
    const RowResidual& row = report->rows[i];
    if (row.held_out || row.rejected) continue;
    if (row.after_sigmas < kSurelyWrongSigmas * scale) continue;
    if (row.after_sigmas < 1e-3) continue;  // rounding of noise-free data
    report->diagnostics.push_back(AboutRow(set,
                                           set.measurements[i],
                                           Severity::kWarning,
                                           codes::kOutlier.code,
                                           fmt::format("row {} is off by {:.3g} times the usual "
                                                       "error of the rows ({:.4g} mm)",
                                                       row.row,
                                                       row.after_sigmas / scale,
                                                       row.after_mm),
                                           "measure it again or leave it out"));
  }
}

void TellRejected(const MeasurementSet& set, CalibrationReport* report) {
  for (std::size_t i = 0; i < report->rows.size(); ++i) {
    const RowResidual& row = report->rows[i];
    if (!row.rejected) continue;
    report->diagnostics.push_back(
        AboutRow(set,
                 set.measurements[i],
                 Severity::kWarning,
                 codes::kRejected.code,
                 fmt::format("row {} was left out of the fit: it is off by {:.3g} times its "
                             "deviation ({:.4g} mm)",
                             row.row,
                             row.after_sigmas,
                             row.after_mm),
                 "measure it again, or keep all rows with --outliers keep"));
  }
}

void WarnOfParameters(const MeasurementSet& set, CalibrationReport* report) {
  for (const IdentifiedParameter& parameter : report->parameters) {
    if (parameter.at_bound) {
      report->diagnostics.push_back(
          Warning(set, codes::kAtBound.code, fmt::format("{} ended at its bound", parameter.name)));
    }
    const double most = kFarFromNominalTolerances * parameter.tolerance;
    if (parameter.tolerance > 0.0 && std::abs(parameter.change()) > most) {
      const double factor = parameter.angle ? kDegPerRad : 1.0;
      report->diagnostics.push_back(
          Warning(set,
                  codes::kFarFromNominal.code,
                  fmt::format("{} changed by {:+.4g} {}, {:.0f} times its manufacturing tolerance",
                              parameter.name,
                              parameter.change() * factor,
                              parameter.angle ? "deg" : "mm",
                              std::abs(parameter.change()) / parameter.tolerance),
                  "check the layout's number and the measurements for a slip"));
    }
  }
}

void WarnOfHeldOut(const MeasurementSet& set, CalibrationReport* report) {
  for (const ErrorStatistics& held_out : report->statistics) {
    if (!held_out.held_out || held_out.count < 3) continue;
    if (held_out.rms_after > held_out.rms_before) {
      report->diagnostics.push_back(Warning(
          set,
          codes::kHeldOutWorse.code,
          fmt::format("the held-out rows became worse: {} RMS {:.4g} before, {:.4g} {} after",
                      held_out.quantity,
                      held_out.rms_before,
                      held_out.rms_after,
                      held_out.angle ? "rad" : "mm"),
          "free fewer parameters or measure more"));
    }
  }
}

/// Free numbers of the machine by what stands before the first dot of their names.
Groups GroupsOf(const CalibrationReport& report, Eigen::Index own) {
  Groups groups;
  for (Eigen::Index i = 0; i < own; ++i) {
    const std::string& name = report.parameters[static_cast<std::size_t>(i)].name;
    const std::string group = name.substr(0, name.find('.'));
    const auto found = std::find_if(
        groups.begin(), groups.end(), [&group](const auto& g) { return g.first == group; });
    if (found == groups.end()) {
      groups.push_back({group, {i}});
    } else {
      found->second.push_back(i);
    }
  }
  return groups;
}

}  // namespace

bool Contradicts(const CalibrationReport& report) {
  return report.dof > 0 && !report.sigma_assumed &&
         report.chi_squared >= ChiSquaredUpper(1e-3, report.dof);
}

Diagnostic AboutRow(const MeasurementSet& set,
                    const Measurement& measurement,
                    Severity severity,
                    std::string code,
                    std::string message,
                    std::string help) {
  Diagnostic diagnostic{.severity = severity,
                        .code = std::move(code),
                        .file = set.file,
                        .message = std::move(message),
                        .help = std::move(help)};
  if (measurement.line > 0) {
    diagnostic.span = SpanAt(set.text, measurement.line, 1, 1);
    diagnostic.span.length = std::max<int>(1, static_cast<int>(diagnostic.span.line_text.size()));
  }
  return diagnostic;
}

void JudgeRows(const MeasurementSet& set,
               const std::vector<JudgedRow>& rows,
               const Eigen::VectorXd& theta,
               PoseRows* poses,
               CalibrationReport* report) {
  std::map<std::pair<bool, std::string>, Sums> sums;
  const std::vector<PoseRows::Judged> judged = poses->Judge(theta);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Measurement& measurement = set.measurements[k];
    const JudgedRow& row = rows[k];
    if (!judged[k].ok) {
      report->status = IdentifyStatus::kForwardFailed;
      report->diagnostics.push_back(AboutRow(
          set,
          measurement,
          Severity::kError,
          codes::kNoPose.code,
          fmt::format("row {}: with the identified geometry the machine has no pose at these "
                      "readings",
                      measurement.row),
          "check the readings of the row"));
      continue;
    }
    const RowErrors& after = judged[k].errors;
    RowResidual residual{.row = measurement.row,
                         .line = measurement.line,
                         .kind = measurement.kind,
                         .held_out = row.held_out,
                         .rejected = row.rejected,
                         .before_mm = row.before.LengthNorm(),
                         .after_mm = after.LengthNorm()};
    residual.after_sigmas =
        std::sqrt(judged[k].whitened_square / static_cast<double>(measurement.Numbers()));
    if (HasRotation(measurement.kind)) {
      residual.before_rad = row.before.AngleNorm();
      residual.after_rad = after.AngleNorm();
    }
    report->rows.push_back(residual);
    if (row.rejected) continue;
    sums[{row.held_out, std::string(LengthQuantity(measurement.kind))}].Add(residual.before_mm,
                                                                            residual.after_mm);
    if (HasRotation(measurement.kind)) {
      sums[{row.held_out, "orientation"}].Add(residual.before_rad, residual.after_rad);
    }
  }
  AddStatistics(sums, report);
}

/// What chance says of the errors left.
std::string Verdict(const CalibrationReport& report) {
  if (report.dof <= 0) return "no number is left to judge the fit by";
  if (report.sigma_assumed) {
    return "no deviations were given, so that the errors left cannot be judged, only compared";
  }
  const double tail = ChiSquaredTail(report.chi_squared, report.dof);
  const std::string figures =
      fmt::format("chi2 {:.4g} for {} degrees of freedom, probability {:.2g}",
                  report.chi_squared,
                  report.dof,
                  tail);
  if (tail < 1e-3) return "the errors left are larger than the deviations allow: " + figures;
  if (tail > 0.999) {
    return "the errors left are smaller than the deviations say, which are too large: " + figures;
  }
  return "the errors left are what the deviations allow: " + figures;
}

void JudgeTool(const std::vector<std::size_t>& fitted,
               const Eigen::VectorXd& theta,
               PoseRows* poses,
               CalibrationReport* report) {
  double sum = 0.0;
  int count = 0;
  const std::size_t stride = fitted.size() / kMostToolRows + 1;
  // Fixtures, whose numbers stand last, do not move the tool.
  const auto own = static_cast<Eigen::Index>(
      std::count_if(report->free.begin(), report->free.end(), [report](int index) {
        return index < report->theta_after.size();
      }));
  const Eigen::MatrixXd covariance = report->covariance.topLeftCorner(own, own);
  Eigen::Matrix<double, 6, Eigen::Dynamic> twists(6, own);
  const Groups groups = GroupsOf(*report, own);
  std::vector<GroupEffect> effects(groups.size());
  for (std::size_t i = 0; i < fitted.size(); i += stride) {
    if (!poses->ToolByParameters(theta, fitted[i], &twists)) continue;
    const Eigen::MatrixXd J = twists.topRows<3>();
    const double square = (J * covariance).cwiseProduct(J).sum();
    sum += square;
    report->tool_sigma_max_mm = std::max(report->tool_sigma_max_mm, std::sqrt(square));
    ++count;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::vector<Eigen::Index>& members = groups[g].second;
      const Eigen::MatrixXd part = J(Eigen::all, members);
      Eigen::VectorXd change(static_cast<Eigen::Index>(members.size()));
      for (std::size_t k = 0; k < members.size(); ++k) {
        change[static_cast<Eigen::Index>(k)] =
            report->parameters[static_cast<std::size_t>(members[k])].change();
      }
      effects[g].change_mm += (part * change).squaredNorm();
      effects[g].sigma_mm += (part * covariance(members, members)).cwiseProduct(part).sum();
    }
  }
  if (count == 0) return;
  report->tool_sigma_rms_mm = std::sqrt(sum / count);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    report->groups.push_back({.group = groups[g].first,
                              .change_mm = std::sqrt(effects[g].change_mm / count),
                              .sigma_mm = std::sqrt(effects[g].sigma_mm / count)});
  }
}

void JudgeParameters(const Selection& selection,
                     const Eigen::VectorXd& theta_before,
                     const Eigen::VectorXd& theta_after,
                     const RankAnalysis& analysis,
                     const std::vector<bool>& at_bound,
                     const IdentifyOptions& options,
                     CalibrationReport* report) {
  const double variance = report->sigma_assumed ? report->sigma0 * report->sigma0 : 1.0;
  report->covariance = variance * (selection.scale.asDiagonal() * analysis.covariance *
                                   selection.scale.asDiagonal());
  for (Eigen::Index i = 0; i < selection.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const kinematics::Parameter& parameter =
        selection.parameters[static_cast<std::size_t>(selection.free[k])];
    IdentifiedParameter identified{.name = parameter.name,
                                   .angle = parameter.angle,
                                   .before = theta_before[selection.free[k]],
                                   .after = theta_after[selection.free[k]],
                                   .tolerance = parameter.tolerance,
                                   .at_bound = at_bound[k]};
    identified.determined = analysis.null_unit.row(i).norm() < 1e-6;
    const bool scaled_without_dof = report->sigma_assumed && report->dof <= 0;
    if (identified.determined && !at_bound[k] && !scaled_without_dof) {
      identified.sigma = std::sqrt(report->covariance(i, i));
    }
    report->parameters.push_back(identified);
  }
  for (Eigen::Index i = 0; i < selection.size(); ++i) {
    for (Eigen::Index j = i + 1; j < selection.size(); ++j) {
      const IdentifiedParameter& first = report->parameters[static_cast<std::size_t>(i)];
      const IdentifiedParameter& second = report->parameters[static_cast<std::size_t>(j)];
      if (!first.sigma || !second.sigma) continue;
      const double correlation = report->covariance(i, j) / (*first.sigma * *second.sigma);
      if (std::abs(correlation) > options.correlation_threshold) {
        report->correlated.push_back({first.name, second.name, correlation});
      }
    }
  }
}

void WarnOfArms(const MeasurementSet& set, CalibrationReport* report) {
  const bool heights_only =
      std::all_of(set.measurements.begin(), set.measurements.end(), [](const Measurement& m) {
        return m.kind == MeasurementKind::kHeight;
      });
  for (const IdentifiedParameter& parameter : report->parameters) {
    if (!heights_only || parameter.name.find(".strut") == std::string::npos) continue;
    report->diagnostics.push_back(
        Warning(set,
                codes::kArmsOnHeights.code,
                fmt::format("{} and the other struts are fitted to heights alone: the heights then "
                            "fit better and the machine is known worse, for sizes in X and Y are "
                            "hardly seen",
                            parameter.name),
                "lock the struts, or measure distances too; compare held-out errors with --folds"));
    break;
  }
}

void WarnOfDoubts(const MeasurementSet& set,
                  const Selection& selection,
                  CalibrationReport* report) {
  for (const NullDirection& direction : report->unidentifiable) {
    report->diagnostics.push_back(
        Warning(set, codes::kNotDetermined.code, direction.words, direction.remedy));
  }
  if (report->dof == 0) {
    report->diagnostics.push_back(
        Warning(set,
                codes::kExactFit.code,
                fmt::format("{} numbers for {} unknowns: the fit is exact whatever was measured, "
                            "and its errors say nothing",
                            report->numbers,
                            selection.size()),
                "measure more"));
  }
  WarnOfContradiction(set, report);
  TellRejected(set, report);
  WarnOfOutliers(set, report);
  WarnOfParameters(set, report);
  WarnOfHeldOut(set, report);
}

}  // namespace kompono::calibration
