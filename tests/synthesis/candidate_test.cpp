// SPDX-License-Identifier: Apache-2.0
// Candidates as layouts and as machines.
#include "kompono/synthesis/candidate.hpp"

#include "studies.hpp"

#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/formula/equivalence.hpp"
#include "kompono/kinematics/machine.hpp"

namespace kompono::synthesis {
namespace {

constexpr const char* kWaterjet = R"(
kompono = 1
study = "small"
base = ["closed", "open"]
[motions.X]
range = [-400, 500]
[motions.Y]
range = [-200, 300]
[motions.Z]
range = [0, 100]
[modules.drive]
module = "lambda"
home = { Y = 600 }
modes = [{}, { q1 = "-" }]
[modules.drive.parameters]
L1 = 1300
L2 = { levels = [700, 820] }
L3 = { range = [500, 700], start = 600 }
)";

StudySpace Build(const std::string& text) {
  Outcome outcome = BuildStudy(text);
  if (!outcome.space) throw std::logic_error(outcome.complaints);
  return std::move(*outcome.space);
}

kinematics::Machine MachineOf(const StudySpace& space, const Candidate& candidate) {
  auto layout = layout::ParseLayout(LayoutText(space, candidate), "layout", BuiltRegistry());
  if (!layout) throw std::logic_error(RenderAll(layout.error(), {}));
  auto machine = kinematics::Machine::Build(std::move(*layout), BuiltRegistry());
  if (!machine) throw std::logic_error(RenderAll(machine.error(), {}));
  return std::move(*machine);
}

TEST(Candidate, HasTheFormulaOfItsLayout) {
  const StudySpace space = Build(kWaterjet);
  Enumeration(space.space()).VisitAll([&](Count, const Selection& selection) {
    const Candidate candidate = space.At(selection);
    const std::string text = LayoutText(space, candidate);
    const auto layout = layout::ParseLayout(text, "layout", BuiltRegistry());
    EXPECT_TRUE(layout) << text;
    if (layout) {
      EXPECT_EQ(formula::Canonical(layout->formula),
                formula::Canonical(space.FormulaOf(candidate)));
    }
    return !testing::Test::HasFailure();
  });
}

/// All orders with groups as items: one candidate of each class, levels and modes aside.
TEST(Candidate, GroupsHaveOneMemberOfEveryClass) {
  const StudySpace fine = Build("equivalence = \"string\"\n" + std::string(kWaterjet));
  const StudySpace coarse = Build(kWaterjet);
  std::set<std::string> classes;
  Enumeration(fine.space()).VisitAll([&](Count, const Selection& selection) {
    classes.insert(formula::DistributionKey(fine.FormulaOf(fine.At(selection))));
    return true;
  });
  std::multiset<std::string> ours;
  std::set<std::string> texts;
  Enumeration(coarse.space()).VisitAll([&](Count, const Selection& selection) {
    const auto formula = coarse.FormulaOf(coarse.At(selection));
    if (texts.insert(formula::Canonical(formula)).second) {
      ours.insert(formula::DistributionKey(formula));
    }
    return true;
  });
  EXPECT_EQ(ours, std::multiset<std::string>(classes.begin(), classes.end()));
}

bool OnPartSide(const StudySpace& space, const Candidate& candidate, char letter) {
  for (const Candidate::Placed& placed : candidate.chain) {
    for (const int motion : space.items()[static_cast<std::size_t>(placed.item)].motions) {
      const char theirs = space.study().motions[static_cast<std::size_t>(motion)].axis.letter;
      if (theirs == letter) return placed.part_side;
    }
  }
  return false;
}

/// Translations only: however a mechanism is mounted and wherever the axes are, the tool's place in
/// the part is the motions' values.
TEST(Candidate, PutsEveryLayoutIntoTheSameWorkZone) {
  const StudySpace space = Build(kWaterjet);
  Enumeration(space.space()).VisitAll([&](Count index, const Selection& selection) {
    const Candidate candidate = space.At(selection);
    const kinematics::Machine machine = MachineOf(space, candidate);
    const Pose<double> X_WT = machine.ToolPose(machine.home(), machine.nominal());
    // Middles of the ranges: 50, 50, 50.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(X_WT.p[i], 50.0, 1e-9) << CountText(index);
    EXPECT_TRUE(X_WT.R.isApprox(Matrix3<double>::Identity(), 1e-12));
    for (std::size_t k = 0; k < machine.coordinates().size(); ++k) {
      const char letter = machine.coordinates()[k].letter;
      kinematics::VectorXd z = machine.home();
      z[static_cast<Eigen::Index>(k)] += 1.0;
      const auto moved = machine.ToolPose(z, machine.nominal());
      Vector3<double> expected = Vector3<double>::Zero();
      expected[letter - 'X'] = OnPartSide(space, candidate, letter) ? -1.0 : 1.0;
      EXPECT_TRUE((moved.p - X_WT.p).isApprox(expected, 1e-9)) << CountText(index) << letter;
    }
    return !testing::Test::HasFailure();
  });
}

TEST(Candidate, SizesReplaceTheStart) {
  const StudySpace space = Build(kWaterjet);
  const auto formula = formula::ParseFormula("part (XY):drive O Z tool");
  ASSERT_TRUE(formula);
  const auto fixing = space.FixFormula(*formula);
  ASSERT_TRUE(fixing);
  const Candidate candidate = space.At(Enumeration(space.space(), *fixing).Unrank(0));
  ASSERT_EQ(candidate.blocks.size(), 1U);
  const std::vector<Size> sizes{{.module = 0, .parameter = 2, .value = 640.0}};
  EXPECT_THAT(ParametersOf(space, candidate.blocks[0]), testing::ElementsAre(1300.0, 700.0, 600.0));
  EXPECT_THAT(ParametersOf(space, candidate.blocks[0], sizes),
              testing::ElementsAre(1300.0, 700.0, 640.0));
  EXPECT_THAT(LayoutText(space, candidate, sizes), testing::HasSubstr("L3 = 640\n"));
}

TEST(Candidate, FormulasLeadBackToTheirCandidates) {
  const StudySpace space = Build(kWaterjet);
  Enumeration(space.space()).VisitAll([&](Count, const Selection& selection) {
    const auto fixing = space.FixFormula(space.FormulaOf(space.At(selection)));
    EXPECT_TRUE(fixing);
    if (fixing) {
      EXPECT_TRUE(Enumeration(space.space(), *fixing).Rank(selection));
    }
    return !testing::Test::HasFailure();
  });
  const auto other = formula::ParseFormula("part A O tool");
  EXPECT_FALSE(space.FixFormula(*other));
  const auto swapped = formula::ParseFormula("part Y X O Z tool");
  ASSERT_TRUE(space.FixFormula(*swapped)) << "the member that stands for its class";
  EXPECT_TRUE(Enumeration(space.space(), *space.FixFormula(*swapped)).count() == 1);
}

TEST(Candidate, ChoicesAreNamed) {
  const StudySpace space = Build(kWaterjet);
  const auto choice = space.ParseChoice("drive.L2=820");
  ASSERT_TRUE(choice);
  EXPECT_EQ(space.space().features()[static_cast<std::size_t>(choice->feature)].name, "drive.L2");
  EXPECT_THAT(space.ParseChoice("drive.L2=821").error().help, testing::HasSubstr("820"));
  EXPECT_THAT(space.ParseChoice("drive.L9=1").error().message, testing::HasSubstr("no feature"));
  EXPECT_EQ(space.ParseChoice("open").error().code, "E0829");
}

}  // namespace
}  // namespace kompono::synthesis
