// SPDX-License-Identifier: Apache-2.0
#include "shipped_machines.hpp"

#include <cmath>

namespace kompono::kinematics {
namespace {

constexpr double kRadPerDeg = 0.017453292519943295769;

PoseTarget Target(std::initializer_list<std::pair<int, double>> components) {
  PoseTarget target;
  for (const auto& [k, value] : components) target.component[static_cast<std::size_t>(k)] = value;
  return target;
}

TEST(Machine, OnTheWorkpieceSideAnAxisMovesTheToolTheOtherWay) {
  const Machine machine = tests::MachineFromText("kompono = 1\nformula = \"part X Y O Z tool\"\n");
  const Solution solved = machine.Inverse(Target({{0, 100.0}, {1, 50.0}, {2, 10.0}}));
  ASSERT_TRUE(solved.ok()) << solved.message;
  EXPECT_NEAR(solved.coordinates[machine.FindCoordinate("X")], -100.0, 1e-12);
  EXPECT_NEAR(solved.coordinates[machine.FindCoordinate("Y")], -50.0, 1e-12);
  EXPECT_NEAR(solved.coordinates[machine.FindCoordinate("Z")], 10.0, 1e-12);
}

TEST(Machine, FiveAxisTableTurnsAboutItsOwnAxis) {
  // The table's C axis passes through (100, 0); the part lies where the table is.
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part C O X Y Z tool\"\n[axis.C]\nposition = [100, 0, 0]\n");
  VectorXd z(4);
  z << 90.0 * kRadPerDeg, 100.0, 0.0, 5.0;
  const Pose<double> X_WT = machine.ToolPose(z, machine.nominal());
  EXPECT_LE((X_WT.p - Vector3<double>(100.0, 0.0, 5.0)).norm(), 1e-12)
      << "the tool stands on the axis of the table";
  const Solution solved = machine.Inverse(Target({{0, 30.0}, {1, -20.0}, {2, 7.0}, {5, -0.5}}));
  ASSERT_TRUE(solved.ok()) << solved.message;
  EXPECT_NEAR(solved.coordinates[machine.FindCoordinate("C")], 0.5, 1e-12);
  const Pose<double> X = machine.ToolPose(solved.coordinates, machine.nominal());
  EXPECT_LE((X.p - Vector3<double>(30.0, -20.0, 7.0)).norm(), 1e-9);
}

TEST(Machine, ComponentsThatAreNotGivenStayAtHome) {
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part O X Y Z A C tool\"\n[tool]\nmodule = \"tool\"\nparameters = { "
      "length = 80 }\n");
  const Solution solved = machine.Inverse(Target({{0, 10.0}, {1, 20.0}, {2, 30.0}}));
  ASSERT_TRUE(solved.ok()) << solved.message;
  EXPECT_NEAR(solved.coordinates[machine.FindCoordinate("A")], 0.0, 1e-12);
  EXPECT_NEAR(solved.coordinates[machine.FindCoordinate("C")], 0.0, 1e-12);
  EXPECT_NEAR(solved.coordinates[machine.FindCoordinate("Z")], 110.0, 1e-9);
}

TEST(Machine, SaysWhenTooManyComponentsAreGiven) {
  const Machine machine = tests::MachineFromText("kompono = 1\nformula = \"part O X Y tool\"\n");
  const Solution solved = machine.Inverse(Target({{0, 10.0}, {1, 20.0}, {2, 30.0}}));
  EXPECT_EQ(solved.status, SolveStatus::kOverdetermined);
  EXPECT_THAT(solved.message, testing::HasSubstr("give fewer components"));
  const Solution consistent = machine.Inverse(Target({{0, 10.0}, {1, 20.0}, {2, 0.0}}));
  EXPECT_TRUE(consistent.ok()) << consistent.message;
}

TEST(Machine, OpenBasePutsTheToolsFoundationWhereItStands) {
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part_xy (XY):drive O|O Z P_z\"\n[block.drive]\nmodule = "
      "\"lambda\"\n"
      "parameters = { L1 = 1200, L2 = 820, L3 = 600 }\n[open_base]\nposition = [900, 450, "
      "20]\nrotation = [0, 0, 90]\n");
  VectorXd z(3);
  z << 300.0, 400.0, 7.0;
  const Pose<double> X = machine.ToolPose(z, machine.nominal());
  EXPECT_LE((X.p - Vector3<double>(600.0, 50.0, 27.0)).norm(), 1e-12);
  EXPECT_LE((X.R.col(0) - Vector3<double>::UnitY()).norm(), 1e-12);
}

TEST(Machine, OutOfReachNamesTheDriveAndTheAmount) {
  const Machine machine = tests::LoadMachine("biglide_mill");
  const Solution solved = machine.Inverse(Target({{0, 0.0}, {1, 5000.0}}));
  EXPECT_EQ(solved.status, SolveStatus::kOutOfReach);
  EXPECT_THAT(solved.message, testing::HasSubstr(".q1 is out of reach"));
  EXPECT_LT(solved.reach[0], 0.0);
}

TEST(Machine, SpareCoordinatesShareAMotionSoThatAllKeepTheirRanges) {
  // Two axes along X: the shortest way would give each half of it, more than one of them has.
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part O X U tool\"\n"
      "[axis.X]\nrange = [-50, 50]\n[axis.U]\nrange = [-400, 400]\n");
  const Solution solved = machine.Inverse(Target({{0, 300.0}}));
  ASSERT_TRUE(solved.ok()) << solved.message;
  const double x = solved.coordinates[machine.FindCoordinate("X")];
  const double u = solved.coordinates[machine.FindCoordinate("U")];
  EXPECT_NEAR(x + u, 300.0, 1e-9);
  EXPECT_LE(std::abs(x), 50.0);
  EXPECT_LE(std::abs(u), 400.0);
  EXPECT_NEAR(machine.Inverse(Target({{0, 60.0}})).coordinates[0], 30.0, 1e-9)
      << "where the shortest way keeps all ranges it stays";
}

TEST(Machine, AStretchedWristFindsTheTurnsThatAreWithinReach) {
  // B C of the struts and B of the turret: two ways to one rotation, one of them out of reach.
  const Machine machine = tests::LoadMachine("kdd_counter_spindle");
  VectorXd z = machine.home();
  for (const auto& [name, value] : {std::pair{"struts.Y", 101.586},
                                    {"struts.Z", 978.759},
                                    {"struts.B", 1.00544},
                                    {"struts.C", 0.215107},
                                    {"B", 0.801886}}) {
    const int at = machine.FindCoordinate(name);
    ASSERT_GE(at, 0) << name;
    z[at] = value;
  }
  const Pose<double> X_WT = machine.ToolPose(z, machine.nominal());
  const PoseNumbers numbers = NumbersFromPose(X_WT, layout::RotationOrder::kXYZ);
  PoseTarget target;
  for (std::size_t k = 0; k < 6; ++k) target.component[k] = numbers.value[k];
  const Solution solved = machine.Inverse(target);
  ASSERT_TRUE(solved.ok()) << solved.message;
  EXPECT_LE((solved.X_WT.p - X_WT.p).norm(), 1e-8);
  EXPECT_LE((solved.X_WT.R - X_WT.R).norm(), 1e-9);
}

TEST(Machine, DriveZeroAndDirectionRelateReadingsToCarriages) {
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part O (XYZ):delta tool\"\n[block.delta]\nmodule = "
      "\"linear_delta\"\n"
      "parameters = { radius = 130.25, strut = 269, azimuth = [90, 210, 330] }\n"
      "[block.delta.drive.q1]\nzero = 300\ndirection = \"-\"\n");
  const Solution solved = machine.Inverse(Target({{0, 0.0}, {1, 0.0}, {2, 0.0}}));
  ASSERT_TRUE(solved.ok()) << solved.message;
  const double carriage = std::sqrt(269.0 * 269.0 - 130.25 * 130.25);
  EXPECT_NEAR(solved.drives[0], 300.0 - carriage, 1e-9);
  EXPECT_NEAR(solved.drives[1], carriage, 1e-9);
  const Solution back = machine.Forward(solved.drives);
  ASSERT_TRUE(back.ok()) << back.message;
  EXPECT_LE(back.X_WT.p.norm(), 1e-9);
}

TEST(Machine, ForkedFormulasGiveAChainPerPartAndTool) {
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"(part1 C_h + part2 C2_h Z2) O X Z tool\"\n[axis.Z2]\nposition = "
      "[0, 0, 0]\n");
  EXPECT_EQ(machine.coordinates().size(), 2U) << "spindles are not positioned";
  const Parsed<Machine> second = machine.Between("part2", "tool");
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->coordinates().size(), 3U);
  EXPECT_GE(second->FindCoordinate("Z2"), 0);
  const Parsed<Machine> none = machine.Between("part3", "");
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error()[0].help, testing::HasSubstr("part"));
}

TEST(Machine, AHexapodSolvedFarAwayStaysOnItsBranchOrRefuses) {
  const Machine machine = tests::LoadMachine("hexapod_reference");
  std::mt19937 random(tests::Seed());
  std::uniform_real_distribution<double> shift(-150.0, 150.0);
  std::uniform_real_distribution<double> tilt(-35.0 * kRadPerDeg, 35.0 * kRadPerDeg);
  int refused = 0;
  const int count = 500;
  for (int i = 0; i < count; ++i) {
    VectorXd z = machine.home();
    for (Eigen::Index k = 0; k < 3; ++k) z[k] += shift(random);
    for (Eigen::Index k = 3; k < 6; ++k) z[k] += tilt(random);
    VectorXd readings;
    machine.DrivesOf(z, machine.nominal(), &readings);
    const Solution back = machine.Forward(readings);
    if (!back.ok()) {
      ++refused;
      EXPECT_FALSE(back.message.empty());
      continue;
    }
    EXPECT_LE((back.coordinates - z).cwiseAbs().maxCoeff(), 1e-7)
        << "pose " << i << ", seed " << tests::Seed();
  }
  EXPECT_LE(refused, count / 50);
}

}  // namespace
}  // namespace kompono::kinematics
