// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/planning.hpp"

#include "identifiability.hpp"
#include "pose_worker.hpp"
#include "selection.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>

#include <Eigen/Cholesky>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr int kRandomSets = 200;
constexpr int kExchangePasses = 3;
/// What is known of every number before: a hundred units of u (tolerances). It decides nothing once
/// the rows determine a number.
constexpr double kWeakPrior = 1e-4;
constexpr int kDraws = 8;       ///< of poses, until there are enough that may be taken
constexpr double kBlind = 1e3;  ///< mm; a predicted deviation above says that rows are missing

class Planner {
 public:
  Planner(const kinematics::Machine& machine, const PlanOptions& options)
      : machine_(machine), options_(options) {}

  Parsed<Plan> Run() {
    const Parsed<analysis::PoseJudge> judge =
        analysis::PoseJudge::Make(machine_, machine_.nominal(), options_.limits);
    if (!judge) return tl::unexpected(judge.error());
    block_.emplace(*judge);
    for (int draw = 0; draw < kDraws && !Enough(); ++draw) {
      const Parsed<MeasurementSet> drawn = Draw(options_.instrument.seed + 1000003ULL * draw);
      if (!drawn) return tl::unexpected(drawn.error());
      if (draw == 0) {
        Parsed<Selection> selection = SelectUnknowns(machine_, *drawn, options_.identify);
        if (!selection) return tl::unexpected(std::move(selection.error()));
        selection_ = std::move(*selection);
        pool_.fixtures = drawn->fixtures;
      }
      Differentiate(*drawn);
    }
    if (static_cast<int>(rows_.size()) < 2 * options_.points) return tl::unexpected(TooFew());
    SumOverZone();
    std::vector<std::size_t> chosen = Greedy();
    Exchange(&chosen);
    return Report(Ordered(chosen));
  }

 private:
  [[nodiscard]] bool Enough() const {
    return tool_.size() >= static_cast<std::size_t>(options_.judged) &&
           rows_.size() >= static_cast<std::size_t>(options_.candidates);
  }

  /// Rows of the nominal machine without noise: deviations become weights.
  [[nodiscard]] Parsed<MeasurementSet> Draw(std::uint64_t seed) const {
    SimulateOptions draw = options_.instrument;
    draw.seed = seed;
    draw.count = options_.candidates + options_.judged;
    draw.held_out = 0;
    draw.sigma_mm = 0.0;
    draw.sigma_rad = 0.0;
    return Simulate(machine_, machine_, machine_.nominal(), draw);
  }

  [[nodiscard]] Diagnostics TooFew() const {
    return {{.code = codes::kFewPoses.code,
             .file = machine_.layout().file.string(),
             .message = fmt::format("of {} poses drawn {} are near a singularity and in {} a joint "
                                    "swings too far or struts touch; {} are too few to choose {} "
                                    "from",
                                    drawn_,
                                    near_singular_,
                                    obstructed_,
                                    rows_.size(),
                                    options_.points),
             .help = "make the region larger, or relax what the poses must keep"}};
  }

  /// Whitened derivatives of the candidates and of the tool over the zone.
  void Differentiate(const MeasurementSet& drawn) {
    PoseWorker worker(machine_,
                      drawn,
                      selection_.free,
                      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(machine_.drives().size())));
    worker.SetGeometry(selection_.nominal);
    const double mm = options_.instrument.sigma_mm > 0.0 ? options_.instrument.sigma_mm
                                                         : options_.identify.default_sigma_mm;
    const double rad = options_.instrument.sigma_rad > 0.0 ? options_.instrument.sigma_rad
                                                           : options_.identify.default_sigma_rad;
    Eigen::Matrix<double, 6, Eigen::Dynamic> twists;
    for (const Measurement& measurement : drawn.measurements) {
      if (Enough()) return;
      PoseRow row{.measurement = &measurement, .sigma_mm = mm, .sigma_rad = rad};
      ++drawn_;
      if (worker.FindStart(selection_.nominal, nullptr, &row) !=
              kinematics::SolveStatus::kConverged ||
          !MayBeTaken(row) || !worker.Linearise(&row, true, false)) {
        continue;
      }
      const Eigen::MatrixXd J =
          worker.jacobian().topRows(worker.rho().size()) * selection_.scale.asDiagonal();
      if (tool_.size() < static_cast<std::size_t>(options_.judged)) {
        if (!worker.ToolByParameters(&row, &twists)) continue;
        Eigen::MatrixXd tool = Eigen::MatrixXd::Zero(3, selection_.size());
        tool.leftCols(twists.cols()) = twists.topRows<3>();
        tool_.push_back(tool * selection_.scale.asDiagonal());
      } else {
        rows_.push_back(J);
        pool_.measurements.push_back(measurement);
      }
    }
  }

  /// Σ_zone Tᵀ T, so that a set's deviation is one trace.
  void SumOverZone() {
    zone_ = Eigen::MatrixXd::Zero(selection_.size(), selection_.size());
    for (const Eigen::MatrixXd& T : tool_) {
      zone_ += T.transpose() * T / static_cast<double>(tool_.size());
    }
  }

  /// Both poses of rows with two readings.
  [[nodiscard]] bool MayBeTaken(const PoseRow& row) {
    for (const Eigen::VectorXd* z : {&row.z, &row.z_second}) {
      if (z->size() == 0) continue;
      if (!Regular(*z)) {
        ++near_singular_;
        return false;
      }
      for (Eigen::Index i = 0; i < z->size(); ++i) {
        block_->column(static_cast<std::size_t>(i))[0] = (*z)[i];
      }
      block_->Judge(1);
      if (!block_->Inside(0)) {
        ++obstructed_;
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool Regular(const Eigen::VectorXd& z) const {
    for (const kinematics::Singularity& s : machine_.Singularities(z, machine_.nominal())) {
      if (s.margin < options_.least_margin) return false;
    }
    return true;
  }

  [[nodiscard]] Eigen::MatrixXd Prior() const {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(selection_.size(), selection_.size());
    for (Eigen::Index i = 0; i < selection_.size(); ++i) {
      const auto& prior = selection_.prior[static_cast<std::size_t>(i)];
      const double known = prior ? selection_.scale[i] / *prior : 0.0;
      M(i, i) = kWeakPrior + known * known;
    }
    return M;
  }

  [[nodiscard]] Eigen::MatrixXd Information(const std::vector<std::size_t>& chosen) const {
    Eigen::MatrixXd M = Prior();
    for (const std::size_t k : chosen) M += rows_[k].transpose() * rows_[k];
    return M;
  }

  static Eigen::MatrixXd Inverse(const Eigen::MatrixXd& M) {
    const Eigen::VectorXd norm = M.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd unit = norm.asDiagonal() * M * norm.asDiagonal();
    return norm.asDiagonal() * unit.llt().solve(Eigen::MatrixXd::Identity(M.rows(), M.cols())) *
           norm.asDiagonal();
  }

  /// How much better a set becomes by row k, whose inverse information is C.
  [[nodiscard]] double Gain(const Eigen::MatrixXd& C,
                            const Eigen::MatrixXd& CZC,
                            std::size_t k) const {
    const Eigen::MatrixXd& J = rows_[k];
    const Eigen::MatrixXd S = Eigen::MatrixXd::Identity(J.rows(), J.rows()) + J * C * J.transpose();
    const Eigen::LLT<Eigen::MatrixXd> root(S);
    if (options_.criterion == PlanCriterion::kDOptimal) {
      return 2.0 * Eigen::MatrixXd(root.matrixL()).diagonal().array().log().sum();
    }
    // tr(Z C) falls by tr(S⁻¹ J C Z C Jᵀ).
    return root.solve(J * CZC * J.transpose()).trace();
  }

  /// The row outside of `chosen` that adds most.
  [[nodiscard]] std::size_t Best(const std::vector<std::size_t>& chosen) const {
    const Eigen::MatrixXd C = Inverse(Information(chosen));
    const Eigen::MatrixXd CZC = C * zone_ * C;
    std::size_t best = rows_.size();
    double most = -1.0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (std::find(chosen.begin(), chosen.end(), k) != chosen.end()) continue;
      const double gain = Gain(C, CZC, k);
      if (gain <= most) continue;
      most = gain;
      best = k;
    }
    return best;
  }

  [[nodiscard]] std::vector<std::size_t> Greedy() const {
    std::vector<std::size_t> chosen;
    while (static_cast<int>(chosen.size()) < options_.points) chosen.push_back(Best(chosen));
    return chosen;
  }

  /// Takes each row out and puts the best in its place, until nothing changes (Fedorov).
  void Exchange(std::vector<std::size_t>* chosen) const {
    for (int pass = 0; pass < kExchangePasses; ++pass) {
      bool changed = false;
      for (std::size_t i = 0; i < chosen->size(); ++i) {
        std::vector<std::size_t> others = *chosen;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        const std::size_t best = Best(others);
        if (best == rows_.size() || best == (*chosen)[i]) continue;
        std::vector<std::size_t> trial = *chosen;
        trial[i] = best;
        if (Worth(trial) <= Worth(*chosen) * (1.0 + 1e-9)) continue;
        *chosen = std::move(trial);
        changed = true;
      }
      if (!changed) return;
    }
  }

  /// Larger is better.
  [[nodiscard]] double Worth(const std::vector<std::size_t>& chosen) const {
    const Eigen::MatrixXd M = Information(chosen);
    if (options_.criterion == PlanCriterion::kDOptimal) {
      const Eigen::LLT<Eigen::MatrixXd> root(M);
      // Positive, so that "better by a share" means something.
      return std::exp(2.0 * Eigen::MatrixXd(root.matrixL()).diagonal().array().log().mean());
    }
    return 1.0 / (Inverse(M) * zone_).trace();
  }

  /// The same rows, the most valuable first.
  [[nodiscard]] std::vector<std::size_t> Ordered(const std::vector<std::size_t>& chosen) const {
    std::vector<std::size_t> ordered;
    std::vector<std::size_t> left = chosen;
    while (!left.empty()) {
      const Eigen::MatrixXd C = Inverse(Information(ordered));
      const Eigen::MatrixXd CZC = C * zone_ * C;
      const auto best = std::max_element(left.begin(), left.end(), [&](auto a, auto b) {
        return Gain(C, CZC, a) < Gain(C, CZC, b);
      });
      ordered.push_back(*best);
      left.erase(best);
    }
    return ordered;
  }

  [[nodiscard]] double ToolSigma(const std::vector<std::size_t>& chosen) const {
    const double sigma = std::sqrt((Inverse(Information(chosen)) * zone_).trace());
    return sigma < kBlind ? sigma : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] Plan Report(const std::vector<std::size_t>& ordered) const {
    Plan plan;
    plan.set.fixtures = pool_.fixtures;
    plan.free = static_cast<int>(selection_.free.size());
    plan.drawn = drawn_;
    plan.near_singular = near_singular_;
    plan.obstructed = obstructed_;
    std::vector<std::size_t> first;
    Eigen::Index numbers = 0;
    for (const std::size_t k : ordered) {
      first.push_back(k);
      numbers += rows_[k].rows();
      plan.tool_sigma_mm.push_back(ToolSigma(first));
      Measurement row = pool_.measurements[k];
      row.row = static_cast<int>(first.size());
      if (options_.instrument.sigma_mm > 0.0) row.sigma_mm = options_.instrument.sigma_mm;
      if (options_.instrument.sigma_rad > 0.0) row.sigma_rad = options_.instrument.sigma_rad;
      plan.set.measurements.push_back(std::move(row));
    }
    Eigen::MatrixXd J(numbers, selection_.size());
    Eigen::Index at = 0;
    for (const std::size_t k : ordered) {
      J.middleRows(at, rows_[k].rows()) = rows_[k];
      at += rows_[k].rows();
    }
    plan.rank = static_cast<int>(AnalyzeRank(J,
                                             std::vector<bool>(selection_.free.size(), false),
                                             options_.identify.rank_threshold)
                                     .rank);
    std::vector<double> random_sigmas;
    std::mt19937_64 random(options_.instrument.seed + 1);
    std::vector<std::size_t> all(rows_.size());
    std::iota(all.begin(), all.end(), 0);
    for (int i = 0; i < kRandomSets; ++i) {
      for (std::size_t k = 0; k < ordered.size(); ++k) {
        std::swap(all[k], all[k + random() % (all.size() - k)]);
      }
      random_sigmas.push_back(
          ToolSigma({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(ordered.size())}));
    }
    std::nth_element(
        random_sigmas.begin(), random_sigmas.begin() + kRandomSets / 2, random_sigmas.end());
    plan.random_tool_sigma_mm = random_sigmas[kRandomSets / 2];
    return plan;
  }

  const kinematics::Machine& machine_;
  const PlanOptions& options_;
  MeasurementSet pool_;  ///< the candidates
  Selection selection_;
  std::optional<analysis::PoseBlock> block_;
  int drawn_ = 0, near_singular_ = 0, obstructed_ = 0;
  std::vector<Eigen::MatrixXd> rows_;  ///< of the candidates, whitened, by u
  std::vector<Eigen::MatrixXd> tool_;
  Eigen::MatrixXd zone_;
};

}  // namespace

Parsed<Plan> PlanMeasurements(const kinematics::Machine& machine, const PlanOptions& options) {
  return Planner(machine, options).Run();
}

}  // namespace kompono::calibration
