// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/geometry_numbers.hpp"

#include "shipped_machines.hpp"

#include <cmath>
#include <numbers>

#include "kompono/geometry/pose.hpp"

namespace kompono::analysis {
namespace {

using kinematics::Machine;

TEST(GeometryAt, EulerAnglesTurnZIntoTheStrut) {
  const Machine machine = tests::LoadMachine("hexapod_reference");
  const GeometryNumbers at = GeometryAt(machine, machine.home(), machine.nominal());
  ASSERT_EQ(at.struts.size(), 6U);
  for (const StrutNumbers& strut : at.struts) {
    const Eigen::Vector3d turned =
        RotationZ(strut.precession_rad) * RotationY(strut.nutation_rad) * Eigen::Vector3d::UnitZ();
    EXPECT_LT((turned - strut.direction).norm(), 1e-14);
  }
}

TEST(GeometryAt, LengthsOfPodsAreTheReadingsOfTheirDrives) {
  const Machine machine = tests::LoadMachine("hexapod_reference");
  kinematics::VectorXd z = machine.home();
  z[0] = 40.0;
  z[4] = 0.1;
  kinematics::VectorXd readings;
  machine.DrivesOf(z, machine.nominal(), &readings);
  const GeometryNumbers at = GeometryAt(machine, z, machine.nominal(), 10.0);
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(at.struts[static_cast<std::size_t>(i)].length_mm, readings[i], 1e-9);
  ASSERT_EQ(at.distances.size(), 15U);
  EXPECT_LE(at.distances.front().centre_lines_mm, at.distances.back().centre_lines_mm);
  for (const StrutDistance& pair : at.distances) {
    EXPECT_NEAR(pair.clearance_mm, pair.centre_lines_mm - 20.0, 1e-12);
    EXPECT_NEAR((pair.on_first - pair.on_second).norm(), pair.centre_lines_mm, 1e-9);
  }
}

TEST(GeometryAt, AnglesOfTheBiglideFollowFromItsTriangle) {
  const Machine machine = tests::MachineFromText(R"(
kompono = 1
formula = "part O (XY):glides tool"
[block.glides]
module = "biglide"
parameters = { L1 = 400, L2 = 400, width = 60 }
home = { X = 0, Y = 200 }
)");
  const GeometryNumbers at = GeometryAt(machine, machine.home(), machine.nominal());
  int seen = 0;
  for (const LinkAngle& angle : at.angles) {
    if (angle.at != "glides.carriage1") continue;
    EXPECT_NEAR(angle.angle_rad, std::numbers::pi / 6.0, 1e-12) << "sin = 200 / 400";
    ++seen;
  }
  EXPECT_EQ(seen, 1);
  ASSERT_EQ(at.distances.size(), 1U);
  EXPECT_NEAR(at.distances[0].centre_lines_mm, 60.0, 1e-9) << "nearest at the platform";
}

TEST(PathOfPoint, OfAPlaceOnALinkLiesBetweenItsEnds) {
  const Machine machine = tests::LoadMachine("biglide_mill");
  std::vector<kinematics::VectorXd> poses;
  for (int i = 0; i < 5; ++i) {
    poses.push_back(machine.home());
    poses.back()[0] += 10.0 * i;
  }
  const auto from = PathOfPoint(machine, poses, machine.nominal(), "glides.carriage1");
  const auto to = PathOfPoint(machine, poses, machine.nominal(), "glides.joint1");
  const auto quarter =
      PathOfPoint(machine, poses, machine.nominal(), "glides.carriage1:glides.joint1:0.25");
  ASSERT_TRUE(from && to && quarter);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_LT(((*quarter)[i] - 0.75 * (*from)[i] - 0.25 * (*to)[i]).norm(), 1e-12);
  EXPECT_NEAR(((*to)[4] - (*to)[0]).x(), 40.0, 1e-9);
  const auto wrong = PathOfPoint(machine, poses, machine.nominal(), "glides.join1");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().front().code, "E0726");
  EXPECT_THAT(wrong.error().front().help, testing::HasSubstr("glides.joint1"));
}

}  // namespace
}  // namespace kompono::analysis
