// SPDX-License-Identifier: Apache-2.0
#include "robust.hpp"

#include "distributions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kompono::calibration {
namespace {

constexpr double kRounding =
    1e-14;  ///< variance of 1e-9 mm against the 0.01 mm assumed: no row is off by that
constexpr double kChance = 1e-3;        ///< that one good row of all is rejected
constexpr double kMostRejected = 0.35;  ///< of the rows; more are no outliers
constexpr double kGross = 100.0;        ///< times the square at which a row of the start stands out
constexpr double kNarrowing = 0.5;
constexpr int kStepsPerWidth = 4;
constexpr int kMostRounds = 12;

class RobustSolver {
 public:
  RobustSolver(LeastSquares problem, bool scale_known)
      : problem_(std::move(problem)),
        all_(problem_.chosen),
        max_iterations_(problem_.max_iterations),
        scale_known_(scale_known) {
    for (const std::size_t k : all_) {
      const int count = problem_.rows->measurement(k).Numbers();
      numbers_.push_back(count);
      total_ += count;
    }
  }

  RobustFit Run(const Eigen::VectorXd& u, bool near) {
    RobustFit out;
    Fit robust;
    if (near) {
      const NormalEquations rows =
          problem_.rows->Assemble(problem_.selection->Theta(u.data()), problem_.chosen, {}, false);
      robust.u = u;
      robust.squares = rows.squares;
      if (!rows.ok || Outside(robust, {}).empty()) {
        out.fit = SolveLeastSquares(problem_, u);
        return out;
      }
    } else {
      FindGross(u);
      out.fit = gross_.empty() ? SolveLeastSquares(problem_, u) : FitWithout(gross_, u);
      const int spare = total_ - static_cast<int>(problem_.selection->size());
      if (!out.fit.converged || spare < 3) return out;
      if (gross_.empty() && Outside(out.fit, {}).empty()) return out;
      robust = Narrow(out.fit);
    }
    std::vector<std::size_t> rejected = Outside(robust, {});
    for (int round = 0; round < kMostRounds; ++round) {
      if (static_cast<double>(rejected.size()) > kMostRejected * static_cast<double>(all_.size())) {
        out.too_many = true;
        if (near) out.fit = FitWithout({}, u);
        return out;
      }
      Fit kept = FitWithout(rejected, robust.u);
      if (!kept.converged) {
        if (near) out.fit = std::move(kept);
        return out;
      }
      kept.iterations += out.fit.iterations;
      kept.solver_ms += out.fit.solver_ms;
      kept.cost_before = out.fit.cost_before;
      std::vector<std::size_t> again = Outside(kept, rejected);
      const bool same = again == rejected;
      robust = std::move(kept);
      if (same) break;
      rejected = std::move(again);
    }
    out.fit = std::move(robust);
    out.rejected = std::move(rejected);
    return out;
  }

 private:
  /// Rows so far off at the start that least squares over all would lead nowhere. They wait until
  /// the others are fitted and are judged then.
  void FindGross(const Eigen::VectorXd& u) {
    const NormalEquations rows =
        problem_.rows->Assemble(problem_.selection->Theta(u.data()), problem_.chosen, {}, false);
    if (!rows.ok) return;
    Fit start;
    start.squares = rows.squares;
    const double variance = Variance(start);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (start.squares[all_[i]] > kGross * Limit(i) * variance) gross_.push_back(all_[i]);
    }
    if (static_cast<double>(gross_.size()) > kMostRejected * static_cast<double>(all_.size())) {
      gross_.clear();
    }
  }

  /// Variance of unit weight that the bulk of the rows shows.
  [[nodiscard]] double Variance(const Fit& fit) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      ratios.push_back(fit.squares[all_[i]] / ChiSquaredUpper(0.5, numbers_[i]));
    }
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    const double fitted = static_cast<double>(problem_.selection->size()) / total_;
    const double variance = *middle / std::max(0.1, 1.0 - fitted);
    return scale_known_ ? std::max(1.0, variance) : std::max(kRounding, variance);
  }

  [[nodiscard]] double Limit(std::size_t i) const {
    return ChiSquaredUpper(kChance / static_cast<double>(all_.size()), numbers_[i]);
  }

  /// Rows that stand out; for those left out of the fit the fit's own error counts too.
  [[nodiscard]] std::vector<std::size_t> Outside(const Fit& fit,
                                                 const std::vector<std::size_t>& left_out) const {
    const double variance = Variance(fit);
    const double leverage = static_cast<double>(problem_.selection->size()) / total_;
    std::vector<std::size_t> outside;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const bool out = std::binary_search(left_out.begin(), left_out.end(), all_[i]);
      const double most = Limit(i) * variance * (out ? 1.0 + leverage * numbers_[i] : 1.0);
      if (fit.squares[all_[i]] > most) outside.push_back(all_[i]);
    }
    return outside;
  }

  Fit Narrow(const Fit& wide) {
    Fit fit = wide;
    double largest = 0.0;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (std::binary_search(gross_.begin(), gross_.end(), all_[i])) continue;
      largest = std::max(largest, fit.squares[all_[i]] / (Limit(i) * Variance(fit)));
    }
    for (double width = std::max(1.0, 2.0 * largest);; width *= kNarrowing) {
      width = std::max(width, 1.0);
      for (int pass = 0; pass < 2; ++pass) {
        Weigh(fit, width);
        problem_.max_iterations = kStepsPerWidth;
        Fit next = SolveLeastSquares(problem_, fit.u);
        if (next.squares.empty()) {  // some row has no pose there: the step before has to do
          problem_.weights.clear();
          return fit;
        }
        fit = std::move(next);
      }
      if (width == 1.0) break;
    }
    problem_.weights.clear();
    return fit;
  }

  /// Geman and McClure: (c² / (c² + r²))², c² = width * what a good row may be off.
  void Weigh(const Fit& fit, double width) {
    const double variance = Variance(fit);
    problem_.weights.assign(problem_.rows->size(), 0.0);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const double c = width * variance * Limit(i);
      const double share = c / (c + fit.squares[all_[i]]);
      problem_.weights[all_[i]] = share * share;
    }
  }

  Fit FitWithout(const std::vector<std::size_t>& rejected, const Eigen::VectorXd& u) {
    problem_.max_iterations = max_iterations_;
    problem_.weights.assign(problem_.rows->size(), 1.0);
    for (const std::size_t k : rejected) problem_.weights[k] = 0.0;
    return SolveLeastSquares(problem_, u);
  }

  LeastSquares problem_;
  std::vector<std::size_t> all_;
  std::vector<std::size_t> gross_;  ///< ascending
  std::vector<int> numbers_;
  int total_ = 0;
  int max_iterations_;
  bool scale_known_;
};

}  // namespace

RobustFit SolveRobustly(LeastSquares problem,
                        const Eigen::VectorXd& u,
                        bool scale_known,
                        bool near) {
  return RobustSolver(std::move(problem), scale_known).Run(u, near);
}

}  // namespace kompono::calibration
