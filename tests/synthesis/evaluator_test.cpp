// SPDX-License-Identifier: Apache-2.0
// Candidates of small studies through all stages.
#include "studies.hpp"
#include <fmt/format.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/kinematics/machine.hpp"
#include "kompono/synthesis/run.hpp"

namespace kompono::synthesis {
namespace {

/// A sheet moved and cut in the plane: plain axes, a lambda or a bi-glide, one base or two.
constexpr const char* kSheet = R"(kompono = 1
study = "small sheet"
base = ["closed", "open"]
process = "z"
part = { size = [400, 400, 10], mass = 60 }
[motions]
X = { range = [-200, 200] }
Y = { range = [-200, 200] }
Z = { range = [0, 100], sides = ["tool"] }
[modules.drive]
module = "lambda"
letters = ["XY"]
home = { Y = { range = [250, 900], start = 500 } }
parameters = { L1 = { range = [300, 2400], start = 1200 }, L2 = { range = [300, 2400], start = 820 }, L3 = { range = [200, 1200], start = 600 } }
modes = [{ q2 = "+" }, { q2 = "-" }]
[objectives]
footprint = "min"
stiffness = "max"
moving_mass = "min"
[reference]
formula = "part (XY):drive O|O Z tool"
[evaluation]
poses = 900
sizing_rounds = 60
)";

StudySpace SpaceOf(const std::string& text) {
  Outcome outcome = BuildStudy(text);
  if (!outcome.space) throw std::runtime_error(outcome.complaints);
  return std::move(*outcome.space);
}

EvaluationSettings SettingsOf(const StudySpace& space) {
  return ReadEvaluationSettings(space.study().text, "study.toml").value();
}

std::vector<Evaluation> AllRows(const Evaluator& evaluator) {
  const Enumeration all(evaluator.space().space());
  std::vector<Evaluation> rows;
  all.VisitAll([&](Count index, const Selection& selection) {
    rows.push_back(
        evaluator.Evaluate(evaluator.space().At(selection, static_cast<std::uint64_t>(index))));
    return true;
  });
  return rows;
}

TEST(Evaluator, LeavesARowForEveryCandidateAndSizesEveryMechanism) {
  const StudySpace space = SpaceOf(kSheet);
  const Evaluator evaluator(space, SettingsOf(space));
  const std::vector<Evaluation> rows = AllRows(evaluator);
  ASSERT_GT(rows.size(), 10U);
  std::size_t sized = 0;
  for (const Evaluation& row : rows) {
    SCOPED_TRACE(fmt::format("{}: {}", row.formula, row.reason));
    EXPECT_EQ(row.status, EvaluationStatus::kOk);
    EXPECT_TRUE(row.metrics.Has(MetricId::kStiffness));
    EXPECT_TRUE(row.metrics.Has(MetricId::kFootprint));
    EXPECT_FALSE(row.metrics.Has(MetricId::kOrientationMargin)) << "nothing turns";
    EXPECT_EQ(row.metrics[MetricId::kMobility], 3.0);
    EXPECT_EQ(row.metrics[MetricId::kZoneShare], 1.0);
    const bool lambda = row.formula.find(":drive") != std::string::npos;
    EXPECT_EQ(row.sizes.size(), lambda ? 4U : 0U);
    EXPECT_EQ(row.metrics[MetricId::kDriveCount], 3.0);
    EXPECT_EQ(row.metrics[MetricId::kFoundations],
              row.formula.find("O|O") != std::string::npos ? 2.0 : 1.0);
    if (!lambda) {
      EXPECT_NEAR(row.metrics[MetricId::kTravel], 400.0 + 400.0 + 100.0, 1e-9);
      EXPECT_EQ(row.metrics[MetricId::kDexterityWorst], 1.0);
      continue;
    }
    // With slider 2 before the joint the goal cannot be met; the nearest to it stays.
    sized += row.metrics[MetricId::kDexterityWorst] >= 0.28 ? 1U : 0U;
  }
  EXPECT_GT(sized, 0U);
  // Sizes once per mode and side, not once per layout.
  EXPECT_LE(evaluator.sizing_sharing().computed, 4U);
  EXPECT_LT(evaluator.mobility_sharing().computed, rows.size());
}

TEST(Evaluator, GivesTheSameStructureAloneAndWithTheRest) {
  const StudySpace space = SpaceOf(kSheet);
  const Evaluator evaluator(space, SettingsOf(space));
  const Enumeration all(space.space());
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(all.count()); ++i) {
    const Candidate candidate = space.At(all.Unrank(i), i);
    const Evaluation structure = evaluator.Structure(candidate);
    const Evaluation row = evaluator.Evaluate(candidate);
    for (const MetricDescription& metric : Metrics()) {
      if (metric.stage != Stage::kStructure) continue;
      EXPECT_EQ(structure.metrics[metric.id], row.metrics[metric.id]) << metric.name;
    }
  }
}

TEST(Evaluator, WritesALayoutThatHasTheSizesAndReachesTheZone) {
  const StudySpace space = SpaceOf(kSheet);
  const Evaluator evaluator(space, SettingsOf(space));
  const auto fixed = space.FixFormula(*formula::ParseFormula(space.study().reference));
  ASSERT_TRUE(fixed);
  const Enumeration lambdas(space.space(), *fixed);
  ASSERT_GT(lambdas.count(), 0U);
  const Candidate candidate = space.At(lambdas.Unrank(0), 0);
  const Evaluation row = evaluator.Evaluate(candidate);
  ASSERT_EQ(row.status, EvaluationStatus::kOk) << row.reason;
  const auto layout =
      layout::ParseLayout(evaluator.LayoutFile(candidate), "layout.toml", space.registry());
  ASSERT_TRUE(layout) << RenderAll(layout.error(), {});
  const auto machine = kinematics::Machine::Build(*layout, space.registry());
  ASSERT_TRUE(machine) << RenderAll(machine.error(), {});
  for (const SizedNumber& size : row.sizes) {
    if (size.name.find("home") != std::string::npos) continue;
    EXPECT_NEAR(
        machine->parameters()[static_cast<std::size_t>(machine->FindParameter(size.name))].nominal,
        size.value,
        1e-9)
        << size.name;
  }
  for (const double x : {-200.0, 0.0, 200.0}) {
    for (const double y : {-200.0, 0.0, 200.0}) {
      kinematics::PoseTarget target;
      target.component = {x, y, 50.0};
      const kinematics::Solution solution = machine->Inverse(target);
      EXPECT_TRUE(solution.ok()) << x << " " << y << ": " << solution.message;
    }
  }
}

TEST(Evaluator, RejectsByALimitAtItsStage) {
  const StudySpace space = SpaceOf(
      fmt::format("{}{}", kSheet, "[limits]\nstack = { max = 1 }\nfootprint = { max = 0.5 }\n"));
  const Evaluator evaluator(space, SettingsOf(space));
  bool at_structure = false;
  for (const Evaluation& row : AllRows(evaluator)) {
    if (row.metrics[MetricId::kStack] > 1.0) {
      at_structure = true;
      EXPECT_EQ(row.status, EvaluationStatus::kRejected);
      EXPECT_EQ(row.stage, Stage::kStructure);
      EXPECT_EQ(row.reason, "stack above 1");
      EXPECT_FALSE(row.metrics.Has(MetricId::kTravel)) << "later stages were not paid for";
    } else if (row.status == EvaluationStatus::kRejected) {
      EXPECT_EQ(row.reason, "footprint above 0.5 m2");
      EXPECT_GT(row.metrics[MetricId::kFootprint], 0.5);
    } else {
      EXPECT_LE(row.metrics[MetricId::kFootprint], 0.5);
    }
  }
  EXPECT_TRUE(at_structure);
}

TEST(Evaluator, RejectsATurnAboutTheToolsOwnAxisWhereASpindleTurnsTheTool) {
  const std::string text =
      "kompono = 1\nstudy = \"five axes\"\n"
      "[motions]\nX = { range = [-100, 100] }\nY = { range = [-100, 100] }\n"
      "Z = { range = [0, 100] }\nA = { range = [-30, 30] }\nC = { range = [-60, 60] }\n"
      "[ends.part]\nside = \"part\"\nchain = \"part\"\n"
      "[ends.spindle]\nside = \"tool\"\nchain = \"C2_v tool\"\n[evaluation]\nposes = 32\n";
  const Outcome outcome = BuildStudy(text);
  ASSERT_TRUE(outcome.space) << outcome.complaints;
  const Evaluator evaluator(*outcome.space, SettingsOf(*outcome.space));
  std::size_t rejected = 0;
  std::size_t ok = 0;
  for (const Evaluation& row : AllRows(evaluator)) {
    // C carries the spindle and nothing turns between them: the last motion before the tool, or
    // followed by translations only.
    const std::size_t c = row.formula.find("C ");
    const std::size_t a = row.formula.find("A ");
    ASSERT_NE(a, std::string::npos) << row.formula;
    const bool idle = c > a && c < row.formula.find("C2_v");
    if (row.status == EvaluationStatus::kOk) {
      ++ok;
      EXPECT_FALSE(idle) << row.formula;
    } else {
      ++rejected;
      EXPECT_EQ(row.reason, "a turn about the tool's own axis does nothing") << row.formula;
      EXPECT_TRUE(idle) << row.formula;
    }
  }
  EXPECT_GT(rejected, 0U);
  EXPECT_GT(ok, 0U);
}

TEST(StudyFront, HoldsWhatIsOkAndHasAllObjectives) {
  const StudySpace space = SpaceOf(kSheet);
  StudyFront front(space.study());
  Evaluation row{.index = 1};
  EXPECT_FALSE(front.Insert(row)) << "no values";
  row.metrics.Set(MetricId::kFootprint, 1.0);
  row.metrics.Set(MetricId::kStiffness, 10.0);
  row.metrics.Set(MetricId::kMovingMass, 100.0);
  EXPECT_TRUE(front.Insert(row));
  Evaluation worse = row;
  worse.index = 2;
  worse.metrics.Set(MetricId::kStiffness, 9.0);
  EXPECT_FALSE(front.Insert(worse)) << "stiffness is to be large";
  worse.status = EvaluationStatus::kRejected;
  worse.metrics.Set(MetricId::kStiffness, 99.0);
  EXPECT_FALSE(front.Insert(worse));
}

}  // namespace
}  // namespace kompono::synthesis
