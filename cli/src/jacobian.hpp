// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_JACOBIAN_HPP_
#define KOMPONO_CLI_JACOBIAN_HPP_

#include <array>
#include <vector>

#include <Eigen/Core>

#include "kompono/kinematics/machine.hpp"

namespace kompono::cli {

/// How the drive readings change with the tool pose: ∂reading/∂z (∂pose/∂z)⁻¹, in mm or rad per mm
/// or rad.
struct DriveJacobian {
  std::vector<std::size_t> components;  ///< of X Y Z A B C: the columns
  Eigen::MatrixXd matrix;               ///< drives x components
};

/// The columns are the pose components that the machine controls: those of `wanted`, then as many
/// of A B C X Y Z, in this order, as its coordinates can move independently. With fewer or more
/// coordinates than components the inverse is the least-squares one, a radian weighing 100 mm.
/// Derivatives of A B C are of the numbers themselves in the given order; at B = ±90° they do not
/// exist and the least-squares solution is given.
[[nodiscard]] DriveJacobian JacobianOf(const kinematics::Machine& machine,
                                       const Eigen::VectorXd& z,
                                       layout::RotationOrder order,
                                       const std::array<bool, 6>& wanted);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_JACOBIAN_HPP_
