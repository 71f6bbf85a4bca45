// SPDX-License-Identifier: Apache-2.0
// 60 measured poses of a hexapod whose truth is known, judged on 100 others without noise. Data and
// its model: tests/calibration/data/README.md.
#include "machines.hpp"
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/calibration/report.hpp"

namespace kompono::calibration {
namespace {

using testing::Good;
using ::testing::HasSubstr;
using testing::kData;
using testing::MachineOf;

constexpr double kNoiseMm = 0.005;
constexpr double kNoiseRad = 5e-6;

/// `train` for the fit and `valid` held out.
MeasurementSet TrainAndValid(const kinematics::Machine& machine,
                             const std::string& train,
                             const std::string& valid,
                             const ReadOptions& options = {}) {
  MeasurementSet set = Good(ReadMeasurements(kData / train, machine, options));
  for (Measurement& m : set.measurements) {
    m.sigma_mm = kNoiseMm;
    m.sigma_rad = kNoiseRad;
  }
  for (Measurement m : Good(ReadMeasurements(kData / valid, machine, options)).measurements) {
    m.held_out = true;
    m.line = 0;
    set.measurements.push_back(m);
  }
  return set;
}

double RmsAfter(const CalibrationReport& report, const std::string& quantity, bool held_out) {
  for (const ErrorStatistics& s : report.statistics) {
    if (s.quantity == quantity && s.held_out == held_out) return s.rms_after;
  }
  return -1.0;
}

TEST(Hexapod, FortyTwoParametersAreRecoveredFromSixtyPoses) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const MeasurementSet set =
      TrainAndValid(machine, "hexapod_train60.csv", "hexapod_valid100_noisefree.csv");
  const CalibrationReport report = Identify(machine, set);
  ASSERT_EQ(report.status, IdentifyStatus::kConverged) << RenderText(report);
  EXPECT_EQ(report.rank, 42);
  EXPECT_EQ(report.dof, 360 - 42);
  EXPECT_NEAR(report.sigma0, 1.0, 0.15) << "the noise was what the file says";
  const double rms_mm = RmsAfter(report, "position", true);
  RecordProperty("valid_position_rms_um", std::to_string(1e3 * rms_mm));
  std::printf(
      "validation: position %.3f um, orientation %.3f urad; fit %.1f ms, all %.1f ms; "
      "predicted tool deviation %.3f um\n",
      1e3 * rms_mm,
      1e6 * RmsAfter(report, "orientation", true),
      report.solver_ms,
      report.total_ms,
      1e3 * report.tool_sigma_rms_mm);
  EXPECT_LT(rms_mm, 2.1e-3);
  EXPECT_GT(rms_mm, 1.0e-3) << "better than the noise allows";
}

TEST(Hexapod, ErrorsOfTheParametersMatchTheirDeviations) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const MeasurementSet set =
      TrainAndValid(machine, "hexapod_train60.csv", "hexapod_valid100_noisefree.csv");
  const CalibrationReport report = Identify(machine, set);
  ASSERT_TRUE(report.ok());
  std::ifstream stream(kData / "truth.json");
  const nlohmann::json truth = nlohmann::json::parse(stream);
  ASSERT_EQ(report.parameters.size(), truth["truth"].size());
  Eigen::VectorXd error(42);
  for (std::size_t i = 0; i < report.parameters.size(); ++i) {
    const IdentifiedParameter& parameter = report.parameters[i];
    const auto k = static_cast<Eigen::Index>(i);
    error[k] = parameter.after - truth["truth"][i].get<double>();
    ASSERT_TRUE(parameter.sigma);
    EXPECT_LT(std::abs(error[k]), 4.0 * *parameter.sigma) << parameter.name;
  }
  // chi² with 42 degrees of freedom: 42 ± 9.2.
  const double chi_squared = error.dot(report.covariance.ldlt().solve(error));
  EXPECT_GT(chi_squared, 42.0 - 3.0 * 9.2);
  EXPECT_LT(chi_squared, 42.0 + 3.0 * 9.2);
}

/// Three rows off by 0.2 mm in a direction of their own.
class OutlierPatterns : public ::testing::TestWithParam<std::array<int, 3>> {};

TEST_P(OutlierPatterns, OfThreeRowsAreRejectedAndNoOthers) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set =
      TrainAndValid(machine, "hexapod_train60.csv", "hexapod_valid100_noisefree.csv");
  std::vector<int> spoilt;
  for (const int row : GetParam()) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(std::sin(row), std::cos(2.0 * row), std::sin(3.0 * row + 1.0)).normalized();
    for (int i = 0; i < 3; ++i) {
      *set.measurements[static_cast<std::size_t>(row - 1)]
           .position_mm[static_cast<std::size_t>(i)] += 0.2 * direction[i];
    }
    spoilt.push_back(row);
  }
  const CalibrationReport report = Identify(machine, set);
  ASSERT_EQ(report.status, IdentifyStatus::kConverged) << RenderText(report);
  EXPECT_EQ(report.rejected, spoilt);
  EXPECT_EQ(report.rows_fitted, 57);
  EXPECT_LT(RmsAfter(report, "position", true), 3.0e-3);
  IdentifyOptions keep;
  keep.outliers = Outliers::kKeep;
  EXPECT_GT(RmsAfter(Identify(machine, set, keep), "position", true), 5.0e-3)
      << "without rejection the rows do harm";
}

INSTANTIATE_TEST_SUITE_P(Rows,
                         OutlierPatterns,
                         ::testing::Values(std::array{1, 2, 3},
                                           std::array{7, 31, 58},
                                           std::array{20, 21, 60},
                                           std::array{5, 33, 47}),
                         [](const auto& rows) {
                           return std::to_string(rows.param[0]) + "_" +
                                  std::to_string(rows.param[1]) + "_" +
                                  std::to_string(rows.param[2]);
                         });

TEST(Hexapod, IsIdentifiedWithCovarianceInSevenMilliseconds) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set = Good(ReadMeasurements(kData / "hexapod_train60.csv", machine));
  for (Measurement& m : set.measurements) {
    m.sigma_mm = kNoiseMm;
    m.sigma_rad = kNoiseRad;
  }
  double best_ms = 1e9;
  // Processor time of all threads and the best of many, so that other work on the machine does not
  // count.
  for (int i = 0; i < 40 && best_ms > 6.0; ++i) {
    const std::clock_t begin = std::clock();
    const CalibrationReport report = Identify(machine, set);
    ASSERT_EQ(report.covariance.rows(), 42);
    best_ms = std::min(best_ms, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  RecordProperty("total_ms", std::to_string(best_ms));
#ifdef NDEBUG
  EXPECT_LT(best_ms, 7.0);
#elif !defined(__SANITIZE_ADDRESS__)
  EXPECT_LT(best_ms, 70.0);
#endif
}

TEST(Hexapod, UnknownBaseAndTargetFramesAreFoundTooAndTheirGaugeIsNamed) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const MeasurementSet set = TrainAndValid(
      machine, "hexapod_mismatch_train60.csv", "hexapod_mismatch_valid100_noisefree.csv");
  IdentifyOptions options;
  options.free = {"struts", "tool.mount"};
  const CalibrationReport report = Identify(machine, set, options);
  ASSERT_EQ(report.status, IdentifyStatus::kRankDeficient) << RenderText(report);
  EXPECT_EQ(report.free.size(), 54U);
  EXPECT_EQ(report.rank, 42);
  EXPECT_EQ(report.unidentifiable.size(), 12U);
  const double rms_mm = RmsAfter(report, "position", true);
  std::printf("%s", RenderText(report).c_str());
  EXPECT_LT(rms_mm, 3.2e-3);
  double wandered = 0.0;
  for (const IdentifiedParameter& p : report.parameters) {
    if (p.name.find(".mount.") == std::string::npos)
      wandered = std::max(wandered, std::abs(p.change()));
  }
  EXPECT_LT(wandered, 1.5) << "the joints stay where their tolerances want them";
}

TEST(Hexapod, UnseenCombinationsMayBeFrozenOrGivenPriorsInstead) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const MeasurementSet set = TrainAndValid(
      machine, "hexapod_mismatch_train60.csv", "hexapod_mismatch_valid100_noisefree.csv");
  IdentifyOptions options;
  options.free = {"struts", "tool.mount"};
  options.gauge = Gauge::kFreeze;
  const CalibrationReport frozen = Identify(machine, set, options);
  ASSERT_EQ(frozen.status, IdentifyStatus::kRankDeficient) << RenderText(frozen);
  EXPECT_EQ(frozen.frozen.size(), 12U);
  for (const IdentifiedParameter& p : frozen.parameters) {
    if (std::find(frozen.frozen.begin(), frozen.frozen.end(), p.name) == frozen.frozen.end()) {
      continue;
    }
    EXPECT_NEAR(p.change(), 0.0, 1e-6) << p.name;
  }
  EXPECT_LT(RmsAfter(frozen, "position", true), 3.2e-3);
  options.gauge = Gauge::kPrior;
  const CalibrationReport prior = Identify(machine, set, options);
  ASSERT_EQ(prior.status, IdentifyStatus::kConverged) << RenderText(prior);
  // The true joints are off by five tolerances, more than such a prior believes.
  std::printf("with priors of one tolerance %.2f um\n", 1e3 * RmsAfter(prior, "position", true));
  EXPECT_LT(RmsAfter(prior, "position", true), 4.5e-3);
  options.gauge = Gauge::kMinimumNorm;
  options.prior_tolerances = 10.0;
  const CalibrationReport wide = Identify(machine, set, options);
  ASSERT_EQ(wide.status, IdentifyStatus::kConverged) << RenderText(wide);
  EXPECT_LT(RmsAfter(wide, "position", true), 3.2e-3);
}

}  // namespace
}  // namespace kompono::calibration
