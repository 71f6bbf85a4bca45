// SPDX-License-Identifier: Apache-2.0
// What each kind of measurement can tell about a hexapod with 42 unknowns: ranks of the exact
// derivatives. The numbers are of an independent study of the same machine.
#include "machines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using testing::Good;
using testing::MachineOf;

const std::vector<std::string> kStruts{"struts.base", "struts.platform", "struts.*.zero"};

Fixture Known(FixtureKind kind, std::string name, std::array<double, 3> value) {
  return {.kind = kind, .name = std::move(name), .value = value};
}

std::vector<Fixture> Targets(int count) {
  const std::vector<Fixture> all{Known(FixtureKind::kTarget, "1", {80.0, 10.0, 40.0}),
                                 Known(FixtureKind::kTarget, "2", {-60.0, 70.0, 55.0}),
                                 Known(FixtureKind::kTarget, "3", {15.0, -90.0, 20.0})};
  return {all.begin(), all.begin() + count};
}

std::vector<Fixture> Centres(int count, bool known) {
  std::vector<Fixture> all{Known(FixtureKind::kCentre, "A", {250.0, 0.0, 700.0}),
                           Known(FixtureKind::kCentre, "B", {-150.0, 220.0, 720.0}),
                           Known(FixtureKind::kCentre, "C", {-100.0, -240.0, 1150.0}),
                           Known(FixtureKind::kCentre, "D", {120.0, 90.0, 600.0})};
  all.resize(static_cast<std::size_t>(count));
  for (Fixture& centre : all) centre.known = known;
  return all;
}

std::vector<Fixture> Planes(int count) {
  std::vector<Fixture> all;
  for (const auto& [name, normal, offset] :
       {std::tuple("X", Eigen::Vector3d(1.0, 0.1, 0.0), 300.0),
        std::tuple("Y", Eigen::Vector3d(-0.1, 1.0, 0.1), 250.0),
        std::tuple("Z", Eigen::Vector3d(0.1, 0.0, 1.0), 500.0)}) {
    if (static_cast<int>(all.size()) == count) break;
    all.push_back(Known(FixtureKind::kPlane, name, {0.0, 0.0, offset}));
    all.back().normal = normal.normalized();
  }
  return all;
}

struct Line {
  std::string name;
  MeasurementKind kind;
  std::vector<Fixture> fixtures;
  std::vector<std::string> more_free;
  bool tilted;
  int rank, unknowns;
};

class Table : public ::testing::TestWithParam<Line> {};

TEST_P(Table, RankIsThatOfTheStudy) {
  const Line& line = GetParam();
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  SimulateOptions options;
  options.count = 240;
  options.seed = 5;
  options.kind = line.kind;
  options.fixtures = line.fixtures;
  const double tilt = line.tilted ? 0.3 : 0.0;
  options.region = {{"struts.X", {-120, 120}},
                    {"struts.Y", {-120, 120}},
                    {"struts.Z", {800, 1000}},
                    {"struts.A", {-tilt, tilt}},
                    {"struts.B", {-tilt, tilt}},
                    {"struts.C", {-tilt, tilt}}};
  const MeasurementSet set = Good(Simulate(machine, machine, machine.nominal(), options));
  IdentifyOptions identify;
  identify.free = kStruts;
  identify.free.insert(identify.free.end(), line.more_free.begin(), line.more_free.end());
  for (const double threshold : {1e-12, 1e-9, 1e-6}) {
    identify.rank_threshold = threshold;
    const CalibrationReport report = Identify(machine, set, identify);
    ASSERT_TRUE(report.ok()) << report.solver_message;
    EXPECT_EQ(report.free.size(), static_cast<std::size_t>(line.unknowns));
    EXPECT_EQ(report.rank, line.rank) << "threshold " << threshold;
    EXPECT_EQ(report.unidentifiable.size(), static_cast<std::size_t>(line.unknowns - line.rank));
    for (const NullDirection& direction : report.unidentifiable) {
      EXPECT_FALSE(direction.words.empty());
      EXPECT_FALSE(direction.remedy.empty());
    }
  }
}

using enum MeasurementKind;
INSTANTIATE_TEST_SUITE_P(
    Lines,
    Table,
    ::testing::Values(
        Line{"full_pose", kPose, {}, {}, true, 42, 42},
        Line{"and_base_mismatch", kPose, {}, {"struts.mount"}, true, 42, 48},
        Line{"and_target_mount", kPose, {}, {"struts.mount", "tool.mount"}, true, 42, 54},
        Line{"position_of_1_target", kPosition, Targets(1), {}, true, 39, 42},
        Line{"position_of_2_targets", kPosition, Targets(2), {}, true, 41, 42},
        Line{"position_of_3_targets", kPosition, Targets(3), {}, true, 42, 42},
        Line{"ball_bar_1_known_centre", kBallBar, Centres(1, true), {}, true, 36, 42},
        Line{"ball_bar_2_known_centres", kBallBar, Centres(2, true), {}, true, 38, 42},
        Line{"ball_bar_3_known_centres", kBallBar, Centres(3, true), {}, true, 39, 42},
        Line{"ball_bar_1_unknown_centre", kBallBar, Centres(1, false), {}, true, 36, 45},
        Line{"ball_bar_3_unknown_centres", kBallBar, Centres(3, false), {}, true, 42, 51},
        Line{"ball_bar_4_unknown_centres", kBallBar, Centres(4, false), {}, true, 45, 54},
        Line{"one_known_plane", kPlane, Planes(1), {}, true, 36, 42},
        Line{"three_known_planes", kPlane, Planes(3), {}, true, 39, 42},
        Line{"full_pose_without_tilt", kPose, {}, {}, false, 24, 42}),
    [](const auto& line) { return line.param.name; });

}  // namespace
}  // namespace kompono::calibration
