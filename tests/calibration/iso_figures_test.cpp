// SPDX-License-Identifier: Apache-2.0
// ISO 9283 and 230-4 figures against numbers by hand on a gantry.
#include "kompono/calibration/iso_figures.hpp"

#include "machines.hpp"
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
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

/// Mean and standard deviation by construction: -1, -1, 0, 1, 1 have s = sqrt(4 / 4).
std::vector<double> FiveAbout(double mean, double s) {
  return {mean - s, mean - s, mean, mean + s, mean + s};
}

/// Worked by hand, µm:
///   target            0    100   200   300   400
///   mean from +       0     2     3     5     4     E+ = 5 - 0 = 5
///   s from +          1     1     1     2     1     R+ = 4 x 2 = 8
///   mean from -      -3    -2     0     1     1     E- = 1 + 3 = 4
///   s from -          1     1    0.5    1     1     R- = 4
///   B_i               3     4     3     4     3     B = 4, mean 3.4
///   mean of both    -1.5    0    1.5    3    2.5    M = 3 + 1.5 = 4.5
///   2s+ + 2s- + |B|   7     8     6    10     7     R = 10
///   + 2s from +       2     4     5     9     6     A+ = 9 + 2 = 11
///   - 2s from +      -2     0     1     1     2
///   + 2s from -      -1     0     1     3     3     A- = 3 + 5 = 8
///   - 2s from -      -5    -4    -1    -1    -1     A = 9 + 5 = 14, E = 5 + 3 = 8
std::vector<TargetDeviations> WorkedTest() {
  return {{.target = 0, .positive = FiveAbout(0, 1), .negative = FiveAbout(-3, 1)},
          {.target = 100, .positive = FiveAbout(2, 1), .negative = FiveAbout(-2, 1)},
          {.target = 200, .positive = FiveAbout(3, 1), .negative = FiveAbout(0, 0.5)},
          {.target = 300, .positive = FiveAbout(5, 2), .negative = FiveAbout(1, 1)},
          {.target = 400, .positive = FiveAbout(4, 1), .negative = FiveAbout(1, 1)}};
}

TEST(Positioning, AWorkedTestGivesTheStandardsFigures) {
  EXPECT_THAT(MissingForPositioning(WorkedTest(), false), ::testing::IsEmpty());
  const PositioningFigures figures = PositioningFiguresOf(WorkedTest());
  ASSERT_TRUE(figures.positive && figures.negative && figures.bidirectional);
  EXPECT_NEAR(figures.bidirectional->accuracy, 14.0, 1e-12);
  EXPECT_NEAR(figures.bidirectional->systematic, 8.0, 1e-12);
  EXPECT_NEAR(figures.bidirectional->repeatability, 10.0, 1e-12);
  EXPECT_NEAR(figures.bidirectional->reversal, 4.0, 1e-12);
  EXPECT_NEAR(figures.bidirectional->mean_reversal, 3.4, 1e-12);
  EXPECT_NEAR(figures.bidirectional->mean_deviation, 4.5, 1e-12);
  EXPECT_NEAR(figures.positive->accuracy, 11.0, 1e-12);
  EXPECT_NEAR(figures.positive->systematic, 5.0, 1e-12);
  EXPECT_NEAR(figures.positive->repeatability, 8.0, 1e-12);
  EXPECT_NEAR(figures.negative->accuracy, 8.0, 1e-12);
  EXPECT_NEAR(figures.negative->systematic, 4.0, 1e-12);
  EXPECT_NEAR(figures.negative->repeatability, 4.0, 1e-12);
}

TEST(Positioning, WhatTheStandardAsksForIsNamed) {
  std::vector<TargetDeviations> targets = WorkedTest();
  targets.pop_back();
  targets[1].negative.pop_back();
  EXPECT_THAT(MissingForPositioning(targets, false),
              ::testing::ElementsAre("4 targets, 5 asked for", "4 of 5 approaches in - at 100 mm"));
  targets = WorkedTest();
  targets.back().target = 2000.0;
  EXPECT_THAT(MissingForPositioning(targets, false),
              ::testing::ElementsAre("5 targets, 10 asked for"));
  for (std::size_t i = 0; i < 5; ++i) targets[i].target = 0.4 * static_cast<double>(i);  // 92 deg
  EXPECT_THAT(MissingForPositioning(targets, true), ::testing::IsEmpty());
  targets.back().target = 3.2;  // 183 deg
  EXPECT_THAT(MissingForPositioning(targets, true),
              ::testing::ElementsAre("5 targets, 8 asked for"));
  EXPECT_THAT(MissingForPositioning({}, false), ::testing::ElementsAre("no targets"));
}

TEST(Positioning, OneDirectionAloneHasItsFigures) {
  std::vector<TargetDeviations> targets = WorkedTest();
  for (TargetDeviations& target : targets) target.negative.clear();
  EXPECT_THAT(MissingForPositioning(targets, false), ::testing::IsEmpty());
  const PositioningFigures figures = PositioningFiguresOf(targets);
  ASSERT_TRUE(figures.positive);
  EXPECT_NEAR(figures.positive->accuracy, 11.0, 1e-12);
  EXPECT_FALSE(figures.negative);
  EXPECT_FALSE(figures.bidirectional);
}

/// The worked test along X at Y 20, Z 30, and three rows along another line.
std::string WorkedFile() {
  std::string text = "X_mm,Y_mm,Z_mm,x_mm,y_mm,z_mm,approach\n";
  for (const TargetDeviations& target : WorkedTest()) {
    for (const bool positive : {true, false}) {
      for (const double um : positive ? target.positive : target.negative) {
        text += fmt::format("{0},20,30,{1:.4f},20,30,{2}X\n",
                            target.target,
                            target.target + 1e-3 * um,
                            positive ? '+' : '-');
      }
    }
  }
  return text + "0,50,30,0,50,30,+Y\n0,60,30,0,60,30,Y-\n0,60,30,0.2,60.1,30,\n";
}

TEST(IsoFigures, RowsWithTheirApproachGiveIso2302) {
  const kinematics::Machine machine = Gantry();
  const auto set = ParseMeasurements(WorkedFile(), "run.csv", machine);
  ASSERT_TRUE(set) << set.error().front().message;
  const IsoFigures figures = IsoFiguresOf(machine, *set, machine.nominal());
  ASSERT_EQ(figures.axes.size(), 2U);
  const AxisTest& x = figures.axes[0];
  EXPECT_EQ(x.axis, 'X');
  EXPECT_EQ(x.line, "Y 20, Z 30");
  EXPECT_EQ(x.targets, 5);
  EXPECT_EQ(x.rows, 50);
  EXPECT_EQ(x.first_row, 1);
  ASSERT_TRUE(x.before.bidirectional);
  EXPECT_NEAR(x.before.bidirectional->accuracy, 14e-3, 1e-9);
  EXPECT_NEAR(x.before.bidirectional->mean_reversal, 3.4e-3, 1e-9);
  EXPECT_THAT(RenderIso(figures),
              HasSubstr("\nISO 230-2, positioning of an axis (mm, deg)\n"
                        "  X from 0 to 400 mm at Y 20, Z 30, 5 targets, 50 rows from 1\n"
                        "    before A 0.0140, R 0.0100, B 0.0040 (mean +0.0034), E 0.0080, M "
                        "0.0045; +: A 0.0110, R 0.0080, E 0.0050; -: A 0.0080, R 0.0040, E "
                        "0.0040\n"));
  EXPECT_THAT(RenderIso(figures),
              HasSubstr("  Y from 50 to 60 mm at X 0, Z 30, 2 targets, 2 rows from 51\n"
                        "    no figures: 2 targets, 5 asked for; 1 of 5 approaches in + at 50 mm; "
                        "0 of 5 approaches in + at 60 mm; and 2 more\n"));
}

TEST(IsoFigures, TheApproachSurvivesWriting) {
  const kinematics::Machine machine = Gantry();
  const auto set = ParseMeasurements(WorkedFile(), "run.csv", machine);
  ASSERT_TRUE(set);
  const auto again = ParseMeasurements(WriteMeasurements(*set, machine, {}), "again.csv", machine);
  ASSERT_TRUE(again);
  for (std::size_t i = 0; i < set->measurements.size(); ++i) {
    const auto& was = set->measurements[i].approach;
    const auto& is = again->measurements[i].approach;
    ASSERT_EQ(was.has_value(), is.has_value()) << i;
    EXPECT_TRUE(!was || (was->axis == is->axis && was->positive == is->positive)) << i;
  }
}

/// Five targets along X, and five turns about Z, of a hexapod whose geometry is not the nominal
/// one; 10 µm and 20 µrad lost when coming from above.
MeasurementSet HexapodTest(const kinematics::Machine& machine, const Eigen::VectorXd& real) {
  MeasurementSet set;
  for (int i = 0; i < 100; ++i) {
    const bool turn = i >= 50;
    const bool positive = i % 2 == 0;
    const double at = static_cast<double>(i % 50 / 10) - 2.0;
    kinematics::PoseTarget target{.component = {0, 0, 0, 0, 0, 0},
                                  .order = machine.layout().rotation_order};
    target.component[2] = machine.Forward(machine.Inverse({}).drives).X_WT.p.z();
    target.component[turn ? 5 : 0] = at * (turn ? 0.1 : 40.0);
    const kinematics::Solution sent = machine.Inverse(target);
    const kinematics::Solution came = machine.Forward(sent.drives, real, sent.coordinates);
    Measurement m{.kind = MeasurementKind::kPose,
                  .readings = sent.drives,
                  .approach = Approach{.axis = turn ? 'C' : 'X', .positive = positive}};
    for (std::size_t k = 0; k < 3; ++k) {
      m.position_mm[k] =
          came.X_WT.p[static_cast<Eigen::Index>(k)] - (k == 0 && !turn && !positive ? 0.01 : 0.0);
    }
    const double lost = turn && !positive ? -2e-5 : 0.0;
    m.R_WT = Eigen::AngleAxisd(lost, Eigen::Vector3d::UnitZ()) * came.X_WT.R;
    m.row = i + 1;
    set.measurements.push_back(std::move(m));
  }
  return set;
}

/// What the identified geometry explains is gone afterwards, the reversal stays.
TEST(IsoFigures, WhatTheGeometryExplainsIsGoneAfterwards) {
  const kinematics::Machine machine = testing::MachineOf("machines/hexapod_reference.toml");
  Eigen::VectorXd real = machine.nominal();
  for (Eigen::Index i = 0; i < real.size(); ++i) {
    const kinematics::Parameter& p = machine.parameters()[static_cast<std::size_t>(i)];
    if (p.identifiable && !p.angle) real[i] += 0.2 * std::sin(1.0 + static_cast<double>(i));
  }
  const IsoFigures figures = IsoFiguresOf(machine, HexapodTest(machine, real), real);
  ASSERT_EQ(figures.axes.size(), 2U);
  for (const AxisTest& test : figures.axes) {
    SCOPED_TRACE(test.axis);
    const double lost = test.axis == 'X' ? 0.01 : 2e-5;
    ASSERT_TRUE(test.before.bidirectional && test.after.bidirectional);
    EXPECT_GT(test.before.bidirectional->systematic, 1.5 * lost);
    EXPECT_NEAR(test.after.bidirectional->systematic, lost, 1e-3 * lost);
    EXPECT_NEAR(test.after.bidirectional->mean_reversal, lost, 1e-3 * lost);
    EXPECT_NEAR(test.after.bidirectional->mean_deviation, 0.0, 1e-3 * lost);
  }
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
