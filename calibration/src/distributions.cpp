// SPDX-License-Identifier: Apache-2.0
#include "distributions.hpp"

#include <cmath>
#include <numbers>

namespace kompono::calibration {

double NormalUpper(double tail) {
  const double half = tail < 0.5 ? tail : 1.0 - tail;
  const double t = std::sqrt(-2.0 * std::log(half));
  const double x = t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                           (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return tail < 0.5 ? x : -x;
}

double ChiSquaredUpper(double tail, double dof) {
  const double spread = 2.0 / (9.0 * dof);
  const double root = 1.0 - spread + NormalUpper(tail) * std::sqrt(spread);
  return root > 0.0 ? dof * root * root * root : 0.0;
}

double ChiSquaredTail(double x, double dof) {
  const double spread = 2.0 / (9.0 * dof);
  const double z = (std::cbrt(x / dof) - (1.0 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

}  // namespace kompono::calibration
