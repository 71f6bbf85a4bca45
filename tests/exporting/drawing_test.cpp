// SPDX-License-Identifier: Apache-2.0
#include "kompono/exporting/drawing.hpp"

#include "shipped_machines.hpp"

#include <regex>

namespace kompono::exporting {
namespace {

std::string Drawn(const kinematics::Machine& machine, const DrawingOptions& options = {}) {
  return DrawSvg(machine, machine.home(), machine.nominal(), options);
}

std::string DrawnShipped(const std::string& name) {
  return Drawn(tests::LoadMachine(name));
}

/// How many elements have the class.
std::size_t CountOf(const std::string& svg, const std::string& kind) {
  const std::string piece = "class=\"" + kind + "\"";
  std::size_t count = 0;
  for (std::size_t at = svg.find(piece); at != std::string::npos; at = svg.find(piece, at + 1))
    ++count;
  return count;
}

/// x and y of the circles of one class, in the order of the picture.
std::vector<std::pair<double, double>> Centres(const std::string& svg, const std::string& kind) {
  const std::regex circle("<circle class=\"" + kind + "\" cx=\"([-0-9.]+)\" cy=\"([-0-9.]+)\"");
  std::vector<std::pair<double, double>> out;
  for (std::sregex_iterator i(svg.begin(), svg.end(), circle); i != std::sregex_iterator(); ++i)
    out.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
  return out;
}

TEST(DrawSvg, DrawsEveryStrutAndPointOfTheSkeleton) {
  const std::string svg = DrawnShipped("hexapod_reference");
  EXPECT_EQ(CountOf(svg, "strut"), 6U);
  EXPECT_EQ(CountOf(svg, "cylinder"), 6U) << "pods change their length";
  EXPECT_EQ(CountOf(svg, "joint"), 12U);
  EXPECT_EQ(CountOf(svg, "plate"), 1U);
  EXPECT_EQ(CountOf(svg, "foundation"), 1U);
  EXPECT_THAT(svg, testing::StartsWith("<svg "));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
}

TEST(DrawSvg, GlidesHaveCarriagesOnRailsAndStrutsOfOneLength) {
  const std::string svg = DrawnShipped("hexaglide_mill");
  EXPECT_EQ(CountOf(svg, "rail"), 6U);
  EXPECT_EQ(CountOf(svg, "carriage"), 6U);
  EXPECT_EQ(CountOf(svg, "cylinder"), 0U);
}

TEST(DrawSvg, RailsAreSeenWhereTheCarriageStandsAtItsZero) {
  // At home the KSM machine's carriages stand on the points that their rails begin with.
  EXPECT_THAT(DrawnShipped("ksm_pyramid"), testing::ContainsRegex("class=\"rail\" x1"));
  const std::string svg = DrawnShipped("ksm_pyramid");
  const std::regex rail(
      "class=\"rail\" x1=\"([0-9.]+)\" y1=\"([0-9.]+)\" x2=\"([0-9.]+)\" y2=\"([0-9.]+)\"");
  int rails = 0;
  for (std::sregex_iterator i(svg.begin(), svg.end(), rail); i != std::sregex_iterator(); ++i) {
    const double length = std::hypot(std::stod((*i)[1]) - std::stod((*i)[3]),
                                     std::stod((*i)[2]) - std::stod((*i)[4]));
    EXPECT_GT(length, 20.0);
    ++rails;
  }
  EXPECT_EQ(rails, 3);
}

TEST(DrawSvg, PlanarMachinesAreSeenSquareOn) {
  // Both carriages of the lambda machine run along X: level in the picture, Y upwards.
  const std::string svg = DrawnShipped("so_waterjet_lambda");
  const std::regex rail(
      "class=\"rail\" x1=\"[0-9.]+\" y1=\"([0-9.]+)\" x2=\"[0-9.]+\" y2=\"([0-9.]+)\"");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(svg, found, rail));
  EXPECT_EQ(found[1], found[2]);
  const auto tool = Centres(svg, "tool");
  ASSERT_EQ(tool.size(), 1U);
  EXPECT_LT(tool[0].second, std::stod(found[1])) << "the tool point lies above its rail";
}

TEST(DrawSvg, LathesLieDown) {
  // The part's name of the main spindle stands left of the counter-spindle's, at about its height.
  const std::string svg = DrawnShipped("kdd_counter_spindle");
  const auto place = [&svg](const std::string& name) {
    const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\">" + name + "<");
    std::smatch found;
    EXPECT_TRUE(std::regex_search(svg, found, text)) << name;
    return std::pair(std::stod(found[1]), std::stod(found[2]));
  };
  EXPECT_GT(place("part2").first - place("part1").first, 100.0);
  EXPECT_LT(std::abs(place("part2").second - place("part1").second), 120.0);
}

TEST(DrawSvg, ShowsUnitsOfEveryBranch) {
  const std::string svg = DrawnShipped("kdd_mirrored_pair");
  EXPECT_EQ(CountOf(svg, "strut"), 8U) << "of both mechanisms";
  EXPECT_EQ(CountOf(svg, "holder"), 2U);
  EXPECT_EQ(CountOf(svg, "disc"), 2U);
  EXPECT_EQ(CountOf(svg, "pocket"), 16U);
  for (const char* name : {"part1", "part2", "tool1", "tool2"})
    EXPECT_THAT(svg, testing::HasSubstr(std::string(">") + name + "<"));
}

TEST(DrawSvg, PlainAxesAreArrowsWithTheirLetters) {
  const std::string svg = DrawnShipped("knee_mill");
  for (const char* letter : {"X", "Y", "Z", "C"})
    EXPECT_THAT(svg, testing::HasSubstr(std::string(">") + letter + "</text>"));
}

TEST(DrawSvg, StaysInsideItsFrame) {
  for (const std::string& name : tests::ShippedMachineFiles()) {
    const std::string svg = Drawn(tests::LoadMachine(name), {.width_px = 300, .height_px = 200});
    for (const char* kind : {"joint", "tool", "tip"}) {
      for (const auto& [x, y] : Centres(svg, kind)) {
        EXPECT_TRUE(x >= 0.0 && x <= 300.0 && y >= 0.0 && y <= 200.0) << name << x << " " << y;
      }
    }
    EXPECT_THAT(svg, testing::Not(testing::HasSubstr("nan"))) << name;
  }
}

}  // namespace
}  // namespace kompono::exporting
