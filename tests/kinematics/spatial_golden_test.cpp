// SPDX-License-Identifier: Apache-2.0
// The spatial mechanisms against what their drawings say: strut lengths, planes of hinges, a tube
// through its joint, the work zone of a lathe head.
#include "shipped_machines.hpp"
#include <fmt/format.h>

#include <map>

namespace kompono::kinematics {
namespace {

std::map<std::string, Eigen::Vector3d> PointsAt(const Machine& machine, const VectorXd& z) {
  std::map<std::string, Eigen::Vector3d> points;
  for (const auto& point : machine.Skeleton(z, machine.nominal()).points)
    points[point.name] = point.p_M;
  return points;
}

VectorXd Numbers(std::initializer_list<double> list) {
  VectorXd out(static_cast<Eigen::Index>(list.size()));
  std::copy(list.begin(), list.end(), out.begin());
  return out;
}

/// Rails of six directions that nothing makes alike.
constexpr const char* kWildHexaglide = R"(
kompono = 1
formula = "part O (XYZABC):glides tool"
[block.glides]
module = "hexaglide"
mode = { q2 = "-", q4 = "-", q6 = "-" }
[block.glides.parameters]
rail_start = [[-700, 500, 480], [-650, 420, 560], [100, 600, 500], [650, -520, 530], [-50, -580, 470], [620, -450, 510]]
rail_end = [[600, 430, 620], [500, 610, 450], [-400, 350, 700], [-600, -400, 610], [700, -330, 580], [-640, -600, 400]]
joint = [[180, 60, 10], [70, 190, -20], [-190, 40, 0], [-170, -70, 15], [60, -180, -10], [200, -35, 5]]
strut = [860, 800, 880, 850, 830, 850]
)";

TEST(Hexaglide, OnAnyRailsStrutsKeepTheirLengthsAndCarriagesTheirRails) {
  const Machine machine = tests::MachineFromText(kWildHexaglide);
  const std::array<double, 6> strut{860.0, 800.0, 880.0, 850.0, 830.0, 850.0};
  std::mt19937 random(tests::Seed());
  int checked = 0;
  for (const tests::NamedPose& pose : tests::PosesOf(machine, 40, &random)) {
    VectorXd q;
    machine.DrivesOf(pose.z, machine.nominal(), &q);
    const auto points = PointsAt(machine, pose.z);
    for (int i = 1; i <= 6; ++i) {
      const Eigen::Vector3d carriage = points.at(fmt::format("glides.carriage{}", i));
      const Eigen::Vector3d start = points.at(fmt::format("glides.start{}", i));
      const Eigen::Vector3d joint = points.at(fmt::format("glides.joint{}", i));
      EXPECT_NEAR((joint - carriage).norm(), strut[static_cast<std::size_t>(i - 1)], 1e-9);
      EXPECT_NEAR((carriage - start).norm(), std::abs(q[i - 1]), 1e-9);
    }
    const Solution back = machine.Forward(q, machine.nominal(), pose.z * 0.999);
    ASSERT_TRUE(back.ok()) << back.message;
    EXPECT_LE((back.coordinates - pose.z).cwiseAbs().maxCoeff(), 1e-7) << pose.kind;
    ++checked;
  }
  EXPECT_GE(checked, 40);
}

TEST(FourStrutLathe, HoldsXAndTheTurnAboutX) {
  const Machine machine = tests::LoadMachine("kdd_four_strut_lathe");
  const auto at_home = PointsAt(machine, Numbers({0.0, 0.0, 0.0, 0.0}));
  EXPECT_NEAR(at_home.at("struts.carriage1").z(), 450.0, 1e-9);
  EXPECT_NEAR(at_home.at("struts.carriage2").z(), -450.0, 1e-9);
  for (const double turn : {-0.2, 0.1, 0.3}) {
    const VectorXd z = Numbers({-40.0, 70.0, turn, -turn});
    EXPECT_NEAR(PointsAt(machine, z).at("struts.tool").x(), 0.0, 1e-12);
    const Pose<double> platform = machine.ToolPose(z, machine.nominal());
    const Pose<double> zero = machine.ToolPose(machine.home(), machine.nominal());
    const PoseNumbers numbers =
        NumbersFromPose({platform.R * zero.R.transpose(), platform.p}, layout::RotationOrder::kXYZ);
    EXPECT_NEAR(numbers.value[3], 0.0, 1e-12) << "A";
    EXPECT_NEAR(numbers.value[4], turn, 1e-12) << "B";
    EXPECT_NEAR(numbers.value[5], -turn, 1e-12) << "C";
  }
}

TEST(SixStrutLathe, IsSingularOnThePlaneOfSymmetryIfCAndCLeanApart) {
  const auto text = [](const char* last_mode) {
    return fmt::format(
        "kompono = 1\nformula = \"part O (XYZABC):struts tool\"\n[block.struts]\n"
        "module = \"six_strut_lathe\"\nmode = {{ q6 = \"{}\" }}\n",
        last_mode);
  };
  const Machine alike = tests::MachineFromText(text("-"));
  const Machine apart = tests::MachineFromText(text("+"));
  for (const double y : {-40.0, 0.0, 30.0}) {
    const VectorXd z = Numbers({0.0, y, 12.0, 0.0, 0.0, 0.0});
    EXPECT_EQ(alike.Singularities(z, alike.nominal()).at(0).type, 0);
    EXPECT_EQ(apart.Singularities(z, apart.nominal()).at(0).type, 2) << y;
  }
}

TEST(HingedTripod, ParasiticMotionIsTheClosedFormula) {
  const double r = 200.0;
  const Machine machine = tests::MachineFromText(
      "kompono = 1\nformula = \"part O (ZAB):head tool\"\n[block.head]\nmodule = \"tripod_3rps\"\n"
      "parameters = { base_radius = 300, platform_radius = 200 }\n");
  for (double a = -0.6; a <= 0.61; a += 0.2) {
    for (double b = -0.6; b <= 0.61; b += 0.2) {
      const VectorXd z = Numbers({420.0, a, b});
      const PoseNumbers pose =
          NumbersFromPose(machine.ToolPose(z, machine.nominal()), layout::RotationOrder::kXYZ);
      const double c = std::atan(-std::sin(a) * std::sin(b) / (std::cos(a) + std::cos(b)));
      const double x = 0.5 * r *
                       (std::cos(b) * std::cos(c) - std::cos(a) * std::cos(c) +
                        std::sin(a) * std::sin(b) * std::sin(c));
      const double y = -r * (std::cos(a) * std::sin(c) + std::sin(a) * std::sin(b) * std::cos(c));
      const std::array<double, 6> wanted{x, y, 420.0, a, b, c};
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(pose.value[i], wanted[i], 1e-10) << i;
      // Why: each joint stays in the upright plane that its hinge leaves it.
      const auto points = PointsAt(machine, z);
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d joint = points.at(fmt::format("head.joint{}", i + 1));
        const double azimuth = i * 2.0 * EIGEN_PI / 3.0;
        EXPECT_NEAR(joint.y() * std::cos(azimuth) - joint.x() * std::sin(azimuth), 0.0, 1e-10);
      }
    }
  }
  // The numbers of the README, at 20°.
  const double t = 20.0 * EIGEN_PI / 180.0;
  const PoseNumbers pose = NumbersFromPose(
      machine.ToolPose(Numbers({420.0, t, t}), machine.nominal()), layout::RotationOrder::kXYZ);
  EXPECT_NEAR(pose.value[0], -0.7267, 5e-5);
  EXPECT_NEAR(pose.value[1], -11.6752, 5e-5);
  EXPECT_NEAR(pose.value[5] * 180.0 / EIGEN_PI, -3.5616, 5e-5);
}

TEST(GuidedTripod, TubeRunsThroughItsJointAndDoesNotTurnAboutItself) {
  const Machine machine = tests::LoadMachine("tripod_guided");
  for (const double x : {-300.0, 0.0, 250.0}) {
    for (const double y : {-200.0, 10.0, 330.0}) {
      const VectorXd z = Numbers({x, y, -880.0});
      const auto points = PointsAt(machine, z);
      const Eigen::Matrix3d R = machine.ToolPose(z, machine.nominal()).R;
      const Eigen::Vector3d along = (points.at("pods.guide") - points.at("pods.tool")).normalized();
      EXPECT_NEAR((R.col(2) - along).norm(), 0.0, 1e-12);
      EXPECT_NEAR(R(0, 1), 0.0, 1e-12) << "the collar's axis stays square to the base's axis x";
      EXPECT_NEAR((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
      for (int i = 1; i <= 3; ++i) {
        VectorXd q;
        machine.DrivesOf(z, machine.nominal(), &q);
        EXPECT_NEAR(
            (points.at(fmt::format("pods.joint{}", i)) - points.at(fmt::format("pods.base{}", i)))
                .norm(),
            q[i - 1],
            1e-9);
      }
    }
  }
}

// Index V100: 250 x 250 x 150 mm. Every 10 mm of it, the corners and edges among them.
TEST(V100Head, ReachesItsWholeWorkZoneWithinItsLimits) {
  const Machine machine = tests::LoadMachine("v100_lathe");
  ASSERT_EQ(machine.coordinates().size(), 3U);
  const std::array<double, 3> wanted{250.0, 250.0, 150.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const Coordinate& c = machine.coordinates()[i];
    ASSERT_TRUE(c.lower && c.upper);
    EXPECT_GE(*c.upper - *c.lower, wanted[i]) << c.name;
  }
  const auto at = [&machine](std::size_t i, double share) {
    const Coordinate& c = machine.coordinates()[i];
    return *c.lower + share * (*c.upper - *c.lower);
  };
  int poses = 0;
  for (int i = 0; i <= 25; ++i) {
    for (int j = 0; j <= 25; ++j) {
      for (int k = 0; k <= 15; ++k, ++poses) {
        const VectorXd z = Numbers({at(0, i / 25.0), at(1, j / 25.0), at(2, k / 15.0)});
        VectorXd q;
        VectorXd reach;
        machine.DrivesOf(z, machine.nominal(), &q, &reach);
        ASSERT_TRUE(q.allFinite() && (reach.array() > 0.0).all()) << z.transpose();
        for (std::size_t d = 0; d < 3; ++d) {
          const Drive& drive = machine.drives()[d];
          ASSERT_TRUE(drive.lower && drive.upper);
          ASSERT_GE(q[static_cast<Eigen::Index>(d)], *drive.lower) << z.transpose();
          ASSERT_LE(q[static_cast<Eigen::Index>(d)], *drive.upper) << z.transpose();
        }
        ASSERT_GT(machine.Singularities(z, machine.nominal()).at(0).margin, 0.2) << z.transpose();
      }
    }
  }
  EXPECT_EQ(poses, 26 * 26 * 16);
}

}  // namespace
}  // namespace kompono::kinematics
