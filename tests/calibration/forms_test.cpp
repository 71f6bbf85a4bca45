// SPDX-License-Identifier: Apache-2.0
// The same problem in two forms: unknown coordinates for every row (what Identify does), and
// residuals in drive space at the measured poses, whitened; and what a hundred thousand poses cost.
#include "machines.hpp"
#include "poses.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using testing::AddNoise;
using testing::HexapodPoses;
using testing::MachineOf;
using Depth = kinematics::Linearisation::Depth;

/// Gauss-Newton on q(pose measured, θ) - q measured, weighted with (J Σ Jᵀ)⁻¹.
Eigen::VectorXd SolveInDriveSpace(const kinematics::Machine& machine,
                                  const MeasurementSet& set,
                                  const std::vector<int>& free) {
  Eigen::VectorXd theta = machine.nominal();
  const auto n = static_cast<Eigen::Index>(free.size());
  kinematics::Linearisation linear(machine, free);
  for (int iteration = 0; iteration < 8; ++iteration) {
    linear.SetGeometry(theta);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
    for (const Measurement& m : set.measurements) {
      Pose<double> X_WT;
      X_WT.R = m.R_WT;
      for (int i = 0; i < 3; ++i) X_WT.p[i] = *m.position_mm[static_cast<std::size_t>(i)];
      const kinematics::PoseNumbers numbers =
          kinematics::NumbersFromPose(X_WT, layout::RotationOrder::kXYZ);
      const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(numbers.value.data(), 6);
      EXPECT_TRUE(linear.At(z, Depth::kByParameters));
      EXPECT_LT((linear.X_WT().p - X_WT.p).norm(), 1e-9) << "coordinates are the pose";
      const Eigen::MatrixXd J =
          linear.readings_by_coordinates() * linear.pose_by_coordinates().inverse();
      Eigen::VectorXd variance(6);
      variance << Eigen::Vector3d::Constant(*m.sigma_mm * *m.sigma_mm),
          Eigen::Vector3d::Constant(*m.sigma_rad * *m.sigma_rad);
      const Eigen::LLT<Eigen::MatrixXd> root(J * variance.asDiagonal() * J.transpose());
      const Eigen::VectorXd r = root.matrixL().solve(linear.readings() - m.readings);
      const Eigen::MatrixXd W = root.matrixL().solve(linear.readings_by_parameters());
      H += W.transpose() * W;
      g += W.transpose() * r;
    }
    const Eigen::VectorXd step = -H.ldlt().solve(g);
    for (Eigen::Index i = 0; i < n; ++i) theta[free[static_cast<std::size_t>(i)]] += step[i];
  }
  return theta;
}

TEST(Forms, UnknownPosesAndWhitenedDriveSpaceAgree) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const Eigen::VectorXd truth = ManufacturedGeometry(machine, 2, 5.0);
  MeasurementSet set = HexapodPoses(machine, truth, 60, 0.005, 5e-6, 9);
  AddNoise(1, &set);
  const CalibrationReport report = Identify(machine, set);
  ASSERT_EQ(report.status, IdentifyStatus::kConverged);
  const Eigen::VectorXd other = SolveInDriveSpace(machine, set, report.free);
  for (std::size_t i = 0; i < report.parameters.size(); ++i) {
    const IdentifiedParameter& p = report.parameters[i];
    EXPECT_NEAR(p.after, other[report.free[i]], 0.01 * *p.sigma) << p.name;
  }
}

double MillisecondsPerPose(const kinematics::Machine& machine, const MeasurementSet& set) {
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const CalibrationReport report = Identify(machine, set);
    EXPECT_EQ(report.status, IdentifyStatus::kConverged);
    best = std::min(best, report.total_ms);
  }
  return best / static_cast<double>(set.measurements.size());
}

TEST(Growth, OfTimeIsThatOfTheRows) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const Eigen::VectorXd truth = ManufacturedGeometry(machine, 2, 5.0);
  MeasurementSet few = HexapodPoses(machine, truth, 1000, 0.005, 5e-6, 9);
  MeasurementSet many = HexapodPoses(machine, truth, 20000, 0.005, 5e-6, 10);
  AddNoise(1, &few);
  AddNoise(2, &many);
  const double of_few = MillisecondsPerPose(machine, few);
  const double of_many = MillisecondsPerPose(machine, many);
  std::printf("per pose: %.1f us of 1000, %.1f us of 20000\n", 1e3 * of_few, 1e3 * of_many);
  EXPECT_LT(of_many, 1.5 * of_few);
}

}  // namespace
}  // namespace kompono::calibration
