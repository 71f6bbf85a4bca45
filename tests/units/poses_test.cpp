// SPDX-License-Identifier: Apache-2.0
// Stations of the shipped units against numbers worked out by hand. Turns are of 90, 45 or 30
// degrees, so that every entry is 0, 1, a half or a root.
#include "unit_bench.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace kompono::tests {
namespace {

constexpr double kHalfRoot2 = std::numbers::sqrt2 / 2.0;
constexpr double kHalfRoot3 = std::numbers::sqrt3 / 2.0;

testing::AssertionResult Is(const Vector3<double>& got, double x, double y, double z) {
  if ((got - Vector3<double>(x, y, z)).norm() < 1e-12) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << got.transpose() << " instead of " << x << " " << y << " " << z;
}
/// Where the tool points: -z of its station.
Vector3<double> ToolAxis(const Pose<double>& X) {
  return -X.R.col(2);
}

TEST(Checker, NoticesAWrongSign) {
  EXPECT_FALSE(Is({1, 2, -3}, 1, 2, 3));
}

TEST(SheetDrive, DatumLiesOnTheUpperSideOfTheTurnedSheet) {
  const UnitBench sheet(
      "sheet_drive",
      {{"clamp", {10, 20, 30}}, {"turn", {90}}, {"datum", {5, 7}}, {"thickness", {4}}});
  EXPECT_TRUE(Is(sheet.At("corner").p, 10, 20, 30));
  EXPECT_TRUE(Is(sheet.At("datum").p, 10 - 7, 20 + 5, 30 + 4));
  EXPECT_TRUE(Is(sheet.At("datum").R.col(0), 0, 1, 0));
}

TEST(SheetDrive, TiltMovesWhatLiesFarFromTheClamps) {
  // Rx(30°): the datum (0, 100) goes to y = 100 cos 30°, z = 100 sin 30°.
  const UnitBench sheet("sheet_drive", {{"tilt", {30, 0}}, {"datum", {0, 100}}});
  EXPECT_TRUE(Is(sheet.At("datum").p, 0, 100 * kHalfRoot3, 50));
}

TEST(Headstock, HoldsThePartBeyondNoseAndChuck) {
  const UnitBench head("headstock", {{"nose_length", {120}}, {"chuck_length", {60}}});
  EXPECT_TRUE(Is(head.At("nose").p, 0, 0, 120));
  EXPECT_TRUE(Is(head.At("part").p, 0, 0, 180));
  EXPECT_TRUE(Is(head.At("part").R.col(2), 0, 0, 1)) << "z points out of the chuck";
  const UnitBench off("headstock",
                      {{"nose_length", {120}},
                       {"chuck_length", {60}},
                       {"offset", {0.5, -0.25}},
                       {"tilt", {0, 90}}});
  EXPECT_TRUE(Is(off.At("part").p, 0.5, -0.25, 180));
  EXPECT_TRUE(Is(off.At("part").R.col(2), 1, 0, 0)) << "a tilt about y leans z towards x";
}

TEST(CounterSpindle, LooksBackAlongTheFirstOne) {
  const UnitBench counter("counter_spindle", {{"nose_length", {120}}, {"chuck_length", {60}}});
  EXPECT_TRUE(Is(counter.At("nose").p, 0, 0, -120));
  EXPECT_TRUE(Is(counter.At("part").p, 0, 0, -180));
  EXPECT_TRUE(Is(counter.At("part").R.col(2), 0, 0, -1));
  EXPECT_TRUE(Is(counter.At("part").R.col(1), 0, 1, 0));
  EXPECT_NEAR(counter.At("part").R.determinant(), 1.0, 1e-15);
}

TEST(CounterSpindle, ItsOwnTiltSwingsTheChuck) {
  // Rx(30°) of (0, 0, -200): y = 200 sin 30°, z = -200 cos 30°.
  const UnitBench counter(
      "counter_spindle",
      {{"nose_length", {140}}, {"chuck_length", {60}}, {"offset", {3, 0}}, {"tilt", {30, 0}}});
  EXPECT_TRUE(Is(counter.At("part").p, 3, 100, -200 * kHalfRoot3));
}

TEST(Tailstock, CentrePointsAtTheHeadstock) {
  const UnitBench tailstock("tailstock",
                            {{"quill", {40}}, {"centre_length", {60}}, {"offset", {0, 2}}});
  EXPECT_TRUE(Is(tailstock.At("centre").p, 0, 2, -100));
  EXPECT_TRUE(Is(tailstock.At("centre").R.col(2), 0, 0, -1));
}

TEST(Turret, RadialToolStandsOnTheWorkingSideOfTheDisc) {
  const UnitBench turret("turret", {{"pockets", {8}}, {"radius", {150}}});
  EXPECT_TRUE(Is(turret.At("pocket3").p, 200, 0, 0)) << "radius 150 and overhang 50";
  EXPECT_TRUE(Is(ToolAxis(turret.At("pocket3")), 1, 0, 0));
}

TEST(Turret, IndexedPocketsStandRoundTheDisc) {
  const UnitBench turret("turret", {{"pockets", {8}}, {"radius", {150}}});
  // With pocket 1 in place pocket 3 of 8 stands two pitches of 45° on, pocket 2 one.
  EXPECT_TRUE(Is(turret.At("pocket1", 1).p, 200, 0, 0));
  EXPECT_TRUE(Is(turret.At("pocket3", 1).p, 0, 200, 0));
  EXPECT_TRUE(Is(ToolAxis(turret.At("pocket3", 1)), 0, 1, 0));
  EXPECT_TRUE(Is(turret.At("pocket2", 1).p, 200 * kHalfRoot2, 200 * kHalfRoot2, 0));
  EXPECT_TRUE(Is(turret.At("pocket1", 3).p, 0, -200, 0)) << "the disc has turned back";
}

TEST(Turret, AxialToolPointsAlongTheDiscsAxis) {
  const UnitBench turret("turret", {{"pocket_angle", {0}}, {"radius", {150}}});
  EXPECT_TRUE(Is(turret.At("pocket1").p, 150, 0, -50));
  EXPECT_TRUE(Is(ToolAxis(turret.At("pocket1")), 0, 0, -1));
}

TEST(Turret, SwivelSwingsTheDiscOnItsArm) {
  // Ry(90°) takes x to -z and z to x: the radial tool at arm + 200 x points along -z.
  const UnitBench turret(
      "turret", {{"swivel", {90}}, {"pivot", {1, 2, 3}}, {"arm", {0, 0, 80}}, {"radius", {150}}});
  EXPECT_TRUE(Is(turret.At("pocket1").p, 1 + 80, 2, 3 - 200));
  EXPECT_TRUE(Is(ToolAxis(turret.At("pocket1")), 0, 0, -1));
}

TEST(Turret, IndexErrorTurnsEveryPocket) {
  const UnitBench turret("turret", {{"index_error", {30}}, {"radius", {150}}});
  EXPECT_TRUE(Is(turret.At("pocket1").p, 200 * kHalfRoot3, 100, 0));
  EXPECT_TRUE(Is(turret.At("pocket7", 7).p, 200 * kHalfRoot3, 100, 0));
}

TEST(Turret, HasNoPocketBeyondItsNumber) {
  const UnitBench turret("turret", {{"pockets", {8}}});
  EXPECT_TRUE(turret.At("pocket8").p.allFinite());
  EXPECT_FALSE(turret.At("pocket9").p.allFinite());
  EXPECT_TRUE(turret.At("pocket1", 8).p.allFinite());
  EXPECT_FALSE(turret.At("pocket1", 9).p.allFinite());
}

TEST(TwinTurret, DiscsStandApartAndIndexByThemselves) {
  const UnitBench twin("twin_turret", {{"pockets", {4}}, {"radius", {150}}, {"distance", {240}}});
  EXPECT_TRUE(Is(twin.At("front1").p, 200, 0, -120));
  EXPECT_TRUE(Is(twin.At("back1").p, 200, 0, 120));
  // One pitch of 90°.
  EXPECT_TRUE(Is(twin.At("front2", 1).p, 0, 200, -120));
  EXPECT_TRUE(Is(twin.At("back4", 1).p, 0, -200, 120));
  EXPECT_TRUE(Is(twin.At("back4", 4).p, 200, 0, 120));
}

TEST(TwinTurret, AxialToolsLookAwayFromEachOther) {
  const UnitBench twin("twin_turret",
                       {{"pocket_angle", {0}}, {"distance", {240}}, {"radius", {150}}});
  EXPECT_TRUE(Is(ToolAxis(twin.At("front1")), 0, 0, -1));
  EXPECT_TRUE(Is(ToolAxis(twin.At("back1")), 0, 0, 1));
  EXPECT_TRUE(Is(twin.At("front1").p, 150, 0, -170));
  EXPECT_TRUE(Is(twin.At("back1").p, 150, 0, 170));
}

TEST(TwinTurret, EachDiscHasItsOwnIndexError) {
  const UnitBench twin("twin_turret",
                       {{"index_error", {0, 90}}, {"distance", {0}}, {"radius", {150}}});
  EXPECT_TRUE(Is(twin.At("front1").p, 200, 0, 0));
  EXPECT_TRUE(Is(twin.At("back1").p, 0, 200, 0));
}

TEST(SpindleAndTool, PointDownwards) {
  EXPECT_TRUE(Is(UnitBench("spindle", {{"length", {90}}}).At("nose").p, 0, 0, -90));
  EXPECT_TRUE(Is(UnitBench("tool", {{"length", {90}}, {"offset", {1, 2}}}).At("tip").p, 1, 2, -90));
}

TEST(JetHead, OffsetsAddUpAndTiltsActBelowTheirJoint) {
  const std::map<std::string, std::vector<double>> lengths{
      {"nozzle_length", {25}}, {"chamber_length", {30}}, {"tube_length", {76}}, {"stand_off", {3}}};
  EXPECT_TRUE(Is(UnitBench("jet_head", lengths).At("jet").p, 0, 0, -134));

  auto shifted = lengths;
  shifted["chamber_offset"] = {0.064, 0};
  shifted["tube_offset"] = {0, 0.038};
  shifted["edge_offset"] = {0.5, 0.08};
  EXPECT_TRUE(Is(UnitBench("jet_head", shifted).At("jet").p, 0.564, 0.118, -134));

  // Ry(90°) takes -z to -x: all below the joint lies sideways.
  auto chamber = lengths;
  chamber["chamber_tilt"] = {0, 90};
  EXPECT_TRUE(Is(UnitBench("jet_head", chamber).At("jet").p, -(30 + 76 + 3), 0, -25));
  auto tube = lengths;
  tube["tube_tilt"] = {90, 0};  // Rx(90°) takes -z to y
  EXPECT_TRUE(Is(UnitBench("jet_head", tube).At("jet").p, 0, 76 + 3, -(25 + 30)));
}

TEST(JetHead, SmallErrorsGrowWithTheLengthBelowThem) {
  // SO 44-55 to first order: shift + tilt x lever; 0.064 mm over the chamber's 30 mm is 0.1222°.
  const double tilt_deg = std::atan(0.064 / 30.0) * 180.0 / std::numbers::pi;
  const UnitBench head("jet_head", {{"chamber_tilt", {0, tilt_deg}}});
  EXPECT_NEAR(head.At("jet").p.x(), -0.064 / 30.0 * (30 + 76 + 3), 1e-6);
  EXPECT_NEAR(
      head.description().FindParameter("chamber_tilt")->tolerance.value_or(0), tilt_deg, 1e-3);
}

}  // namespace
}  // namespace kompono::tests
