// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/inscribed.hpp"

#include "shipped_machines.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "kompono/analysis/zone_files.hpp"

namespace kompono::analysis {
namespace {

struct Zone {
  Machine machine;
  std::unique_ptr<PoseJudge> judge;
  std::unique_ptr<ZoneFunction> function;
  WorkZone zone;
};

Zone Compute(const std::string& toml, double tolerance, bool regular) {
  Zone out{.machine = tests::MachineFromText(toml)};
  out.judge = std::make_unique<PoseJudge>(*PoseJudge::Make(out.machine, out.machine.nominal(), {}));
  const auto region = RegionOf(out.machine, {}, out.machine.home());
  out.function = std::make_unique<ZoneFunction>(*ZoneFunction::Make(*out.judge, *region, regular));
  out.zone = ComputeZone(*out.function, {.tolerance = tolerance});
  return out;
}

/// Three pods to one point whose feet lie together: the zone is what a ball of 300 mm around them
/// has above a plane 100 mm over its middle. (It is singular all over, which is not asked for
/// here.)
const char* const kCap = R"(
kompono = 1
formula = "part O (XYZ):pods tool"
[block.pods]
module = "tripod"
parameters = { foot = [[0, 0, -100], [0.001, 0, -100], [0, 0.001, -100]] }
home = { X = 0, Y = 0, Z = 100 }
range = { X = [-400, 400], Y = [-400, 400], Z = [0, 400] }
[block.pods.drive.q1]
range = [0, 300]
[block.pods.drive.q2]
range = [0, 300]
[block.pods.drive.q3]
range = [0, 300]
)";

TEST(Inscribed, BoxAndCylinderOfACapAreTheKnownOnes) {
  const Zone cap = Compute(kCap, 0.01, false);
  // The cube stands on the plane: a²/2 + (100 + a)² = 300².
  const InscribedBody cube =
      LargestInside(*cap.function, cap.zone, BodyShape::kBox, {1.0, 1.0, 1.0});
  ASSERT_TRUE(cube.found);
  const double edge = (-200.0 + std::sqrt(520000.0)) / 3.0;
  EXPECT_NEAR(cube.size[0], edge, 0.01 * edge);
  EXPECT_LE(cube.size[0], edge + 0.01);
  EXPECT_NEAR(cube.centre[2], 0.5 * edge, 0.02 * edge);
  // A cylinder as high as wide: (d/2)² + (100 + d)² = 300².
  const InscribedBody cylinder =
      LargestInside(*cap.function, cap.zone, BodyShape::kCylinder, {1.0, 1.0, 1.0});
  ASSERT_TRUE(cylinder.found);
  const double diameter = (-200.0 + std::sqrt(440000.0)) / 2.5;
  EXPECT_NEAR(cylinder.size[0], diameter, 0.01 * diameter);
  EXPECT_LE(cylinder.size[0], diameter + 0.01);
  EXPECT_NEAR(cylinder.content,
              std::numbers::pi / 4.0 * cylinder.size[0] * cylinder.size[0] * cylinder.size[2],
              1e-6 * cylinder.content);
}

TEST(Inscribed, ProofIsRefusedForWhatSticksOut) {
  const Zone cap = Compute(kCap, 0.05, false);
  const auto proven = [&](BodyShape shape, double size) {
    return ProvenInside(*cap.function, shape, {0, 0, 0.5 * size + 1e-9}, {size, size, size});
  };
  EXPECT_TRUE(proven(BodyShape::kBox, 173.5));
  EXPECT_FALSE(proven(BodyShape::kBox, 174.0));
  EXPECT_TRUE(proven(BodyShape::kCylinder, 185.0));
  EXPECT_FALSE(proven(BodyShape::kCylinder, 185.6));
}

TEST(ZoneSurface, OfACapHasItsVolumeAndArea) {
  const Zone cap = Compute(kCap, 0.01, false);
  const ZoneSurface surface = SurfaceOfZone(*cap.function, cap.zone, 40);
  const double volume = std::numbers::pi * 200.0 * 200.0 * 700.0 / 3.0;
  const double area = std::numbers::pi * (2.0 * 300.0 * 200.0 + 300.0 * 300.0 - 100.0 * 100.0);
  EXPECT_NEAR(surface.Volume(), volume, 0.01 * volume);
  EXPECT_NEAR(surface.Area(), area, 0.02 * area);
  EXPECT_NEAR(cap.zone.content, volume, cap.zone.bound + 0.1);
  // Closed: every edge belongs to two triangles, once in each direction.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
  }
  const std::string ply = SurfacePly(surface, "two\nlines");
  EXPECT_THAT(ply, testing::StartsWith("ply\nformat ascii 1.0\ncomment two lines\n"));
}

TEST(OutlineOfZone, OfABiglideEnclosesItsArea) {
  const Zone glides = Compute(R"(
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
)",
                              0.002,
                              true);
  const Outline outline = OutlineOfZone(*glides.function, glides.zone, 150);
  ASSERT_EQ(outline.size(), 1U) << "one closed line";
  double area = 0.0;
  for (std::size_t k = 0; k < outline[0].size(); ++k) {
    const auto& a = outline[0][k];
    const auto& b = outline[0][(k + 1) % outline[0].size()];
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  EXPECT_NEAR(std::abs(area), glides.zone.content, glides.zone.bound + 0.005 * std::abs(area));
  EXPECT_THAT(ZoneCsv(glides.machine, glides.zone),
              testing::StartsWith("glides.X_from_mm,glides.X_to_mm,glides.Y_from_mm,"));
  const std::string svg = PicturesSvg({{.title = "a < b",
                                        .horizontal = "X mm",
                                        .vertical = "Y mm",
                                        .outline = outline,
                                        .lower = {-400, 0},
                                        .upper = {400, 500}}});
  EXPECT_THAT(svg, testing::HasSubstr("a &lt; b"));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
}

TEST(Inscribed, ABoxThatTouchesAllEndsIsFoundWhole) {
  // Index V100: its zone is the box 250 x 250 x 150, no more and no less.
  const Machine machine = tests::LoadMachine("v100_lathe");
  const auto judge = PoseJudge::Make(machine, machine.nominal(), {});
  const auto region = RegionOf(machine, {}, machine.home());
  const auto function = ZoneFunction::Make(*judge, *region, true);
  ASSERT_TRUE(function);
  const WorkZone zone = ComputeZone(*function, {});
  const std::vector<double> wanted{250.0, 250.0, 150.0};
  const InscribedBody box = LargestInside(*function, zone, BodyShape::kBox, wanted);
  EXPECT_EQ(box.size, wanted);
  EXPECT_NEAR(box.content, 250.0 * 250.0 * 150.0, 1e-6);
  const InscribedBody cylinder = LargestInside(*function, zone, BodyShape::kCylinder, wanted);
  EXPECT_EQ(cylinder.size, wanted);
  const std::vector<double> larger{250.5, 250.5, 150.3};
  const InscribedBody less = LargestInside(*function, zone, BodyShape::kBox, larger);
  ASSERT_TRUE(less.found);
  EXPECT_LE(less.size[0], 250.0);
}

}  // namespace
}  // namespace kompono::analysis
