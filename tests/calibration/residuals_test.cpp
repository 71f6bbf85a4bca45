// SPDX-License-Identifier: Apache-2.0
// Residuals of every kind of measurement and their derivatives; a wrong sign must not go unnoticed.
#include "residuals.hpp"

#include "machines.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using testing::Good;
using testing::MachineOf;

/// |J - central difference| relative to the column's size.
double JacobianError(const RowModel& row,
                     const Eigen::VectorXd& theta,
                     const std::vector<int>& free,
                     const RowMajorMatrix& J) {
  double worst = 0.0;
  for (std::size_t j = 0; j < free.size(); ++j) {
    const double step = 1e-4;
    Eigen::VectorXd shifted = theta;
    shifted[free[j]] += step;
    const Eigen::VectorXd plus = row.Whitened(row.Predict(shifted, false)).value;
    shifted[free[j]] -= 2.0 * step;
    const Eigen::VectorXd minus = row.Whitened(row.Predict(shifted, false)).value;
    const Eigen::VectorXd difference = (plus - minus) / (2.0 * step);
    const Eigen::VectorXd column = J.col(static_cast<Eigen::Index>(j));
    const double size = std::max(1.0, difference.norm());
    worst = std::max(worst, (difference - column).norm() / size);
  }
  return worst;
}

class RowJacobian : public ::testing::TestWithParam<MeasurementKind> {};

TEST_P(RowJacobian, AgreesWithDifferencesAndAFlippedSignIsNoticed) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  SimulateOptions options;
  options.count = 4;
  options.seed = 7;
  options.kind = GetParam();
  options.region = {{"struts.X", {-80, 80}},
                    {"struts.Y", {-80, 80}},
                    {"struts.Z", {850, 950}},
                    {"struts.A", {-0.1, 0.1}},
                    {"struts.B", {-0.1, 0.1}},
                    {"struts.C", {-0.1, 0.1}}};
  const Eigen::VectorXd truth = ManufacturedGeometry(machine, 3, 20.0);
  const MeasurementSet set = Good(Simulate(machine, machine, truth, options));
  std::vector<int> free;
  for (std::size_t i = 0; i < machine.parameters().size(); ++i) free.push_back(static_cast<int>(i));
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(machine.nominal().size());
  for (const Measurement& measurement : set.measurements) {
    RowModel row(machine, measurement, 1.0, 0.01);
    ASSERT_TRUE(row.FindStart(machine.nominal(), nullptr).ok());
    RowMajorMatrix J(row.size(), machine.nominal().size());
    row.Jacobian(row.Predict(machine.nominal(), true), free, scale, J);
    EXPECT_LT(JacobianError(row, machine.nominal(), free, J), 2e-5);
    const int joint = machine.FindParameter("struts.base[2].x");
    J.col(joint) *= -1.0;
    EXPECT_GT(JacobianError(row, machine.nominal(), free, J), 1e-3)
        << "the check must notice a wrong sign";
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds,
                         RowJacobian,
                         ::testing::Values(MeasurementKind::kHeight,
                                           MeasurementKind::kDistance,
                                           MeasurementKind::kPosition,
                                           MeasurementKind::kPose),
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
