// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SIMULATION_HPP_
#define KOMPONO_CALIBRATION_SIMULATION_HPP_

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/measurements.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// Measurements of a machine that exists only as numbers: what `kompono measure` does.
namespace kompono::calibration {

struct SimulateOptions {
  int count = 60;    ///< rows used for the fit
  int held_out = 0;  ///< further rows, marked held_out
  std::uint64_t seed = 1;
  MeasurementKind kind = MeasurementKind::kPosition;
  std::array<bool, 3> components{true, true, true};  ///< of a position: x, y, z
  double sigma_mm = 0.0;                             ///< noise on each length
  double sigma_rad = 0.0;  ///< noise on each component of the rotation vector
  /// What the instrument needs of itself; rows take targets and centres, planes or sheets in turn.
  /// Fixtures that are not known keep their true values here and are unknown in the result.
  std::vector<Fixture> fixtures;
  bool held_out_without_noise = false;  ///< to judge against the truth itself
  /// Coordinate name -> lower, upper (mm, rad); over the ranges of the layout.
  std::map<std::string, std::array<double, 2>> region;
};

/// Random poses. The control computes the readings from the nominal machine; the true machine goes
/// where its own geometry `theta_true` takes these readings; the instrument adds noise. `truth`
/// must have the drives of `nominal`; pass `nominal` twice to change numbers only. Fails (E044x)
/// when a coordinate has no range, or too few poses can be reached.
[[nodiscard]] Parsed<MeasurementSet> Simulate(const kinematics::Machine& nominal,
                                              const kinematics::Machine& truth,
                                              const Eigen::VectorXd& theta_true,
                                              const SimulateOptions& options);

/// θ of the layout with `changes` added: pattern -> mm or rad. E0431 for a pattern that matches
/// nothing.
[[nodiscard]] Parsed<Eigen::VectorXd> ChangedGeometry(const kinematics::Machine& machine,
                                                      const std::map<std::string, double>& changes);

/// θ of the layout with every number that has a tolerance off by a normal deviate of `scale` times
/// that tolerance: a machine as the workshop delivers it.
[[nodiscard]] Eigen::VectorXd ManufacturedGeometry(const kinematics::Machine& machine,
                                                   std::uint64_t seed,
                                                   double scale = 1.0);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SIMULATION_HPP_
