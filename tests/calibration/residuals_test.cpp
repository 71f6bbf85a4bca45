// SPDX-License-Identifier: Apache-2.0
// Residuals of every kind of measurement and their derivatives; a wrong sign must not go unnoticed.
#include "residuals.hpp"

#include "machines.hpp"
#include "pose_worker.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using testing::Good;
using testing::MachineOf;

/// Fixtures that a kind of row needs, none of them known, all of them away from simple places.
std::vector<Fixture> FixturesFor(MeasurementKind kind) {
  std::vector<Fixture> fixtures{
      {.kind = FixtureKind::kTarget, .name = "T", .value = {40.0, -30.0, 55.0}, .known = false}};
  if (kind == MeasurementKind::kBallBar) {
    fixtures.push_back(
        {.kind = FixtureKind::kCentre, .name = "C", .value = {300.0, 50.0, 700.0}, .known = false});
  } else if (kind == MeasurementKind::kPlane) {
    fixtures.push_back({.kind = FixtureKind::kPlane,
                        .name = "P",
                        .value = {0.02, -0.03, 400.0},
                        .normal = Eigen::Vector3d(0.2, 0.3, 0.9).normalized(),
                        .known = false});
  } else if (kind == MeasurementKind::kHole) {
    fixtures.push_back(
        {.kind = FixtureKind::kSheet, .name = "S", .value = {10.0, -20.0, 0.3}, .known = false});
  }
  return fixtures;
}

class RowJacobian : public ::testing::TestWithParam<MeasurementKind> {
 protected:
  /// ρ and its derivatives of a row at θ; coordinates follow.
  Eigen::VectorXd Rho(PoseWorker& worker, PoseRow& row, const Eigen::VectorXd& theta) {
    worker.SetGeometry(theta);
    EXPECT_TRUE(worker.Linearise(&row, true, false));
    return worker.rho();
  }

  /// Largest difference to central differences, relative to each column's length or to 1.
  double Error(PoseWorker& worker,
               PoseRow& row,
               const Eigen::VectorXd& theta,
               const Eigen::MatrixXd& J) {
    double worst = 0.0;
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      const double step = 1e-4;
      Eigen::VectorXd shifted = theta;
      shifted[i] += step;
      const Eigen::VectorXd plus = Rho(worker, row, shifted);
      shifted[i] -= 2.0 * step;
      const Eigen::VectorXd difference = (plus - Rho(worker, row, shifted)) / (2.0 * step);
      worst = std::max(worst, (difference - J.col(i)).norm() / std::max(1.0, difference.norm()));
    }
    return worst;
  }
};

TEST_P(RowJacobian, AgreesWithDifferencesAndAFlippedSignIsNoticed) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  SimulateOptions options;
  options.count = 4;
  options.seed = 7;
  options.kind = GetParam();
  options.fixtures = FixturesFor(GetParam());
  options.region = {{"struts.X", {-80, 80}},
                    {"struts.Y", {-80, 80}},
                    {"struts.Z", {850, 950}},
                    {"struts.A", {-0.1, 0.1}},
                    {"struts.B", {-0.1, 0.1}},
                    {"struts.C", {-0.1, 0.1}}};
  const Eigen::VectorXd truth = ManufacturedGeometry(machine, 3, 20.0);
  const MeasurementSet set = Good(Simulate(machine, machine, truth, options));
  const Eigen::VectorXd theta = AllNominal(machine, set);
  std::vector<int> free;
  for (int i = 0; i < theta.size(); ++i) free.push_back(i);
  PoseWorker worker(machine, set, free, Eigen::VectorXd::Zero(6));
  for (const Measurement& measurement : set.measurements) {
    PoseRow row{.measurement = &measurement, .sigma_mm = 1.0, .sigma_rad = 0.01};
    worker.SetGeometry(theta);
    ASSERT_EQ(worker.FindStart(theta, nullptr, &row), kinematics::SolveStatus::kConverged);
    // The first pass moves the coordinates to where they belong, the second differentiates there.
    Rho(worker, row, theta);
    Rho(worker, row, theta);
    Eigen::MatrixXd J = worker.jacobian().topRows(measurement.Numbers());
    EXPECT_LT(Error(worker, row, theta, J), 2e-5);
    const int joint = machine.FindParameter("struts.base[2].x");
    J.col(joint) *= -1.0;
    EXPECT_GT(Error(worker, row, theta, J), 1e-3) << "the check must notice a wrong sign";
  }
}

TEST_P(RowJacobian, IsOfTheErrorsThatTheForwardProblemGives) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  SimulateOptions options;
  options.count = 3;
  options.kind = GetParam();
  options.fixtures = FixturesFor(GetParam());
  options.region = {{"struts.X", {-80, 80}},
                    {"struts.Y", {-80, 80}},
                    {"struts.Z", {850, 950}},
                    {"struts.A", {-0.1, 0.1}},
                    {"struts.B", {-0.1, 0.1}},
                    {"struts.C", {0, 0.1}}};
  const Eigen::VectorXd truth = ManufacturedGeometry(machine, 5, 20.0);
  const MeasurementSet set = Good(Simulate(machine, machine, truth, options));
  const Eigen::VectorXd theta = AllNominal(machine, set);
  const FixtureValues fixtures{.fixtures = &set.fixtures,
                               .value = theta.data() + machine.parameters().size()};
  PoseWorker worker(machine, set, {0}, Eigen::VectorXd::Zero(6));
  for (const Measurement& measurement : set.measurements) {
    PoseRow row{.measurement = &measurement, .sigma_mm = 1.0, .sigma_rad = 1.0};
    worker.SetGeometry(theta);
    ASSERT_EQ(worker.FindStart(theta, nullptr, &row), kinematics::SolveStatus::kConverged);
    const Eigen::VectorXd rho = Rho(worker, row, theta);
    RowModel model(machine, measurement, 1.0, 1.0);
    const Eigen::VectorXd slow = model.Errors(model.FindStart(theta, nullptr), fixtures).value;
    EXPECT_LT((rho - slow).norm(), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds,
                         RowJacobian,
                         ::testing::Values(MeasurementKind::kHeight,
                                           MeasurementKind::kDistance,
                                           MeasurementKind::kPosition,
                                           MeasurementKind::kPose,
                                           MeasurementKind::kBallBar,
                                           MeasurementKind::kPlane,
                                           MeasurementKind::kHole,
                                           MeasurementKind::kRelative),
                         [](const auto& kind) { return std::string(Name(kind.param)); });

TEST(Residuals, ArePredictedMinusMeasured) {
  Measurement height{.kind = MeasurementKind::kHeight, .value_mm = 2.0};
  Pose<double> X;
  X.p = {1, 2, 5};
  EXPECT_EQ(ErrorsOf(height, X, {}).value[0], 3.0);
  Measurement distance{.kind = MeasurementKind::kDistance, .value_mm = 5.0};
  Pose<double> Y;
  Y.p = {1, 2, -2};
  EXPECT_EQ(ErrorsOf(distance, X, Y).value[0], 2.0);
  Measurement position{.kind = MeasurementKind::kPosition};
  position.position_mm[1] = 7.0;
  EXPECT_EQ(ErrorsOf(position, X, {}).value.size(), 1);
  EXPECT_EQ(ErrorsOf(position, X, {}).value[0], -5.0);
  Measurement pose{.kind = MeasurementKind::kPose};
  pose.position_mm = {1.0, 2.0, 5.0};
  X.R = RotationFromVector({0, 0, 0.1});
  EXPECT_NEAR(ErrorsOf(pose, X, {}).value[5], 0.1, 1e-15);
  EXPECT_EQ(ErrorsOf(pose, X, {}).lengths, 3);
}

TEST(Rotations, ComeBackFromTheirVector) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (const double size : {0.0, 1e-12, 1e-6, 1e-2, 1.0, 3.1}) {
    Eigen::Vector3d r(normal(random), normal(random), normal(random));
    r *= size / r.norm();
    EXPECT_LT((RotationVector(RotationFromVector(r)) - r).norm(), 1e-13 + 1e-9 * (size > 3 ? 1 : 0))
        << "angle " << size;
  }
}

TEST(Rotations, LeftJacobianInverseIsTheDerivativeOfTheLogarithm) {
  for (const double size : {1e-8, 0.0099, 0.0101, 0.5, 3.0}) {
    const Eigen::Vector3d r = size * Eigen::Vector3d(0.6, -0.48, 0.64);
    const Eigen::Matrix3d J = LeftJacobianInverse(r);
    for (int i = 0; i < 3; ++i) {
      const double step = 1e-6;
      const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d difference =
          (RotationVector(RotationFromVector(d) * RotationFromVector(r)) -
           RotationVector(RotationFromVector(-d) * RotationFromVector(r))) /
          (2.0 * step);
      EXPECT_LT((difference - J.col(i)).norm(), 2e-8) << "angle " << size;
    }
  }
}

}  // namespace
}  // namespace kompono::calibration
