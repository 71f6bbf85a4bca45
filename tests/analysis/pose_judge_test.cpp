// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/pose_judge.hpp"

#include "shipped_machines.hpp"

#include <cmath>
#include <numbers>

namespace kompono::analysis {
namespace {

Region AroundHome(const Machine& machine, double mm, double rad) {
  Region region{.z = machine.home()};
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const kinematics::Coordinate& c = machine.coordinates()[i];
    const double half = c.rotary ? rad : mm;
    region.varied.push_back(static_cast<int>(i));
    region.lower.push_back(c.home - half);
    region.upper.push_back(c.home + half);
  }
  return region;
}

/// What Machine itself says of a pose: the slow way.
bool Allowed(const Machine& machine, const VectorXd& z) {
  VectorXd readings;
  VectorXd reach;
  machine.DrivesOf(z, machine.nominal(), &readings, &reach);
  for (std::size_t i = 0; i < machine.drives().size(); ++i) {
    const kinematics::Drive& drive = machine.drives()[i];
    if (drive.name.find('.') == std::string::npos) continue;  // a plain axis: its range is the box
    const double reading = readings[static_cast<Eigen::Index>(i)];
    if (!std::isfinite(reading) || (drive.lower && reading < *drive.lower) ||
        (drive.upper && reading > *drive.upper))
      return false;
  }
  return true;
}

TEST(PoseJudge, AgreesWithTheMachineForEveryShippedLayout) {
  std::mt19937 random(tests::Seed());
  for (const std::string& name : tests::ShippedMachineFiles()) {
    const Machine machine = tests::LoadMachine(name);
    const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
    ASSERT_TRUE(judge) << name;
    const Region region = AroundHome(machine, 400.0, 0.5);
    PoseBlock block(*judge);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<VectorXd> poses;
    for (std::size_t k = 0; k < 301; ++k) {
      std::vector<double> at;
      for (std::size_t i = 0; i < region.dimension(); ++i)
        at.push_back(region.lower[i] + uniform(random) * region.Extent(i));
      poses.push_back(region.At(at));
      for (Eigen::Index i = 0; i < poses.back().size(); ++i)
        block.column(static_cast<std::size_t>(i))[k] = poses.back()[i];
    }
    block.Judge(poses.size());
    std::size_t inside = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      EXPECT_EQ(block.Inside(k), Allowed(machine, poses[k]))
          << name << " at " << poses[k].transpose() << ", seed " << tests::Seed();
      EXPECT_EQ(block.CauseOf(k) < 0, block.Inside(k)) << name;
      inside += block.Inside(k) ? 1 : 0;
    }
    EXPECT_EQ(block.InsideCount(), inside) << name;
  }
}

constexpr const char* kDelta = R"(
kompono = 1
formula = "part O (XYZ):delta tool"
[block.delta]
module = "linear_delta"
parameters = { radius = 130, azimuth = [90, 210, 330], strut = 270 }
home = { X = 0, Y = 0, Z = 0 }
[block.delta.drive.q1]
range = [100, 400]
direction = "-"
zero = 500
)";

TEST(PoseJudge, NamesTheLimitOfAReversedDriveByItsReading) {
  // Coordinate = 500 - reading: readings 100 … 400 are coordinates 100 … 400 the other way round.
  const Machine machine = tests::MachineFromText(kDelta);
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  ASSERT_TRUE(judge);
  VectorXd z = machine.home();
  VectorXd readings;
  machine.DrivesOf(z, machine.nominal(), &readings);
  z[2] += readings[0] - 399.0;  // Z up by d lowers the reading by d
  EXPECT_EQ(CauseAt(*judge, z), -1);
  z[2] -= 2.0;
  const int cause = CauseAt(*judge, z);
  ASSERT_GE(cause, 0);
  EXPECT_EQ(judge->constraints()[static_cast<std::size_t>(cause)].name,
            "delta.q1 at its upper limit");
}

TEST(CountGrid, IsTheSameForAnyNumberOfThreadsAndSumsUp) {
  const Machine machine = tests::LoadMachine("biglide_mill");
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  const Region region{
      .z = machine.home(), .varied = {0, 1}, .lower = {-900, -500}, .upper = {900, 500}};
  const std::array<std::uint64_t, 2> steps{317, 211};
  const PoseCount one = CountGrid(*judge, region, steps, true, {.threads = 1});
  const PoseCount three = CountGrid(*judge, region, steps, true, {.threads = 3});
  EXPECT_EQ(one.poses, 317U * 211U);
  EXPECT_EQ(one.inside, three.inside);
  EXPECT_EQ(one.causes, three.causes);
  EXPECT_FALSE(one.stopped);
  std::uint64_t outside = 0;
  for (const std::uint64_t cause : one.causes) outside += cause;
  EXPECT_EQ(one.inside + outside, one.poses);
  EXPECT_GT(one.inside, 0U);
  EXPECT_GT(outside, 0U);
}

TEST(CountGrid, AfterAStopTellsWhatWasDone) {
  const Machine machine = tests::LoadMachine("biglide_mill");
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  const Region region{
      .z = machine.home(), .varied = {0, 1}, .lower = {-900, -500}, .upper = {900, 500}};
  const std::array<std::uint64_t, 2> steps{100000, 100000};  // minutes of work
  std::atomic<bool> stop{false};
  std::uint64_t told = 0;
  const PoseCount count = CountGrid(*judge,
                                    region,
                                    steps,
                                    false,
                                    {.threads = 2,
                                     .progress =
                                         [&](std::uint64_t done, std::uint64_t all) {
                                           EXPECT_LE(done, all);
                                           told = done;
                                           stop = true;
                                         },
                                     .stop = &stop});
  EXPECT_TRUE(count.stopped);
  EXPECT_GE(count.poses, told * PoseBlock::kCapacity);
  EXPECT_LT(count.poses, steps[0] * steps[1]);
}

/// Its first pod leads straight up at home; 30° of swing at its foot is tan 30° sideways.
Machine Pods(const std::string& limits = {}) {
  return tests::MachineFromText(R"(
kompono = 1
formula = "part O (XYZ):pods tool"
units = { angle = "rad" }
[block.pods]
module = "tripod"
parameters = { foot = [[0, 0, 0], [500, 0, 0], [0, 500, 0]] }
home = { X = 0, Y = 0, Z = 400 }
)" + limits);
}

TEST(PoseJudge, SwingOfAPodIsTheAngleFromHome) {
  const Machine machine = Pods();
  const auto judge =
      PoseJudge::Make(machine,
                      machine.nominal(),
                      {.swings = {{.joint = "pods.foot1", .swing_rad = std::numbers::pi / 6.0}}});
  ASSERT_TRUE(judge) << RenderAll(judge.error(), {});
  const double edge = 400.0 * std::tan(std::numbers::pi / 6.0);
  EXPECT_EQ(CauseAt(*judge, Eigen::Vector3d(edge - 0.01, 0.0, 400.0)), -1);
  const int cause = CauseAt(*judge, Eigen::Vector3d(edge + 0.01, 0.0, 400.0));
  ASSERT_GE(cause, 0);
  EXPECT_EQ(judge->constraints()[static_cast<std::size_t>(cause)].name, "swing of pods.foot1");
}

TEST(PoseJudge, SwingOfAnUnknownJointIsRefusedWithAProposal) {
  const Machine machine = tests::LoadMachine("hexapod_reference");
  const auto judge = PoseJudge::Make(
      machine, machine.nominal(), {.swings = {{.joint = "struts.bas1", .swing_rad = 1.0}}});
  ASSERT_FALSE(judge);
  EXPECT_EQ(judge.error().front().code, "E0721");
  EXPECT_THAT(judge.error().front().help, testing::HasSubstr("struts.base1"));
}

TEST(PoseJudge, StrutsOfAHexapodCollideWhenThePlatformTurnsFarEnough) {
  const Machine machine = tests::LoadMachine("hexapod_reference");
  const auto judge =
      PoseJudge::Make(machine, machine.nominal(), {.strut_radius_mm = 20.0, .clearance_mm = 5.0});
  ASSERT_TRUE(judge);
  VectorXd z = machine.home();
  EXPECT_EQ(CauseAt(*judge, z), -1);
  z[5] = 2.9;  // half a turn about its own axis: the struts cross
  const int cause = CauseAt(*judge, z);
  ASSERT_GE(cause, 0);
  EXPECT_EQ(judge->constraints()[static_cast<std::size_t>(cause)].kind,
            Constraint::Kind::kClearance);
}

TEST(PoseJudge, KeepsTheSwingsThatTheLayoutGivesUnlessToldNotTo) {
  const Machine machine = Pods("swing = { \"foot1\" = 0.5235987755982988 }\n");
  const double edge = 400.0 * std::tan(std::numbers::pi / 6.0);
  const Eigen::Vector3d outside(edge + 0.01, 0.0, 400.0);
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  ASSERT_TRUE(judge) << RenderAll(judge.error(), {});
  EXPECT_EQ(CauseAt(*judge, Eigen::Vector3d(edge - 0.01, 0.0, 400.0)), -1);
  EXPECT_GE(CauseAt(*judge, outside), 0);
  const std::vector<BrokenStrutLimit> broken = BrokenStrutLimits(*judge, outside);
  ASSERT_EQ(broken.size(), 1U);
  EXPECT_EQ(broken[0].constraint->name, "swing of pods.foot1");
  EXPECT_NEAR(broken[0].value, std::atan2(outside[0], 400.0), 1e-12);
  EXPECT_NEAR(broken[0].limit, std::numbers::pi / 6.0, 1e-12);
  const auto free = PoseJudge::Make(machine, machine.nominal(), {.of_layout = false});
  EXPECT_EQ(CauseAt(*free, outside), -1);
  const auto wider = PoseJudge::Make(
      machine, machine.nominal(), {.swings = {{.joint = "pods.foot1", .swing_rad = 1.0}}});
  EXPECT_GE(CauseAt(*wider, outside), 0) << "the narrower of both counts";
}

TEST(PoseJudge, KeepsTheClearanceThatTheLayoutGives) {
  // A platform turned by half a turn crosses its struts.
  std::string text = tests::LoadMachine("hexapod_reference").layout().text;
  const std::string module = "module = \"hexapod\"";
  const std::size_t at = text.find(module);
  ASSERT_NE(at, std::string::npos) << text;
  text.insert(at, "strut_diameter = 40\nclearance = 5\n");
  const Machine machine = tests::MachineFromText(text);
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  VectorXd z = machine.home();
  EXPECT_TRUE(BrokenStrutLimits(*judge, z).empty());
  z[5] = 2.9;
  const std::vector<BrokenStrutLimit> broken = BrokenStrutLimits(*judge, z);
  ASSERT_FALSE(broken.empty());
  EXPECT_EQ(broken[0].limit, 45.0) << "between centre lines: twice the radius and the clearance";
  const auto thinner =
      PoseJudge::Make(machine, machine.nominal(), {.strut_radius_mm = 0.0, .clearance_mm = 1e-6});
  ASSERT_TRUE(thinner);
  EXPECT_LT(BrokenStrutLimits(*thinner, z).size(), broken.size()) << "told anew";
}

}  // namespace
}  // namespace kompono::analysis
