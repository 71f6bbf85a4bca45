// SPDX-License-Identifier: Apache-2.0
// ReplaceNumbers: new numbers in the old text.
#include "shipped_registry.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::layout {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kRadian = 57.295779513082323;

Layout Read(const std::string& text) {
  Outcome outcome = Parse(text);
  EXPECT_TRUE(outcome.layout) << outcome.complaints;
  return outcome.layout.value_or(Layout{});
}

std::string Replaced(const Layout& layout, const std::vector<Replacement>& replacements) {
  const auto text = ReplaceNumbers(layout, ShippedRegistry(), replacements, "m.csv");
  return text ? *text : RenderAll(text.error(), {});
}

/// The text above [calibrated].
std::string Above(const std::string& text) {
  return text.substr(0, text.find("\n[calibrated]"));
}

std::map<std::string, double> ValuesOf(const Layout& layout) {
  std::map<std::string, double> values;
  for (const Number& number : NumbersOf(layout, ShippedRegistry()))
    values[number.name] = number.value;
  return values;
}

const std::string kHead = "kompono = 1\nformula = \"part O (XYZ):delta B tool\"\n";

TEST(ReplacedNumbers, StandWhereTheOldOnesStood) {
  const std::string text = kHead + R"(
# the machine
[block.delta]      # a delta
module = "linear_delta"
  parameters = { strut = [ 300.0, 300, 3e2 ], radius = 150 } # mm
mount = { position = [0, 0,    10], rotation = [0,0,0] }

[block.delta.drive.q2]
zero = 1_000.5 # reference
direction = "-"
)";
  const std::string expected = kHead + R"(
# the machine
[block.delta]      # a delta
module = "linear_delta"
  parameters = { strut = [ 300.0, 301.25, 3e2 ], radius = 149.5 } # mm
mount = { position = [0, 0,    10.125], rotation = [0,0,0] }

[block.delta.drive.q2]
zero = 999.75 # reference
direction = "-"
)";
  const std::string result = Replaced(Read(text),
                                      {{"delta.strut[2]", 301.25, 0.5},
                                       {"delta.radius", 149.5, std::nullopt},
                                       {"delta.mount.z", 10.125, std::nullopt},
                                       {"delta.q2.zero", 999.75, 0.25}});
  EXPECT_EQ(result, expected + R"(
[calibrated]
source = "m.csv"

[calibrated.nominal]
"delta.radius" = 150
"delta.strut[2]" = 300
"delta.mount.z" = 10
"delta.q2.zero" = 1000.5

[calibrated.sigma]
"delta.strut[2]" = 0.5
"delta.q2.zero" = 0.25
)");
}

TEST(ReplacedNumbers, AreAddedWhereTheFileHadNone) {
  const std::string text = kHead + R"([block.delta]
module = "linear_delta"
parameters.radius = 150
parameters.strut = 300 # all three

[block.delta.drive.q1]
range = [0, 500]

[calibration]
free = ["delta"])";
  const std::string result = Replaced(Read(text),
                                      {{"delta.strut[3]", 303, std::nullopt},
                                       {"delta.joint_radius", 20, std::nullopt},
                                       {"delta.mount.y", 2, std::nullopt},
                                       {"delta.mount.c", 0.5 / kRadian, std::nullopt},
                                       {"delta.q1.zero", 0.5, std::nullopt},
                                       {"delta.q3.zero", 0.25, std::nullopt},
                                       {"B.zero", 0.01, std::nullopt},
                                       {"B.rotation.a", 0.02, std::nullopt},
                                       {"tool.mount.z", 7, std::nullopt}});
  EXPECT_EQ(Above(result), kHead + R"([block.delta]
module = "linear_delta"
parameters.radius = 150
parameters.strut = [300, 300, 303] # all three
parameters.joint_radius = 20
mount.position = [0, 2, 0]
mount.rotation = [0, 0, 0.5]

[block.delta.drive.q1]
range = [0, 500]
zero = 0.5

[calibration]
free = ["delta"]

[block.delta.drive.q3]
zero = 0.25

[axis.B]
rotation = [1.1459155902616465, 0, 0]
zero = 0.5729577951308232

[tool.mount]
position = [0, 0, 7]
)");
}

TEST(ReplacedNumbers, GoIntoInlineTables) {
  const std::string text =
      "kompono = 1\nformula = \"part O (XYZ):delta tool\"\n"
      "block = { delta = { module = \"linear_delta\", parameters = { radius = 150, strut = 300 }, "
      "drive = { q1 = {} } } }\ntool = { module = \"tool\" } # end\n";
  const std::string result = Replaced(Read(text),
                                      {{"delta.radius", 151, std::nullopt},
                                       {"delta.mount.x", 1, std::nullopt},
                                       {"delta.mount.b", 0.1, std::nullopt},
                                       {"delta.q1.zero", 2, std::nullopt},
                                       {"delta.q2.zero", 3, std::nullopt},
                                       {"tool.length", 90, std::nullopt}});
  EXPECT_EQ(
      Above(result),
      "kompono = 1\nformula = \"part O (XYZ):delta tool\"\n"
      "block = { delta = { module = \"linear_delta\", parameters = { radius = 151, strut = 300 }, "
      "drive = { q1 = { zero = 2 }, q2.zero = 3 }, mount.position = [1, 0, 0], "
      "mount.rotation = [0, 5.729577951308232, 0] } }\n"
      "tool = { module = \"tool\", parameters.length = 90 } # end\n");
}

TEST(ReplacedNumbers, KeepPointsCommentsAndWindowsLineEnds) {
  const std::string text =
      "kompono = 1\r\nformula = \"part O|O (XYZ):pods tool\"\r\n[block.pods]\r\nmodule = "
      "\"tripod\"\r\n[block.pods.parameters]\r\nfoot = [\r\n  [0, 0, 0], # left\r\n  [500, 0, "
      "0],\r\n"
      "  [250, 433, 0], # far\r\n]\r\n";
  const std::string result = Replaced(
      Read(text), {{"pods.foot[2].y", -0.5, std::nullopt}, {"open_base.x", 3, std::nullopt}});
  EXPECT_THAT(result, HasSubstr("[0, 0, 0], # left\r\n  [500, -0.5, 0],\r\n"));
  EXPECT_THAT(result, HasSubstr("]\r\n\r\n[open_base]\r\nposition = [3, 0, 0]\r\n"));
  EXPECT_EQ(std::count(result.begin(), result.end(), '\n'),
            std::count(result.begin(), result.end(), '\r'));
}

TEST(ReplacedNumbers, KeepTheFirstNominalAndTheNewestSigma) {
  const std::string text = kHead +
                           "[block.delta]\nmodule = \"linear_delta\"\nparameters = { radius = 150, "
                           "strut = 300 }\n";
  const std::string once =
      Replaced(Read(text), {{"delta.radius", 151, 0.25}, {"delta.q1.zero", 1, 0.5}});
  const std::string twice =
      Replaced(Read(once), {{"delta.radius", 152, 0.125}, {"delta.q1.zero", 2, std::nullopt}});
  EXPECT_THAT(twice, HasSubstr("[calibrated.nominal]\n\"delta.radius\" = 150\n"));
  EXPECT_THAT(twice, HasSubstr("[calibrated.sigma]\n\"delta.radius\" = 0.125\n"));
  EXPECT_THAT(twice, HasSubstr("radius = 152"));
  EXPECT_THAT(twice.substr(twice.find("[calibrated.sigma]")), Not(HasSubstr("q1.zero")));
}

TEST(ReplacedNumbers, QuoteTheSource) {
  const Layout layout = Read("kompono = 1\nformula = \"part X O tool\"\n");
  const auto text =
      ReplaceNumbers(layout, ShippedRegistry(), {{"X.zero", 1, {}}}, "a \"b\" \\ c\nd");
  ASSERT_TRUE(text);
  EXPECT_THAT(*text, HasSubstr("source = \"a \\\"b\\\" \\\\ c\\u000Ad\"\n"));
}

TEST(ReplacedNumbers, AreRefusedWhenUnknownOrNotFinite) {
  const auto layout = ReadLayout("layouts/machines/flsun_v400.toml", ShippedRegistry());
  ASSERT_TRUE(layout);
  EXPECT_EQ(Replaced(*layout, {{"delta.strut[4]", 1, {}}, {"delta.radius", std::nan(""), {}}}),
            "layouts/machines/flsun_v400.toml: error: the layout has no number 'delta.strut[4]' "
            "[E0331]\n  help: did you mean 'delta.strut[1]'?\n"
            "layouts/machines/flsun_v400.toml: error: 'delta.radius' cannot become nan [E0307]\n"
            "2 errors\n");
  EXPECT_THAT(Replaced(*layout, {{"delta.radius", -3, {}}}), HasSubstr("[E0308]"))
      << "the new text is judged like any other";
  EXPECT_THAT(Replaced(*layout, {{"delta.inclination[1]", 1, {}}}), HasSubstr("[E0331]"));
}

// Every number of every machine, changed at random, reads back to 1e-12.
class EveryNumber : public testing::TestWithParam<std::string> {};

TEST_P(EveryNumber, ReadsBackAsItWasWritten) {
  const auto layout = ReadLayout(GetParam(), ShippedRegistry());
  ASSERT_TRUE(layout);
  std::mt19937_64 random(20240607);
  std::uniform_real_distribution<double> change(1e-3, 1.0);
  std::vector<Replacement> replacements;
  std::map<std::string, double> wanted;
  for (const Number& number : NumbersOf(*layout, ShippedRegistry())) {
    const bool whole = number.pure && number.value == std::round(number.value);  // a count
    const double value =
        whole ? number.value : number.value + (number.angle ? 0.01 : 1.0) * change(random);
    const bool by_other_name = !number.other_names.empty() && random() % 2 == 0;
    replacements.push_back(
        {by_other_name ? number.other_names.back() : number.name, value, change(random)});
    wanted[number.name] = value;
  }
  const auto text = ReplaceNumbers(*layout, ShippedRegistry(), replacements, "random");
  ASSERT_TRUE(text) << RenderAll(text.error(), {});
  const std::map<std::string, double> values = ValuesOf(Read(*text));
  ASSERT_EQ(values.size(), wanted.size());
  for (const auto& [name, value] : wanted)
    EXPECT_NEAR(values.at(name), value, 1e-12 * std::abs(value)) << name;
  // Comments survive: every comment of the old text stands in the new one.
  for (std::size_t at = layout->text.find("\n#"); at != std::string::npos;
       at = layout->text.find("\n#", at + 1)) {
    const std::size_t end = layout->text.find('\n', at + 1);
    EXPECT_THAT(*text, HasSubstr(layout->text.substr(at, end - at)));
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         EveryNumber,
                         testing::ValuesIn(TomlFilesIn("layouts/machines")),
                         [](const auto& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

// With the numbers it has already, a file is changed by the [calibrated] table only; in degrees
// too.
TEST_P(EveryNumber, StaysWhenItIsReplacedByItself) {
  const auto layout = ReadLayout(GetParam(), ShippedRegistry());
  ASSERT_TRUE(layout);
  const std::map<std::string, double> before = ValuesOf(*layout);
  std::vector<Replacement> replacements;
  for (const auto& [name, value] : before) replacements.push_back({name, value, std::nullopt});
  const auto text = ReplaceNumbers(*layout, ShippedRegistry(), replacements, "itself");
  ASSERT_TRUE(text) << RenderAll(text.error(), {});
  for (const auto& [name, value] : ValuesOf(Read(*text))) EXPECT_EQ(value, before.at(name)) << name;
}

}  // namespace
}  // namespace kompono::layout
