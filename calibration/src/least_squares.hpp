// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_LEAST_SQUARES_HPP_
#define KOMPONO_CALIBRATION_SRC_LEAST_SQUARES_HPP_

#include "residuals.hpp"
#include "selection.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/identification.hpp"

namespace kompono::calibration {

struct Fit {
  Eigen::VectorXd u;
  bool converged = false;
  std::string message;
  int iterations = 0;
  double cost_before = 0.0,
         cost_after = 0.0;  ///< 1/2 Σ r², gauge rows included (0 at the solution)
  double solver_ms = 0.0;
};

/// Levenberg-Marquardt over the whitened residuals of `rows` and the priors, from `u` on. `gauge`:
/// orthonormal columns along which u must stay 0; no column for none. The rows' starting
/// coordinates follow the accepted steps.
[[nodiscard]] Fit SolveLeastSquares(const std::vector<RowModel*>& rows,
                                    const Selection& selection,
                                    const Eigen::VectorXd& u,
                                    const Eigen::MatrixXd& gauge,
                                    int max_iterations);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_LEAST_SQUARES_HPP_
