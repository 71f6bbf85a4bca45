// SPDX-License-Identifier: Apache-2.0
// A map of what the geometry leaves: kept for a smooth error that is no number of the model,
// refused for noise.
#include "kompono/calibration/residual_map.hpp"

#include "machines.hpp"

#include <cmath>
#include <random>

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
      "[axis.X]\nrange = [-500, 500]\n[axis.Y]\nrange = [-300, 300]\n[axis.Z]\nrange = [0, 200]\n");
}

/// The bend of a guideway along X with a sag of 0.06 mm in the middle.
Eigen::Vector3d Bend(const Eigen::Vector3d& p) {
  return {0.0, 0.02 * std::sin(0.006 * p.x()), -0.06 * std::cos(p.x() * std::acos(-1.0) / 1000.0)};
}

/// Positions on the gantry, `bend` times the bend, with noise of 5 µm; the last fifth held out.
MeasurementSet Measured(double bend, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  MeasurementSet set;
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d at(
        500.0 * uniform(random), 300.0 * uniform(random), 100.0 + 100.0 * uniform(random));
    const Eigen::Vector3d p = at + bend * Bend(at);
    Measurement m;
    m.readings = at;
    for (int i = 0; i < 3; ++i) {
      m.position_mm[static_cast<std::size_t>(i)] = p[i] + 0.005 * normal(random);
    }
    m.sigma_mm = 0.005;
    m.row = k + 1;
    m.held_out = k >= 80;
    set.measurements.push_back(std::move(m));
  }
  return set;
}

MappedResiduals MapOf(const kinematics::Machine& machine, const MeasurementSet& set) {
  IdentifyOptions options;
  options.free = {"X.zero", "Y.zero", "Z.zero"};
  options.outliers = Outliers::kKeep;
  const CalibrationReport report = Identify(machine, set, options);
  EXPECT_TRUE(report.ok());
  return Good(MapResiduals(machine, set, report, options));
}

TEST(ResidualMap, ASmoothErrorIsMappedAndUnseenRowsGain) {
  const kinematics::Machine machine = Gantry();
  for (const unsigned seed : {1U, 2U, 3U}) {
    const MappedResiduals mapped = MapOf(machine, Measured(1.0, seed));
    SCOPED_TRACE(RenderText(mapped.judged));
    EXPECT_TRUE(mapped.judged.kept);
    EXPECT_LT(mapped.judged.validated.with_mm, 0.7 * mapped.judged.validated.without_mm);
    ASSERT_TRUE(mapped.judged.held_out.has_value());
    EXPECT_EQ(mapped.judged.held_out->rows, 20);
    EXPECT_LT(mapped.judged.held_out->with_mm, 0.7 * mapped.judged.held_out->without_mm);
  }
}

TEST(ResidualMap, NoiseIsRefusedInWords) {
  const kinematics::Machine machine = Gantry();
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const MappedResiduals mapped = MapOf(machine, Measured(0.0, seed));
    EXPECT_FALSE(mapped.judged.kept) << "seed " << seed << RenderText(mapped.judged);
    EXPECT_THAT(mapped.judged.verdict, HasSubstr("refused: "));
  }
}

TEST(ResidualMap, InterpolatesLinearlyAndStaysAtItsBorder) {
  const kinematics::Machine machine = Gantry();
  const ResidualMap map{
      .axes = {{"X", {0.0, 100.0}}, {"Y", {0.0, 10.0, 20.0}}},
      .error_mm = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {4, 0, 0}, {4, 1, 0}, {4, 2, 0}}};
  EXPECT_TRUE(
      map.At(machine, Eigen::Vector3d(25.0, 15.0, 7.0)).isApprox(Eigen::Vector3d(1.0, 1.5, 0.0)));
  EXPECT_TRUE(
      map.At(machine, Eigen::Vector3d(200.0, -5.0, 0.0)).isApprox(Eigen::Vector3d(4.0, 0.0, 0.0)));
  EXPECT_TRUE(map.Covers(machine, Eigen::Vector3d(25.0, 20.0, 7.0)));
  EXPECT_FALSE(map.Covers(machine, Eigen::Vector3d(25.0, 21.0, 7.0)));
}

TEST(ResidualMap, ReadsBackWhatItWrote) {
  const kinematics::Machine machine = Gantry();
  const MappedResiduals mapped = MapOf(machine, Measured(1.0, 4));
  const std::string text = WriteResidualMap(machine, mapped, "points.csv");
  const ResidualMap read = Good(ParseResidualMap(text, "map.toml", machine));
  const Eigen::Vector3d at(123.0, -45.0, 67.0);
  EXPECT_LT((read.At(machine, at) - mapped.map.At(machine, at)).norm(), 1e-5);
}

TEST(ResidualMap, AllThatIsWrongWithAFileIsToldAtOnce) {
  const kinematics::Machine machine = Gantry();
  const auto parsed = ParseResidualMap(
      "residual_map = 2\nerror_mm = [[1, 2]]\n[[axis]]\ncoordinate = \"Q\"\n"
      "[[axis]]\ncoordinate = \"Y\"\nvalues_mm = [3, 1]\n",
      "map.toml",
      machine);
  ASSERT_FALSE(parsed.has_value());
  const std::string said = RenderAll(parsed.error(), {});
  EXPECT_THAT(said, HasSubstr("map.toml:1:16: error: 'residual_map' must be 1"));
  EXPECT_THAT(said, HasSubstr("the machine has no coordinate 'Q'"));
  EXPECT_THAT(said, HasSubstr("at least two numbers in ascending order"));
  EXPECT_THAT(said, HasSubstr("a node's error must be three numbers"));
}

TEST(ResidualMap, TooFewRowsAreRefused) {
  const kinematics::Machine machine = Gantry();
  MeasurementSet set = Measured(1.0, 1);
  set.measurements.resize(10);
  IdentifyOptions options;
  options.free = {"X.zero"};
  const CalibrationReport report = Identify(machine, set, options);
  const auto mapped = MapResiduals(machine, set, report, options);
  ASSERT_FALSE(mapped.has_value());
  EXPECT_EQ(mapped.error()[0].code, "E0470");
}

}  // namespace
}  // namespace kompono::calibration
