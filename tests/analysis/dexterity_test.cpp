// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/dexterity.hpp"

#include "shipped_machines.hpp"

#include <cmath>

namespace kompono::analysis {
namespace {

Machine Biglide() {
  return tests::MachineFromText(R"(
kompono = 1
formula = "part O (XY):glides tool"
[block.glides]
module = "biglide"
parameters = { L1 = 400, L2 = 400, width = 0 }
home = { X = 0, Y = 200 }
)");
}

PoseBlock Judged(const PoseJudge& judge, const std::vector<tests::NamedPose>& list) {
  PoseBlock poses(judge);
  for (std::size_t k = 0; k < list.size(); ++k) {
    for (Eigen::Index i = 0; i < list[k].z.size(); ++i)
      poses.column(static_cast<std::size_t>(i))[k] = list[k].z[i];
  }
  poses.Judge(list.size());
  return poses;
}

TEST(Dexterity, OfManyPosesIsThatOfEachForEveryMechanism) {
  std::mt19937 random(tests::Seed());
  for (const std::string& name : tests::ShippedMachineFiles()) {
    const Machine machine = tests::LoadMachine(name);
    const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
    for (std::size_t m = 0; m < judge->mechanisms().size(); ++m) {
      const double length = CharacteristicLength(*judge, m);
      DexterityBlock block(*judge, m, length);
      const std::vector<tests::NamedPose> list = tests::PosesOf(machine, 40, &random);
      const PoseBlock poses = Judged(*judge, list);
      block.Evaluate(poses, list.size());
      for (std::size_t k = 0; k < list.size(); ++k) {
        const Dexterity exact = DexterityAt(*judge, m, list[k].z, length).dexterity;
        if (!(exact.condition < 1e4)) continue;  // differences lose digits there
        const Dexterity fast = block.At(k);
        const double tolerance = list[k].kind == "near a limit" ? 2e-3 : 1e-5;
        EXPECT_NEAR(fast.condition / exact.condition, 1.0, tolerance * exact.condition)
            << name << ", " << list[k].kind << ", seed " << tests::Seed();
        EXPECT_NEAR(fast.weakest_force / exact.weakest_force, 1.0, tolerance * exact.condition);
        EXPECT_NEAR(fast.slowest_velocity / exact.slowest_velocity,
                    1.0,
                    tolerance * std::max(10.0, exact.condition));
      }
    }
  }
}

/// Of the drives by the coordinates; NaN where they differ in number.
double Determinant(const PoseJudge::Mechanism& mechanism, const VectorXd& z) {
  const std::size_t n = mechanism.coordinate.size();
  if (n != static_cast<std::size_t>(mechanism.shape.drives)) return NAN;
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = mechanism.sign[i] * z[mechanism.coordinate[i]];
  std::vector<double> q(n);
  std::vector<double> by_x(n * n);
  static_cast<void>(mechanism.code->Evaluate(plugin::Quantity::kDrives,
                                             {x, {}, mechanism.parameters, mechanism.modes},
                                             {.values = q, .by_coordinates = by_x}));
  const auto side = static_cast<Eigen::Index>(n);
  return Eigen::Map<const Eigen::MatrixXd>(by_x.data(), side, side).determinant();
}

TEST(Dexterity, TellsTheSidesOfTypeTwoSingularitiesApart) {
  std::mt19937 random(tests::Seed());
  for (const std::string& name : tests::ShippedMachineFiles()) {
    const Machine machine = tests::LoadMachine(name);
    const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
    for (std::size_t m = 0; m < judge->mechanisms().size(); ++m) {
      const PoseJudge::Mechanism& mechanism = judge->mechanisms()[m];
      DexterityBlock block(*judge, m, 100.0, true);
      const std::vector<tests::NamedPose> list = tests::PosesOf(machine, 40, &random);
      const PoseBlock poses = Judged(*judge, list);
      block.Evaluate(poses, list.size());
      const double home = Determinant(mechanism, machine.home());
      for (std::size_t k = 0; k < list.size(); ++k) {
        const double here = Determinant(mechanism, list[k].z);
        if (!(std::abs(here) > 1e-6 * std::abs(home)) || !poses.Inside(k)) continue;
        EXPECT_EQ(block.OnHomeSide(k), here * home > 0.0)
            << name << ", " << list[k].kind << ", seed " << tests::Seed();
      }
    }
  }
}

TEST(Dexterity, OfTheBiglideFollowsFromItsStruts) {
  // With struts at angles ±a to the rail, q̇i = ẋ ± tan(a) ẏ: J = [1 t; 1 -t], singular values √2
  // and √2 t; at 45° the condition is 1.
  const Machine machine = Biglide();
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  EXPECT_EQ(CharacteristicLength(*judge, 0), 1.0);
  const double middle = 400.0 / std::sqrt(2.0);
  EXPECT_NEAR(
      DexterityAt(*judge, 0, Eigen::Vector2d(50, middle), 1.0).dexterity.condition, 1, 1e-12);
  const double a = std::asin(200.0 / 400.0);
  const DexterityDetails at = DexterityAt(*judge, 0, Eigen::Vector2d(0, 200), 1.0);
  EXPECT_NEAR(at.dexterity.condition, 1.0 / std::tan(a), 1e-12);
  EXPECT_NEAR(at.dexterity.weakest_force, std::sqrt(2.0) * std::tan(a), 1e-12);
  ASSERT_EQ(at.axes.size(), 2U);
  EXPECT_NEAR(std::abs(at.axes[0].twist[1]), 1.0, 1e-12) << "fastest along y, where it is weakest";
  EXPECT_NEAR(at.axes[0].velocity * at.axes[0].force, 1.0, 1e-12);
}

TEST(Dexterity, CharacteristicLengthIsBestAtHome) {
  const Machine machine = tests::LoadMachine("hexapod_reference");
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  const double length = CharacteristicLength(*judge, 0);
  const auto condition = [&](double l) {
    return DexterityAt(*judge, 0, machine.home(), l).dexterity.condition;
  };
  EXPECT_LE(condition(length), condition(1.02 * length) + 1e-9);
  EXPECT_LE(condition(length), condition(0.98 * length) + 1e-9);
}

TEST(DexterityOver, FindsTheExtremesOfTheBiglideAndIgnoresThreads) {
  const Machine machine = Biglide();
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  const Region region{
      .z = machine.home(), .varied = {0, 1}, .lower = {-100, 50}, .upper = {100, 350}};
  const std::array<std::uint64_t, 2> steps{50, 300};
  const DexterityField one = DexterityOver(*judge, 0, 1.0, region, steps, {.threads = 1});
  const DexterityField two = DexterityOver(*judge, 0, 1.0, region, steps, {.threads = 2});
  EXPECT_EQ(one.poses, 50U * 300U);
  EXPECT_NEAR(one.best, 1.0, 0.01);
  EXPECT_NEAR(one.best_at[1], 400.0 / std::sqrt(2.0), 1.0);
  EXPECT_NEAR(one.worst_at[1], 50.5, 1e-9);
  EXPECT_NEAR(one.worst, std::sqrt(160000.0 - 50.5 * 50.5) / 50.5, 1e-5);
  EXPECT_EQ(one.worst, two.worst);
  EXPECT_EQ(one.best, two.best);
  EXPECT_NEAR(one.mean, two.mean, 1e-12 * one.mean);
  EXPECT_GT(one.global, 0.0);
  EXPECT_LT(one.global, 1.0);
}

TEST(DexterityOver, LeavesOutWhatLiesBeyondASingularityUnlessAsked) {
  const Machine machine = Biglide();
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  // Both struts lie on the rail's line at Y = 0: as many poses on either side.
  const Region region{
      .z = machine.home(), .varied = {0, 1}, .lower = {-100, -350}, .upper = {100, 350}};
  const std::array<std::uint64_t, 2> steps{20, 300};
  EXPECT_EQ(DexterityOver(*judge, 0, 1.0, region, steps).poses, 20U * 150U);
  EXPECT_EQ(DexterityOver(*judge, 0, 1.0, region, steps, {}, false).poses, 20U * 300U);
}

}  // namespace
}  // namespace kompono::analysis
