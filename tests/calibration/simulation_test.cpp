// SPDX-License-Identifier: Apache-2.0
// Measurements of machines that exist only as numbers.
#include "kompono/calibration/simulation.hpp"

#include "machines.hpp"
#include "residuals.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::calibration {
namespace {

using testing::Good;
using ::testing::HasSubstr;
using testing::MachineFrom;
using testing::MachineOf;

kinematics::Machine WaterJet() {
  return MachineOf("machines/so_waterjet_lambda.toml");
}

TEST(Simulate, TheSameSeedGivesTheSameRowsAndAnotherOneOthers) {
  const kinematics::Machine machine = WaterJet();
  SimulateOptions options;
  options.sigma_mm = 0.02;
  const auto text = [&](std::uint64_t seed) {
    options.seed = seed;
    return WriteMeasurements(
        Good(Simulate(machine, machine, machine.nominal(), options)), machine, {});
  };
  EXPECT_EQ(text(1), text(1));
  EXPECT_NE(text(1), text(2));
}

TEST(Simulate, StaysInsideRangesLimitsAndRegion) {
  const kinematics::Machine machine = WaterJet();
  SimulateOptions options;
  options.count = 200;
  options.region["drive.X"] = {100.0, 300.0};
  const MeasurementSet set = Good(Simulate(machine, machine, machine.nominal(), options));
  const int x = machine.FindCoordinate("drive.X");
  const int y = machine.FindCoordinate("drive.Y");
  for (const Measurement& m : set.measurements) {
    const kinematics::Solution at = machine.Forward(m.readings);
    ASSERT_TRUE(at.ok());
    EXPECT_GE(at.coordinates[x], 100.0 - 1e-6);
    EXPECT_LE(at.coordinates[x], 300.0 + 1e-6);
    EXPECT_GE(at.coordinates[y], 200.0 - 1e-6);
    EXPECT_LE(at.coordinates[y], 1000.0 + 1e-6);
    for (std::size_t i = 0; i < machine.drives().size(); ++i) {
      const kinematics::Drive& drive = machine.drives()[i];
      EXPECT_GE(m.readings[static_cast<Eigen::Index>(i)], *drive.lower);
      EXPECT_LE(m.readings[static_cast<Eigen::Index>(i)], *drive.upper);
    }
  }
}

TEST(Simulate, NoiseHasTheGivenDeviation) {
  const kinematics::Machine machine = WaterJet();
  SimulateOptions options;
  options.count = 1500;
  options.held_out = 10;
  options.held_out_without_noise = true;
  options.kind = MeasurementKind::kPose;
  options.sigma_mm = 0.02;
  options.sigma_rad = 0.003;
  const MeasurementSet set = Good(Simulate(machine, machine, machine.nominal(), options));
  double lengths = 0.0;
  double angles = 0.0;
  for (const Measurement& m : set.measurements) {
    const RowModel row(machine, m, 1.0, 1.0);
    const RowErrors errors = row.Errors(row.Predict(machine.nominal(), false));
    if (m.held_out) {
      EXPECT_LT(errors.value.norm(), 1e-9);
      continue;
    }
    lengths += std::pow(errors.LengthNorm(), 2);
    angles += std::pow(errors.AngleNorm(), 2);
  }
  EXPECT_NEAR(std::sqrt(lengths / (3 * 1500)), 0.02, 0.001);
  EXPECT_NEAR(std::sqrt(angles / (3 * 1500)), 0.003, 0.00015);
}

TEST(Simulate, ReadingsComeFromTheNominalMachineAndPosesFromTheTrueOne) {
  const kinematics::Machine machine = WaterJet();
  SimulateOptions options;
  options.count = 5;
  const Eigen::VectorXd truth = Good(ChangedGeometry(machine, {{"open_base.x", 0.5}}));
  for (const Measurement& m : Good(Simulate(machine, machine, truth, options)).measurements) {
    const Pose<double> nominal = machine.Forward(m.readings).X_WT;
    EXPECT_NEAR(*m.position_mm[0] - nominal.p.x(), 0.5, 1e-9);
    EXPECT_NEAR(*m.position_mm[1] - nominal.p.y(), 0.0, 1e-9);
  }
}

TEST(Simulate, DrawsFromDriveLimitsWhereCoordinatesHaveNoRange) {
  const kinematics::Machine machine = MachineFrom(R"(kompono = 1
name = "delta"
formula = "part O (XYZ):delta tool"
[block.delta]
module = "linear_delta"
parameters = { radius = 160, strut = [345, 345, 345] }
[block.delta.drive.q1]
range = [-50, 50]
[block.delta.drive.q2]
range = [-50, 50]
[block.delta.drive.q3]
range = [-50, 50]
)");
  SimulateOptions options;
  options.count = 30;
  const MeasurementSet set = Good(Simulate(machine, machine, machine.nominal(), options));
  for (const Measurement& m : set.measurements) EXPECT_LE(m.readings.cwiseAbs().maxCoeff(), 50.0);
}

TEST(Simulate, RefusesInWords) {
  const kinematics::Machine jet = WaterJet();
  const kinematics::Machine printer = MachineOf("machines/flsun_v400.toml");
  SimulateOptions options;
  options.region = {{"drive.x", {0, 1}}, {"Z", {2, 1}}};
  const Parsed<MeasurementSet> region = Simulate(jet, printer, printer.nominal(), options);
  ASSERT_FALSE(region);
  const std::string text = RenderAll(region.error(), {});
  EXPECT_THAT(text, HasSubstr("the true machine has other drives than the nominal one [E0443]"));
  EXPECT_THAT(text,
              HasSubstr("the machine has no coordinate 'drive.x' [E0444]\n"
                        "  help: did you mean 'drive.X'?"));
  EXPECT_THAT(text, HasSubstr("the range of Z runs from 2 down to 1 [E0444]"));
  const Parsed<MeasurementSet> none = Simulate(printer, printer, printer.nominal(), {});
  ASSERT_FALSE(none);
  EXPECT_THAT(RenderAll(none.error(), {}),
              HasSubstr("poses cannot be drawn: no range is known of delta.X, delta.Y, delta.Z"));
  SimulateOptions far;
  far.region = {{"drive.X", {90000, 90001}}};
  const Parsed<MeasurementSet> nowhere = Simulate(jet, jet, jet.nominal(), far);
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(RenderAll(nowhere.error(), {}), HasSubstr("only 0 of 60 poses were found"));
}

TEST(ChangedGeometry, NamesPatternsThatMatchNothing) {
  const Parsed<Eigen::VectorXd> theta =
      ChangedGeometry(WaterJet(), {{"open_bas.x", 1.0}, {"tool.edge_offset", 0.1}});
  ASSERT_FALSE(theta);
  EXPECT_THAT(RenderAll(theta.error(), {}), HasSubstr("no parameter is called 'open_bas.x'"));
}

TEST(ManufacturedGeometry, MovesOnlyWhatHasATolerance) {
  const kinematics::Machine machine = WaterJet();
  const Eigen::VectorXd theta = ManufacturedGeometry(machine, 1);
  EXPECT_EQ(theta, ManufacturedGeometry(machine, 1));
  int moved = 0;
  for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
    const double change = theta[static_cast<Eigen::Index>(i)] - machine.parameters()[i].nominal;
    EXPECT_EQ(change != 0.0, machine.parameters()[i].tolerance > 0.0);
    moved += change != 0.0 ? 1 : 0;
  }
  EXPECT_GT(moved, 5);
}

}  // namespace
}  // namespace kompono::calibration
