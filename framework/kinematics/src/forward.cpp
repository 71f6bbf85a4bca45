// SPDX-License-Identifier: Apache-2.0
// One mechanism: x from its drives, in closed form or followed from a start.
#include "machine_impl.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kompono::kinematics {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kClosedLoops = 1e-9;  ///< of the size: residual of a closed form
constexpr double kModesMeet = 1e-6;    ///< of the size: drives of two working modes that are one

/// Scale of positions: what a rounding error is measured against.
double SizeOf(const VectorXd& x, const VectorXd& q) {
  return std::max(q.size() > 0 ? q.cwiseAbs().maxCoeff() : 0.0,
                  x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0);
}

/// Residual of the loops, mm.
double ResidualAt(const MechanismModel& mechanism,
                  const VectorXd& x,
                  const VectorXd& q,
                  const VectorXd& theta) {
  const Evaluation at =
      Evaluate(mechanism, plugin::Quantity::kClosure, x, q, theta, {.by_coordinates = true});
  if (at.status != plugin::Status::kOk || !at.values.allFinite() ||
      !at.by_coordinates.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  const ScaledJacobian scaled = ScaleJacobians(mechanism, at.by_coordinates, MatrixXd());
  return at.values.cwiseQuotient(scaled.row_scale).cwiseAbs().maxCoeff();
}

/// The first drive whose inverse kinematics at x is not q, or -1.
Eigen::Index LegOnOtherSide(const MechanismModel& mechanism,
                            const VectorXd& x,
                            const VectorXd& q,
                            const VectorXd& theta) {
  const Evaluation back = Evaluate(mechanism, plugin::Quantity::kDrives, x, q, theta, {});
  const double size = SizeOf(x, q);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (std::isfinite(back.values[i]) && std::abs(back.values[i] - q[i]) > kModesMeet * size) {
      return i;
    }
  }
  return -1;
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
  out.residual = ResidualAt(mechanism, x, q, theta);
  if (out.residual > kClosedLoops * SizeOf(x, q)) {
    out.message =
        fmt::format("the closed-form solution leaves {:.3g} mm in the loops", out.residual);
    return out;
  }
  if (const Eigen::Index leg = LegOnOtherSide(mechanism, x, q, theta); leg >= 0) {
    out.status = SolveStatus::kOtherAssemblyMode;
    out.message = fmt::format(
        "the loops close with leg {} on its other side; set that assembly mode in the layout, or "
        "check the readings",
        leg + 1);
    return out;
  }
  out.status = SolveStatus::kConverged;
  return out;
}

SolveStatus StatusOf(plugin::ForwardOutcome outcome) {
  switch (outcome) {
    case plugin::ForwardOutcome::kProven:
      return SolveStatus::kConverged;
    case plugin::ForwardOutcome::kBlocked:
      return SolveStatus::kSingular;
    case plugin::ForwardOutcome::kOtherMode:
      return SolveStatus::kOtherAssemblyMode;
    case plugin::ForwardOutcome::kStartOutOfReach:
      return SolveStatus::kOutOfReach;
    case plugin::ForwardOutcome::kAmbiguous:
      return SolveStatus::kAmbiguous;
  }
  return SolveStatus::kNoConvergence;
}

std::string MessageOf(plugin::ForwardOutcome outcome, double reached) {
  switch (outcome) {
    case plugin::ForwardOutcome::kBlocked:
      return fmt::format(
          "followed from the start, the loops stop closing after {:.1f} % of the way to these "
          "drive "
          "positions: det A vanishes there (type 2 singularity) or the drives do not fit one "
          "another; give a start nearer to the pose",
          100.0 * reached);
    case plugin::ForwardOutcome::kOtherMode:
      return "these drive positions belong to another assembly mode than the start; give a start "
             "on "
             "the wanted branch (home in the layout)";
    case plugin::ForwardOutcome::kStartOutOfReach:
      return "the start is no pose of the mechanism, a leg does not reach it; give another start "
             "(home in the layout)";
    case plugin::ForwardOutcome::kAmbiguous:
      return "near a type 2 singularity two poses within the limits have these drive positions, "
             "and "
             "the start does not tell them apart; give a start nearer to the pose";
    case plugin::ForwardOutcome::kProven:
      break;
  }
  return "";
}

}  // namespace

LocalLimits LimitsOf(const Machine::Impl& impl, const MechanismModel& mechanism) {
  const layout::Block& block = BlockOf(impl, mechanism);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  LocalLimits out;
  bool any = false;
  for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
    const Coordinate& coordinate =
        impl.coordinates[static_cast<std::size_t>(mechanism.coordinate[i])];
    any = any || coordinate.lower || coordinate.upper;
    const double lower = coordinate.lower.value_or(-kNone);
    const double upper = coordinate.upper.value_or(kNone);
    const bool turned = block.letters[i].sign < 0;
    out.lower.push_back(turned ? -upper : lower);
    out.upper.push_back(turned ? -lower : upper);
  }
  return any ? out : LocalLimits{};
}

bool ClosesOnItsModes(const MechanismModel& mechanism,
                      const VectorXd& x,
                      const VectorXd& q,
                      const VectorXd& theta) {
  return x.allFinite() && ResidualAt(mechanism, x, q, theta) <= kClosedLoops * SizeOf(x, q) &&
         LegOnOtherSide(mechanism, x, q, theta) < 0;
}

Followed FollowFrom(const MechanismModel& mechanism,
                    const VectorXd& q,
                    const VectorXd& theta,
                    const MatrixXd& x_starts) {
  const RowMajor starts = x_starts;
  const RowMajor drives = q.replicate(1, starts.cols());
  RowMajor found(starts.rows(), starts.cols());
  std::vector<const double*> start_rows;
  std::vector<const double*> drive_rows;
  std::vector<double*> found_rows;
  for (Eigen::Index i = 0; i < starts.rows(); ++i) {
    start_rows.push_back(starts.row(i).data());
    found_rows.push_back(found.row(i).data());
  }
  for (Eigen::Index i = 0; i < drives.rows(); ++i) drive_rows.push_back(drives.row(i).data());
  std::vector<plugin::ForwardOutcome> outcomes(static_cast<std::size_t>(starts.cols()));
  Followed out;
  out.status = mechanism.code->Forward(
      {.count = outcomes.size(),
       .drives = drive_rows.data(),
       .starts = start_rows.data(),
       .parameters = {theta.data() + mechanism.theta_module,
                      static_cast<std::size_t>(mechanism.code->Shape().parameters)},
       .modes = mechanism.modes,
       .coordinates = found_rows.data(),
       .outcomes = outcomes.data()});
  out.x = found;
  return out;
}

MechanismSolution SolveMechanism(const Machine::Impl& impl,
                                 const MechanismModel& mechanism,
                                 const VectorXd& q,
                                 const VectorXd& theta,
                                 const VectorXd& x_start) {
  const Evaluation closed =
      Evaluate(mechanism, plugin::Quantity::kCoordinates, x_start, q, theta, {});
  if (closed.status == plugin::Status::kOk) return ClosedForm(mechanism, q, theta, closed.values);
  const plugin::MechanismShape shape = mechanism.code->Shape();
  MechanismSolution out;
  out.x = x_start;
  std::vector<const double*> drives;
  for (const double& number : q) drives.push_back(&number);
  std::vector<double*> coordinates;
  for (double& number : out.x) coordinates.push_back(&number);
  const LocalLimits limits = LimitsOf(impl, mechanism);
  plugin::ForwardOutcome outcome{};
  double reached = 0.0;
  std::int32_t iterations = 0;
  const plugin::Status status =
      mechanism.code->Forward({.count = 1,
                               .drives = drives.data(),
                               .start = {x_start.data(), static_cast<std::size_t>(x_start.size())},
                               .parameters = {theta.data() + mechanism.theta_module,
                                              static_cast<std::size_t>(shape.parameters)},
                               .modes = mechanism.modes,
                               .lower = limits.lower,
                               .upper = limits.upper,
                               .coordinates = coordinates.data(),
                               .outcomes = &outcome,
                               .reached = &reached,
                               .iterations = &iterations});
  out.iterations = iterations;
  if (status != plugin::Status::kOk) {
    out.x.setConstant(std::numeric_limits<double>::quiet_NaN());
    out.message = fmt::format(
        "module {} has no forward kinematics: no closed form, and {} loops for {} coordinates",
        mechanism.description->id,
        shape.closures,
        shape.coordinates);
    return out;
  }
  out.status = StatusOf(outcome);
  out.message = MessageOf(outcome, reached);
  if (out.status == SolveStatus::kConverged) out.residual = ResidualAt(mechanism, out.x, q, theta);
  return out;
}

}  // namespace kompono::kinematics
