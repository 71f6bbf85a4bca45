// SPDX-License-Identifier: Apache-2.0
#include "kompono/exporting/drawing.hpp"

#include "shipped_machines.hpp"

namespace kompono::exporting {
namespace {

std::size_t CountOf(const std::string& text, const std::string& piece) {
  std::size_t count = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1))
    ++count;
  return count;
}

TEST(DrawSvg, DrawsEveryStrutAndPointOfTheSkeleton) {
  const kinematics::Machine machine = tests::LoadMachine("hexapod_reference");
  const std::string svg = DrawSvg(machine, machine.home(), machine.nominal());
  EXPECT_EQ(CountOf(svg, "class=\"strut\""), 6U);
  EXPECT_EQ(CountOf(svg, "<circle"), 13U);
  EXPECT_THAT(svg, testing::StartsWith("<svg "));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
}

TEST(DrawSvg, StaysInsideItsFrame) {
  const kinematics::Machine machine = tests::LoadMachine("ksm_pyramid");
  const std::string svg =
      DrawSvg(machine, machine.home(), machine.nominal(), {.width_px = 300, .height_px = 200});
  for (std::size_t at = svg.find("cx=\""); at != std::string::npos;
       at = svg.find("cx=\"", at + 1)) {
    const double x = std::stod(svg.substr(at + 4));
    EXPECT_GE(x, 0.0);
    EXPECT_LE(x, 300.0);
  }
}

}  // namespace
}  // namespace kompono::exporting
