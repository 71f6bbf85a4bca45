// SPDX-License-Identifier: Apache-2.0
#include "shipped_machines.hpp"

#include <random>

namespace kompono::kinematics {
namespace {

using layout::RotationOrder;

class PoseNumbersOfBothOrders : public testing::TestWithParam<RotationOrder> {};

TEST_P(PoseNumbersOfBothOrders, ComeBackFromTheirPose) {
  std::mt19937 random(tests::Seed());
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  for (int i = 0; i < 1000; ++i) {
    PoseNumbers numbers;
    for (double& number : numbers.value) number = uniform(random);
    const PoseNumbers back = NumbersFromPose(PoseFromNumbers(numbers, GetParam()), GetParam());
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(back.value[k], numbers.value[k], 1e-12) << "seed " << tests::Seed();
  }
}

TEST_P(PoseNumbersOfBothOrders, KeepThePoseAtTheGimbalLock) {
  for (const double b : {1.5707963267948966, -1.5707963267948966}) {
    const Pose<double> X = PoseFromNumbers({{1, 2, 3, 0.4, b, 0.3}}, GetParam());
    const PoseNumbers numbers = NumbersFromPose(X, GetParam());
    EXPECT_EQ(numbers.value[3], 0.0);
    const Pose<double> again = PoseFromNumbers(numbers, GetParam());
    EXPECT_LE((again.R - X.R).norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders,
                         PoseNumbersOfBothOrders,
                         testing::Values(RotationOrder::kXYZ, RotationOrder::kZYX));

TEST(PoseFromNumbers, TurnsAboutTheAxesInTheOrderOfItsName) {
  const double quarter = 1.5707963267948966;
  // Rx(90°) Rz(90°) e_x = Rx e_y = e_z;  Rz(90°) Rx(90°) e_x = Rz e_x = e_y.
  const Pose<double> xyz = PoseFromNumbers({{0, 0, 0, quarter, 0, quarter}}, RotationOrder::kXYZ);
  const Pose<double> zyx = PoseFromNumbers({{0, 0, 0, quarter, 0, quarter}}, RotationOrder::kZYX);
  EXPECT_LE((xyz.R * Vector3<double>::UnitX() - Vector3<double>::UnitZ()).norm(), 1e-15);
  EXPECT_LE((zyx.R * Vector3<double>::UnitX() - Vector3<double>::UnitY()).norm(), 1e-15);
}

}  // namespace
}  // namespace kompono::kinematics
