// SPDX-License-Identifier: Apache-2.0
// Metrics of machines against closed forms and against the machine itself.
#include "budget.hpp"
#include "required_zone.hpp"
#include "shipped_machines.hpp"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/synthesis/sizing.hpp"

namespace kompono::synthesis {
namespace {

using Eigen::VectorXd;
using kinematics::Machine;

constexpr double kPi = 3.14159265358979323846;

Machine Built(const std::string& text) {
  Parsed<layout::Layout> layout = layout::ParseLayout(text, "test.toml", tests::ShippedRegistry());
  if (!layout) throw std::runtime_error(RenderAll(layout.error(), {}));
  Parsed<Machine> machine = Machine::Build(*layout, tests::ShippedRegistry());
  if (!machine) throw std::runtime_error(RenderAll(machine.error(), {}));
  return *machine;
}

Motion MotionOf(char letter, double lower, double upper) {
  Motion out;
  out.axis.letter = letter;
  out.name = std::string(1, letter);
  out.range = {lower, upper};
  return out;
}

constexpr const char* kGantry =
    "kompono = 1\nname = \"gantry\"\nformula = \"part O X Y Z tool\"\n"
    "[axis.X]\nstiffness = 20\n[axis.Y]\nstiffness = 40\n[axis.Z]\nstiffness = 100\n";

// A table that tilts about A and turns about C, 80 mm below the part's datum.
constexpr const char* kTrunnion =
    "kompono = 1\nname = \"trunnion\"\nformula = \"part C A Y O X Z tool\"\n"
    "[axis.A]\nposition = [0, 0, -80]\n[axis.C]\nposition = [0, 0, -80]\n";

constexpr const char* kLambda =
    "kompono = 1\nname = \"lambda\"\nformula = \"part (XY):drive O Z tool\"\n"
    "[block.drive]\nmodule = \"lambda\"\nparameters = { L1 = 1200, L2 = 820, L3 = 600 }\n"
    "mount = { position = [0, -600, 0] }\nhome = { X = 0, Y = 600 }\n"
    "[block.drive.drive.q1]\nstiffness = 0.05\n[block.drive.drive.q2]\nstiffness = 0.05\n"
    "[axis.Z]\nstiffness = 1000\n";

TEST(RequiredZone, OfAMachineThatOnlyTranslatesIsTheZoneItselfTurnedRoundOnThePartsSide) {
  const std::vector<Motion> motions{MotionOf('X', -100, 300), MotionOf('Y', 0, 50)};
  const Machine machine = Built("kompono = 1\nname = \"table\"\nformula = \"part X O Y tool\"\n");
  const RequiredZone zone = FindRequiredZone(machine, motions);
  ASSERT_TRUE(zone.found);
  ASSERT_EQ(zone.region.dimension(), 2U);
  EXPECT_NEAR(zone.region.lower[0], -300.0, 1e-9);
  EXPECT_NEAR(zone.region.upper[0], 100.0, 1e-9);
  EXPECT_NEAR(zone.region.lower[1], 0.0, 1e-9);
  EXPECT_NEAR(zone.region.upper[1], 50.0, 1e-9);
  EXPECT_DOUBLE_EQ(zone.content, 400.0 * 50.0);
  EXPECT_EQ(zone.lengths, 2U);
}

TEST(RequiredZone, OfATiltingTableCoversWhatTheMachineItselfSolves) {
  const double tilt = 0.5;
  const std::vector<Motion> motions{MotionOf('X', -100, 100),
                                    MotionOf('Y', -100, 100),
                                    MotionOf('Z', 0, 100),
                                    MotionOf('A', -tilt, tilt),
                                    MotionOf('C', -kPi, kPi)};
  const Machine machine = Built(kTrunnion);
  const RequiredZone zone = FindRequiredZone(machine, motions);
  ASSERT_TRUE(zone.found);
  ASSERT_EQ(zone.region.dimension(), 5U);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  const int x = machine.FindCoordinate("X");
  const int y = machine.FindCoordinate("Y");
  const int z = machine.FindCoordinate("Z");
  VectorXd lower = VectorXd::Constant(5, 1e9);
  VectorXd upper = -lower;
  for (int trial = 0; trial < 3000; ++trial) {
    // Coordinates first, then the tool's place: Newton from there with the turns held.
    VectorXd at = machine.home();
    at[machine.FindCoordinate("A")] = tilt * part(random);
    at[machine.FindCoordinate("C")] = kPi * part(random);
    const Eigen::Vector3d wanted(100 * part(random), 100 * part(random), 50 + 50 * part(random));
    // The part's frame is carried by C, then A: p_M = R_A R_C (w - pivot) + pivot, in closed form.
    const Eigen::Vector3d pivot(0, 0, -80);
    const double a = at[machine.FindCoordinate("A")];
    const double c = at[machine.FindCoordinate("C")];
    const Eigen::Vector3d p = RotationX(a) * (RotationZ(c) * (wanted - pivot)) + pivot;
    // The table's Y carries the part, so the machine's Y is the other way round.
    at[x] = p.x();
    at[y] = -p.y();
    at[z] = p.z();
    const Eigen::Vector3d reached = machine.ToolPose(at, machine.nominal()).p;
    ASSERT_LT((reached - wanted).norm(), 1e-9);
    lower = lower.cwiseMin(at);
    upper = upper.cwiseMax(at);
  }
  for (std::size_t i = 0; i < 5; ++i) {
    const int coordinate = zone.region.varied[i];
    // Corners at a grid of angles: all but a hair of what any pose needs, and not far beyond.
    const double width = upper[coordinate] - lower[coordinate];
    EXPECT_LT(zone.region.lower[i], lower[coordinate] + 0.01 * width) << coordinate;
    EXPECT_GT(zone.region.upper[i], upper[coordinate] - 0.01 * width) << coordinate;
    EXPECT_LT(zone.region.Extent(i), 1.2 * width) << coordinate;
  }
  // The table's way in Y is longer than the zone: the part swings.
  EXPECT_GT(zone.region.Extent(2), 210.0);
}

TEST(RequiredZone, IsNotFoundWhereAMotionIsMissing) {
  const Machine machine = Built("kompono = 1\nname = \"t\"\nformula = \"part X O Y tool\"\n");
  EXPECT_FALSE(FindRequiredZone(machine, {MotionOf('X', 0, 1), MotionOf('Z', 0, 1)}).found);
}

TEST(PoseGrid, HoldsBothEndsAndIsTheSameInColumns) {
  const Machine machine = Built(kLambda);
  const RequiredZone zone =
      FindRequiredZone(machine, {MotionOf('X', -200, 200), MotionOf('Y', -200, 200)});
  ASSERT_TRUE(zone.found);
  const PoseGrid grid(zone.region, 10000);
  EXPECT_EQ(grid.size(), 10000U);
  const auto judge = analysis::PoseJudge::Make(machine, machine.nominal(), {});
  ASSERT_TRUE(judge);
  analysis::PoseBlock block(*judge);
  grid.Fill(8000, 2000, block);
  for (const std::uint64_t k : {0U, 1U, 99U, 100U, 1999U}) {
    const VectorXd z = grid.At(8000 + k);
    for (Eigen::Index i = 0; i < z.size(); ++i)
      EXPECT_NEAR(block.column(static_cast<std::size_t>(i))[k], z[i], 1e-9) << k << " " << i;
  }
  EXPECT_DOUBLE_EQ(grid.At(0)[0], zone.region.lower[0]);
  EXPECT_DOUBLE_EQ(grid.At(grid.size() - 1)[0], zone.region.upper[0]);
}

TEST(ZoneMap, AgreesWithSinglePosesAndWithTheDrives) {
  const Machine machine = Built(kLambda);
  const RequiredZone zone =
      FindRequiredZone(machine, {MotionOf('X', -200, 200), MotionOf('Y', -300, 300)});
  ASSERT_TRUE(zone.found);
  const auto judge = analysis::PoseJudge::Make(machine, machine.nominal(), {});
  ASSERT_TRUE(judge);
  const PoseGrid grid(zone.region, 400);
  const ZoneMap map = MapZone(*judge, {1.0}, zone.region, grid);
  EXPECT_EQ(map.inside, 400U);
  double worst = 1.0;
  double sum = 0.0;
  double lowest = 1e9;
  for (std::uint64_t i = 0; i < grid.size(); ++i) {
    const VectorXd z = grid.At(i);
    const double inverse = 1.0 / analysis::DexterityAt(*judge, 0, z, 1.0).dexterity.condition;
    worst = std::min(worst, inverse);
    sum += inverse;
    VectorXd readings;
    machine.DrivesOf(z, machine.nominal(), &readings);
    lowest = std::min(lowest, readings[machine.FindDrive("drive.q1")]);
  }
  EXPECT_NEAR(map.dexterity_worst, worst, 1e-6);
  EXPECT_NEAR(map.dexterity_mean, sum / 400.0, 1e-6);
  EXPECT_NEAR(
      map.drives[static_cast<std::size_t>(machine.FindDrive("drive.q1"))].lower, lowest, 1e-9);
}

TEST(ZoneMap, CountsWhatIsOutOfReach) {
  const Machine machine = Built(kLambda);
  // Link 1 is 1200 long: beyond that there is nothing.
  const RequiredZone zone =
      FindRequiredZone(machine, {MotionOf('X', -1, 1), MotionOf('Y', -1200, 300)});
  ASSERT_TRUE(zone.found);
  const auto judge = analysis::PoseJudge::Make(machine, machine.nominal(), {});
  const ZoneMap map = MapZone(*judge, {1.0}, zone.region, PoseGrid(zone.region, 10000));
  // Y of the mechanism runs from 300 to 1800: 0.6 of it is below 1200.
  EXPECT_NEAR(map.Share(), 0.6, 0.01);
}

/// The tool of a bi-glide passes its rail, where both legs lie along it: there and behind it is no
/// zone, though every drive reaches it.
TEST(ZoneMap, EndsAtASingularity) {
  const Machine machine = Built(
      "kompono = 1\nname = \"Bi-glide\"\nformula = \"part O (XY):glides tool\"\n"
      "[block.glides]\nmodule = \"biglide\"\nparameters = { L1 = 400, L2 = 400, width = 80 }\n"
      "home = { X = 0, Y = 250 }\n");
  const auto judge = analysis::PoseJudge::Make(machine, machine.nominal(), {});
  ASSERT_TRUE(judge);
  const VectorXd home = machine.home();
  analysis::Region region{.z = home, .varied = {1}};
  region.lower = {-std::abs(home[1])};
  region.upper = {std::abs(home[1])};
  const ZoneMap map = MapZone(*judge, {1.0}, region, PoseGrid(region, 1000));
  EXPECT_EQ(map.inside, 500U);
  EXPECT_EQ(map.beyond, 500U);
}

TEST(Budget, OfThreePerpendicularAxesIsTheWeakestDriveAndTheSumOfVariances) {
  const Machine machine = Built(kGantry);
  const RequiredZone zone =
      FindRequiredZone(machine, {MotionOf('X', 0, 0), MotionOf('Y', 0, 0), MotionOf('Z', 0, 0)});
  EvaluationSettings settings;
  settings.squareness_rad = 0.0;
  settings.guide_angle_rad = 1e-5;
  settings.guide_lever_mm = 400.0;
  settings.guide_straightness_mm = 0.003;
  settings.drive_tolerance_mm = 0.004;
  settings.slide_kg = 100.0;
  settings.slide_share = 0.0;
  settings.tool_kg = 50.0;
  settings.acceleration_mm_s2 = 1000.0;
  const MovedMasses masses = MassesOf(machine, 500.0, settings);
  EXPECT_DOUBLE_EQ(masses.of.at("Z"), 150.0);
  EXPECT_DOUBLE_EQ(masses.of.at("Y"), 250.0);
  EXPECT_DOUBLE_EQ(masses.of.at("X"), 350.0);
  EXPECT_DOUBLE_EQ(masses.sum, 750.0) << "the part stands still";
  const ToolBudget budget = BudgetOf(machine, zone.poses, masses, 'z', settings);
  EXPECT_NEAR(budget.stiffness_n_per_mm, 20e3, 1e-6);
  // Forces 150, 250 and 350 N on 100, 40 and 20 N/µm.
  EXPECT_NEAR(budget.dynamic_mm, 150.0 / 100e3 + 250.0 / 40e3 + 350.0 / 20e3, 1e-9);
  const double guides = 3 * (2 * 0.003 * 0.003 + 2 * 400.0 * 400.0 * 1e-10);
  EXPECT_NEAR(budget.error_mm, std::sqrt(guides + 3 * 0.004 * 0.004), 1e-9);
  EXPECT_TRUE(std::isnan(budget.orientation_margin));
  EXPECT_EQ(budget.singularity_margin, 1.0);
}

TEST(Budget, OfAMechanismIsWhatItsForwardKinematicsSays) {
  const Machine machine = Built(kLambda);
  const RequiredZone zone =
      FindRequiredZone(machine, {MotionOf('X', 0, 0), MotionOf('Y', 100, 100)});
  EvaluationSettings settings;
  settings.guide_angle_rad = settings.squareness_rad = settings.guide_straightness_mm = 0.0;
  settings.drive_tolerance_mm = 0.01;
  const MovedMasses masses = MassesOf(machine, 500.0, settings);
  const ToolBudget budget = BudgetOf(machine, {zone.region.z}, masses, 'z', settings);
  // Each drive and each number of the geometry moved a little, the tool's way by forward solution.
  const VectorXd z = zone.region.z;
  const VectorXd theta = machine.nominal();
  VectorXd readings;
  machine.DrivesOf(z, theta, &readings);
  Eigen::Matrix3d compliance = Eigen::Matrix3d::Zero();
  double variance = 0.0;
  const auto moved = [&](const VectorXd& q, const VectorXd& numbers) {
    const auto solution = machine.Forward(q, numbers, z);
    EXPECT_TRUE(solution.ok()) << solution.message;
    return solution.X_WT.p;
  };
  const double step = 1e-3;
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    VectorXd up = readings;
    VectorXd down = readings;
    up[i] += step;
    down[i] -= step;
    const Eigen::Vector3d t = (moved(up, theta) - moved(down, theta)) / (2 * step);
    const double k = *machine.drives()[static_cast<std::size_t>(i)].stiffness;
    compliance += t * t.transpose() / k;
    variance += t.squaredNorm() * 0.01 * 0.01;
  }
  for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
    const double tolerance = machine.parameters()[i].tolerance;
    if (tolerance <= 0.0) continue;
    VectorXd up = theta;
    VectorXd down = theta;
    up[static_cast<Eigen::Index>(i)] += step;
    down[static_cast<Eigen::Index>(i)] -= step;
    const Eigen::Vector3d t = (moved(readings, up) - moved(readings, down)) / (2 * step);
    variance += t.squaredNorm() * tolerance * tolerance;
  }
  const double largest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(compliance).eigenvalues().maxCoeff();
  EXPECT_NEAR(budget.stiffness_n_per_mm, 1.0 / largest, 1e-4 / largest);
  EXPECT_NEAR(budget.error_mm, std::sqrt(variance), 1e-4 * std::sqrt(variance));
  EXPECT_LT(budget.singularity_margin, 1.0);
  EXPECT_GT(budget.singularity_margin, 0.0);
}

TEST(Budget, FindsTheSingularTableAtLevelAndNotTheTiltedOne) {
  const Machine machine = Built(kTrunnion);
  const EvaluationSettings settings;
  const MovedMasses masses = MassesOf(machine, 10.0, settings);
  const auto margin = [&](double from, double to) {
    const RequiredZone zone = FindRequiredZone(machine,
                                               {MotionOf('X', 0, 0),
                                                MotionOf('Y', 0, 0),
                                                MotionOf('Z', 0, 0),
                                                MotionOf('A', from, to),
                                                MotionOf('C', 0, 0)});
    return BudgetOf(machine, zone.poses, masses, 'z', settings).orientation_margin;
  };
  EXPECT_NEAR(margin(-0.5, 0.5), 0.0, 1e-9) << "C about the tool's own axis";
  // Directions by A and C are perpendicular, by C shortened to the sine of the tilt.
  EXPECT_NEAR(margin(0.5, 0.9), std::sin(0.5), 1e-9);
}

TEST(SpaceBox, OfAMovingTableIsLongerByItsTravel) {
  Study study;
  study.part_size_mm = {400.0, 200.0, 50.0};
  study.motions = {MotionOf('X', -200, 200), MotionOf('Y', -100, 100)};
  const auto box = [&](const char* formula) {
    const Machine machine =
        Built(std::string("kompono = 1\nname = \"t\"\nformula = \"") + formula + "\"\n");
    const RequiredZone zone = FindRequiredZone(machine, study.motions);
    EXPECT_TRUE(zone.found);
    return BoxOf(machine, zone.poses, study);
  };
  EXPECT_NEAR(box("part O X Y tool").FloorMm2(), 400.0 * 200.0, 1e-6);
  EXPECT_NEAR(box("part X Y O tool").FloorMm2(), 800.0 * 400.0, 1e-6);
}

TEST(Sizing, GivesTheSmallestLambdaThatKeepsTheGoal) {
  const Machine machine = Built(kLambda);
  const RequiredZone zone =
      FindRequiredZone(machine, {MotionOf('X', -250, 250), MotionOf('Y', -200, 200)});
  ASSERT_TRUE(zone.found);
  SizingTask task{.machine = &machine, .mechanism = 0, .region = &zone.region};
  for (const char* name : {"drive.L1", "drive.L2", "drive.L3"}) {
    task.free.push_back({.numbers = {machine.FindParameter(name)},
                         .lower = 300.0,
                         .upper = 2400.0,
                         .start = 1200.0});
  }
  EvaluationSettings settings;
  settings.dexterity_goal = 0.2;
  const SizingResult sized = SizeMechanism(task, settings);
  EXPECT_TRUE(sized.Reaches());
  EXPECT_GE(sized.dexterity_worst, 0.2 - 1e-3);
  EXPECT_LE(sized.evaluations, 200);
  // Another start leads to much the same.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> length(300.0, 2400.0);
  const SizingResult again = SizeMechanism(task, settings);
  EXPECT_EQ(again.values, sized.values) << "deterministic";
  for (FreeNumber& number : task.free) number.start = length(random);
  const SizingResult other = SizeMechanism(task, settings);
  EXPECT_NEAR(other.size_mm, sized.size_mm, 0.1 * sized.size_mm);
}

TEST(Sizing, SaysHowNearItCameWhereTheGoalCannotBeMet) {
  const Machine machine = Built(kLambda);
  const RequiredZone zone =
      FindRequiredZone(machine, {MotionOf('X', -250, 250), MotionOf('Y', -590, 500)});
  SizingTask task{.machine = &machine, .mechanism = 0, .region = &zone.region};
  task.free.push_back({.numbers = {machine.FindParameter("drive.L1")},
                       .lower = 1250.0,
                       .upper = 1500.0,
                       .start = 1300.0});
  EvaluationSettings settings;
  settings.dexterity_goal = 0.9;
  const SizingResult sized = SizeMechanism(task, settings);
  EXPECT_LT(sized.dexterity_worst, 0.9);
}

}  // namespace
}  // namespace kompono::synthesis
