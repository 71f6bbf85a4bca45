// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_BUDGET_HPP_
#define KOMPONO_SYNTHESIS_BUDGET_HPP_

#include "required_zone.hpp"

#include <map>
#include <string>

#include "kompono/kinematics/machine.hpp"
#include "kompono/synthesis/evaluation.hpp"

/// Stiffness, first-order errors, inertia, masses and space of a sized machine.
namespace kompono::synthesis {

/// What each plain axis ("X") and mechanism ("drive") sets in motion, itself included, kg.
struct MovedMasses {
  std::map<std::string, double> of;
  double sum = 0.0;
};
/// Slides weigh what the settings say and a share of what they carry; mechanisms their platform,
/// carriages and struts at home.
[[nodiscard]] MovedMasses MassesOf(const kinematics::Machine& machine,
                                   double part_kg,
                                   const EvaluationSettings& settings);

/// The worst over the required poses; not a number where no pose could be evaluated.
struct ToolBudget {
  double stiffness_n_per_mm = 0.0;
  double error_mm = 0.0;
  double dynamic_mm = 0.0;
  double orientation_margin = 0.0;  ///< not a number for a machine that does not turn
  double singularity_margin = 1.0;
  std::uint64_t poses = 0;
};
/// With q̇ = J ẋ and compliances 1/k of the drives, the tool's compliance is Σ t tᵀ / k over the
/// columns t of J⁻¹ (HEX); errors of readings, of numbers of the geometry (closures kept) and of
/// guides add as variances (SO 44-55); inertia of what each drive moves bends it (SO 6).
/// `process_direction`: the tool's axis, 'x', 'y' or 'z'.
[[nodiscard]] ToolBudget BudgetOf(const kinematics::Machine& machine,
                                  const std::vector<Eigen::VectorXd>& poses,
                                  const MovedMasses& masses,
                                  char process_direction,
                                  const EvaluationSettings& settings);

/// Box around part, tool, frames and mechanisms in the required poses, in the workpiece-side
/// base.
struct SpaceBox {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();
  [[nodiscard]] double FloorMm2() const {
    return (upper.x() - lower.x()) * (upper.y() - lower.y());
  }
  /// Two posts and a beam along the longer side.
  [[nodiscard]] double PortalMm() const;
  /// Product of its `n` largest sides.
  [[nodiscard]] double Content(std::size_t n) const;
};
[[nodiscard]] SpaceBox BoxOf(const kinematics::Machine& machine,
                             const std::vector<Eigen::VectorXd>& poses,
                             const Study& study);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_BUDGET_HPP_
