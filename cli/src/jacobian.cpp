// SPDX-License-Identifier: Apache-2.0
#include "jacobian.hpp"

#include <algorithm>

#include <Eigen/QR>

#include "kompono/geometry/pose.hpp"

namespace kompono::cli {
namespace {

using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

constexpr double kRadianLengthMm = 100.0;
constexpr double kRank = 1e-9;  ///< relative threshold below which a direction does not count

/// ω = E (Ȧ, Ḃ, Ċ)
Eigen::Matrix3d RatesToOmega(const kinematics::PoseNumbers& pose, layout::RotationOrder order) {
  Eigen::Matrix3d E;
  if (order == layout::RotationOrder::kXYZ) {
    const Eigen::Matrix3d R_a = RotationX(pose.value[3]);
    const Eigen::Matrix3d R_ab = R_a * RotationY(pose.value[4]);
    E << Eigen::Vector3d::UnitX(), R_a.col(1), R_ab.col(2);
  } else {
    const Eigen::Matrix3d R_c = RotationZ(pose.value[5]);
    const Eigen::Matrix3d R_cb = R_c * RotationY(pose.value[4]);
    E << R_cb.col(0), R_c.col(1), Eigen::Vector3d::UnitZ();
  }
  return E;
}

Eigen::MatrixXd Rows(const Matrix6X& J, const std::vector<std::size_t>& rows) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), J.cols());
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) = J.row(static_cast<Eigen::Index>(rows[i]));
  return out;
}

/// Independent rows; what is small against `size`, an entry of the whole matrix, is rounding.
Eigen::Index RankOf(const Eigen::MatrixXd& J, double size) {
  if (J.size() == 0) return 0;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J);
  return (qr.matrixQR().diagonal().cwiseAbs().array() > kRank * size).count();
}

}  // namespace

DriveJacobian JacobianOf(const kinematics::Machine& machine,
                         const Eigen::VectorXd& z,
                         layout::RotationOrder order,
                         const std::array<bool, 6>& wanted) {
  const Eigen::VectorXd theta = machine.nominal();
  kinematics::PoseDerivatives derivatives;
  const Pose<double> X_WT = machine.ToolPose(z, theta, &derivatives);
  Matrix6X pose_by_z = derivatives.by_coordinates;
  const Eigen::Matrix3d E = RatesToOmega(kinematics::NumbersFromPose(X_WT, order), order);
  pose_by_z.bottomRows<3>() =
      E.completeOrthogonalDecomposition().solve(pose_by_z.bottomRows<3>().eval());
  // Millimetres and radians are made comparable on both sides.
  pose_by_z.bottomRows<3>() *= kRadianLengthMm;
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(z.size());
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    if (machine.coordinates()[i].rotary) scale[static_cast<Eigen::Index>(i)] /= kRadianLengthMm;
  }
  const Matrix6X scaled = pose_by_z * scale.asDiagonal();
  const double size = scaled.size() == 0 ? 0.0 : scaled.cwiseAbs().maxCoeff();

  DriveJacobian out;
  for (std::size_t k = 0; k < 6; ++k) {
    if (wanted[k]) out.components.push_back(k);
  }
  Eigen::Index rank = RankOf(Rows(scaled, out.components), size);
  for (const std::size_t k : {3U, 4U, 5U, 0U, 1U, 2U}) {
    if (wanted[k]) continue;
    std::vector<std::size_t> more = out.components;
    more.push_back(k);
    const Eigen::Index with = RankOf(Rows(scaled, more), size);
    if (with <= rank) continue;
    rank = with;
    out.components = std::move(more);
  }
  std::sort(out.components.begin(), out.components.end());

  Eigen::VectorXd readings;
  Eigen::MatrixXd readings_by_z;
  machine.DrivesOf(z, theta, &readings, nullptr, &readings_by_z);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kRank);
  solver.compute(Rows(scaled, out.components));
  const Eigen::MatrixXd inverse = solver.pseudoInverse();
  out.matrix = readings_by_z * scale.asDiagonal() * inverse;
  for (std::size_t i = 0; i < out.components.size(); ++i) {
    if (out.components[i] > 2) out.matrix.col(static_cast<Eigen::Index>(i)) *= kRadianLengthMm;
  }
  return out;
}

}  // namespace kompono::cli
