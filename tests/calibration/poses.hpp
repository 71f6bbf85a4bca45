// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_CALIBRATION_POSES_HPP_
#define KOMPONO_TESTS_CALIBRATION_POSES_HPP_

#include "residuals.hpp"

#include <random>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
#include "kompono/kinematics/linearisation.hpp"
#include "kompono/kinematics/machine.hpp"

/// Measured poses of a hexapod in any number, without the detour over a control.
namespace kompono::calibration::testing {

/// `count` poses of the machine with geometry θ, spread over ±120 mm and ±15°.
inline MeasurementSet HexapodPoses(const kinematics::Machine& machine,
                                   const Eigen::VectorXd& theta,
                                   int count,
                                   double sigma_mm,
                                   double sigma_rad,
                                   unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  kinematics::Linearisation linear(machine, {});
  linear.SetGeometry(theta);
  MeasurementSet set;
  set.file = "simulated";
  for (int k = 0; k < count; ++k) {
    Eigen::VectorXd z = machine.home();
    for (int i = 0; i < 6; ++i) z[i] += (i < 3 ? 120.0 : 0.26) * uniform(random);
    if (!linear.At(z, kinematics::Linearisation::Depth::kValues)) continue;
    Measurement m{.kind = MeasurementKind::kPose, .readings = linear.readings()};
    for (int i = 0; i < 3; ++i) m.position_mm[static_cast<std::size_t>(i)] = linear.X_WT().p[i];
    m.R_WT = linear.X_WT().R;
    m.sigma_mm = sigma_mm;
    m.sigma_rad = sigma_rad;
    m.row = k + 1;
    set.measurements.push_back(std::move(m));
  }
  return set;
}

/// Normal noise of each row's own deviations.
inline void AddNoise(unsigned seed, MeasurementSet* set) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (Measurement& m : set->measurements) {
    for (std::optional<double>& component : m.position_mm) {
      if (component) *component += *m.sigma_mm * normal(random);
    }
    const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
    m.R_WT = RotationFromVector(*m.sigma_rad * turn) * m.R_WT;
  }
}

}  // namespace kompono::calibration::testing

#endif  // KOMPONO_TESTS_CALIBRATION_POSES_HPP_
