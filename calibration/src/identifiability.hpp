// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_IDENTIFIABILITY_HPP_
#define KOMPONO_CALIBRATION_SRC_IDENTIFIABILITY_HPP_

#include "residuals.hpp"
#include "selection.hpp"

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/identification.hpp"

namespace kompono::calibration {

/// What the Jacobian J of whitened residuals and priors by u says. Unknowns in `held` (at a bound)
/// do not take part.
///
/// Behind the exact null space stand directions that are seen, but so weakly that their deviation
/// would exceed `weakest` in u: what symmetry hides at the nominal geometry the real one shows by
/// its small errors only. To follow them would move numbers by hundreds of their tolerances.
struct RankAnalysis {
  Eigen::Index rank = 0;      ///< without the weak directions
  double condition = 0.0;     ///< of the determined part, columns of unit length
  Eigen::MatrixXd null_unit;  ///< null space for columns of unit length; weak directions last
  Eigen::VectorXd column_norm;
  Eigen::MatrixXd gauge;           ///< null space in u, orthonormal; weak directions last
  Eigen::MatrixXd covariance;      ///< of u, of smallest trace: no variance along the gauge
  std::vector<double> weak_sigma;  ///< deviations of the weak directions, of u
};
[[nodiscard]] RankAnalysis AnalyzeRank(const Eigen::MatrixXd& J,
                                       const std::vector<bool>& held,
                                       double threshold,
                                       double weakest = std::numeric_limits<double>::infinity());

/// The null space as combinations of few parameters, in words, with what would determine them.
[[nodiscard]] std::vector<NullDirection> DescribeNullSpace(const RankAnalysis& analysis,
                                                           const kinematics::Machine& machine,
                                                           const Selection& selection,
                                                           const std::vector<RowModel*>& rows,
                                                           const Eigen::VectorXd& theta);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_IDENTIFIABILITY_HPP_
