// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_ROBUST_HPP_
#define KOMPONO_CALIBRATION_SRC_ROBUST_HPP_

#include "least_squares.hpp"

#include <vector>

namespace kompono::calibration {

struct RobustFit {
  Fit fit;                            ///< of the rows that were kept
  std::vector<std::size_t> rejected;  ///< of the chosen rows, ascending
  /// More rows would have to go than an outlier's name allows; nothing was rejected.
  bool too_many = false;
};

/// Two stages: least squares over all rows but those grossly off at the start; then, if a whole row
/// is off by more than chance allows, a loss of Geman and McClure's form on whole rows that is
/// narrowed step by step from one that sees no outlier. Rows that still stand out are taken out and
/// the others fitted by plain least squares, until the two sets no longer change. `scale_known`:
/// the rows' deviations are real; else only their ratios are. `near`: u comes from a robust fit of
/// some of the rows, so that what stands out there stands out in all.
[[nodiscard]] RobustFit SolveRobustly(LeastSquares problem,
                                      const Eigen::VectorXd& u,
                                      bool scale_known,
                                      bool near);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_ROBUST_HPP_
