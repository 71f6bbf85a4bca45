// SPDX-License-Identifier: Apache-2.0
#include "shipped_registry.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/layout/codes.hpp"

namespace kompono::layout {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kDeg = std::numbers::pi / 180.0;

const std::string kLambda = R"(
[block.drive]
module = "lambda"
parameters = { L1 = 1200, L2 = 820, L3 = 600 }
)";

Layout Good(const std::string& text) {
  const Outcome outcome = Parse(text);
  EXPECT_TRUE(outcome.layout) << outcome.complaints;
  return outcome.layout.value_or(Layout{});
}

class Machines : public testing::TestWithParam<std::string> {};

TEST_P(Machines, AreGoodLayoutsWithoutWarnings) {
  Diagnostics notes;
  const Parsed<Layout> layout = ReadLayout(GetParam(), ShippedRegistry(), &notes);
  ASSERT_TRUE(layout) << RenderAll(layout.error(), {});
  EXPECT_TRUE(notes.empty()) << RenderAll(notes, {});
  EXPECT_EQ(layout->text, ReadText(GetParam()));
  EXPECT_EQ(layout->file, GetParam());
  EXPECT_FALSE(layout->name.empty());
  EXPECT_THAT(layout->text, HasSubstr("# ")) << "a machine says where its numbers come from";
  for (const Block& block : layout->blocks) {
    const plugin::ModuleDescription* module = ShippedRegistry().Find(block.module);
    ASSERT_NE(module, nullptr);
    EXPECT_EQ(block.parameters.size(), static_cast<std::size_t>(module->ParameterNumbers()));
    EXPECT_EQ(block.modes.size(), module->modes.size());
    EXPECT_EQ(block.drives.size(), module->drives.size());
    EXPECT_EQ(block.letters.size(), module->letters.size());
    EXPECT_EQ(block.home.size(), module->letters.size());
    EXPECT_EQ(block.lower.size(), module->letters.size());
    EXPECT_EQ(block.upper.size(), module->letters.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         Machines,
                         testing::ValuesIn(TomlFilesIn("layouts/machines")),
                         [](const auto& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

TEST(ShippedMachines, TheKsmPyramidHasTheRailsOfThePrintedFormula) {
  const auto layout = ReadLayout("layouts/machines/ksm_pyramid.toml", ShippedRegistry());
  ASSERT_TRUE(layout);
  const std::vector<double>& p = layout->blocks.front().parameters;
  const double azimuth = 29.9925 * kDeg;
  const double height = 70.003 * kDeg;
  const double u[3] = {
      std::cos(height) * std::cos(azimuth), std::cos(height) * std::sin(azimuth), std::sin(height)};
  const double w[3] = {60.6325, 34.9855, -195.8773};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(p[9 + i] - p[i], 300.0 * u[i], 1e-9);  // D - A
    EXPECT_NEAR(p[18 + i] - p[i], w[i], 1e-9);         // K - A
    EXPECT_EQ(p[27 + i], 208.009986);
  }
  for (const std::size_t of : {0U, 9U, 18U}) {  // drives 2 and 3: drive 1 turned by ±120°
    for (std::size_t drive = 1; drive < 3; ++drive) {
      const double turn = (drive == 1 ? 120.0 : -120.0) * kDeg;
      const double x = p[of];
      const double y = p[of + 1];
      EXPECT_NEAR(p[of + 3 * drive], std::cos(turn) * x - std::sin(turn) * y, 1e-9);
      EXPECT_NEAR(p[of + 3 * drive + 1], std::sin(turn) * x + std::cos(turn) * y, 1e-9);
      EXPECT_EQ(p[of + 3 * drive + 2], p[of + 2]);
    }
  }
}

TEST(ShippedMachines, TheFlsunCountsItsTravelDownFromTheEndStops) {
  const auto layout = ReadLayout("layouts/machines/flsun_v400.toml", ShippedRegistry());
  ASSERT_TRUE(layout);
  for (const Drive& drive : layout->blocks.front().drives) {
    EXPECT_EQ(drive.sign, -1);
    EXPECT_NEAR(drive.zero, 421.0 + std::sqrt(345.0 * 345.0 - 161.75 * 161.75), 1e-9);
  }
  EXPECT_THAT(layout->calibration.lock, ElementsAre("delta.azimuth[3]"));
  EXPECT_EQ(layout->calibration.free.size(), 9U);
}

TEST(Units, ConvertEveryNumberOfTheFile) {
  const Layout layout = Good(R"(kompono = 1
formula = "part (XY):drive O|O Z B tool"
units = { length = "in", angle = "rad" }
[block.drive]
module = "lambda"
parameters = { L1 = 40, L2 = 30, L3 = 20 }
mount = { position = [1, 2, 3], rotation = [0, 0, 0.01] }
home = { X = 2 }
range = { Y = [-1, 20] }
[block.drive.drive.q2]
range = [-10, 10]
speed = 60
acceleration = 2
stiffness = 50
zero = 3
direction = "-"
[axis.B]
range = [-1, 1]
home = 0.5
speed = 120
acceleration = 3
stiffness = 4
position = [0, 1, 0]
rotation = [0.1, 0, 0]
[open_base]
position = [1, 0, 0]
rotation = [0, 0, 0.5]
[tool]
module = "tool"
parameters = { length = 4 }
[calibration]
prior = { "drive.L1" = 0.1, "open_base.c" = 0.001 }
bounds = { "Z.zero" = [-1, 1] }
)");
  const Block& block = layout.blocks.front();
  EXPECT_THAT(block.parameters, ElementsAre(1016.0, 762.0, 508.0));
  EXPECT_DOUBLE_EQ(block.mount.position_mm[2], 76.2);
  EXPECT_EQ(block.mount.rotation_rad[2], 0.01);
  EXPECT_EQ(block.home[0], 50.8);
  EXPECT_FALSE(block.home[1]);
  EXPECT_EQ(block.lower[1], -25.4);
  EXPECT_EQ(block.upper[1], 508.0);
  const Drive& q2 = block.drives[1];
  EXPECT_EQ(q2.lower, -254.0);
  EXPECT_EQ(q2.upper, 254.0);
  EXPECT_DOUBLE_EQ(*q2.speed, 25.4);
  EXPECT_DOUBLE_EQ(*q2.acceleration, 50.8);
  EXPECT_EQ(q2.stiffness, 50000.0);
  EXPECT_DOUBLE_EQ(q2.zero, 76.2);
  EXPECT_EQ(q2.sign, -1);
  EXPECT_FALSE(block.drives[0].lower || block.drives[0].speed || block.drives[0].stiffness);
  const Axis* b = layout.FindAxis("B");
  ASSERT_NE(b, nullptr);
  EXPECT_EQ(b->home, 0.5);
  EXPECT_EQ(b->drive.speed, 2.0);
  EXPECT_EQ(b->drive.acceleration, 3.0);
  EXPECT_EQ(b->drive.stiffness, 4000.0);
  EXPECT_EQ(b->frame.position_mm[1], 25.4);
  EXPECT_EQ(b->frame.rotation_rad[0], 0.1);
  EXPECT_EQ(layout.open_base.position_mm[0], 25.4);
  EXPECT_EQ(layout.open_base.rotation_rad[2], 0.5);
  EXPECT_EQ(layout.FindEnd("tool")->parameters.front(), 101.6);
  EXPECT_DOUBLE_EQ(layout.calibration.prior_sigma.at("drive.L1"), 2.54);
  EXPECT_EQ(layout.calibration.prior_sigma.at("open_base.c"), 0.001);
  EXPECT_EQ(layout.calibration.bounds.at("Z.zero")[0], -25.4);
}

TEST(Units, AreMillimetresAndDegreesUnlessTheFileSaysOtherwise) {
  const Layout layout = Good(
      "kompono = 1\nformula = \"part X O B tool\"\n[axis.B]\nhome = 90\n"
      "speed = 360\n[axis.X]\nspeed = 60\n");
  EXPECT_EQ(layout.FindAxis("B")->home, 90.0 * kDeg);
  EXPECT_DOUBLE_EQ(*layout.FindAxis("B")->drive.speed, 6.0 * kDeg);
  EXPECT_EQ(layout.FindAxis("X")->drive.speed, 1.0);
}

TEST(Parameters, TakeDefaultsFixedNumbersAndOneNumberForAll) {
  const Layout layout = Good(R"(kompono = 1
formula = "part O (XYZ):delta tool"
[block.delta]
module = "linear_delta"
parameters = { radius = 150, strut = 300, azimuth = [90, 210, 331] }
)");
  const std::vector<double>& p = layout.blocks.front().parameters;
  ASSERT_EQ(p.size(), 14U);
  EXPECT_EQ(p[0], 150.0);
  EXPECT_EQ(p[6], 331.0 * kDeg);
  EXPECT_EQ(p[7], 90.0 * kDeg) << "fixed by the preset";
  EXPECT_THAT(std::vector<double>(p.begin() + 10, p.begin() + 13), ElementsAre(300, 300, 300));
  EXPECT_EQ(p[13], 0.0) << "the description's default";
}

TEST(Modes, AreTheModulesUnlessGiven) {
  const std::string head = "kompono = 1\nformula = \"part (XY):drive O tool\"\n" + kLambda;
  EXPECT_THAT(Good(head).blocks.front().modes, ElementsAre(1, 1, 1));
  EXPECT_THAT(Good(head + "mode = { q2 = \"-\", side = -1 }\n").blocks.front().modes,
              ElementsAre(1, -1, -1));
}

TEST(Axes, KnowTheirSpindlesAndHomes) {
  const Layout layout = Good(R"(kompono = 1
formula = "part C_h O X Z2 b C2_v tool"
[axis.C]
positioning = true
[axis.X]
range = [100, 300]
[axis.Z2]
range = [0, 50]
zero = 200
direction = "-"
home = 170
)");
  ASSERT_EQ(layout.axes.size(), 5U);
  EXPECT_FALSE(layout.FindAxis("C")->main_motion);
  EXPECT_TRUE(layout.FindAxis("C2")->main_motion);
  EXPECT_EQ(layout.FindAxis("X")->home, 100.0) << "the value of the range nearest to 0";
  EXPECT_EQ(layout.FindAxis("Z2")->home, 170.0);
  EXPECT_EQ(layout.FindAxis("Z2")->letter, 'Z');
  EXPECT_NE(layout.FindAxis("b"), nullptr);
  EXPECT_EQ(layout.FindAxis("B"), nullptr);
}

TEST(Ends, AreFoundByTheNameOfTheirLeafWithoutItsPlane) {
  const Layout layout = Good(R"(kompono = 1
formula = "(part1_xy C_h + part2 C2_h Z2) O X tool"
[part1]
module = "workpiece"
parameters = { datum = [1, 2, 3] }
[tool]
mount = { position = [0, 0, 5] }
)");
  ASSERT_EQ(layout.ends.size(), 3U);
  EXPECT_THAT(layout.FindEnd("part1")->parameters, ElementsAre(1, 2, 3));
  EXPECT_EQ(layout.FindEnd("part1")->station, "datum");
  EXPECT_TRUE(layout.FindEnd("part2")->module.empty());
  EXPECT_EQ(layout.FindEnd("tool")->mount.position_mm[2], 5.0);
}

TEST(Ends, OfAProcessAreDescribedInThreeWays) {
  for (const std::string table : {"tool", "process", "P_z"}) {
    const Layout layout = Good("kompono = 1\nformula = \"part X Y O Z P_z\"\n[" + table +
                               "]\nmodule = \"jet_head\"\n");
    const End* end = layout.FindEnd("P_z");
    ASSERT_NE(end, nullptr);
    EXPECT_EQ(end->module, "jet_head");
    EXPECT_EQ(end->table, table);
  }
}

TEST(Groups, WithoutAName_FindTheOnlyBlockThatFits) {
  const Outcome outcome = Parse("kompono = 1\nformula = \"part (XY) O Z tool\"\n" + kLambda);
  ASSERT_TRUE(outcome.layout) << outcome.complaints;
  EXPECT_EQ(formula::Canonical(outcome.layout->formula), "part (XY):drive O Z tool");
  ASSERT_EQ(outcome.notes.size(), 1U);
  EXPECT_EQ(outcome.notes.front().code, codes::kBlockFound.code);
}

TEST(Groups, OfOneLetterAskForAMechanismOfOneLetter) {
  EXPECT_THAT(Parse("kompono = 1\nformula = \"part X:drive O Z tool\"\n" + kLambda).complaints,
              HasSubstr("'lambda' realises X Y, but the formula asks 'drive' for X [E0325]"));
}

TEST(Poses, AreReadAsXyzOrZyx) {
  const std::string text = "kompono = 1\nformula = \"part X O tool\"\n";
  EXPECT_EQ(Good(text).rotation_order, RotationOrder::kXYZ);
  EXPECT_EQ(Good(text + "pose = { rotation = \"zyx\" }\n").rotation_order, RotationOrder::kZYX);
}

TEST(CalibratedTable, KeepsWhatItDoesNotKnow) {
  Good(
      "kompono = 1\nformula = \"part X O tool\"\n[calibrated]\nsource = \"m.csv\"\ndate = "
      "2024-05-01\nnominal = { \"X.zero\" = 0 }\n[calibrated.rig]\nlaser = true\n");
}

TEST(Formulas, ShowTheirDialectAtTheRightPlace) {
  const Outcome outcome =
      Parse("kompono = 1\n# a comment\nformula = \"\"\"\\\n   part X \\u0030\\\n  Z tool\"\"\"\n");
  ASSERT_TRUE(outcome.layout) << outcome.complaints;
  ASSERT_EQ(outcome.notes.size(), 1U);
  EXPECT_EQ(outcome.notes.front().code, "N0103");
  EXPECT_EQ(outcome.notes.front().span.line, 4);
  EXPECT_EQ(outcome.notes.front().span.column, 11);
  EXPECT_EQ(outcome.notes.front().span.length, 6);
}

TEST(Numbers, MayBeIntegersThatADoubleRounds) {
  const Layout layout = Good(
      "kompono = 1\nformula = \"part X O tool\"\n[axis.X]\nzero = "
      "9223372036854775807\nspeed = 9007199254740993\n");
  EXPECT_EQ(layout.FindAxis("X")->drive.zero, 9223372036854775808.0);
}

TEST(Files, WithABomOrWindowsLineEndsAreRead) {
  Good("\xef\xbb\xbfkompono = 1\r\nformula = \"part X O tool\"\r\n[axis.X]\r\nrange = [0, 1]\r\n");
  EXPECT_THAT(Parse("kompono = 1\r\nformula = \"part X O tool\"\r\n[axis.Y]\r\n").complaints,
              HasSubstr("test.toml:3:7: error"));
}

TEST(Files, ThatCannotBeReadAreNamed) {
  const auto missing = ReadLayout("no/such/file.toml", ShippedRegistry());
  ASSERT_FALSE(missing);
  EXPECT_EQ(RenderAll(missing.error(), {}),
            "no/such/file.toml: error: the file does not exist [E0333]\n1 error\n");
  const auto folder = ReadLayout("layouts", ShippedRegistry());
  ASSERT_FALSE(folder);
  EXPECT_THAT(RenderAll(folder.error(), {}), HasSubstr("this is a folder [E0333]"));
}

TEST(Names, ComeFromTheFileIfItGivesNone) {
  const auto layout = ParseLayout(
      "kompono = 1\nformula = \"part X O tool\"\n", "some/where/press.toml", ShippedRegistry());
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->name, "press");
}

}  // namespace
}  // namespace kompono::layout
