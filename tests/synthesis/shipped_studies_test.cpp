// SPDX-License-Identifier: Apache-2.0
// The studies that ship: read without complaint, counted and enumerated equal, every layout a
// machine.
#include "studies.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/kinematics/machine.hpp"

namespace kompono::synthesis {
namespace {

class ShippedStudies : public testing::TestWithParam<const char*> {
 protected:
  static Outcome Open() {
    const std::string file = std::string("layouts/studies/") + GetParam() + ".toml";
    return BuildStudy(SourceText(file), file);
  }
};

TEST_P(ShippedStudies, AreCountedAndEnumeratedEqual) {
  const Outcome outcome = Open();
  ASSERT_TRUE(outcome.space) << outcome.complaints;
  EXPECT_TRUE(outcome.notes.empty()) << RenderAll(outcome.notes, {});
  const Enumeration all(outcome.space->space());
  Count walked = 0;
  all.VisitAll([&](Count, const Selection&) { return ++walked > 0; });
  EXPECT_TRUE(walked == all.count());
  EXPECT_TRUE(walked == CountDepthFirst(outcome.space->space()));
  EXPECT_GE(walked, 10);
}

TEST_P(ShippedStudies, MakeMachinesOnly) {
  const Outcome outcome = Open();
  ASSERT_TRUE(outcome.space) << outcome.complaints;
  Enumeration(outcome.space->space()).VisitAll([&](Count index, const Selection& selection) {
    const std::string text = LayoutText(*outcome.space, outcome.space->At(selection));
    auto layout = layout::ParseLayout(text, "layout", BuiltRegistry());
    EXPECT_TRUE(layout) << text;
    if (layout) {
      const auto machine = kinematics::Machine::Build(std::move(*layout), BuiltRegistry());
      EXPECT_TRUE(machine) << CountText(index) << RenderAll(machine.error(), {}) << text;
    }
    return !testing::Test::HasFailure();
  });
}

INSTANTIATE_TEST_SUITE_P(
    Files,
    ShippedStudies,
    testing::Values("five_axis_milling", "kdd_lathes", "so_waterjet", "pyramid_or_delta"),
    [](const auto& one) { return std::string(one.param); });

/// Bohez's classes without the study's own rules: design.md, section 4.
TEST(FiveAxisMilling, Has384DistributionsWithoutRules) {
  const Outcome outcome = BuildStudy(SourceText("layouts/studies/five_axis_milling.toml"));
  ASSERT_TRUE(outcome.space) << outcome.complaints;
  EXPECT_EQ(CountText(Explain(outcome.space->space()).structural), "384");
}

}  // namespace
}  // namespace kompono::synthesis
