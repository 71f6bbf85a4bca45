// SPDX-License-Identifier: Apache-2.0
// Forty times the same poses with other noise: are the deviations that the report predicts those
// that the results show?
#include "machines.hpp"
#include "poses.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using testing::AddNoise;
using testing::HexapodPoses;
using testing::MachineOf;

constexpr int kDraws = 40;

TEST(FortyNoiseDraws, ScatterAsPredictedAndIntervalsCover) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const Eigen::VectorXd truth = ManufacturedGeometry(machine, 11, 5.0);
  const MeasurementSet exact = HexapodPoses(machine, truth, 60, 0.005, 5e-6, 3);
  double ratio_squares = 0.0;
  double tool_squares = 0.0;
  double tool_predicted = 0.0;
  int covered = 0;
  int intervals = 0;
  std::vector<double> errors;
  for (unsigned draw = 1; draw <= kDraws; ++draw) {
    MeasurementSet set = exact;
    AddNoise(100 + draw, &set);
    for (Measurement m : exact.measurements) {
      m.held_out = true;
      set.measurements.push_back(m);
    }
    const CalibrationReport report = Identify(machine, set);
    ASSERT_EQ(report.status, IdentifyStatus::kConverged);
    ASSERT_TRUE(report.rejected.empty());
    for (std::size_t i = 0; i < report.parameters.size(); ++i) {
      const IdentifiedParameter& p = report.parameters[i];
      ASSERT_TRUE(p.sigma);
      const double ratio = (p.after - truth[report.free[i]]) / *p.sigma;
      ratio_squares += ratio * ratio;
      covered += std::abs(ratio) < 1.96 ? 1 : 0;
      ++intervals;
    }
    for (const ErrorStatistics& s : report.statistics) {
      if (s.held_out && s.quantity == "position") tool_squares += s.rms_after * s.rms_after;
    }
    tool_predicted += report.tool_sigma_rms_mm * report.tool_sigma_rms_mm;
  }
  const double scatter = std::sqrt(ratio_squares / intervals);
  const double tool = std::sqrt(tool_squares / tool_predicted);
  const double share = static_cast<double>(covered) / intervals;
  std::printf(
      "scatter over prediction: parameters %.3f, tool %.3f; 95 %% intervals cover %.1f %%\n",
      scatter,
      tool,
      100.0 * share);
  EXPECT_NEAR(scatter, 1.0, 0.2);
  EXPECT_NEAR(tool, 1.0, 0.2);
  EXPECT_GE(share, 0.90);
  EXPECT_LE(share, 0.98);
}

TEST(NoisyDrives, AreCountedInTheDeviations) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const MeasurementSet exact = HexapodPoses(machine, machine.nominal(), 80, 0.005, 5e-6, 4);
  constexpr double kDriveSigmaMm = 0.02;
  IdentifyOptions options;
  options.drive_sigma_mm = kDriveSigmaMm;
  double sigma0_squares = 0.0;
  double ratio_squares = 0.0;
  for (unsigned draw = 1; draw <= 10; ++draw) {
    MeasurementSet set = exact;
    AddNoise(draw, &set);
    std::mt19937_64 random(draw);
    std::normal_distribution<double> normal(0.0, kDriveSigmaMm);
    for (Measurement& m : set.measurements) {
      for (double& reading : m.readings) reading += normal(random);
    }
    const CalibrationReport report = Identify(machine, set, options);
    ASSERT_EQ(report.status, IdentifyStatus::kConverged);
    sigma0_squares += report.sigma0 * report.sigma0 / 10.0;
    for (const IdentifiedParameter& p : report.parameters) {
      ratio_squares += std::pow(p.change() / *p.sigma, 2) / (10.0 * 42.0);
    }
  }
  EXPECT_NEAR(std::sqrt(sigma0_squares), 1.0, 0.05);
  EXPECT_NEAR(std::sqrt(ratio_squares), 1.0, 0.2);
}

}  // namespace
}  // namespace kompono::calibration
