// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/identification.hpp"

#include "identifiability.hpp"
#include "least_squares.hpp"
#include "locked_suspects.hpp"
#include "pose_rows.hpp"
#include "residuals.hpp"
#include "robust.hpp"
#include "selection.hpp"
#include "statistics.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr std::size_t kCoarseRows = 1500;  ///< that come before a fit of many more
constexpr std::size_t kRankRows = 3000;
constexpr std::size_t kWordRows = 200;
constexpr std::size_t kSuspectRows = 500;
constexpr int kGaugePasses = 3;    ///< until what is held is what cannot be seen
constexpr double kRegular = 1e-9;  ///< pivots of equations with columns of unit length

/// Covariance of the unknowns that are not held, for a regular H.
Eigen::MatrixXd InverseOf(const Eigen::MatrixXd& H, const std::vector<bool>& held) {
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < H.rows(); ++i) {
    if (!held[static_cast<std::size_t>(i)]) active.push_back(i);
  }
  const Eigen::MatrixXd of_active = H(active, active);
  const Eigen::VectorXd norm = of_active.diagonal().cwiseSqrt().cwiseInverse();
  const auto n = static_cast<Eigen::Index>(active.size());
  const Eigen::MatrixXd unit = norm.asDiagonal() * of_active * norm.asDiagonal();
  const Eigen::MatrixXd inverse =
      norm.asDiagonal() * unit.ldlt().solve(Eigen::MatrixXd::Identity(n, n)) * norm.asDiagonal();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(H.rows(), H.cols());
  out(active, active) = inverse;
  return out;
}

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
    if (options_.gauge == Gauge::kPrior) {
      for (std::size_t i = 0; i < selection_.prior.size(); ++i) {
        const auto index = static_cast<std::size_t>(selection_.free[i]);
        const double tolerance = selection_.parameters[index].tolerance;
        if (!selection_.prior[i] && tolerance > 0.0) selection_.prior[i] = tolerance;
      }
    }
    report_.free = selection_.free;
    report_.theta_before = options_.start.value_or(machine_.nominal());
    report_.theta_after = report_.theta_before;
    theta_before_ = selection_.nominal;
    if (report_.theta_before.size() == machine_.nominal().size()) {
      theta_before_.head(report_.theta_before.size()) = report_.theta_before;
    } else {
      return Refuse(codes::kBadStart.code,
                    fmt::format("the start has {} numbers, the machine {}",
                                report_.theta_before.size(),
                                machine_.parameters().size()));
    }
    const std::vector<bool> held_out = HeldOut(set_, options_);
    rows_.resize(set_.measurements.size());
    for (std::size_t i = 0; i < set_.measurements.size(); ++i) {
      const Measurement& m = set_.measurements[i];
      rows_[i].held_out = held_out[i];
      if (held_out[i]) continue;
      fitted_.push_back(i);
      report_.numbers += m.Numbers();
      const bool turned = HasRotation(m.kind);
      report_.sigma_assumed |= !m.sigma_mm || (turned && !m.sigma_rad);
    }
    report_.sigma_assumed |= set_.relative_weights;
    report_.rows_fitted = static_cast<int>(fitted_.size());
    report_.rows_held_out = static_cast<int>(rows_.size() - fitted_.size());
    if (fitted_.empty()) return Refuse(codes::kNothingFitted.code, "no row is left for the fit");
    poses_ = std::make_unique<PoseRows>(machine_, set_, selection_.free, Noise());
    return true;
  }

  [[nodiscard]] RowNoise Noise() const {
    return {.default_sigma_mm = options_.default_sigma_mm,
            .default_sigma_rad = options_.default_sigma_rad,
            .drive_sigma_mm = options_.drive_sigma_mm,
            .drive_sigma_rad = options_.drive_sigma_rad};
  }

  bool Refuse(std::string code, std::string message) {
    report_.diagnostics.push_back(
        {.code = std::move(code), .file = set_.file, .message = std::move(message)});
    return false;
  }

  /// Every row needs a pose before the solver starts; those that have none are named, all of them.
  bool FindStarts() {
    const std::vector<kinematics::SolveStatus> status = poses_->Start(theta_before_);
    const std::vector<PoseRows::Judged> before = poses_->Judge(theta_before_);
    bool all = true;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (status[k] == kinematics::SolveStatus::kConverged && before[k].ok) {
        rows_[k].before = before[k].errors;
        continue;
      }
      all = false;
      const Measurement& m = set_.measurements[k];
      report_.diagnostics.push_back(AboutRow(
          set_,
          m,
          Severity::kError,
          codes::kNoPose.code,
          fmt::format(
              "row {}: the machine has no pose at these readings ({})", m.row, Name(status[k])),
          "check the readings, their units and the layout's drive zeros"));
    }
    if (!all) report_.status = IdentifyStatus::kForwardFailed;
    return all;
  }

  [[nodiscard]] bool Rejects() const {
    if (options_.outliers == Outliers::kAutomatic) return !set_.relative_weights;
    return options_.outliers == Outliers::kReject;
  }

  void Fit() {
    Eigen::VectorXd u = selection_.Unknowns(theta_before_);
    LeastSquares problem{.rows = poses_.get(),
                         .selection = &selection_,
                         .chosen = Some(kCoarseRows),
                         .weights = {},
                         .gauge = GaugeAtStart(u),
                         .max_iterations = options_.max_iterations};
    bool near = false;
    if (problem.chosen.size() < fitted_.size()) {
      // Some of the rows lead almost to the end; the others then need one pass or two.
      const RobustFit coarse = FitOf(problem, u, false);
      near = coarse.fit.converged && !coarse.too_many;
      if (coarse.fit.converged) u = coarse.fit.u;
      Keep(coarse.fit);
    }
    problem.chosen = fitted_;
    RobustFit robust = FitOf(problem, u, near);
    if (robust.too_many) WarnOfTooMany();
    for (const std::size_t k : robust.rejected) rows_[k].rejected = true;
    std::erase_if(fitted_, [this](std::size_t k) { return rows_[k].rejected; });
    for (const std::size_t k : robust.rejected) {
      report_.rejected.push_back(set_.measurements[k].row);
      report_.numbers -= set_.measurements[k].Numbers();
    }
    report_.rows_fitted = static_cast<int>(fitted_.size());
    struct Fit fit = std::move(robust.fit);
    report_.cost_before = CostOf(rows_);
    Keep(fit);
    RankAnalysis analysis = Analyze(fit);
    problem.chosen = fitted_;
    for (int pass = 0; pass < kGaugePasses && fit.converged; ++pass) {
      const Eigen::Index held = problem.gauge.cols();
      const bool settled =
          pass == 0 ? analysis.gauge.cols() + held == 0 : analysis.gauge.cols() == held;
      if (settled) break;
      Settle(analysis, &problem, &fit);
      Keep(fit);
      analysis = Analyze(fit);
    }
    theta_ = selection_.Theta(fit.u.data());
    report_.theta_after = theta_.head(report_.theta_before.size());
    Judge(fit, analysis);
  }

  /// What the measurements cannot see at the start is held from the first step on: the equations
  /// know nothing of it but rounding, and would follow that far away. Empty if they are regular.
  Eigen::MatrixXd GaugeAtStart(const Eigen::VectorXd& u) {
    Eigen::MatrixXd none(selection_.size(), 0);
    const NormalEquations at =
        poses_->Assemble(selection_.Theta(u.data()), Some(kCoarseRows), {}, true);
    if (!at.ok) return none;
    const Eigen::MatrixXd full = at.H.selfadjointView<Eigen::Upper>();
    const Eigen::VectorXd norm = full.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(norm.asDiagonal() * full * norm.asDiagonal());
    if (ldlt.vectorD().minCoeff() > kRegular) return none;
    struct Fit start;
    start.u = u;
    start.cost_after = at.cost;
    start.H = selection_.scale.asDiagonal() * full * selection_.scale.asDiagonal();
    return Analyze(start).gauge;
  }

  /// Converges again with the unseen combinations settled at this solution.
  void Settle(const RankAnalysis& analysis, LeastSquares* problem, struct Fit* fit) {
    Eigen::VectorXd u = fit->u;
    if (options_.gauge == Gauge::kFreeze && analysis.gauge.cols() > 0) {
      u = Freeze(fit->u, analysis, problem);
    } else {
      // The smallest change among all equally good ones: take the part along the null space out
      // and converge again with it held at zero.
      u -= analysis.gauge * (analysis.gauge.transpose() * fit->u);
      problem->gauge = analysis.gauge;
    }
    *fit = SolveLeastSquares(*problem, u);
  }

  /// Chooses one number of every unseen combination to stay at its start; returns the equally good
  /// point at which they do.
  Eigen::VectorXd Freeze(const Eigen::VectorXd& u,
                         const RankAnalysis& analysis,
                         LeastSquares* problem) {
    const Eigen::MatrixXd& N = analysis.gauge;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> pivots(N.transpose());
    std::vector<Eigen::Index> rows;
    report_.frozen.clear();
    problem->gauge = Eigen::MatrixXd::Zero(N.rows(), N.cols());
    for (Eigen::Index k = 0; k < N.cols(); ++k) {
      rows.push_back(pivots.colsPermutation().indices()[k]);
      problem->gauge(rows.back(), k) = 1.0;
      report_.frozen.push_back(selection_
                                   .parameters[static_cast<std::size_t>(
                                       selection_.free[static_cast<std::size_t>(rows.back())])]
                                   .name);
    }
    return u -
           N * Eigen::MatrixXd(N(rows, Eigen::all)).partialPivLu().solve(Eigen::VectorXd(u(rows)));
  }

  /// O1 to O5 of the determined part.
  void Observe(const Eigen::MatrixXd& H) {
    if (H.size() == 0) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(H, Eigen::EigenvaluesOnly);
    const Eigen::VectorXd values = eigen.eigenvalues().tail(report_.rank).cwiseMax(0.0).cwiseSqrt();
    if (values.size() == 0 || values[0] <= 0.0) return;
    const double largest = values[values.size() - 1];
    const auto rows = static_cast<double>(std::max(1, report_.rows_fitted));
    report_.observability = {std::exp(values.array().log().mean()) / std::sqrt(rows),
                             values[0] / largest,
                             values[0],
                             values[0] * values[0] / largest,
                             1.0 / values.cwiseInverse().sum()};
  }

  RobustFit FitOf(const LeastSquares& problem, const Eigen::VectorXd& u, bool near) {
    if (Rejects()) return SolveRobustly(problem, u, !report_.sigma_assumed, near);
    return {.fit = SolveLeastSquares(problem, u), .rejected = {}};
  }

  /// At most `most` of the fitted rows, evenly spread.
  [[nodiscard]] std::vector<std::size_t> Some(std::size_t most) const {
    const std::size_t stride = (fitted_.size() + most - 1) / most;
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < fitted_.size(); i += stride) some.push_back(fitted_[i]);
    return some;
  }

  void WarnOfTooMany() {
    report_.diagnostics.push_back(
        {.severity = Severity::kWarning,
         .code = codes::kTooManyOutliers.code,
         .file = set_.file,
         .message = "more than a third of the rows stand out, so that none was left out",
         .help = "check units and columns of the file, or give larger deviations"});
  }

  void Keep(const struct Fit& fit) {
    report_.iterations += fit.iterations;
    report_.solver_ms += fit.solver_ms;
    report_.cost_after = fit.cost_after;
    report_.solver_message = fit.message;
  }

  /// Rank and null space from exact derivatives: of all rows, or of so many that full rank on them
  /// is full rank on all; the covariance is of all.
  RankAnalysis Analyze(const struct Fit& fit) {
    const Eigen::VectorXd theta = selection_.Theta(fit.u.data());
    at_bound_.assign(selection_.free.size(), false);
    Eigen::Index priors = 0;
    for (Eigen::Index i = 0; i < selection_.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (selection_.prior[k]) ++priors;
      if (!selection_.bounds[k]) continue;
      const auto& [lower, upper] = *selection_.bounds[k];
      const double value = theta[selection_.free[k]];
      const double close = 1e-9 * (upper - lower);
      at_bound_[k] = value <= lower + close || value >= upper - close;
    }
    const auto analyze = [&](const std::vector<std::size_t>& rows) {
      const Eigen::MatrixXd triangle = poses_->Triangle(theta, rows, {}, selection_.scale);
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(triangle.rows() + priors, selection_.size());
      J.topRows(triangle.rows()) = triangle;
      Eigen::Index at = triangle.rows();
      for (Eigen::Index i = 0; i < selection_.size(); ++i) {
        const std::optional<double>& prior = selection_.prior[static_cast<std::size_t>(i)];
        if (prior) J(at++, i) = selection_.scale[i] / *prior;
      }
      return AnalyzeRank(J, at_bound_, options_.rank_threshold, Weakest(fit));
    };
    const std::vector<std::size_t> some = Some(kRankRows);
    RankAnalysis analysis = analyze(some);
    if (some.size() < fitted_.size()) {
      if (analysis.gauge.cols() > 0) {
        analysis = analyze(fitted_);
      } else {
        analysis.covariance = InverseOf(fit.H, at_bound_);
      }
    }
    report_.rank = static_cast<int>(analysis.rank);
    report_.dof = report_.numbers + static_cast<int>(priors) - report_.rank;
    report_.scaled_condition = analysis.condition;
    return analysis;
  }

  /// Largest deviation in u with which a combination is followed. Weights of rows without given
  /// deviations are measured by the errors left.
  [[nodiscard]] double Weakest(const struct Fit& fit) const {
    if (options_.weak_tolerances <= 0.0) return std::numeric_limits<double>::infinity();
    if (!report_.sigma_assumed) return options_.weak_tolerances;
    const auto spare =
        static_cast<double>(std::max<Eigen::Index>(1, report_.numbers - selection_.size()));
    return options_.weak_tolerances / std::max(1e-30, std::sqrt(2.0 * fit.cost_after / spare));
  }

  void Judge(const struct Fit& fit, const RankAnalysis& analysis) {
    report_.chi_squared = 2.0 * report_.cost_after;
    report_.sigma0 = report_.dof > 0 ? std::sqrt(report_.chi_squared / report_.dof) : 0.0;
    report_.verdict = Verdict(report_);
    Observe(fit.H);
    report_.status =
        analysis.gauge.cols() > 0 ? IdentifyStatus::kRankDeficient : IdentifyStatus::kConverged;
    report_.unidentifiable =
        DescribeNullSpace(analysis, machine_, selection_, Models(analysis), theta_);
    JudgeParameters(selection_, theta_before_, theta_, analysis, at_bound_, options_, &report_);
    JudgeTool(fitted_, theta_, poses_.get(), &report_);
    JudgeRows(set_, rows_, theta_, poses_.get(), &report_);
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
    WarnOfArms(set_, &report_);
    if (report_.ok() && Contradicts(report_)) {
      report_.suspects =
          SuspectLocked(machine_, set_, Some(kSuspectRows), selection_, theta_, Noise());
    }
    if (report_.ok()) WarnOfDoubts(set_, selection_, &report_);
  }

  /// Rows for the words about the null space, if there is one.
  std::vector<RowModel*> Models(const RankAnalysis& analysis) {
    std::vector<RowModel*> pointers;
    if (analysis.gauge.cols() == 0) return pointers;
    models_.clear();
    for (const std::size_t k : Some(kWordRows)) {
      models_.emplace_back(
          machine_, set_.measurements[k], options_.default_sigma_mm, options_.default_sigma_rad);
      models_.back().StartAt(poses_->coordinates(k), poses_->second_coordinates(k));
    }
    for (RowModel& model : models_) pointers.push_back(&model);
    return pointers;
  }

  /// C of the fitted rows at the start; the priors are 0 there or nearly so.
  [[nodiscard]] double CostOf(const std::vector<JudgedRow>& rows) const {
    double cost = 0.0;
    for (const std::size_t k : fitted_) {
      const RowErrors& errors = rows[k].before;
      const Measurement& m = set_.measurements[k];
      const double mm = m.sigma_mm.value_or(options_.default_sigma_mm);
      const double rad = m.sigma_rad.value_or(options_.default_sigma_rad);
      cost += 0.5 * errors.value.head(errors.lengths).squaredNorm() / (mm * mm);
      cost +=
          0.5 * errors.value.tail(errors.value.size() - errors.lengths).squaredNorm() / (rad * rad);
    }
    return cost;
  }

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  const IdentifyOptions& options_;
  Selection selection_;
  Eigen::VectorXd theta_before_, theta_;  ///< fixtures included
  std::vector<JudgedRow> rows_;
  std::vector<std::size_t> fitted_;
  std::vector<RowModel> models_;
  std::unique_ptr<PoseRows> poses_;
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
  const Eigen::VectorXd all = AllNominal(machine, set);
  const FixtureValues fixtures{.fixtures = &set.fixtures,
                               .value = all.data() + machine.parameters().size()};
  for (const Measurement& measurement : set.measurements) {
    if (measurement.held_out) continue;
    RowModel row(machine, measurement, options.default_sigma_mm, options.default_sigma_rad);
    const RowModel::Prediction prediction = row.FindStart(theta, nullptr);
    if (!prediction.ok()) return std::numeric_limits<double>::quiet_NaN();
    sum += row.Whitened(prediction, fixtures).value.squaredNorm();
  }
  return sum;
}

}  // namespace kompono::calibration
