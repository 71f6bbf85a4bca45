// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/identification.hpp"

#include "identifiability.hpp"
#include "least_squares.hpp"
#include "residuals.hpp"
#include "selection.hpp"
#include "statistics.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Which rows are kept out of the fit: the file's choice and, of the others, a drawn fraction.
std::vector<bool> HeldOut(const MeasurementSet& set, const IdentifyOptions& options) {
  std::vector<bool> held_out;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < set.measurements.size(); ++i) {
    held_out.push_back(set.measurements[i].held_out);
    if (!held_out.back()) others.push_back(i);
  }
  const auto count = static_cast<std::size_t>(std::lround(
      std::clamp(options.held_out_fraction, 0.0, 1.0) * static_cast<double>(others.size())));
  std::mt19937_64 random(options.seed);
  for (std::size_t k = 0; k < count; ++k) {
    std::swap(others[k], others[k + random() % (others.size() - k)]);
    held_out[others[k]] = true;
  }
  return held_out;
}

/// One identification from the first complaint to the report.
class Identification {
 public:
  Identification(const kinematics::Machine& machine,
                 const MeasurementSet& set,
                 const IdentifyOptions& options)
      : machine_(machine), set_(set), options_(options) {}

  CalibrationReport Run() {
    const auto begin = std::chrono::steady_clock::now();
    if (Prepare() && FindStarts()) Fit();
    report_.total_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return std::move(report_);
  }

 private:
  bool Prepare() {
    Parsed<Selection> selection = SelectUnknowns(machine_, set_, options_);
    if (!selection) {
      report_.diagnostics = std::move(selection.error());
      return false;
    }
    selection_ = std::move(*selection);
    report_.free = selection_.free;
    report_.theta_before = options_.start.value_or(machine_.nominal());
    report_.theta_after = report_.theta_before;
    if (report_.theta_before.size() != selection_.nominal.size()) {
      return Refuse(codes::kBadStart.code,
                    fmt::format("the start has {} numbers, the machine {}",
                                report_.theta_before.size(),
                                selection_.nominal.size()));
    }
    const std::vector<bool> held_out = HeldOut(set_, options_);
    for (std::size_t i = 0; i < set_.measurements.size(); ++i) {
      const Measurement& m = set_.measurements[i];
      rows_.push_back({RowModel(machine_, m, options_.default_sigma_mm, options_.default_sigma_rad),
                       held_out[i],
                       {}});
      if (held_out[i]) continue;
      report_.numbers += m.Numbers();
      const bool turned = m.kind == MeasurementKind::kPose;
      report_.sigma_assumed |= !m.sigma_mm || (turned && !m.sigma_rad);
    }
    report_.sigma_assumed |= set_.relative_weights;
    for (JudgedRow& row : rows_) {
      if (!row.held_out) fitted_.push_back(&row.model);
    }
    report_.rows_fitted = static_cast<int>(fitted_.size());
    report_.rows_held_out = static_cast<int>(rows_.size() - fitted_.size());
    if (fitted_.empty()) return Refuse(codes::kNothingFitted.code, "no row is left for the fit");
    return true;
  }

  bool Refuse(std::string code, std::string message) {
    report_.diagnostics.push_back(
        {.code = std::move(code), .file = set_.file, .message = std::move(message)});
    return false;
  }

  /// Every row needs a pose before the solver starts; those that have none are named, all of them.
  bool FindStarts() {
    const RowModel* neighbour = nullptr;
    bool all = true;
    for (JudgedRow& row : rows_) {
      const Measurement& m = row.model.measurement();
      const RowModel::Prediction prediction = row.model.FindStart(report_.theta_before, neighbour);
      if (prediction.ok()) {
        row.before = row.model.Errors(prediction);
        neighbour = &row.model;
        continue;
      }
      all = false;
      report_.diagnostics.push_back(
          AboutRow(set_,
                   m,
                   Severity::kError,
                   codes::kNoPose.code,
                   fmt::format("row {}: the machine has no pose at these readings ({})",
                               m.row,
                               Name(prediction.status())),
                   "check the readings, their units and the layout's drive zeros"));
    }
    if (!all) report_.status = IdentifyStatus::kForwardFailed;
    return all;
  }

  void Fit() {
    Eigen::VectorXd u = selection_.Unknowns(report_.theta_before);
    const Eigen::MatrixXd no_gauge(selection_.size(), 0);
    struct Fit fit = SolveLeastSquares(fitted_, selection_, u, no_gauge, options_.max_iterations);
    report_.cost_before = fit.cost_before;
    Keep(fit);
    RankAnalysis analysis = Analyze(fit.u);
    if (analysis.gauge.cols() > 0 && fit.converged) {
      // The smallest change among all equally good ones: take the part along the null space out
      // and converge again with it held at zero.
      u = fit.u - analysis.gauge * (analysis.gauge.transpose() * fit.u);
      fit = SolveLeastSquares(fitted_, selection_, u, analysis.gauge, options_.max_iterations);
      Keep(fit);
      analysis = Analyze(fit.u);
    }
    report_.theta_after = selection_.Theta(fit.u.data());
    Judge(fit, analysis);
  }

  void Keep(const struct Fit& fit) {
    report_.iterations += fit.iterations;
    report_.solver_ms += fit.solver_ms;
    report_.cost_after = fit.cost_after;
    report_.solver_message = fit.message;
  }

  RankAnalysis Analyze(const Eigen::VectorXd& u) {
    const Eigen::VectorXd theta = selection_.Theta(u.data());
    Eigen::Index priors = 0;
    for (const auto& prior : selection_.prior) priors += prior ? 1 : 0;
    RowMajorMatrix J = RowMajorMatrix::Zero(report_.numbers + priors, selection_.size());
    Eigen::Index at = 0;
    for (const RowModel* row : fitted_) {
      const RowModel::Prediction prediction = row->Predict(theta, true);
      if (prediction.ok()) {
        row->Jacobian(prediction,
                      selection_.free,
                      selection_.scale,
                      J.block(at, 0, row->size(), selection_.size()));
      }
      at += row->size();
    }
    at_bound_.assign(selection_.free.size(), false);
    for (Eigen::Index i = 0; i < selection_.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (selection_.prior[k]) J(at++, i) = selection_.scale[i] / *selection_.prior[k];
      if (!selection_.bounds[k]) continue;
      const auto& [lower, upper] = *selection_.bounds[k];
      const double value = theta[selection_.free[k]];
      const double close = 1e-9 * (upper - lower);
      at_bound_[k] = value <= lower + close || value >= upper - close;
    }
    report_.dof = static_cast<int>(J.rows());
    RankAnalysis analysis = AnalyzeRank(J, at_bound_, options_.rank_threshold);
    report_.rank = static_cast<int>(analysis.rank);
    report_.dof -= report_.rank;
    report_.scaled_condition = analysis.condition;
    return analysis;
  }

  void Judge(const struct Fit& fit, const RankAnalysis& analysis) {
    report_.chi_squared = 2.0 * report_.cost_after;
    report_.sigma0 = report_.dof > 0 ? std::sqrt(report_.chi_squared / report_.dof) : 0.0;
    report_.status =
        analysis.gauge.cols() > 0 ? IdentifyStatus::kRankDeficient : IdentifyStatus::kConverged;
    report_.unidentifiable =
        DescribeNullSpace(analysis, machine_, selection_, fitted_, report_.theta_after);
    JudgeParameters(machine_, selection_, analysis, at_bound_, options_, rows_, &report_);
    JudgeRows(set_, rows_, report_.theta_after, &report_);
    if (report_.status == IdentifyStatus::kForwardFailed) return;
    if (!fit.converged) {
      report_.status = IdentifyStatus::kIterationLimit;
      Refuse(codes::kNotConverged.code,
             fmt::format("the solver did not converge in {} iterations", report_.iterations));
      report_.diagnostics.back().help =
          "allow more iterations, lock parameters, or give a layout nearer to the machine";
    } else if (report_.dof <= 0 && analysis.gauge.cols() > 0) {
      report_.status = IdentifyStatus::kTooFewMeasurements;
      Refuse(codes::kTooFew.code,
             fmt::format("{} measured numbers cannot determine {} parameters",
                         report_.numbers,
                         selection_.size()));
      report_.diagnostics.back().help =
          "measure more, lock parameters, or give them prior deviations";
    }
    if (report_.ok()) WarnOfDoubts(set_, selection_, &report_);
  }

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  const IdentifyOptions& options_;
  Selection selection_;
  std::vector<JudgedRow> rows_;
  std::vector<RowModel*> fitted_;
  std::vector<bool> at_bound_;
  CalibrationReport report_;
};

}  // namespace

std::string_view Name(IdentifyStatus status) {
  switch (status) {
    case IdentifyStatus::kConverged:
      return "converged";
    case IdentifyStatus::kRankDeficient:
      return "rank_deficient";
    case IdentifyStatus::kIterationLimit:
      return "iteration_limit";
    case IdentifyStatus::kTooFewMeasurements:
      return "too_few_measurements";
    case IdentifyStatus::kForwardFailed:
      return "forward_failed";
    case IdentifyStatus::kBadInput:
      break;
  }
  return "bad_input";
}

CalibrationReport Identify(const kinematics::Machine& machine,
                           const MeasurementSet& set,
                           const IdentifyOptions& options) {
  return Identification(machine, set, options).Run();
}

double WeightedSquares(const kinematics::Machine& machine,
                       const MeasurementSet& set,
                       const Eigen::VectorXd& theta,
                       const IdentifyOptions& options) {
  double sum = 0.0;
  for (const Measurement& measurement : set.measurements) {
    if (measurement.held_out) continue;
    RowModel row(machine, measurement, options.default_sigma_mm, options.default_sigma_rad);
    const RowModel::Prediction prediction = row.FindStart(theta, nullptr);
    if (!prediction.ok()) return std::numeric_limits<double>::quiet_NaN();
    sum += row.Whitened(prediction).value.squaredNorm();
  }
  return sum;
}

}  // namespace kompono::calibration
