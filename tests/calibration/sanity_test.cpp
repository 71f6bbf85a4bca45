// SPDX-License-Identifier: Apache-2.0
// Slips in measurement files: each is named with its place before anything is solved.
#include "machines.hpp"
#include "residuals.hpp"

#include <functional>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using ::testing::AllOf;
using testing::Good;
using ::testing::HasSubstr;
using testing::MachineOf;

MeasurementSet Poses(const kinematics::Machine& machine, MeasurementKind kind) {
  SimulateOptions options;
  options.count = 40;
  options.seed = 3;
  options.kind = kind;
  options.sigma_mm = 0.005;
  options.sigma_rad = 5e-6;
  options.region = {{"struts.X", {-120, 120}},
                    {"struts.Y", {-100, 140}},
                    {"struts.Z", {800, 1000}},
                    {"struts.A", {-0.2, 0.2}},
                    {"struts.B", {-0.2, 0.2}},
                    {"struts.C", {-0.2, 0.2}}};
  return Good(Simulate(machine, machine, ManufacturedGeometry(machine, 4, 5.0), options));
}

/// What is said of a file after a change of its rows; empty if it is taken.
std::string SaidOf(MeasurementKind kind, const std::function<void(Measurement*)>& change) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set = Poses(machine, kind);
  for (Measurement& m : set.measurements) change(&m);
  const std::string text = WriteMeasurements(set, machine, {});
  const Parsed<MeasurementSet> read = ParseMeasurements(text, "poses.csv", machine);
  return read ? std::string() : RenderAll(read.error(), {});
}

TEST(Sanity, GoodPosesAreTaken) {
  EXPECT_EQ(SaidOf(MeasurementKind::kPose, [](Measurement*) {}), "");
  EXPECT_EQ(SaidOf(MeasurementKind::kPosition, [](Measurement*) {}), "");
}

TEST(Sanity, SwappedReadingsAreNamed) {
  EXPECT_THAT(SaidOf(MeasurementKind::kPose,
                     [](Measurement* m) { std::swap(m->readings[1], m->readings[4]); }),
              AllOf(HasSubstr("E0423"),
                    HasSubstr("struts.q2_mm and struts.q5_mm are swapped"),
                    HasSubstr("poses.csv:1:")));
}

TEST(Sanity, ANegatedLegIsNamed) {
  EXPECT_THAT(SaidOf(MeasurementKind::kPose, [](Measurement* m) { m->readings[2] *= -1.0; }),
              AllOf(HasSubstr("E0426"), HasSubstr("struts.q3_mm has the wrong sign")));
}

TEST(Sanity, ALegInMetresIsNamed) {
  EXPECT_THAT(SaidOf(MeasurementKind::kPose, [](Measurement* m) { m->readings[5] *= 1e-3; }),
              AllOf(HasSubstr("E0415"), HasSubstr("struts.q6_mm is in metres")));
}

TEST(Sanity, MetresForMillimetresAreNamed) {
  EXPECT_THAT(SaidOf(MeasurementKind::kPose,
                     [](Measurement* m) {
                       for (auto& component : m->position_mm) *component *= 1e-3;
                     }),
              AllOf(HasSubstr("E0415"), HasSubstr("metres")));
}

TEST(Sanity, SwappedCoordinatesAreNamed) {
  const auto swap = [](Measurement* m) { std::swap(m->position_mm[0], m->position_mm[1]); };
  for (const MeasurementKind kind : {MeasurementKind::kPose, MeasurementKind::kPosition}) {
    EXPECT_THAT(SaidOf(kind, swap),
                AllOf(HasSubstr("E0423"), HasSubstr("x_mm and y_mm are swapped")));
  }
}

TEST(Sanity, ANegatedCoordinateIsNamed) {
  EXPECT_THAT(SaidOf(MeasurementKind::kPosition, [](Measurement* m) { *m->position_mm[1] *= -1; }),
              AllOf(HasSubstr("E0426"), HasSubstr("y_mm has the wrong sign")));
}

TEST(Sanity, InvertedRotationsAreNamed) {
  EXPECT_THAT(SaidOf(MeasurementKind::kPose, [](Measurement* m) { m->R_WT.transposeInPlace(); }),
              AllOf(HasSubstr("E0426"), HasSubstr("workpiece in the tool")));
}

TEST(Sanity, FarRowsAndContradictingRowsAreNamedWithTheirLines) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set = Poses(machine, MeasurementKind::kPosition);
  *set.measurements[6].position_mm[2] += 20.0;
  set.measurements.push_back(set.measurements[10]);
  *set.measurements.back().position_mm[0] += 0.4;
  Diagnostics notes;
  const std::string text = WriteMeasurements(set, machine, {});
  Good(ParseMeasurements(text, "poses.csv", machine, {}, &notes));
  const std::string said = RenderAll(notes, {});
  EXPECT_THAT(said, AllOf(HasSubstr("W0427"), HasSubstr("poses.csv:8:1")));
  EXPECT_THAT(
      said,
      AllOf(HasSubstr("W0428"), HasSubstr("poses.csv:42:1"), HasSubstr("the readings of line 12")));
}

TEST(Sanity, ARowWithASlipIsRefusedUnlessItIsToBeLeftOut) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set = Poses(machine, MeasurementKind::kPosition);
  *set.measurements[6].position_mm[2] /= 10.0;  // the point one digit too far to the left
  set.measurements[9].readings[2] += 100.0;
  const std::string text = WriteMeasurements(set, machine, {});
  const auto refused = ParseMeasurements(text, "poses.csv", machine);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(RenderAll(refused.error(), {}),
              AllOf(HasSubstr("E0473"), HasSubstr("poses.csv:8:1"), HasSubstr("poses.csv:11:1")));
  const MeasurementSet kept =
      Good(ParseMeasurements(text, "poses.csv", machine, {.keep_slips = true}));
  EXPECT_EQ(Identify(machine, kept).rejected, (std::vector<int>{7, 10}));
}

TEST(Sanity, RowsOutOfReachAreNamedAndNothingIsFitted) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set = Poses(machine, MeasurementKind::kPose);
  set.measurements[4].readings[0] = 3000.0;
  const std::string text = WriteMeasurements(set, machine, {});
  const MeasurementSet read = Good(ParseMeasurements(text, "poses.csv", machine));
  const CalibrationReport report = Identify(machine, read);
  EXPECT_EQ(report.status, IdentifyStatus::kForwardFailed);
  EXPECT_THAT(RenderAll(report.diagnostics, {}),
              AllOf(HasSubstr("E0451"), HasSubstr("poses.csv:6:")));
}

TEST(Sanity, TooFewRowsAreSaidToBeTooFew) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set = Poses(machine, MeasurementKind::kPose);
  set.measurements.resize(6);
  const CalibrationReport report = Identify(machine, set);
  EXPECT_EQ(report.status, IdentifyStatus::kTooFewMeasurements);
  EXPECT_FALSE(report.ok());
  EXPECT_THAT(RenderAll(report.diagnostics, {}),
              HasSubstr("36 measured numbers cannot determine 42 parameters"));
}

TEST(Fixtures, AreReadBackFromTheirFile) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  SimulateOptions options;
  options.count = 12;
  options.kind = MeasurementKind::kBallBar;
  options.fixtures = {
      {.kind = FixtureKind::kTarget, .name = "T", .value = {10.0, 20.0, 30.0}},
      {.kind = FixtureKind::kCentre, .name = "A", .value = {200.0, 0.0, 700.0}},
      {.kind = FixtureKind::kCentre, .name = "B", .value = {0.0, 210.0, 690.0}, .known = false}};
  options.region = {{"struts.X", {-100, 100}},
                    {"struts.Y", {-100, 100}},
                    {"struts.Z", {850, 950}},
                    {"struts.A", {-0.1, 0.1}},
                    {"struts.B", {-0.1, 0.1}},
                    {"struts.C", {-0.1, 0.1}}};
  const MeasurementSet set = Good(Simulate(machine, machine, machine.nominal(), options));
  const MeasurementSet read =
      Good(ParseMeasurements(WriteMeasurements(set, machine, {}), "bar.csv", machine));
  ASSERT_EQ(read.fixtures.size(), 3U);
  for (std::size_t i = 0; i < read.measurements.size(); ++i) {
    const Measurement& m = read.measurements[i];
    EXPECT_EQ(m.kind, MeasurementKind::kBallBar);
    EXPECT_EQ(read.fixtures[static_cast<std::size_t>(m.target)].name, "T");
    const Fixture& centre = read.fixtures[static_cast<std::size_t>(m.fixture)];
    const Fixture& wanted = set.fixtures[static_cast<std::size_t>(set.measurements[i].fixture)];
    EXPECT_EQ(centre.name, wanted.name);
    EXPECT_EQ(centre.known, wanted.known);
    // The unknown one is found where the nominal machine, here the true one, says.
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(centre.value[k], wanted.value[k], 1e-6);
  }
}

TEST(Fixtures, InTwoPlacesOrMissingAreRefused) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const std::string header =
      "kind,value_mm,centre,centre_x_mm,centre_y_mm,centre_z_mm,q1,q2,q3,q4,q5,q6\n";
  const std::string readings = ",900,900,900,900,900,900\n";
  const Parsed<MeasurementSet> read =
      ParseMeasurements(header + "ball_bar,100,A,1,2,3" + readings + "ball_bar,100,A,1,2,4" +
                            readings + "ball_bar,100,,,," + readings,
                        "bar.csv",
                        machine);
  ASSERT_FALSE(read);
  EXPECT_THAT(RenderAll(read.error(), {}),
              AllOf(HasSubstr("bar.csv:3:1: error: centre 'A' has other numbers"),
                    HasSubstr("E0419"),
                    HasSubstr("bar.csv:4:1: error: a ball_bar row needs a centre"),
                    HasSubstr("E0420")));
}

}  // namespace
}  // namespace kompono::calibration
