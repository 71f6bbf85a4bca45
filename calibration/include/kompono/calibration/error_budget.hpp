// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_ERROR_BUDGET_HPP_
#define KOMPONO_CALIBRATION_ERROR_BUDGET_HPP_

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// What the small errors of a machine's elements do at the tool (SO 44-55: Δ_0 = Σ_k A_0k Δ_k),
/// split as SO splits it: Δb setting of the part and mismatch of the bases, Δm mechanism and
/// dynamics, Δn tool or jet, δ = sqrt(Δb² + Δm² + Δn²) (SO 1, 2).
namespace kompono::calibration {

enum class ErrorPart { kBase, kMechanism, kTool };
[[nodiscard]] std::string_view Name(ErrorPart part);

/// Which of the three a number of the geometry belongs to.
[[nodiscard]] ErrorPart PartOf(const kinematics::Machine& machine, std::string_view parameter);

struct BudgetOptions {
  /// Standard deviations by pattern, mm or rad; other numbers have their manufacturing tolerance.
  std::map<std::string, double> sigma;
  /// Instead of deviations the known errors of one machine, of the size of θ.
  std::optional<Eigen::VectorXd> change;
  std::map<std::string, std::array<double, 2>> region;  ///< over the ranges of the layout; mm, rad
  int poses = 200;
  int samples = 500;  ///< of the Monte Carlo check; each is a machine seen at every pose
  std::uint64_t seed = 1;
  double mass_kg = 0.0;  ///< moved with the tool or the part; 0: no dynamic error
  /// mm/s²; else the smallest of the drives' accelerations in the layout.
  std::optional<double> acceleration;
  /// Direction of the acceleration in the datum, and of the error that counts; else the worst one.
  std::optional<Eigen::Vector3d> direction;
};

struct Contribution {
  std::string name;
  ErrorPart part = ErrorPart::kMechanism;
  double sigma = 0.0;  ///< of the number (or its known error), mm or rad
  bool angle = false;
  double rms_mm = 0.0;  ///< at the tool point over the zone, length of the vector
  double max_mm = 0.0;
};

struct Budget {
  std::vector<Contribution> contributions;  ///< largest first; those without effect are left out
  std::array<double, 3> part_mm{};          ///< Δb, Δm (geometry only), Δn: RMS over the zone
  double geometry_mm = 0.0;                 ///< first order, RMS over the zone
  double monte_carlo_mm = 0.0;              ///< the same without linearising
  /// Inertia over drive stiffness, in the direction in which it is worst; RMS, least and most over
  /// the zone. 0 without mass.
  double dynamic_mm = 0.0, dynamic_least_mm = 0.0, dynamic_most_mm = 0.0;
  double mechanism_mm = 0.0;  ///< Δm: geometry and dynamics, root of squares
  double total_mm = 0.0;      ///< δ
};

/// E044x when poses cannot be drawn, E0431 for a pattern that names nothing, E0445 for a dynamic
/// error without stiffness or acceleration.
[[nodiscard]] Parsed<Budget> ErrorBudget(const kinematics::Machine& machine,
                                         const BudgetOptions& options);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_ERROR_BUDGET_HPP_
