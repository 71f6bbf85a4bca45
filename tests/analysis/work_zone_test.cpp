// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/work_zone.hpp"

#include "shipped_machines.hpp"

#include <cmath>
#include <numbers>

namespace kompono::analysis {
namespace {

struct Zone {
  Machine machine;
  std::unique_ptr<PoseJudge> judge;
  std::unique_ptr<ZoneFunction> function;
};

Zone Prepare(Machine machine, const std::vector<Span>& varied = {}, const Limits& limits = {}) {
  Zone out{.machine = std::move(machine)};
  auto judge = PoseJudge::Make(out.machine, out.machine.nominal(), limits);
  if (!judge) throw std::runtime_error(RenderAll(judge.error(), {}));
  out.judge = std::make_unique<PoseJudge>(std::move(*judge));
  const auto region = RegionOf(out.machine, varied, out.machine.home());
  if (!region) throw std::runtime_error(RenderAll(region.error(), {}));
  auto function = ZoneFunction::Make(*out.judge, *region, true);
  if (!function) throw std::runtime_error(RenderAll(function.error(), {}));
  out.function = std::make_unique<ZoneFunction>(std::move(*function));
  return out;
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
[block.delta.drive.q2]
range = [100, 400]
[block.delta.drive.q3]
range = [100, 400]
)";

/// The delta by hand: vertical towers at 130 mm, struts of 270 mm, carriages between 100 and 400
/// mm.
bool DeltaReaches(double x, double y, double z) {
  for (const double azimuth : {90.0, 210.0, 330.0}) {
    const double dx = x - 130.0 * std::cos(azimuth * std::numbers::pi / 180.0);
    const double dy = y - 130.0 * std::sin(azimuth * std::numbers::pi / 180.0);
    const double square = 270.0 * 270.0 - dx * dx - dy * dy;
    if (square < 0.0) return false;
    const double height = z + std::sqrt(square);
    if (height < 100.0 || height > 400.0) return false;
  }
  return true;
}

TEST(WorkZone, VolumeOfALinearDeltaAgreesWithAnIndependentMonteCarloEstimate) {
  const Zone zone = Prepare(tests::MachineFromText(kDelta));
  const WorkZone found = ComputeZone(*zone.function, {.tolerance = 0.002});
  EXPECT_LE(found.bound, 0.002 * found.content * 1.0001);
  std::mt19937_64 random(tests::Seed());
  // No point is within 270 mm of all three towers unless it is within 215 mm of the middle.
  std::uniform_real_distribution<double> side(-215.0, 215.0);
  std::uniform_real_distribution<double> up(-170.0, 400.0);
  const double box = 430.0 * 430.0 * 570.0;
  const int samples = 4000000;
  int inside = 0;
  for (int i = 0; i < samples; ++i) inside += DeltaReaches(side(random), side(random), up(random));
  const double share = static_cast<double>(inside) / samples;
  const double deviation = box * std::sqrt(share * (1.0 - share) / samples);
  EXPECT_NEAR(found.content, box * share, found.bound + 4.0 * deviation)
      << "seed " << tests::Seed() << ", one standard deviation " << deviation;
  EXPECT_LT(4.0 * deviation, 0.01 * found.content) << "else the comparison says little";
}

TEST(WorkZone, BoundHoldsAtEveryTolerance) {
  const Zone zone = Prepare(tests::MachineFromText(kDelta));
  const WorkZone fine = ComputeZone(*zone.function, {.tolerance = 0.0005});
  for (const double tolerance : {0.2, 0.05, 0.01}) {
    const WorkZone coarse = ComputeZone(*zone.function, {.tolerance = tolerance});
    EXPECT_NEAR(coarse.content, fine.content, coarse.bound + fine.bound) << tolerance;
    EXPECT_LE(coarse.bound, tolerance * coarse.content * 1.0001);
    EXPECT_LT(coarse.judged, fine.judged);
  }
}

TEST(WorkZone, AreaOfABiglideIsThatOfItsFormula) {
  // q1 >= -300 and q2 <= 300 with equal struts l: |x| <= 300 - sqrt(l² - y²), which is an area of
  // the integral of 2 (300 - sqrt(l² - y²)) from y0 = sqrt(l² - 300²) to l on home's side of y = 0.
  const Zone zone = Prepare(tests::MachineFromText(R"(
kompono = 1
formula = "part O (XY):glides tool"
[block.glides]
module = "biglide"
parameters = { L1 = 400, L2 = 400, width = 0 }
home = { X = 0, Y = 350 }
[block.glides.drive.q1]
range = [-300, 1000]
[block.glides.drive.q2]
range = [-1000, 300]
)"));
  const WorkZone found = ComputeZone(*zone.function, {.tolerance = 0.0005});
  const double l = 400.0;
  const double y0 = std::sqrt(l * l - 300.0 * 300.0);
  const auto integral = [l](double y) {  // of sqrt(l² - y²)
    return 0.5 * (y * std::sqrt(std::max(0.0, l * l - y * y)) + l * l * std::asin(y / l));
  };
  const double area = 2.0 * (300.0 * (l - y0) - (integral(l) - integral(y0)));
  EXPECT_NEAR(found.content, area, found.bound);
  EXPECT_LT(found.bound, 0.001 * area);
  ASSERT_EQ(found.lower.size(), 2U);
  EXPECT_NEAR(found.lower[1], y0, 5.0);
  EXPECT_NEAR(found.upper[1], l, 5.0);
}

TEST(WorkZone, EndsAtTheSingularityUnlessAskedOtherwise) {
  // Without ranges the biglide reaches |y| < 400; at y = 0 its drives do not hold it.
  const Zone zone = Prepare(tests::MachineFromText(R"(
kompono = 1
formula = "part O (XY):glides tool"
[block.glides]
module = "biglide"
parameters = { L1 = 400, L2 = 400, width = 0 }
home = { X = 0, Y = 350 }
range = { X = [-100, 100], Y = [-380, 380] }
)"));
  const WorkZone regular = ComputeZone(*zone.function, {.tolerance = 0.001});
  EXPECT_NEAR(regular.content, 200.0 * 380.0, regular.bound);
  const auto all = ZoneFunction::Make(*zone.judge, zone.function->region(), false);
  ASSERT_TRUE(all);
  const WorkZone both = ComputeZone(*all, {.tolerance = 0.001});
  EXPECT_NEAR(both.content, 200.0 * 760.0, both.bound);
  EXPECT_LT(both.bound, 1e-6 * both.content) << "nothing but the box bounds it";
}

TEST(WorkZone, OfAHexapodAgreesWithTheBatchJudge) {
  std::string ranges;
  for (int i = 1; i <= 6; ++i)
    ranges += "[block.struts.drive.q" + std::to_string(i) + "]\nrange = [850, 1150]\n";
  const Zone zone = Prepare(tests::MachineFromText(R"(
kompono = 1
formula = "part O (XYZABC):struts tool"
[block.struts]
module = "hexapod_symmetric"
parameters = { base_radius = 600, base_half_angle = 10, platform_radius = 250, platform_half_angle = 10 }
home = { X = 0, Y = 0, Z = 900, A = 5, B = -4, C = 3 }
)" + ranges));
  const WorkZone found = ComputeZone(*zone.function, {.tolerance = 0.01});
  ASSERT_FALSE(found.empty());
  EXPECT_LE(found.bound, 0.01 * found.content * 1.0001);
  Region box = zone.function->region();
  box.lower = found.lower;
  box.upper = found.upper;
  const std::array<std::uint64_t, 3> steps{120, 120, 120};
  const PoseCount count = CountGrid(*zone.judge, box, steps);
  const double by_grid =
      box.Content() * static_cast<double>(count.inside) / static_cast<double>(count.poses);
  // A grid of 120 steps is good to about a tenth of a cell's layer.
  EXPECT_NEAR(found.content, by_grid, found.bound + 0.004 * found.content);
  double shares = 0.0;
  for (const double share : found.shares) shares += share;
  EXPECT_NEAR(shares, 1.0, 1e-9);
}

TEST(WorkZone, CellsCalledCertainAreInsideAtEveryPoint) {
  const Zone zone = Prepare(tests::MachineFromText(kDelta));
  const WorkZone found = ComputeZone(*zone.function, {.tolerance = 0.05});
  std::mt19937 random(tests::Seed());
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int certain = 0;
  for (const ZoneCell& cell : found.cells) {
    if (!cell.certain) continue;
    ++certain;
    std::array<double, 3> at{};
    for (int trial = 0; trial < 20; ++trial) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto edge = found.Edge(cell, i);
        at[i] = edge[0] + uniform(random) * (edge[1] - edge[0]);
      }
      EXPECT_TRUE(DeltaReaches(at[0], at[1], at[2])) << "seed " << tests::Seed();
    }
  }
  EXPECT_GT(certain, 50);
}

TEST(WorkZone, OfADeltaWithoutRangesIsCutByTheSearchAndSaysSo) {
  const Zone zone = Prepare(tests::LoadMachine("linuxcnc_lineardelta"));
  const WorkZone found = ComputeZone(*zone.function, {.tolerance = 0.01});
  ASSERT_EQ(found.touches.size(), 3U);
  EXPECT_FALSE(found.touches[0][0]);
  EXPECT_TRUE(found.touches[2][0] && found.touches[2][1]);
}

TEST(WorkZone, IsTheSameForAnyNumberOfThreads) {
  const Zone zone = Prepare(tests::MachineFromText(kDelta));
  const WorkZone one = ComputeZone(*zone.function, {.tolerance = 0.02, .control = {.threads = 1}});
  const WorkZone four = ComputeZone(*zone.function, {.tolerance = 0.02, .control = {.threads = 4}});
  EXPECT_EQ(one.content, four.content);
  EXPECT_EQ(one.bound, four.bound);
  EXPECT_EQ(one.cells.size(), four.cells.size());
}

TEST(WorkZone, AfterAStopTheBoundStillHolds) {
  const Zone zone = Prepare(tests::MachineFromText(kDelta));
  const WorkZone fine = ComputeZone(*zone.function, {.tolerance = 0.001});
  std::atomic<bool> stop{false};
  const WorkZone cut = ComputeZone(
      *zone.function,
      {.tolerance = 1e-6,
       .most_cells = 50000000,
       .control = {.progress = [&](std::uint64_t, std::uint64_t) { stop = true; }, .stop = &stop}});
  EXPECT_TRUE(cut.stopped);
  EXPECT_NEAR(cut.content, fine.content, cut.bound + fine.bound);
}

TEST(WorkZone, ClearanceAndSwingMakeItSmaller) {
  const Machine machine = tests::LoadMachine("linuxcnc_tripod");
  const std::vector<Span> varied{
      {"pods.X", 0.0, 500.0}, {"pods.Y", -100.0, 400.0}, {"pods.Z", 100.0, 600.0}};
  const WorkZone all = ComputeZone(*Prepare(machine, varied).function, {.tolerance = 0.02});
  const Zone limited =
      Prepare(machine, varied, {.swings = {{.joint = "pods.foot*", .swing_rad = 0.5}}});
  const WorkZone some = ComputeZone(*limited.function, {.tolerance = 0.02});
  EXPECT_LT(some.content + some.bound, all.content - all.bound);
  Region box = limited.function->region();
  const std::array<std::uint64_t, 3> steps{80, 80, 80};
  const PoseCount count = CountGrid(*limited.judge, box, steps);
  EXPECT_NEAR(some.content,
              box.Content() * static_cast<double>(count.inside) / static_cast<double>(count.poses),
              some.bound + 0.01 * some.content);
}

TEST(RegionOf, RefusesUnknownCoordinatesAndEmptySpans) {
  const Machine machine = tests::LoadMachine("biglide_mill");
  const auto unknown = RegionOf(machine, {{"glides.Q", {}, {}}}, machine.home());
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().front().code, "E0724");
  const auto empty = RegionOf(machine, {{"Y", 400.0, 500.0}}, machine.home());
  ASSERT_FALSE(empty) << "the layout's range of Y ends at 350";
  EXPECT_EQ(empty.error().front().code, "E0725");
}

}  // namespace
}  // namespace kompono::analysis
