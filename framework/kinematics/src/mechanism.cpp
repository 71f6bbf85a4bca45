// SPDX-License-Identifier: Apache-2.0
// One mechanism: evaluation through the contract.
#include "machine_impl.hpp"

#include <cmath>

namespace kompono::kinematics {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::span<const double> View(const VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<double> View(VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<double> View(RowMajor& m) {
  return {m.data(), static_cast<std::size_t>(m.size())};
}

}  // namespace

Evaluation Evaluate(const MechanismModel& mechanism,
                    plugin::Quantity quantity,
                    const VectorXd& x,
                    const VectorXd& q,
                    const VectorXd& theta,
                    Wanted wanted) {
  const plugin::MechanismShape shape = mechanism.code->Shape();
  const auto rows = static_cast<Eigen::Index>(plugin::RowsOf(shape, quantity));
  Evaluation out;
  out.values.resize(rows);
  RowMajor by_x(wanted.by_coordinates ? rows : 0, shape.coordinates);
  RowMajor by_q(wanted.by_drives ? rows : 0, shape.drives);
  RowMajor by_theta(wanted.by_parameters ? rows : 0, shape.parameters);
  const std::span<const double> parameters(theta.data() + mechanism.theta_module,
                                           static_cast<std::size_t>(shape.parameters));
  out.status = mechanism.code->Evaluate(quantity,
                                        {.coordinates = View(x),
                                         .drives = View(q),
                                         .parameters = parameters,
                                         .modes = mechanism.modes},
                                        {.values = View(out.values),
                                         .by_coordinates = View(by_x),
                                         .by_drives = View(by_q),
                                         .by_parameters = View(by_theta)});
  out.by_coordinates = by_x;
  out.by_drives = by_q;
  out.by_parameters = by_theta;
  return out;
}

ScaledJacobian ScaleJacobians(const MechanismModel& mechanism,
                              const MatrixXd& A,
                              const MatrixXd& B) {
  const std::string& letters = mechanism.description->letters;
  ScaledJacobian out{.A = A, .B = B, .row_scale = VectorXd::Ones(A.rows())};
  double linear = 0.0;
  double rotary = 0.0;
  for (int i = 0; i < A.rows(); ++i) {
    double translational = 0.0;
    for (int j = 0; j < A.cols(); ++j) {
      if (!IsRotaryLetter(letters[static_cast<std::size_t>(j)])) translational += A(i, j) * A(i, j);
    }
    const double scale = translational > 0.0 ? std::sqrt(translational) : A.row(i).norm();
    out.row_scale[i] = scale > 0.0 ? scale : 1.0;
    out.A.row(i) /= out.row_scale[i];
    if (out.B.size() > 0) out.B.row(i) /= out.row_scale[i];
  }
  int rotary_count = 0;
  for (int j = 0; j < A.cols(); ++j) {
    const bool turns = IsRotaryLetter(letters[static_cast<std::size_t>(j)]);
    (turns ? rotary : linear) += out.A.col(j).squaredNorm();
    rotary_count += turns ? 1 : 0;
  }
  const auto linear_count = static_cast<double>(A.cols() - rotary_count);
  if (rotary_count > 0 && linear_count > 0 && rotary > 0.0 && linear > 0.0) {
    out.length_mm = std::sqrt((rotary / rotary_count) / (linear / linear_count));
  }
  for (int j = 0; j < A.cols(); ++j) {
    if (IsRotaryLetter(letters[static_cast<std::size_t>(j)])) out.A.col(j) /= out.length_mm;
  }
  return out;
}

}  // namespace kompono::kinematics
