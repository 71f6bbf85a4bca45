// SPDX-License-Identifier: Apache-2.0
// Where the planar mechanisms are singular by hand calculation (SO; KDD 2-4).
#include "shipped_machines.hpp"
#include <fmt/format.h>

namespace kompono::kinematics {
namespace {

Machine LambdaMachine(double l1, double l2, double l3, const std::string& q2) {
  return tests::MachineFromText(fmt::format(
      "kompono = 1\nformula = \"part O (XY):drive tool\"\n[block.drive]\nmodule = \"lambda\"\n"
      "parameters = {{ L1 = {}, L2 = {}, L3 = {} }}\nmode = {{ q2 = \"{}\" }}\n",
      l1,
      l2,
      l3,
      q2));
}

Singularity At(const Machine& machine, double x, double y) {
  VectorXd z(2);
  z << x, y;
  return machine.Singularities(z, machine.nominal()).at(0);
}

TEST(Lambda, IsOfType1WhereLink1StandsUpright) {
  const Machine machine = LambdaMachine(1000.0, 800.0, 500.0, "+");
  EXPECT_EQ(At(machine, 0.0, 600.0).type, 0);
  EXPECT_EQ(At(machine, 0.0, 1000.0).type, 1);
}

TEST(Lambda, IsOfType1AtL1L2OverL3WhenL2IsShorter) {
  const Machine machine = LambdaMachine(1000.0, 300.0, 500.0, "+");
  EXPECT_EQ(At(machine, 0.0, 600.0).type, 1) << "y = L1 L2 / L3";
  EXPECT_EQ(At(machine, 0.0, 500.0).type, 0);
}

TEST(Lambda, IsOfType2OnTheRail) {
  const Machine machine = LambdaMachine(1000.0, 800.0, 500.0, "+");
  EXPECT_EQ(At(machine, 0.0, 0.0).type, 2);
}

TEST(Lambda, WithEqualLinksAndMinusModeIsSingularEverywhere) {
  const Machine minus = LambdaMachine(1000.0, 500.0, 500.0, "-");
  for (const double y : {200.0, 500.0, 800.0}) EXPECT_EQ(At(minus, 0.0, y).type & 2, 2) << y;
  const Machine plus = LambdaMachine(1000.0, 500.0, 500.0, "+");
  EXPECT_EQ(At(plus, 0.0, 500.0).type, 0);
  EXPECT_EQ(At(plus, 0.0, 1000.0).type, 3)
      << "both links upright: type 1, and the sliders meet: type 2";
}

TEST(BiGlide, IsOfType2OnTheRailAndWhereTheCarriagesMeet) {
  const auto machine = [](const std::string& q1) {
    return tests::MachineFromText(
        "kompono = 1\nformula = \"part O (XY):glides tool\"\n[block.glides]\nmodule = \"biglide\"\n"
        "parameters = { L1 = 400, L2 = 400 }\nmode = { q1 = \"" +
        q1 + "\" }\n");
  };
  EXPECT_EQ(At(machine("-"), 10.0, 200.0).type, 0);
  EXPECT_EQ(At(machine("-"), 10.0, 0.0).type, 2);
  EXPECT_EQ(At(machine("+"), 10.0, 200.0).type, 2)
      << "both carriages on the same side of equal struts";
}

}  // namespace
}  // namespace kompono::kinematics
