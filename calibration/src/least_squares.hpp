// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_LEAST_SQUARES_HPP_
#define KOMPONO_CALIBRATION_SRC_LEAST_SQUARES_HPP_

#include "pose_rows.hpp"
#include "selection.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace kompono::calibration {

struct Fit {
  Eigen::VectorXd u;
  bool converged = false;
  std::string message;
  int iterations = 0;
  double cost_before = 0.0,
         cost_after = 0.0;      ///< 1/2 Σ w r², gauge rows included (0 at the solution)
  std::vector<double> squares;  ///< whitened |r|² of the rows of the set, at the solution
  Eigen::MatrixXd H;            ///< by u, of rows and priors; symmetric
  double solver_ms = 0.0;
};

/// What is minimised: rows with weights, priors, and directions in which u must stay 0.
struct LeastSquares {
  PoseRows* rows = nullptr;
  const Selection* selection = nullptr;
  std::vector<std::size_t> chosen;  ///< rows that count
  std::vector<double> weights;      ///< per row of the set; empty: all 1
  Eigen::MatrixXd gauge;            ///< orthonormal columns; none: no column
  int max_iterations = 100;
};

/// Levenberg-Marquardt on the reduced normal equations from `u` on; bounds as an active set.
[[nodiscard]] Fit SolveLeastSquares(const LeastSquares& problem, const Eigen::VectorXd& u);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_LEAST_SQUARES_HPP_
