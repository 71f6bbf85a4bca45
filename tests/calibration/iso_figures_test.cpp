// SPDX-License-Identifier: Apache-2.0
// ISO 9283 and 230-4 figures against numbers by hand on a gantry.
#include "kompono/calibration/iso_figures.hpp"

#include "machines.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::calibration {
namespace {

using testing::Good;
using ::testing::HasSubstr;
using testing::MachineFrom;

kinematics::Machine Gantry() {
  return MachineFrom(
      "kompono = 1\nname = \"Gantry\"\nformula = \"part O X Y Z tool\"\n"
      "[axis.X]\nrange = [-500, 500]\n[axis.Y]\nrange = [-500, 500]\n[axis.Z]\nrange = [-500, "
      "500]\n");
}

Measurement At(double x, double y, double z, int row) {
  Measurement m;
  m.readings = Eigen::Vector3d(10.0, 20.0, 30.0);
  m.position_mm = {x, y, z};
  m.row = row;
  return m;
}

TEST(IsoFigures, RepeatedPosesGiveAccuracyAndRepeatability) {
  const kinematics::Machine machine = Gantry();
  MeasurementSet set;
  // Barycentre (10.03, 20.04, 30), 0.05 away; distances to it 0.01, 0.01, 0.02, 0.02.
  set.measurements = {At(10.04, 20.04, 30.0, 1),
                      At(10.02, 20.04, 30.0, 2),
                      At(10.03, 20.06, 30.0, 3),
                      At(10.03, 20.02, 30.0, 4)};
  Eigen::VectorXd identified = machine.nominal();
  identified[machine.FindParameter("X.zero")] += 0.03;
  const IsoFigures figures = IsoFiguresOf(machine, set, identified);
  ASSERT_EQ(figures.poses.size(), 1U);
  EXPECT_EQ(figures.poses[0].repeats, 4);
  EXPECT_NEAR(figures.poses[0].accuracy_before_mm, 0.05, 1e-9);
  EXPECT_NEAR(figures.poses[0].accuracy_after_mm, 0.04, 1e-9);
  const double deviation = std::sqrt(4.0 * 0.005 * 0.005 / 3.0);
  EXPECT_NEAR(figures.poses[0].repeatability_mm, 0.015 + 3.0 * deviation, 1e-9);
  EXPECT_THAT(RenderIso(figures), HasSubstr("AP 0.0500 before, 0.0400 after"));
}

TEST(IsoFigures, ABallBarsRunGivesItsCircularDeviation) {
  const kinematics::Machine machine = Gantry();
  MeasurementSet set;
  set.fixtures = {{.kind = FixtureKind::kCentre, .name = "A"}};
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.1 + i * std::acos(-1.0) / 6.0;
    Measurement m;
    m.kind = MeasurementKind::kBallBar;
    m.readings = Eigen::Vector3d(100.0 * std::cos(angle), 100.0 * std::sin(angle), 0.0);
    m.value_mm = 100.0 + (i == 3 ? 0.02 : i == 7 ? -0.03 : 0.0);
    m.fixture = 0;
    m.row = i + 1;
    set.measurements.push_back(m);
  }
  const IsoFigures figures = IsoFiguresOf(machine, set, machine.nominal());
  ASSERT_EQ(figures.runs.size(), 1U);
  EXPECT_NEAR(figures.runs[0].deviation_before_mm, 0.05, 1e-9);
  EXPECT_NEAR(figures.runs[0].deviation_after_mm, 0.05, 1e-9);
  EXPECT_NEAR(figures.runs[0].radial_most_before_mm, 0.02, 1e-9);
  EXPECT_NEAR(figures.runs[0].radial_least_before_mm, -0.03, 1e-9);
}

TEST(IsoFigures, RowsThatDoNotRepeatGiveNone) {
  const kinematics::Machine machine = Gantry();
  MeasurementSet set;
  set.measurements = {At(10, 20, 30, 1), At(10, 20, 30, 2)};
  const IsoFigures figures = IsoFiguresOf(machine, set, machine.nominal());
  EXPECT_TRUE(figures.empty());
  EXPECT_EQ(RenderIso(figures), "");
}

}  // namespace
}  // namespace kompono::calibration
