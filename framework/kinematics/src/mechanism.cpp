// SPDX-License-Identifier: Apache-2.0
// One mechanism: evaluation through the contract, and x from its drives.
#include "machine_impl.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace kompono::kinematics {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kSingularBelow = 1e-9;  ///< reciprocal condition number of the scaled A
constexpr int kNewtonSteps = 40;
constexpr int kContinuationSteps = 400;

std::size_t RowsOf(const plugin::MechanismShape& shape, plugin::Quantity quantity) {
  switch (quantity) {
    case plugin::Quantity::kPlatform:
      return 12;
    case plugin::Quantity::kDrives:
    case plugin::Quantity::kReach:
      return static_cast<std::size_t>(shape.drives);
    case plugin::Quantity::kClosure:
      return static_cast<std::size_t>(shape.closures);
    case plugin::Quantity::kSkeleton:
      return 3 * static_cast<std::size_t>(shape.points);
    case plugin::Quantity::kCoordinates:
    case plugin::Quantity::kHome:
      return static_cast<std::size_t>(shape.coordinates);
  }
  return 0;
}

std::span<const double> View(const VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<double> View(VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<double> View(RowMajor& m) {
  return {m.data(), static_cast<std::size_t>(m.size())};
}

/// Closure, A and the scaled residual at one point.
struct Linearisation {
  VectorXd g_mm;  ///< rows scaled to mm
  MatrixXd A;     ///< rows scaled, rotary columns as they are (mm per mm, mm per rad)
  double det = 0.0;      ///< of the fully scaled A
  double regular = 0.0;  ///< reciprocal condition number of the fully scaled A, 0 = singular
  double length_mm = 1.0;
  bool finite = true;
};

Linearisation Linearise(const MechanismModel& mechanism,
                        const VectorXd& x,
                        const VectorXd& q,
                        const VectorXd& theta) {
  const Evaluation at =
      Evaluate(mechanism, plugin::Quantity::kClosure, x, q, theta, {.by_coordinates = true});
  Linearisation out;
  out.finite =
      at.status == plugin::Status::kOk && at.values.allFinite() && at.by_coordinates.allFinite();
  if (!out.finite) return out;
  const ScaledJacobian scaled = ScaleJacobians(mechanism, at.by_coordinates, MatrixXd());
  out.length_mm = scaled.length_mm;
  out.g_mm = at.values.cwiseQuotient(scaled.row_scale);
  out.A = at.by_coordinates;
  for (int i = 0; i < out.A.rows(); ++i) out.A.row(i) /= scaled.row_scale[i];
  const Eigen::PartialPivLU<MatrixXd> lu(scaled.A);
  out.det = lu.determinant();
  out.regular = lu.rcond();
  return out;
}

/// Scale of positions: what a rounding error is measured against.
double SizeOf(const VectorXd& x, const VectorXd& q) {
  return std::max({1.0,
                   q.size() > 0 ? q.cwiseAbs().maxCoeff() : 0.0,
                   x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0});
}

/// Damped Newton on the closure at fixed drives.
MechanismSolution Newton(const MechanismModel& mechanism,
                         const VectorXd& q,
                         const VectorXd& theta,
                         const VectorXd& x_start) {
  MechanismSolution out;
  out.x = x_start;
  Linearisation here = Linearise(mechanism, out.x, q, theta);
  for (out.iterations = 0; out.iterations < kNewtonSteps && here.finite; ++out.iterations) {
    out.residual = here.g_mm.cwiseAbs().maxCoeff();
    if (here.regular < kSingularBelow) {
      out.status = SolveStatus::kSingular;
      return out;
    }
    const VectorXd step = -here.A.partialPivLu().solve(here.g_mm);
    double largest = 0.0;
    for (int i = 0; i < step.size(); ++i) {
      const bool rotary =
          IsRotaryLetter(mechanism.description->letters[static_cast<std::size_t>(i)]);
      largest = std::max(largest, std::abs(step[i]) * (rotary ? here.length_mm : 1.0));
    }
    const double size = SizeOf(out.x, q);
    if (largest <= 1e-14 * size || out.residual <= 2e-16 * size) {
      out.status = SolveStatus::kConverged;
      return out;
    }
    const double norm = here.g_mm.norm();
    double fraction = std::min(1.0, 0.5 * std::max(here.length_mm, 0.1 * size) / largest);
    bool better = false;
    for (int halving = 0; halving < 12 && !better; ++halving, fraction *= 0.5) {
      const VectorXd trial = out.x + fraction * step;
      const Linearisation there = Linearise(mechanism, trial, q, theta);
      better = there.finite && there.g_mm.norm() < norm;
      if (better) {
        out.x = trial;
        here = there;
      }
    }
    if (!better) {  // at the floor of rounding, or stuck
      if (out.residual <= 1e-12 * size) out.status = SolveStatus::kConverged;
      return out;
    }
  }
  return out;
}

/// Follows the solution from the drives of the start to the wanted ones, in steps small enough for
/// Newton to stay on the branch: det A keeps its sign and x moves little.
MechanismSolution Continue(const MechanismModel& mechanism,
                           const VectorXd& q,
                           const VectorXd& theta,
                           const VectorXd& x_start) {
  const Evaluation start = Evaluate(mechanism, plugin::Quantity::kDrives, x_start, {}, theta, {});
  MechanismSolution out;
  out.x = x_start;
  if (start.status != plugin::Status::kOk || !start.values.allFinite()) return out;
  const double sign = Linearise(mechanism, x_start, start.values, theta).det;
  double done = 0.0;
  double step = 0.125;
  int iterations = 0;
  for (int count = 0; count < kContinuationSteps && done < 1.0; ++count) {
    const double next = std::min(1.0, done + step);
    const MechanismSolution trial =
        Newton(mechanism, start.values + next * (q - start.values), theta, out.x);
    iterations += trial.iterations;
    const bool kept =
        trial.status == SolveStatus::kConverged && trial.iterations <= 6 &&
        Linearise(mechanism, trial.x, start.values + next * (q - start.values), theta).det * sign >
            0.0;
    if (kept) {
      out = trial;
      done = next;
      step *= 2.0;
    } else {
      step *= 0.5;
      if (step < 1e-5) {
        out.status = trial.status == SolveStatus::kSingular ? SolveStatus::kSingular
                                                            : SolveStatus::kNoConvergence;
        break;
      }
    }
  }
  out.iterations = iterations;
  if (done < 1.0 && out.status == SolveStatus::kConverged) out.status = SolveStatus::kNoConvergence;
  return out;
}

MechanismSolution ClosedForm(const MechanismModel& mechanism,
                             const VectorXd& q,
                             const VectorXd& theta,
                             const VectorXd& x) {
  MechanismSolution out;
  out.x = x;
  if (!x.allFinite()) {
    out.status = SolveStatus::kOutOfReach;
    out.message = "the legs do not meet at these drive positions";
    return out;
  }
  const Linearisation at = Linearise(mechanism, x, q, theta);
  out.residual = at.finite ? at.g_mm.cwiseAbs().maxCoeff() : INFINITY;
  if (out.residual <= 1e-9 * SizeOf(x, q)) {
    out.status = SolveStatus::kConverged;
  } else {
    out.message =
        fmt::format("the closed-form solution leaves {:.3g} mm in the loops", out.residual);
  }
  return out;
}

}  // namespace

Evaluation Evaluate(const MechanismModel& mechanism,
                    plugin::Quantity quantity,
                    const VectorXd& x,
                    const VectorXd& q,
                    const VectorXd& theta,
                    Wanted wanted) {
  const plugin::MechanismShape shape = mechanism.code->Shape();
  const auto rows = static_cast<Eigen::Index>(RowsOf(shape, quantity));
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

MechanismSolution SolveMechanism(const MechanismModel& mechanism,
                                 const VectorXd& q,
                                 const VectorXd& theta,
                                 const VectorXd& x_start) {
  const Evaluation closed =
      Evaluate(mechanism, plugin::Quantity::kCoordinates, x_start, q, theta, {});
  if (closed.status == plugin::Status::kOk) return ClosedForm(mechanism, q, theta, closed.values);
  MechanismSolution out = Newton(mechanism, q, theta, x_start);
  const Evaluation start = Evaluate(mechanism, plugin::Quantity::kDrives, x_start, {}, theta, {});
  const bool start_known = start.status == plugin::Status::kOk && start.values.allFinite();
  const auto same_branch = [&](const MechanismSolution& solution) {
    if (!start_known) return true;
    const double before = Linearise(mechanism, x_start, start.values, theta).det;
    return before * Linearise(mechanism, solution.x, q, theta).det > 0.0;
  };
  if (out.status == SolveStatus::kConverged && same_branch(out)) return out;
  const bool strayed = out.status == SolveStatus::kConverged;
  const MechanismSolution followed = Continue(mechanism, q, theta, x_start);
  if (followed.status == SolveStatus::kConverged) return followed;
  out.x = followed.x;
  out.iterations += followed.iterations;
  out.status = strayed ? SolveStatus::kOtherAssemblyMode : followed.status;
  out.message =
      strayed ? "these drive positions belong to another assembly mode than the start; "
                "give a start on the wanted branch (home in the layout)"
      : out.status == SolveStatus::kSingular
          ? "det A vanishes on the way from the start to these drive positions (type 2 singularity)"
          : "Newton's iteration did not close the loops; the drives may be out of reach of one "
            "another";
  return out;
}

}  // namespace kompono::kinematics
