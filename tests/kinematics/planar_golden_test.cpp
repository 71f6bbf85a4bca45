// SPDX-License-Identifier: Apache-2.0
// The planar mechanisms against numbers made elsewhere: SO's figure 6 and KDD's equation 4.
#include "shipped_machines.hpp"
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <Eigen/LU>

namespace kompono::kinematics {
namespace {

Machine Lambda(double l1, double l2, double l3, int mode1, int mode2) {
  return tests::MachineFromText(fmt::format(
      "kompono = 1\nformula = \"part O (XY):drive tool\"\n[block.drive]\nmodule = \"lambda\"\n"
      "parameters = {{ L1 = {}, L2 = {}, L3 = {} }}\nmode = {{ q1 = {}, q2 = {} }}\n",
      l1,
      l2,
      l3,
      mode1,
      mode2));
}

VectorXd Pair(double x, double y) {
  VectorXd z(2);
  z << x, y;
  return z;
}

struct Figure6 {
  double l1, l2, l3;
  int mode1, mode2;
  double y, det;
};

std::vector<Figure6> ReadFigure6() {
  std::ifstream in(std::filesystem::path(KOMPONO_SOURCE_DIR) /
                   "tests/kinematics/data/lambda_figure6.csv");
  std::string line;
  std::getline(in, line);
  std::vector<Figure6> rows;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    Figure6 row{};
    cells >> row.l1 >> row.l2 >> row.l3 >> row.mode1 >> row.mode2 >> row.y >> row.det;
    rows.push_back(row);
  }
  return rows;
}

TEST(LambdaFigure6, DeterminantAgainstYInAllModes) {
  const std::vector<Figure6> rows = ReadFigure6();
  ASSERT_GE(rows.size(), 80U);
  for (const Figure6& row : rows) {
    const Machine machine = Lambda(row.l1, row.l2, row.l3, row.mode1, row.mode2);
    for (const double x : {-300.0, 0.0, 741.0}) {  // the curve does not depend on x
      VectorXd q;
      MatrixXd J;
      machine.DrivesOf(Pair(x, row.y), machine.nominal(), &q, nullptr, &J);
      EXPECT_NEAR(J.determinant(), row.det, 1e-12 * std::max(1.0, std::abs(row.det)))
          << "L2 = " << row.l2 << ", modes " << row.mode1 << ' ' << row.mode2 << ", y = " << row.y;
    }
  }
}

int TypeAt(const Machine& machine, double y) {
  return machine.Singularities(Pair(12.0, y), machine.nominal()).at(0).type;
}

// det A = (L3/L1) y (q2 - q1), det B = X d, case by case.
TEST(LambdaSingularities, WhereTheyStandForL2BelowAtAndAboveL3) {
  for (const int mode1 : {1, -1}) {
    for (const int mode2 : {1, -1}) {
      const Machine shorter = Lambda(1200.0, 400.0, 600.0, mode1, mode2);
      EXPECT_EQ(TypeAt(shorter, 0.0), 2);
      EXPECT_EQ(TypeAt(shorter, 799.0), 0);
      EXPECT_EQ(TypeAt(shorter, 800.0), 1) << "y = L1 L2 / L3";
      VectorXd q;
      VectorXd reach;
      shorter.DrivesOf(Pair(0.0, 801.0), shorter.nominal(), &q, &reach);
      EXPECT_LT(reach[1], 0.0) << "beyond it slider 2 is out of reach";
      EXPECT_GT(reach[0], 0.0);

      const Machine longer = Lambda(1200.0, 800.0, 600.0, mode1, mode2);
      EXPECT_EQ(TypeAt(longer, 0.0), 2);
      EXPECT_EQ(TypeAt(longer, 800.0), 0);
      EXPECT_EQ(TypeAt(longer, 1200.0), 1) << "y = L1";

      const Machine equal = Lambda(1200.0, 600.0, 600.0, mode1, mode2);
      const bool folded = mode1 != mode2;  // the sliders coincide at every pose
      for (const double y : {300.0, 800.0, 1100.0})
        EXPECT_EQ(TypeAt(equal, y), folded ? 2 : 0) << mode1 << mode2 << y;
      EXPECT_EQ(TypeAt(equal, 1200.0), 3) << "upright, and the sliders meet";
    }
  }
}

// d = P ± sqrt(P² - H), P = l1 cos φ1 + l2 cos φ4, H = l1² + l2² - g² + 2 l1 l2 cos(φ1 + φ4).
TEST(BiGlideWithWidth, CarriagesStandAsFarApartAsKdd4Says) {
  const double l1 = 420.0;
  const double l2 = 350.0;
  const double g = 90.0;
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part O (XY):glides tool\"\n[block.glides]\nmodule = \"biglide\"\n"
      "parameters = { L1 = 420, L2 = 350, width = 90 }\n");
  for (const double x : {-100.0, 0.0, 55.5}) {
    for (double y = 20.0; y < 349.0; y += 23.0) {
      VectorXd q;
      machine.DrivesOf(Pair(x, y), machine.nominal(), &q);
      const double phi1 = std::asin(y / l1);
      const double phi4 = std::asin(y / l2);
      const double P = l1 * std::cos(phi1) + l2 * std::cos(phi4);
      const double H = l1 * l1 + l2 * l2 - g * g + 2.0 * l1 * l2 * std::cos(phi1 + phi4);
      EXPECT_NEAR(q[1] - q[0], P + std::sqrt(P * P - H), 1e-9) << x << ' ' << y;
    }
  }
}

// With a platform the carriages are g apart where the struts' lines meet: inside the work zone.
TEST(BiGlideWithWidth, InnerSingularityIsWhereTheStrutsAreParallel) {
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part O (XY):glides tool\"\n[block.glides]\nmodule = \"biglide\"\n"
      "parameters = { L1 = 400, L2 = 400, width = 90 }\nmode = { q1 = \"+\", q2 = \"+\" }\n");
  VectorXd q;
  machine.DrivesOf(Pair(10.0, 200.0), machine.nominal(), &q);
  EXPECT_NEAR(q[1] - q[0], 90.0, 1e-9);
  EXPECT_EQ(machine.Singularities(Pair(10.0, 200.0), machine.nominal()).at(0).type, 2);
}

}  // namespace
}  // namespace kompono::kinematics
