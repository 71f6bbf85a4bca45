// SPDX-License-Identifier: Apache-2.0
// Pose -> coordinates by Newton on SE(3), coordinates <-> readings mechanism by mechanism.
#include "machine_impl.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace kompono::kinematics {
namespace {

constexpr double kDegPerRad = 57.295779513082320877;
constexpr double kRadianLength_mm =
    100.0;  ///< what a radian weighs where millimetres and radians are compared
constexpr int kIterations = 60;

/// Which pose components are asked for, and how their error is measured.
struct Rows {
  std::vector<int> components;  ///< of X Y Z A B C
  bool full_rotation = false;  ///< A, B and C together: the rotation vector, free of gimbal trouble
};

/// ∂(X Y Z A B C)/∂z in pose numbers, from the twist.
Matrix6X NumbersJacobian(const Pose<double>& X,
                         const Matrix6X& twist,
                         layout::RotationOrder order) {
  const PoseNumbers numbers = NumbersFromPose(X, order);
  const double a = numbers.value[3];
  const double b = numbers.value[4];
  const double c = numbers.value[5];
  Matrix3<double> E;  // ω = E (ȧ, ḃ, ċ)
  if (order == layout::RotationOrder::kXYZ) {
    const Matrix3<double> Ra = RotationX(a);
    const Matrix3<double> Rab = Ra * RotationY(b);
    E << Vector3<double>::UnitX(), Ra.col(1), Rab.col(2);
  } else {
    const Matrix3<double> Rc = RotationZ(c);
    const Matrix3<double> Rcb = Rc * RotationY(b);
    E << Rcb.col(0), Rc.col(1), Vector3<double>::UnitZ();
  }
  Matrix6X out = twist;
  out.bottomRows<3>() = E.completeOrthogonalDecomposition().solve(twist.bottomRows<3>().eval());
  return out;
}

double Weight(int component) {
  return component < 3 ? 1.0 : kRadianLength_mm;
}

MatrixXd WeightedRows(const Matrix6X& J, const std::vector<int>& components) {
  MatrixXd out(static_cast<Eigen::Index>(components.size()), J.cols());
  for (std::size_t i = 0; i < components.size(); ++i) {
    out.row(static_cast<Eigen::Index>(i)) = J.row(components[i]) * Weight(components[i]);
  }
  return out;
}

Eigen::Index RankOf(const MatrixXd& J, const VectorXd& column_scale) {
  if (J.rows() == 0) return 0;
  const Eigen::JacobiSVD<MatrixXd> svd(J * column_scale.asDiagonal());
  const double largest = svd.singularValues()[0];
  Eigen::Index rank = 0;
  for (const double value : svd.singularValues())
    rank += value > 1e-9 * std::max(largest, 1e-300) ? 1 : 0;
  return rank;
}

VectorXd ColumnScale(const Machine::Impl& impl) {
  VectorXd scale(static_cast<Eigen::Index>(impl.coordinates.size()));
  for (std::size_t i = 0; i < impl.coordinates.size(); ++i) {
    scale[static_cast<Eigen::Index>(i)] = impl.coordinates[i].rotary ? 1.0 / kRadianLength_mm : 1.0;
  }
  return scale;
}

/// The given components, and every further one that the machine controls besides them.
Rows ChooseRows(const PoseTarget& target, const Matrix6X& J, const VectorXd& column_scale) {
  Rows rows;
  for (int k = 0; k < 6; ++k) {
    if (target.component[static_cast<std::size_t>(k)]) rows.components.push_back(k);
  }
  Eigen::Index rank = RankOf(WeightedRows(J, rows.components), column_scale);
  for (const int k : {3, 4, 5, 0, 1, 2}) {
    if (target.component[static_cast<std::size_t>(k)] || rank == J.cols()) continue;
    std::vector<int> more = rows.components;
    more.push_back(k);
    const Eigen::Index with = RankOf(WeightedRows(J, more), column_scale);
    if (with > rank) {
      rank = with;
      rows.components = std::move(more);
    }
  }
  std::sort(rows.components.begin(), rows.components.end());
  rows.full_rotation = std::count_if(rows.components.begin(), rows.components.end(), [](int k) {
                         return k > 2;
                       }) == 3;
  return rows;
}

struct Error {
  VectorXd weighted;
  MatrixXd J;
  double largest = 0.0;  ///< mm or rad
};

Error ErrorAt(const Machine::Impl& impl,
              const Rows& rows,
              const PoseNumbers& wanted,
              layout::RotationOrder order,
              const VectorXd& z,
              const VectorXd& theta) {
  PoseDerivatives derivatives;
  const Pose<double> X = ChainPose(impl, z, theta, &derivatives);
  Error out;
  Eigen::Matrix<double, 6, 1> error;
  Matrix6X J = derivatives.by_coordinates;
  const PoseNumbers now = NumbersFromPose(X, order);
  for (int k = 0; k < 6; ++k) {
    const auto i = static_cast<std::size_t>(k);
    error[k] = wanted.value[i] - now.value[i];
    if (k > 2) error[k] = std::remainder(error[k], 2.0 * EIGEN_PI);
  }
  if (rows.full_rotation) {
    const Eigen::AngleAxisd turn(PoseFromNumbers(wanted, order).R * X.R.transpose());
    error.tail<3>() = turn.angle() * turn.axis();
  } else {
    J = NumbersJacobian(X, derivatives.by_coordinates, order);
  }
  out.J = WeightedRows(J, rows.components);
  out.weighted.resize(out.J.rows());
  for (std::size_t i = 0; i < rows.components.size(); ++i) {
    const int k = rows.components[i];
    out.weighted[static_cast<Eigen::Index>(i)] = error[k] * Weight(k);
    out.largest = std::max(out.largest, std::abs(error[k]));
  }
  return out;
}

/// Least-norm Newton step in scaled coordinates, limited to what a linearisation can be trusted
/// for.
VectorXd StepOf(const Error& error, const VectorXd& column_scale) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(1e-10);
  solver.compute(error.J * column_scale.asDiagonal());
  VectorXd scaled = solver.solve(error.weighted);
  for (Eigen::Index i = 0; i < scaled.size(); ++i) {
    if (column_scale[i] == 1.0) continue;
    const double most = 0.5 * kRadianLength_mm;  // half a radian
    if (std::abs(scaled[i]) > most) scaled *= most / std::abs(scaled[i]);
  }
  return column_scale.asDiagonal() * scaled;
}

std::string OverdeterminedMessage(const Machine::Impl& impl,
                                  const PoseTarget& target,
                                  double left,
                                  bool angle) {
  int given = 0;
  for (const auto& component : target.component) given += component ? 1 : 0;
  return fmt::format(
      "{} pose components were given, but the machine has {} coordinates and cannot meet them all: "
      "{:.6g} {} are left; "
      "give fewer components",
      given,
      impl.coordinates.size(),
      angle ? left * kDegPerRad : left,
      angle ? "deg" : "mm or rad");
}

}  // namespace

VectorXd LocalCoordinates(const Machine::Impl& impl,
                          const MechanismModel& mechanism,
                          const VectorXd& z) {
  const layout::Block& block = BlockOf(impl, mechanism);
  VectorXd x(static_cast<Eigen::Index>(mechanism.coordinate.size()));
  for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
    x[static_cast<Eigen::Index>(i)] = block.letters[i].sign * z[mechanism.coordinate[i]];
  }
  return x;
}

const layout::Block& BlockOf(const Machine::Impl& impl, const MechanismModel& mechanism) {
  return impl.layout().blocks[static_cast<std::size_t>(mechanism.block)];
}

VectorXd DriveCoordinates(const Machine::Impl& impl,
                          const MechanismModel& mechanism,
                          const VectorXd& readings,
                          const VectorXd& theta) {
  const layout::Block& block = BlockOf(impl, mechanism);
  VectorXd q(static_cast<Eigen::Index>(block.drives.size()));
  for (std::size_t i = 0; i < block.drives.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    q[k] = theta[mechanism.theta_zero + k] +
           block.drives[i].sign * readings[mechanism.first_drive + k];
  }
  return q;
}

void SetAxes(const Machine::Impl& impl,
             const VectorXd& readings,
             const VectorXd& theta,
             VectorXd& z) {
  for (const AxisModel& axis : impl.axes) {
    if (axis.coordinate < 0) continue;
    const int sign = impl.layout().axes[static_cast<std::size_t>(axis.axis)].drive.sign;
    z[axis.coordinate] = theta[axis.theta_zero] + sign * readings[axis.drive];
  }
}

void Machine::DrivesOf(const VectorXd& z,
                       const VectorXd& theta,
                       VectorXd* readings,
                       VectorXd* reach,
                       MatrixXd* by_coordinates) const {
  const auto count = static_cast<Eigen::Index>(impl_->drives.size());
  readings->resize(count);
  if (reach != nullptr) reach->setConstant(count, std::numeric_limits<double>::infinity());
  if (by_coordinates != nullptr) by_coordinates->setZero(count, z.size());
  for (const AxisModel& axis : impl_->axes) {
    if (axis.coordinate < 0) continue;
    const int sign = layout().axes[static_cast<std::size_t>(axis.axis)].drive.sign;
    (*readings)[axis.drive] = sign * (z[axis.coordinate] - theta[axis.theta_zero]);
    if (by_coordinates != nullptr) (*by_coordinates)(axis.drive, axis.coordinate) = sign;
  }
  for (const MechanismModel& mechanism : impl_->mechanisms) {
    if (mechanism.first_drive < 0) continue;
    const layout::Block& block = BlockOf(*impl_, mechanism);
    const VectorXd x = LocalCoordinates(*impl_, mechanism, z);
    const Evaluation q = Evaluate(mechanism,
                                  plugin::Quantity::kDrives,
                                  x,
                                  VectorXd(),
                                  theta,
                                  {.by_coordinates = by_coordinates != nullptr});
    Evaluation margin;
    if (reach != nullptr)
      margin = Evaluate(mechanism, plugin::Quantity::kReach, x, VectorXd(), theta, {});
    for (std::size_t i = 0; i < block.drives.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const Eigen::Index row = mechanism.first_drive + k;
      const int sign = block.drives[i].sign;
      (*readings)[row] = sign * (q.values[k] - theta[mechanism.theta_zero + k]);
      if (reach != nullptr) (*reach)[row] = margin.values[k];
      for (std::size_t j = 0; by_coordinates != nullptr && j < mechanism.coordinate.size(); ++j) {
        (*by_coordinates)(row, mechanism.coordinate[j]) =
            sign * block.letters[j].sign * q.by_coordinates(k, static_cast<Eigen::Index>(j));
      }
    }
  }
}

Solution Machine::CoordinatesOf(const VectorXd& readings,
                                const VectorXd& theta,
                                const VectorXd& start) const {
  Solution out;
  out.status = SolveStatus::kConverged;
  out.coordinates = start;
  out.drives = readings;
  SetAxes(*impl_, readings, theta, out.coordinates);
  for (const MechanismModel& mechanism : impl_->mechanisms) {
    if (mechanism.first_drive < 0) continue;
    const layout::Block& block = BlockOf(*impl_, mechanism);
    const VectorXd q = DriveCoordinates(*impl_, mechanism, readings, theta);
    const MechanismSolution solved =
        SolveMechanism(*impl_, mechanism, q, theta, LocalCoordinates(*impl_, mechanism, start));
    for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
      out.coordinates[mechanism.coordinate[i]] =
          block.letters[i].sign * solved.x[static_cast<Eigen::Index>(i)];
    }
    out.iterations = std::max(out.iterations, solved.iterations);
    out.residual = std::max(out.residual, solved.residual);
    if (solved.status != SolveStatus::kConverged && out.status == SolveStatus::kConverged) {
      out.status = solved.status;
      out.message = fmt::format("{}: {}", block.name, solved.message);
    }
  }
  return out;
}

Solution Machine::Forward(const VectorXd& readings,
                          const VectorXd& theta,
                          const VectorXd& start) const {
  Solution out = CoordinatesOf(readings, theta, start);
  out.X_WT = ToolPose(out.coordinates, theta);
  VectorXd again;
  DrivesOf(out.coordinates, theta, &again, &out.reach);
  return out;
}

namespace {

/// A pose that is asked for; z is sought.
struct PoseProblem {
  const Machine& machine;
  const Machine::Impl& impl;
  const VectorXd& theta;
  Rows rows;
  PoseNumbers wanted;
  layout::RotationOrder order = layout::RotationOrder::kXYZ;
  VectorXd column_scale;
  double size = 1.0;  ///< mm; what errors are small against

  [[nodiscard]] Error At(const VectorXd& z) const {
    return ErrorAt(impl, rows, wanted, order, z, theta);
  }
};

/// Damped Newton from z; the error where it ends.
Error Converge(const PoseProblem& problem, VectorXd& z, int& iterations) {
  Error here = problem.At(z);
  for (; iterations < kIterations && here.weighted.allFinite(); ++iterations) {
    if (here.largest <= 1e-15 * problem.size) break;
    const VectorXd step = StepOf(here, problem.column_scale);
    double fraction = 1.0;
    bool better = false;
    for (int halving = 0; halving < 16 && !better; ++halving, fraction *= 0.5) {
      const VectorXd trial = z + fraction * step;
      Error there = problem.At(trial);
      better = there.weighted.allFinite() && there.weighted.norm() < here.weighted.norm();
      if (better) {
        z = trial;
        here = std::move(there);
      } else if (here.largest <= 1e-12 * problem.size) {
        break;  // nothing but rounding is left
      }
    }
    if (!better) break;
  }
  return here;
}

bool IsMet(const PoseProblem& problem, const Error& error) {
  return error.largest <= 1e-10 * problem.size;
}

/// How far z is from what drives reach and from the ranges of drives and coordinates, in parts of
/// the size and radians; 0 if all is kept.
double Violation(const PoseProblem& problem, const VectorXd& z) {
  VectorXd readings;
  VectorXd reach;
  problem.machine.DrivesOf(z, problem.theta, &readings, &reach);
  const auto beyond = [&](const auto& of, double value) {
    const double unit = of.rotary ? 1.0 : problem.size;
    return (of.lower ? std::max(0.0, *of.lower - value) / unit : 0.0) +
           (of.upper ? std::max(0.0, value - *of.upper) / unit : 0.0);
  };
  double sum = 0.0;
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    if (reach[i] < 0.0) {
      sum += std::sqrt(-reach[i]) / problem.size;
    } else if (!std::isfinite(readings[i])) {
      sum += 1.0;
    } else {
      sum += beyond(problem.impl.drives[static_cast<std::size_t>(i)], readings[i]);
    }
  }
  for (Eigen::Index i = 0; i < z.size(); ++i)
    sum += beyond(problem.impl.coordinates[static_cast<std::size_t>(i)], z[i]);
  return sum;
}

/// Directions in which the coordinates move without the pose: the columns, in scaled coordinates.
MatrixXd FreeDirections(const PoseProblem& problem, const Error& error) {
  const MatrixXd J = error.J * problem.column_scale.asDiagonal();
  const Eigen::JacobiSVD<MatrixXd> svd(J, Eigen::ComputeFullV);
  const VectorXd& gain = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < gain.size() && gain[rank] > 1e-9 * gain[0]) ++rank;
  return svd.matrixV().rightCols(J.cols() - rank);
}

/// Where coordinates are left over, several settings give the pose: from one that breaks a limit
/// this looks for one that keeps all, along the free directions with steps that grow and shrink.
void MoveWithinLimits(const PoseProblem& problem, VectorXd& z, Error& error, double& violation) {
  double step = 0.1;  // of the size, or rad
  for (int trial = 0; trial < 100 && violation > 0.0 && step > 1e-4;) {
    const MatrixXd free = FreeDirections(problem, error);
    bool better = false;
    for (Eigen::Index k = 0; k < 2 * free.cols() && !better; ++k, ++trial) {
      const VectorXd along = problem.column_scale.cwiseProduct(free.col(k / 2));
      double longest = 0.0;
      for (Eigen::Index i = 0; i < along.size(); ++i) {
        const bool turns = problem.impl.coordinates[static_cast<std::size_t>(i)].rotary;
        longest = std::max(longest, std::abs(along[i]) / (turns ? 1.0 : problem.size));
      }
      VectorXd moved = z + (k % 2 == 0 ? step : -step) / longest * along;
      int iterations = 0;
      Error there = Converge(problem, moved, iterations);
      const double left = IsMet(problem, there) ? Violation(problem, moved) : violation;
      better = left < violation;
      if (!better) continue;
      z = moved;
      error = std::move(there);
      violation = left;
    }
    if (free.cols() == 0) return;
    step = better ? std::min(0.4, 1.5 * step) : 0.5 * step;
  }
}

/// Three turns can give one rotation in two ways, and a wrist that starts stretched out may end in
/// the wrong one: where a limit is broken, starts on either side of `start` are tried too.
void TryOtherTurns(const PoseProblem& problem,
                   const VectorXd& start,
                   VectorXd& z,
                   Error& error,
                   double& violation) {
  const auto& coordinates = problem.impl.coordinates;
  const auto turns =
      std::count_if(coordinates.begin(), coordinates.end(), [](const auto& c) { return c.rotary; });
  if (turns < 3) return;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    for (const double turn : {0.5, -0.5}) {
      if (violation == 0.0) return;
      if (!coordinates[i].rotary) continue;
      VectorXd other = start;
      other[static_cast<Eigen::Index>(i)] += turn;
      int iterations = 0;
      Error there = Converge(problem, other, iterations);
      if (!IsMet(problem, there)) continue;
      const double left = Violation(problem, other);
      if (left >= violation) continue;
      violation = left;
      z = other;
      error = std::move(there);
    }
  }
}

/// Of the settings that give the pose, one that keeps what limits there are, if one is found.
void KeepLimits(const PoseProblem& problem, const VectorXd& start, VectorXd& z, Error& error) {
  double violation = Violation(problem, z);
  if (violation > 0.0) MoveWithinLimits(problem, z, error, violation);
  if (violation > 0.0) TryOtherTurns(problem, start, z, error, violation);
}

}  // namespace

Solution Machine::Inverse(const PoseTarget& target,
                          const VectorXd& theta,
                          const VectorXd& start) const {
  const Impl& impl = *impl_;
  Solution out;
  out.coordinates = start;
  out.status = SolveStatus::kConverged;
  PoseDerivatives at_start;
  const Pose<double> X_start = ChainPose(impl, start, theta, &at_start);
  PoseProblem problem{.machine = *this,
                      .impl = impl,
                      .theta = theta,
                      .wanted = NumbersFromPose(X_start, target.order),
                      .order = target.order,
                      .column_scale = ColumnScale(impl)};
  problem.rows = ChooseRows(target,
                            NumbersJacobian(X_start, at_start.by_coordinates, target.order),
                            problem.column_scale);
  for (std::size_t k = 0; k < 6; ++k)
    problem.wanted.value[k] = target.component[k].value_or(problem.wanted.value[k]);
  for (std::size_t k = 0; k < 3; ++k)
    problem.size = std::max(problem.size, std::abs(problem.wanted.value[k]));
  if (!problem.rows.components.empty()) {
    Error here = Converge(problem, out.coordinates, out.iterations);
    if (IsMet(problem, here)) KeepLimits(problem, start, out.coordinates, here);
    out.residual = here.largest;
    if (!IsMet(problem, here)) {
      const bool too_many = RankOf(here.J, problem.column_scale) < here.J.rows();
      out.status = too_many ? SolveStatus::kOverdetermined : SolveStatus::kNoConvergence;
      out.message = too_many
                        ? OverdeterminedMessage(impl, target, here.largest, false)
                        : fmt::format("the pose could not be reached: {:.6g} mm or rad are left",
                                      here.largest);
    }
  }
  out.X_WT = ToolPose(out.coordinates, theta);
  DrivesOf(out.coordinates, theta, &out.drives, &out.reach);
  for (Eigen::Index i = 0; i < out.drives.size() && out.ok(); ++i) {
    if (out.reach[i] >= 0.0 && std::isfinite(out.drives[i])) continue;
    out.status = SolveStatus::kOutOfReach;
    out.message = fmt::format(
        "{} is out of reach by {:.6g} mm²: its strut is too short by {:.6g} mm² under the root",
        impl.drives[static_cast<std::size_t>(i)].name,
        -out.reach[i],
        -out.reach[i]);
  }
  return out;
}

MeasuredPose Machine::Measure(const VectorXd& readings,
                              const VectorXd& theta,
                              const VectorXd& start,
                              bool with_derivatives) const {
  const Solution forward = CoordinatesOf(readings, theta, start);
  MeasuredPose out;
  out.status = forward.status;
  out.coordinates = forward.coordinates;
  if (out.status != SolveStatus::kConverged) return out;
  if (!with_derivatives) {
    out.X_WT = ToolPose(forward.coordinates, theta);
    return out;
  }
  PoseDerivatives derivatives;
  out.X_WT = ToolPose(forward.coordinates, theta, &derivatives);
  out.by_parameters = derivatives.by_parameters;
  out.by_readings.setZero(6, readings.size());
  for (const AxisModel& axis : impl_->axes) {
    if (axis.coordinate < 0) continue;
    const int sign = layout().axes[static_cast<std::size_t>(axis.axis)].drive.sign;
    out.by_readings.col(axis.drive) += sign * derivatives.by_coordinates.col(axis.coordinate);
    out.by_parameters.col(axis.theta_zero) += derivatives.by_coordinates.col(axis.coordinate);
  }
  for (const MechanismModel& mechanism : impl_->mechanisms) {
    if (mechanism.first_drive < 0) continue;
    const layout::Block& block = BlockOf(*impl_, mechanism);
    const VectorXd q = DriveCoordinates(*impl_, mechanism, readings, theta);
    const Evaluation g =
        Evaluate(mechanism,
                 plugin::Quantity::kClosure,
                 LocalCoordinates(*impl_, mechanism, forward.coordinates),
                 q,
                 theta,
                 {.by_coordinates = true, .by_drives = true, .by_parameters = true});
    // g(x, q, θ) = 0 stays so: dx = -A⁻¹ (B dq + ∂g/∂θ dθ)
    const Eigen::PartialPivLU<MatrixXd> A(g.by_coordinates);
    const MatrixXd x_by_q = -A.solve(g.by_drives);
    const MatrixXd x_by_theta = -A.solve(g.by_parameters);
    Matrix6X twist(6, static_cast<Eigen::Index>(mechanism.coordinate.size()));
    for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
      twist.col(static_cast<Eigen::Index>(i)) =
          block.letters[i].sign * derivatives.by_coordinates.col(mechanism.coordinate[i]);
    }
    out.by_parameters.middleCols(mechanism.theta_module, x_by_theta.cols()) += twist * x_by_theta;
    const Matrix6X by_q = twist * x_by_q;
    out.by_parameters.middleCols(mechanism.theta_zero, by_q.cols()) += by_q;
    for (Eigen::Index i = 0; i < by_q.cols(); ++i) {
      out.by_readings.col(mechanism.first_drive + i) +=
          block.drives[static_cast<std::size_t>(i)].sign * by_q.col(i);
    }
  }
  return out;
}

}  // namespace kompono::kinematics
