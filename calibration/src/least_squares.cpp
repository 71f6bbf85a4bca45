// SPDX-License-Identifier: Apache-2.0
#include "least_squares.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace kompono::calibration {
namespace {

constexpr double kSmallGain = 1e-9;   ///< of the cost: the step is taken and was the last
constexpr double kSmallStep = 1e-13;  ///< of u: nothing but rounding is left
constexpr std::size_t kManyRows = 3000;
constexpr double kFirstDamping = 1e-9;
constexpr double kLeastDamping = 1e-13;
constexpr double kMostDamping = 1e12;

/// Cost, gradient and Hessian by u with everything that belongs to the problem.
struct Point {
  Eigen::VectorXd u;
  bool ok = false;
  double cost = 0.0;
  Eigen::MatrixXd H_data;  ///< rows and priors
  Eigen::MatrixXd H;       ///< with the gauge
  Eigen::VectorXd g;
  std::vector<double> squares;
};

class Descent {
 public:
  explicit Descent(const LeastSquares& problem) : problem_(problem), of_(*problem.selection) {
    const Eigen::Index n = of_.size();
    lower_.setConstant(n, -std::numeric_limits<double>::infinity());
    upper_.setConstant(n, std::numeric_limits<double>::infinity());
    prior_.setZero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (of_.prior[k]) prior_[i] = of_.scale[i] / *of_.prior[k];
      if (!of_.bounds[k]) continue;
      const double nominal = of_.nominal[of_.free[k]];
      lower_[i] = ((*of_.bounds[k])[0] - nominal) / of_.scale[i];
      upper_[i] = ((*of_.bounds[k])[1] - nominal) / of_.scale[i];
    }
  }

  Fit Run(const Eigen::VectorXd& start) {
    Fit fit;
    Point here = At(start.cwiseMax(lower_).cwiseMin(upper_));
    fit.cost_before = here.cost;
    double damping = kFirstDamping;
    if (!here.ok) fit.message = "no pose at the start";
    while (here.ok && !fit.converged && fit.iterations < problem_.max_iterations) {
      ++fit.iterations;
      const Eigen::VectorXd step = StepFrom(here, damping);
      const Eigen::VectorXd next = (here.u + step).cwiseMax(lower_).cwiseMin(upper_);
      const Eigen::VectorXd moved = next - here.u;
      const double gain = -here.g.dot(moved) - 0.5 * moved.dot(here.H * moved);
      const bool tiny = moved.cwiseAbs().maxCoeff() <= kSmallStep * (1.0 + here.u.norm());
      if (tiny || (damping <= kFirstDamping && gain <= kSmallGain * here.cost)) {
        if (!tiny && gain > 0.0) Finish(next, gain, &here);
        fit.converged = true;
        fit.message = "converged";
        break;
      }
      if (problem_.chosen.size() > kManyRows && TakeForetold(next, gain, &here)) {
        fit.converged = true;
        fit.message = "converged";
        break;
      }
      Point there = At(next);
      if (there.ok && there.cost <= here.cost) {
        here = std::move(there);
        damping = std::max(kLeastDamping, 0.1 * damping);
      } else {
        // At the floor of rounding no step gains any more.
        if (there.ok && there.cost - here.cost <= 1e-12 * here.cost + 1e-24) {
          fit.converged = true;
          fit.message = "converged";
          break;
        }
        damping *= 100.0;
        if (damping > kMostDamping) {
          fit.message = "no step from here lowers the cost";
          break;
        }
      }
    }
    if (!fit.converged && fit.message.empty()) fit.message = "iteration limit";
    fit.u = here.u;
    fit.cost_after = here.cost;
    fit.squares = std::move(here.squares);
    fit.H = std::move(here.H_data);
    return fit;
  }

 private:
  /// Takes a last step whose effect on the cost is known well enough.
  static void Finish(const Eigen::VectorXd& u, double gain, Point* here) {
    here->u = u;
    here->cost -= gain;
  }

  /// Of very many rows a second pass with derivatives is saved: if the cost falls as the linear
  /// model foretold, no further step would gain anything.
  bool TakeForetold(const Eigen::VectorXd& u, double gain, Point* here) const {
    const NormalEquations rows =
        problem_.rows->Assemble(of_.Theta(u.data()), problem_.chosen, problem_.weights, false);
    double cost = rows.cost + 0.5 * prior_.cwiseProduct(u).squaredNorm();
    if (problem_.gauge.cols() > 0) return false;
    if (!rows.ok || std::abs(here->cost - gain - cost) > kSmallGain * cost) return false;
    here->u = u;
    here->cost = cost;
    here->squares = rows.squares;
    return true;
  }

  [[nodiscard]] Point At(const Eigen::VectorXd& u) const {
    Point point{.u = u};
    const NormalEquations rows =
        problem_.rows->Assemble(of_.Theta(u.data()), problem_.chosen, problem_.weights, true);
    point.ok = rows.ok && std::isfinite(rows.cost);
    if (!point.ok) return point;
    point.squares = rows.squares;
    point.H_data = of_.scale.asDiagonal() *
                   Eigen::MatrixXd(rows.H.selfadjointView<Eigen::Upper>()) * of_.scale.asDiagonal();
    point.g = of_.scale.cwiseProduct(rows.g);
    point.cost = rows.cost + 0.5 * prior_.cwiseProduct(u).squaredNorm();
    point.H_data.diagonal() += prior_.cwiseAbs2();
    point.g += prior_.cwiseAbs2().cwiseProduct(u);
    point.H = point.H_data;
    if (problem_.gauge.cols() > 0) {
      // As stiff as the rows, so that neither spoils the other's digits.
      const double weight = std::max(1.0, point.H_data.diagonal().mean());
      const Eigen::VectorXd along = problem_.gauge.transpose() * u;
      point.H += weight * problem_.gauge * problem_.gauge.transpose();
      point.g += weight * problem_.gauge * along;
      point.cost += 0.5 * weight * along.squaredNorm();
    }
    return point;
  }

  /// Damped Gauss-Newton step of the unknowns that no bound holds back.
  [[nodiscard]] Eigen::VectorXd StepFrom(const Point& here, double damping) const {
    const Eigen::Index n = here.u.size();
    std::vector<bool> held(static_cast<std::size_t>(n), false);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    for (int pass = 0; pass < 4; ++pass) {
      std::vector<Eigen::Index> active;
      for (Eigen::Index i = 0; i < n; ++i) {
        const bool out_below = here.u[i] <= lower_[i] && here.g[i] > 0.0;
        const bool out_above = here.u[i] >= upper_[i] && here.g[i] < 0.0;
        if (!out_below && !out_above && !held[static_cast<std::size_t>(i)]) active.push_back(i);
      }
      step.setZero();
      if (active.empty()) return step;
      const Eigen::VectorXd solved = Damped(here.H(active, active), here.g(active), damping);
      bool crossed = false;
      for (std::size_t k = 0; k < active.size(); ++k) {
        const Eigen::Index i = active[k];
        step[i] = solved[static_cast<Eigen::Index>(k)];
        const bool out = here.u[i] + step[i] < lower_[i] || here.u[i] + step[i] > upper_[i];
        if (!out) continue;
        // Goes to its bound; the others are solved again without it.
        held[static_cast<std::size_t>(i)] = here.u[i] <= lower_[i] || here.u[i] >= upper_[i];
        crossed = crossed || held[static_cast<std::size_t>(i)];
      }
      if (!crossed) return step;
    }
    return step;
  }

  /// Columns of unit length before damping, so that the unknowns' units do not matter.
  static Eigen::VectorXd Damped(Eigen::MatrixXd H, const Eigen::VectorXd& g, double damping) {
    const double least = 1e-30 + 1e-26 * H.diagonal().maxCoeff();
    const Eigen::VectorXd norm = H.diagonal().cwiseMax(least).cwiseSqrt().cwiseInverse();
    H = norm.asDiagonal() * H * norm.asDiagonal();
    H.diagonal().array() += damping;
    return norm.cwiseProduct(H.ldlt().solve(-norm.cwiseProduct(g)));
  }

  const LeastSquares& problem_;
  const Selection& of_;
  Eigen::VectorXd lower_, upper_, prior_;
};

}  // namespace

Fit SolveLeastSquares(const LeastSquares& problem, const Eigen::VectorXd& u) {
  const auto begin = std::chrono::steady_clock::now();
  Fit fit = Descent(problem).Run(u);
  fit.solver_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return fit;
}

}  // namespace kompono::calibration
