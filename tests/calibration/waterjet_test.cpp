// SPDX-License-Identifier: Apache-2.0
// SO's open-base water-jet from end to end: a machine that is off by what SO says, 60 holes
// measured in the sheet, the geometry identified, other holes predicted.
#include "machines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/report.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::Field;
using testing::Good;
using ::testing::HasSubstr;
using testing::kMeasurements;
using testing::MachineOf;
using testing::Plugins;

/// Holes in a sheet: x and y with 0.02 mm; the held-out ones without noise.
SimulateOptions Holes(std::uint64_t seed) {
  SimulateOptions options;
  options.count = 60;
  options.held_out = 40;
  options.seed = seed;
  options.components = {true, true, false};
  options.sigma_mm = 0.02;
  options.held_out_without_noise = true;
  options.region["Z"] = {0.0, 0.0};
  return options;
}

const ErrorStatistics& HeldOut(const CalibrationReport& report) {
  for (const ErrorStatistics& s : report.statistics) {
    if (s.held_out) return s;
  }
  throw std::logic_error("no rows were held out");
}

class WaterJet : public ::testing::Test {
 protected:
  kinematics::Machine nominal_ = MachineOf("machines/so_waterjet_lambda.toml");
  kinematics::Machine truth_ = MachineOf("measurements/so_waterjet_true.toml");
};

TEST_F(WaterJet, IsOffByWhatSoSaysAndMeetsItsHolesAfterIdentification) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const MeasurementSet set = Good(Simulate(nominal_, truth_, truth_.nominal(), Holes(seed)));
    const CalibrationReport report = Identify(nominal_, set);
    ASSERT_EQ(report.status, IdentifyStatus::kConverged) << RenderText(report);
    std::printf("seed %d: held-out RMS %.4f -> %.4f mm, sigma0 %.3f\n",
                static_cast<int>(seed),
                HeldOut(report).rms_before,
                HeldOut(report).rms_after,
                report.sigma0);
    EXPECT_GE(HeldOut(report).rms_before, 0.75);
    EXPECT_LE(HeldOut(report).rms_before, 0.82);
    EXPECT_LE(HeldOut(report).rms_after, 0.10);
    EXPECT_GT(HeldOut(report).rms_after, 0.001);
  }
}

TEST_F(WaterJet, ShippedHolesGiveTheSame) {
  const MeasurementSet set =
      Good(ReadMeasurements(kMeasurements / "so_waterjet_holes.csv", nominal_));
  const CalibrationReport report = Identify(nominal_, set);
  ASSERT_EQ(report.status, IdentifyStatus::kConverged) << RenderText(report);
  EXPECT_EQ(report.rows_fitted, 60);
  EXPECT_EQ(report.rows_held_out, 40);
  EXPECT_LE(HeldOut(report).rms_after, 0.10);
}

TEST_F(WaterJet, NozzleEdgeAndOpenBaseAreSaidToBeInseparable) {
  const MeasurementSet set = Good(Simulate(nominal_, truth_, truth_.nominal(), Holes(1)));
  IdentifyOptions options;
  options.free = {"open_base.x", "open_base.y", "open_base.c", "tool.edge_offset"};
  const CalibrationReport report = Identify(nominal_, set, options);
  ASSERT_EQ(report.status, IdentifyStatus::kRankDeficient) << RenderText(report);
  std::printf("%s", RenderText(report).c_str());
  EXPECT_THAT(report.unidentifiable,
              Contains(Field(&NullDirection::words,
                             "open_base.x and P_z.edge_offset[1] can only be told apart up "
                             "to their sum")));
  EXPECT_THAT(report.unidentifiable,
              Contains(Field(&NullDirection::words,
                             "open_base.y and P_z.edge_offset[2] can only be told apart up "
                             "to their sum")));
  EXPECT_THAT(report.unidentifiable,
              Contains(Field(&NullDirection::remedy,
                             "lock one of them; no measurement of this tool can tell them apart")));
}

TEST_F(WaterJet, CalibratedLayoutHoldsTheIdentifiedNumbers) {
  const MeasurementSet set = Good(Simulate(nominal_, truth_, truth_.nominal(), Holes(2)));
  const CalibrationReport report = Identify(nominal_, set);
  const std::string text = Good(CalibratedLayout(nominal_, Plugins(), report, "60 holes, seed 2"));
  const kinematics::Machine calibrated = testing::MachineFrom(text);
  EXPECT_TRUE(calibrated.nominal().isApprox(report.theta_after, 1e-12));
  EXPECT_THAT(text, HasSubstr("60 holes, seed 2"));
}

TEST_F(WaterJet, NoLayoutIsWrittenFromAFailedIdentification) {
  const MeasurementSet set = Good(Simulate(nominal_, truth_, truth_.nominal(), Holes(3)));
  IdentifyOptions options;
  options.max_iterations = 1;
  const CalibrationReport report = Identify(nominal_, set, options);
  EXPECT_EQ(report.status, IdentifyStatus::kIterationLimit);
  const Parsed<std::string> layout = CalibratedLayout(nominal_, Plugins(), report, "holes");
  ASSERT_FALSE(layout);
  EXPECT_THAT(RenderAll(layout.error(), {}),
              HasSubstr("error: the solver did not converge in 1 iterations"));
}

}  // namespace
}  // namespace kompono::calibration
