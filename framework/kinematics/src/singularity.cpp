// SPDX-License-Identifier: Apache-2.0
#include "machine_impl.hpp"

#include <algorithm>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace kompono::kinematics {
namespace {

constexpr double kSingular = 1e-7;  ///< margin below which a pose is called singular

double SmallestSingularValue(const MatrixXd& M) {
  return M.size() == 0 ? 1.0 : Eigen::JacobiSVD<MatrixXd>(M).singularValues().minCoeff();
}

}  // namespace

std::vector<Singularity> Machine::Singularities(const VectorXd& z, const VectorXd& theta) const {
  std::vector<Singularity> out;
  for (const MechanismModel& mechanism : impl_->mechanisms) {
    if (mechanism.first_drive < 0) continue;
    Singularity here;
    here.block = BlockOf(*impl_, mechanism).name;
    const VectorXd x = LocalCoordinates(*impl_, mechanism, z);
    const VectorXd q =
        Evaluate(mechanism, plugin::Quantity::kDrives, x, VectorXd(), theta, {}).values;
    const Evaluation g = Evaluate(mechanism,
                                  plugin::Quantity::kClosure,
                                  x,
                                  q,
                                  theta,
                                  {.by_coordinates = true, .by_drives = true});
    const ScaledJacobian scaled = ScaleJacobians(mechanism, g.by_coordinates, g.by_drives);
    if (!scaled.A.allFinite() || !scaled.B.allFinite()) {
      here.margin = here.margin_a = here.margin_b = 0.0;
    } else {
      here.margin_a = SmallestSingularValue(scaled.A);
      here.margin_b = SmallestSingularValue(scaled.B);
      here.margin = std::min(here.margin_a, here.margin_b);
      here.det_a = scaled.A.rows() == scaled.A.cols() ? scaled.A.determinant() : 0.0;
      here.type = (here.margin_b < kSingular ? 1 : 0) + (here.margin_a < kSingular ? 2 : 0);
    }
    out.push_back(here);
  }
  return out;
}

}  // namespace kompono::kinematics
