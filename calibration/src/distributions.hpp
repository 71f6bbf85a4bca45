// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_DISTRIBUTIONS_HPP_
#define KOMPONO_CALIBRATION_SRC_DISTRIBUTIONS_HPP_

namespace kompono::calibration {

/// x with P(X > x) = `tail` for a standard normal X; absolute error below 5e-4 (Abramowitz and
/// Stegun 26.2.23). 0 < tail < 1.
[[nodiscard]] double NormalUpper(double tail);

/// x with P(X > x) = `tail` for chi² with `dof` degrees of freedom, Wilson and Hilferty's
/// approximation.
[[nodiscard]] double ChiSquaredUpper(double tail, double dof);

/// P(X > x) for chi² with `dof` degrees of freedom, by the same approximation.
[[nodiscard]] double ChiSquaredTail(double x, double dof);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_DISTRIBUTIONS_HPP_
