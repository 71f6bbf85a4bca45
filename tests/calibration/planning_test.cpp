// SPDX-License-Identifier: Apache-2.0
// Chosen poses against random ones, by prediction and by what identifications with them find.
#include "kompono/calibration/planning.hpp"

#include "machines.hpp"
#include "poses.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using testing::AddNoise;
using testing::Good;
using testing::MachineOf;

PlanOptions TwentyPoses(PlanCriterion criterion) {
  PlanOptions options;
  options.points = 20;
  options.criterion = criterion;
  options.instrument.kind = MeasurementKind::kPose;
  options.instrument.sigma_mm = 0.005;
  options.instrument.sigma_rad = 5e-6;
  options.instrument.region = {{"struts.X", {-150, 150}},
                               {"struts.Y", {-150, 150}},
                               {"struts.Z", {800, 1000}},
                               {"struts.A", {-0.3, 0.3}},
                               {"struts.B", {-0.3, 0.3}},
                               {"struts.C", {-0.3, 0.3}}};
  return options;
}

class Criteria : public ::testing::TestWithParam<PlanCriterion> {};

TEST_P(Criteria, TwentyChosenPosesBeatTheMedianOfRandomSets) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const Plan plan = Good(PlanMeasurements(machine, TwentyPoses(GetParam())));
  ASSERT_EQ(plan.set.measurements.size(), 20U);
  EXPECT_EQ(plan.rank, 42);
  std::printf("predicted tool deviation: chosen %.2f um, random %.2f um, ratio %.2f\n",
              1e3 * plan.tool_sigma_mm.back(),
              1e3 * plan.random_tool_sigma_mm,
              plan.random_tool_sigma_mm / plan.tool_sigma_mm.back());
  EXPECT_GE(plan.random_tool_sigma_mm, 1.4 * plan.tool_sigma_mm.back());
  for (std::size_t i = 1; i < plan.tool_sigma_mm.size(); ++i) {
    EXPECT_LE(plan.tool_sigma_mm[i], plan.tool_sigma_mm[i - 1]) << "more rows, " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Both,
                         Criteria,
                         ::testing::Values(PlanCriterion::kDOptimal, PlanCriterion::kToolError),
                         [](const auto& criterion) {
                           return criterion.param == PlanCriterion::kDOptimal ? "d_optimal"
                                                                              : "tool_error";
                         });

TEST(Plan, OffersNoPoseInWhichAJointSwingsTooFarOrStrutsTouch) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  PlanOptions options = TwentyPoses(PlanCriterion::kToolError);
  const Plan free = Good(PlanMeasurements(machine, options));
  EXPECT_EQ(free.obstructed, 0);
  options.limits.swings = {{"struts.base*", 0.12}};
  options.limits.strut_radius_mm = 20.0;
  const Plan plan = Good(PlanMeasurements(machine, options));
  EXPECT_GT(plan.obstructed, 0);
  EXPECT_GT(plan.drawn, free.drawn);
  const auto judge = analysis::PoseJudge::Make(machine, machine.nominal(), options.limits);
  ASSERT_TRUE(judge);
  const auto broken = [&](const Plan& of) {
    analysis::PoseBlock poses(*judge);
    const std::size_t count = of.set.measurements.size();
    for (std::size_t k = 0; k < count; ++k) {
      const kinematics::Solution at = machine.Forward(of.set.measurements[k].readings);
      EXPECT_TRUE(at.ok());
      for (Eigen::Index i = 0; i < at.coordinates.size(); ++i) {
        poses.column(static_cast<std::size_t>(i))[k] = at.coordinates[i];
      }
    }
    poses.Judge(count);
    return count - poses.InsideCount();
  };
  EXPECT_GT(broken(free), 0U) << "the limits exclude nothing, so that this shows nothing";
  EXPECT_EQ(broken(plan), 0U);
}

TEST(Plan, SaysWhyTooFewPosesAreLeft) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  PlanOptions options = TwentyPoses(PlanCriterion::kToolError);
  options.limits.swings = {{"struts.base*", 1e-4}};
  const auto plan = PlanMeasurements(machine, options);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().front().message.find("a joint swings too far"), std::string::npos);
  options.limits.swings = {{"struts.nothing", 0.1}};
  const auto wrong = PlanMeasurements(machine, options);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().front().code, "E0721");
}

/// RMS over `draws` identifications of the tool's error on poses of the zone.
double ToolError(const kinematics::Machine& machine,
                 const MeasurementSet& rows,
                 const MeasurementSet& judges,
                 unsigned draws) {
  double sum = 0.0;
  for (unsigned draw = 1; draw <= draws; ++draw) {
    MeasurementSet set = rows;
    AddNoise(draw, &set);
    for (Measurement m : judges.measurements) {
      m.held_out = true;
      set.measurements.push_back(std::move(m));
    }
    for (const ErrorStatistics& s : Identify(machine, set).statistics) {
      if (s.held_out && s.quantity == "position") sum += s.rms_after * s.rms_after / draws;
    }
  }
  return std::sqrt(sum);
}

TEST(Planning, PredictionsHoldInIdentifications) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  const PlanOptions options = TwentyPoses(PlanCriterion::kToolError);
  const Plan plan = Good(PlanMeasurements(machine, options));
  SimulateOptions judge = options.instrument;
  judge.sigma_mm = judge.sigma_rad = 0.0;
  judge.count = 100;
  judge.seed = 77;
  const MeasurementSet judges = Good(Simulate(machine, machine, machine.nominal(), judge));
  const double chosen = ToolError(machine, plan.set, judges, 20);
  EXPECT_NEAR(chosen, plan.tool_sigma_mm.back(), 0.2 * chosen);
  std::vector<double> random;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    SimulateOptions draw = options.instrument;
    draw.count = 20;
    draw.seed = 1000 + seed;
    MeasurementSet set = Good(Simulate(machine, machine, machine.nominal(), draw));
    random.push_back(ToolError(machine, set, judges, 10));
  }
  std::sort(random.begin(), random.end());
  std::printf("identified: chosen %.2f um, random %.2f um\n", 1e3 * chosen, 1e3 * random[4]);
  EXPECT_GE(random[4], 1.4 * chosen);
}

}  // namespace
}  // namespace kompono::calibration
