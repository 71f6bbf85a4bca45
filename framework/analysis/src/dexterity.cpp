// SPDX-License-Identifier: Apache-2.0
// One pose: exact derivatives, Eigen's decompositions.
#include "kompono/analysis/dexterity.hpp"

#include "mechanism_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace kompono::analysis {
namespace {

using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Columns (v, L ω) by the local coordinates.
Matrix6X ScaledTwists(const PoseJudge::Mechanism& mechanism, const VectorXd& x, double length) {
  const Values at = ValuesAt(mechanism, plugin::Quantity::kPlatform, x, VectorXd(), true);
  const Pose<double> X = Pose<double>::Read({at.value.data(), 12});
  Matrix6X twists(6, x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const VectorXd column = at.by_coordinates.col(i);
    const Pose<double> d = Pose<double>::Read({column.data(), 12});
    const Matrix3<double> W = d.R * X.R.transpose();
    twists.col(i) << d.p, length * 0.5 * (W(2, 1) - W(1, 2)), length * 0.5 * (W(0, 2) - W(2, 0)),
        length * 0.5 * (W(1, 0) - W(0, 1));
  }
  return twists;
}

bool Turns(const Matrix6X& twists) {
  return !twists.bottomRows<3>().isZero(1e-12);
}

/// Rotary drives count with the characteristic length.
void ScaleRotaryDrives(const PoseJudge::Mechanism& mechanism, double length, MatrixXd& by_x) {
  for (std::size_t i = 0; i < mechanism.description->drives.size(); ++i) {
    if (mechanism.description->drives[i].rotary) by_x.row(static_cast<Eigen::Index>(i)) *= length;
  }
}

}  // namespace

DexterityDetails DexterityAt(const PoseJudge& judge,
                             std::size_t mechanism,
                             const VectorXd& z,
                             double length_mm) {
  const PoseJudge::Mechanism& of = judge.mechanisms()[mechanism];
  const VectorXd x = LocalAt(of, z);
  DexterityDetails out;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  out.dexterity = {nan, nan, nan};
  const Values drives = ValuesAt(of, plugin::Quantity::kDrives, x, VectorXd(), true);
  if (!drives.value.allFinite() || !drives.by_coordinates.allFinite()) return out;
  MatrixXd by_x = drives.by_coordinates;
  ScaleRotaryDrives(of, length_mm, by_x);
  const Matrix6X twists = ScaledTwists(of, x, length_mm);
  const Eigen::HouseholderQR<Matrix6X> qr(twists);
  const Eigen::Index n = x.size();
  const MatrixXd Q = qr.householderQ() * MatrixXd::Identity(6, n);
  const MatrixXd R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const MatrixXd J =
      R.transpose().triangularView<Eigen::Lower>().solve(by_x.transpose()).transpose();
  if (!J.allFinite()) return out;
  const Eigen::JacobiSVD<MatrixXd> svd(J, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& s = svd.singularValues();
  const double least = s[s.size() - 1];
  out.dexterity = {
      .condition = least > 0.0 ? s[0] / least : std::numeric_limits<double>::infinity(),
      .weakest_force = least,
      .slowest_velocity = 1.0 / s[0]};
  for (Eigen::Index i = s.size() - 1; i >= 0; --i) {
    out.axes.push_back(
        {.twist = Q * svd.matrixV().col(i),
         .velocity = s[i] > 0.0 ? 1.0 / s[i] : std::numeric_limits<double>::infinity(),
         .force = s[i]});
  }
  return out;
}

double CharacteristicLength(const PoseJudge& judge, std::size_t mechanism) {
  const VectorXd home = judge.machine().home();
  const PoseJudge::Mechanism& of = judge.mechanisms()[mechanism];
  const Matrix6X twists = ScaledTwists(of, LocalAt(of, home), 1.0);
  if (!Turns(twists) || twists.topRows<3>().isZero(1e-12)) return 1.0;
  const auto condition = [&](double log_length) {
    return DexterityAt(judge, mechanism, home, std::exp(log_length)).dexterity.condition;
  };
  // Golden section; the condition falls to one valley and rises again.
  double from = std::log(1e-3);
  double to = std::log(1e6);
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = to - golden * (to - from);
  double b = from + golden * (to - from);
  double at_a = condition(a);
  double at_b = condition(b);
  while (to - from > 1e-4) {
    if (!(at_a > at_b)) {
      to = b;
      b = a;
      at_b = at_a;
      a = to - golden * (to - from);
      at_a = condition(a);
    } else {
      from = a;
      a = b;
      at_a = at_b;
      b = from + golden * (to - from);
      at_b = condition(b);
    }
  }
  return std::exp(0.5 * (from + to));
}

}  // namespace kompono::analysis
