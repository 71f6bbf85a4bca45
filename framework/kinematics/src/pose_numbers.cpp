// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "kompono/kinematics/machine.hpp"

namespace kompono::kinematics {
namespace {

constexpr double kGimbal = 1e-12;

/// Angles of R = Rx(a) Ry(b) Rz(c).
std::array<double, 3> AnglesXYZ(const Matrix3<double>& R) {
  const double cosine = std::hypot(R(0, 0), R(0, 1));
  const double b = std::atan2(R(0, 2), cosine);
  if (cosine < kGimbal) return {0.0, b, std::atan2(R(1, 0), R(1, 1))};
  return {std::atan2(-R(1, 2), R(2, 2)), b, std::atan2(-R(0, 1), R(0, 0))};
}

/// Angles of R = Rz(c) Ry(b) Rx(a).
std::array<double, 3> AnglesZYX(const Matrix3<double>& R) {
  const double cosine = std::hypot(R(0, 0), R(1, 0));
  const double b = std::atan2(-R(2, 0), cosine);
  if (cosine < kGimbal) return {0.0, b, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), b, std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace

Pose<double> PoseFromNumbers(const PoseNumbers& numbers, layout::RotationOrder order) {
  const auto& v = numbers.value;
  Pose<double> X;
  X.p = {v[0], v[1], v[2]};
  X.R = order == layout::RotationOrder::kXYZ
            ? RotationXYZ(v[3], v[4], v[5])
            : Matrix3<double>(RotationZ(v[5]) * RotationY(v[4]) * RotationX(v[3]));
  return X;
}

PoseNumbers NumbersFromPose(const Pose<double>& X_WT, layout::RotationOrder order) {
  const std::array<double, 3> angles =
      order == layout::RotationOrder::kXYZ ? AnglesXYZ(X_WT.R) : AnglesZYX(X_WT.R);
  return {{X_WT.p[0], X_WT.p[1], X_WT.p[2], angles[0], angles[1], angles[2]}};
}

std::string_view Name(SolveStatus status) {
  switch (status) {
    case SolveStatus::kConverged:
      return "converged";
    case SolveStatus::kOutOfReach:
      return "out of reach";
    case SolveStatus::kNoConvergence:
      return "no convergence";
    case SolveStatus::kSingular:
      return "singular";
    case SolveStatus::kAmbiguous:
      return "ambiguous";
    case SolveStatus::kOtherAssemblyMode:
      return "other assembly mode";
    case SolveStatus::kOverdetermined:
      return "overdetermined";
  }
  return "unknown";
}

}  // namespace kompono::kinematics
