// SPDX-License-Identifier: Apache-2.0
#include "least_squares.hpp"

#include <algorithm>
#include <chrono>

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

namespace kompono::calibration {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One row of the file.
class RowCost final : public ceres::CostFunction {
 public:
  RowCost(RowModel* row, const Selection& selection) : row_(row), selection_(selection) {
    set_num_residuals(row->size());
    mutable_parameter_block_sizes()->push_back(static_cast<int>(selection.size()));
  }

  /// Where the machine has no pose the step is refused and the solver tries a shorter one.
  bool Evaluate(double const* const* u, double* residuals, double** jacobians) const override {
    const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    const RowModel::Prediction prediction = row_->Predict(selection_.Theta(u[0]), derivatives);
    if (!prediction.ok()) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, row_->size()) = row_->Whitened(prediction).value;
    if (derivatives) {
      Eigen::Map<RowMajorMatrix> jacobian(jacobians[0], row_->size(), selection_.size());
      row_->Jacobian(prediction, selection_.free, selection_.scale, jacobian);
      row_->StartFrom(prediction);  // derivatives are asked for at accepted points only
    }
    return true;
  }

 private:
  RowModel* row_;
  const Selection& selection_;
};

/// residual = matrix * u: priors and gauge.
class LinearCost final : public ceres::CostFunction {
 public:
  explicit LinearCost(RowMajorMatrix matrix) : matrix_(std::move(matrix)) {
    set_num_residuals(static_cast<int>(matrix_.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(matrix_.cols()));
  }

  bool Evaluate(double const* const* u, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd>(residuals, matrix_.rows()) =
        matrix_ * Eigen::Map<const Eigen::VectorXd>(u[0], matrix_.cols());
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajorMatrix>(jacobians[0], matrix_.rows(), matrix_.cols()) = matrix_;
    }
    return true;
  }

 private:
  RowMajorMatrix matrix_;
};

RowMajorMatrix PriorRows(const Selection& selection) {
  const auto count = std::count_if(
      selection.prior.begin(), selection.prior.end(), [](const auto& p) { return p.has_value(); });
  RowMajorMatrix rows = RowMajorMatrix::Zero(count, selection.size());
  Eigen::Index row = 0;
  for (Eigen::Index i = 0; i < selection.size(); ++i) {
    const std::optional<double>& sigma = selection.prior[static_cast<std::size_t>(i)];
    if (sigma) rows(row++, i) = selection.scale[i] / *sigma;
  }
  return rows;
}

void SetBounds(const Selection& selection, double* u, ceres::Problem* problem) {
  for (Eigen::Index i = 0; i < selection.size(); ++i) {
    const auto& bounds = selection.bounds[static_cast<std::size_t>(i)];
    if (!bounds) continue;
    const double nominal = selection.nominal[selection.free[static_cast<std::size_t>(i)]];
    const double lower = ((*bounds)[0] - nominal) / selection.scale[i];
    const double upper = ((*bounds)[1] - nominal) / selection.scale[i];
    problem->SetParameterLowerBound(u, static_cast<int>(i), lower);
    problem->SetParameterUpperBound(u, static_cast<int>(i), upper);
    u[i] = std::clamp(u[i], lower, upper);
  }
}

ceres::Solver::Options SolverOptions(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.max_num_iterations = max_iterations;
  // The problem is small and nearly linear: go on until only rounding is left.
  options.function_tolerance = 1e-13;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.max_num_consecutive_invalid_steps = 20;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

Fit SolveLeastSquares(const std::vector<RowModel*>& rows,
                      const Selection& selection,
                      const Eigen::VectorXd& u,
                      const Eigen::MatrixXd& gauge,
                      int max_iterations) {
  Fit fit{.u = u};
  const auto begin = std::chrono::steady_clock::now();
  ceres::Problem problem;
  problem.AddParameterBlock(fit.u.data(), static_cast<int>(fit.u.size()));
  for (RowModel* row : rows) {
    problem.AddResidualBlock(new RowCost(row, selection), nullptr, fit.u.data());
  }
  RowMajorMatrix priors = PriorRows(selection);
  if (priors.rows() > 0) {
    problem.AddResidualBlock(new LinearCost(std::move(priors)), nullptr, fit.u.data());
  }
  if (gauge.cols() > 0) {
    problem.AddResidualBlock(new LinearCost(gauge.transpose()), nullptr, fit.u.data());
  }
  SetBounds(selection, fit.u.data(), &problem);
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(max_iterations), &problem, &summary);
  fit.solver_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  fit.converged = summary.termination_type == ceres::CONVERGENCE;
  fit.message = summary.message;
  fit.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  fit.cost_before = summary.initial_cost;
  fit.cost_after = summary.final_cost;
  return fit;
}

}  // namespace kompono::calibration
