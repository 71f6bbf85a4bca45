// SPDX-License-Identifier: Apache-2.0
// The table [evaluation] of a study, and the tables of stages and metrics.
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/synthesis/evaluation.hpp"

namespace kompono::synthesis {
namespace {

TEST(Metrics, HaveNamesOfTheirOwnAndStandInTheOrderOfTheirNumbers) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kMetrics; ++i) {
    const MetricDescription& metric = Metrics()[i];
    EXPECT_EQ(static_cast<std::size_t>(metric.id), i) << metric.name;
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_FALSE(metric.unit.empty()) << metric.name;
    EXPECT_FALSE(metric.method.empty()) << metric.name;
    EXPECT_EQ(FindMetric(metric.name), &metric);
  }
  EXPECT_EQ(FindMetric("stifness"), nullptr);
  EXPECT_EQ(MetricNames().size(), kMetrics);
}

TEST(Metrics, AreNoNumbersUntilTheyAreSet) {
  MetricValues values;
  EXPECT_FALSE(values.Has(MetricId::kTravel));
  values.Set(MetricId::kTravel, 0.0);
  EXPECT_TRUE(values.Has(MetricId::kTravel));
}

TEST(Stages, StandInTheOrderOfTheirCost) {
  for (std::size_t i = 0; i < kStages; ++i)
    EXPECT_EQ(static_cast<std::size_t>(Stages()[i].stage), i) << Stages()[i].name;
}

TEST(EvaluationSettings, AreDefaultsWithoutTheTable) {
  const auto settings = ReadEvaluationSettings("study = \"x\"\n", "x.toml");
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->poses, 10000U);
}

TEST(EvaluationSettings, AreConvertedToMillimetresRadiansAndNewtons) {
  const auto settings = ReadEvaluationSettings(
      "[evaluation]\nposes = 1000\ndrive_stiffness = 0.05\ndrive_tolerance = 10\n"
      "squareness = 3600\n",
      "x.toml");
  ASSERT_TRUE(settings) << RenderAll(settings.error(), {});
  EXPECT_EQ(settings->poses, 1000U);
  EXPECT_DOUBLE_EQ(settings->drive_stiffness_n_per_mm, 50.0);
  EXPECT_DOUBLE_EQ(settings->drive_tolerance_mm, 0.01);
  EXPECT_NEAR(settings->squareness_rad, 0.017453292519943295, 1e-15);
}

TEST(EvaluationSettings, AreRefusedAltogetherWithPlaceAndWayOut) {
  const auto settings = ReadEvaluationSettings(
      "[evaluation]\nposses = 1000\nsizing_steps = 2.5\nzone_share = 2\ntool_mass = \"heavy\"\n",
      "x.toml");
  ASSERT_FALSE(settings);
  EXPECT_EQ(RenderAll(settings.error(), {}),
            "x.toml:2:1: error: unknown key 'posses' in [evaluation] [E0840]\n"
            " 2 | posses = 1000\n"
            "   | ^~~~~~\n"
            "  help: did you mean 'poses'?\n"
            "x.toml:3:16: error: 'sizing_steps' is no whole number [E0841]\n"
            " 3 | sizing_steps = 2.5\n"
            "   |                ^~~\n"
            "  help: give a whole number from 2 to 21: poses per coordinate while sizing\n"
            "x.toml:4:14: error: 'zone_share' is out of range [E0841]\n"
            " 4 | zone_share = 2\n"
            "   |              ^\n"
            "  help: give a number from 0 to 1: least share of the required zone\n"
            "x.toml:5:13: error: 'tool_mass' is no number [E0841]\n"
            " 5 | tool_mass = \"heavy\"\n"
            "   |             ^~~~~~~\n"
            "  help: give a number from 0 to 1e+09 kg: of tool and spindle\n"
            "4 errors\n");
}

}  // namespace
}  // namespace kompono::synthesis
