// SPDX-License-Identifier: Apache-2.0
// Reading and judging of study files.
#include "kompono/synthesis/study.hpp"

#include "studies.hpp"
#include <nlohmann/json.hpp>

#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::synthesis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kHead = "kompono = 1\nstudy = \"s\"\n";
constexpr const char* kPlane =
    "[motions.X]\nrange = [-5, 5]\n[motions.Y]\nrange = [0, 8]\nspeed = 600\nstiffness = 2\n";

std::string Complaints(const std::string& text) {
  return BuildStudy(text).complaints;
}

Study Good(const std::string& text) {
  Parsed<Study> study = ParseStudy(text, "study.toml", BuiltRegistry());
  EXPECT_TRUE(study) << RenderAll(study.error(), {});
  return study ? *std::move(study) : Study{};
}

TEST(Study, GivesNumbersInMillimetresRadiansAndSeconds) {
  const Study study = Good(std::string(kHead) + kPlane +
                           "[motions.C]\nrange = [-90, 180]\nsides = [\"part\"]\nspeed = 360\n");
  ASSERT_EQ(study.motions.size(), 3U);
  EXPECT_EQ(study.motions[1].name, "Y");
  EXPECT_EQ(study.motions[1].range, (Interval{0.0, 8.0}));
  EXPECT_DOUBLE_EQ(*study.motions[1].drive.speed, 10.0);
  EXPECT_DOUBLE_EQ(*study.motions[1].drive.stiffness, 2000.0);
  EXPECT_DOUBLE_EQ(study.motions[2].range.upper, std::numbers::pi);
  EXPECT_DOUBLE_EQ(*study.motions[2].drive.speed, 2.0 * std::numbers::pi / 60.0);
  EXPECT_EQ(study.motions[2].sides, (Sides{.part = true, .tool = false}));
  EXPECT_EQ(study.ends.size(), 2U) << "bare part and tool";
}

TEST(Study, KeepsTheOrderOfTheFile) {
  const Study study =
      Good(std::string(kHead) +
           "[motions]\nZ = { range = [0, 1] }\nA = { range = [0, 1] }\n"
           "X = { range = [0, 1] }\n[objectives]\nzeta = \"max\"\nalpha = \"min\"\n");
  std::vector<std::string> names;
  for (const Motion& motion : study.motions) names.push_back(motion.name);
  EXPECT_THAT(names, ElementsAre("Z", "A", "X"));
  ASSERT_EQ(study.objectives.size(), 2U);
  EXPECT_EQ(study.objectives[0].metric, "zeta");
  EXPECT_TRUE(study.objectives[0].maximise);
}

TEST(Study, ReadsParametersFixedInLevelsAndInRanges) {
  const Study study = Good(
      std::string(kHead) + kPlane +
      "[modules.drive]\nmodule = \"lambda\"\nhome = { Y = { range = [300, 500], start = 400 } }\n"
      "modes = [{ q2 = \"-\" }, {}]\n"
      "[modules.drive.parameters]\nL1 = 1200\nL2 = { levels = [700, 820] }\n"
      "L3 = { range = [300, 900] }\n");
  ASSERT_EQ(study.modules.size(), 1U);
  const StudyModule& module = study.modules[0];
  EXPECT_THAT(module.defaults, ElementsAre(1200.0, 0.0, 600.0));
  EXPECT_THAT(module.home, ElementsAre(0.0, 400.0));
  ASSERT_EQ(module.parameters.size(), 4U);
  EXPECT_EQ(module.parameters[1].levels[1].name, "820");
  EXPECT_EQ(module.parameters[2].range, (Interval{300.0, 900.0}));
  EXPECT_EQ(module.parameters[3].name, "home.Y");
  EXPECT_EQ(module.parameters[3].coordinate, 1);
  ASSERT_EQ(module.modes.size(), 2U);
  EXPECT_EQ(module.modes[0].name, "+-+");
  EXPECT_EQ(module.modes[1].name, "+++");
}

TEST(Study, TellsAllProblemsOfAFileAtOnce) {
  const std::string said = Complaints(
      "kompono = 1\nstudy = \"s\"\nequivalence = \"some\"\n"
      "[motions.X]\nrange = [5, -5]\n[motions.Q7x]\nrange = [0, 1]\n"
      "[modules.drive]\nmodule = \"lamda\"\n"
      "[ends.e]\nside = \"tool\"\nchain = \"part X\"\n"
      "[[rule]]\nname = \"r\"\nforbid = []\nkind = \"logical\"\nreason = \"\"\nauthor = \"\"\n");
  for (const char* code : {"E0808", "E0810", "E0811", "E0812", "E01", "E0823"}) {
    EXPECT_THAT(said, HasSubstr(code));
  }
  EXPECT_THAT(said, HasSubstr("did you mean 'lambda'?"));
  EXPECT_THAT(said, HasSubstr("write [-5, 5]"));
  EXPECT_THAT(said, HasSubstr("study.toml:5:9: error: lower limit 5 of 'range'"));
}

TEST(Study, HasACodeForEveryFault) {
  const std::string plane = std::string(kHead) + kPlane;
  const std::string lambda =
      plane + "[modules.d]\nmodule = \"lambda\"\n[modules.d.parameters]\nL1 = 1200\nL3 = 600\n";
  const std::string rule =
      "[[rule]]\nname = \"r\"\nkind = \"logical\"\nreason = \"\"\n"
      "author = \"\"\n";
  const std::vector<std::pair<std::string, std::string>> bad{
      {"kompono = 1\nstudy = ", "E0801"},
      {plane + "[part]\nsise = [1, 2, 3]\n", "E0802"},
      {"kompono = 1\n" + std::string(kPlane), "E0803"},
      {std::string("study = 3\n") + kPlane, "E0804"},
      {plane + "[part]\nsize = [1, 2]\n", "E0805"},
      {plane + "[part]\nmass = nan\n", "E0806"},
      {plane + "[part]\nmass = -1\n", "E0807"},
      {"kompono = 2\nstudy = \"s\"\n" + std::string(kPlane), "E0809"},
      {plane + "[modules.d]\nmodule = \"spindle\"\n", "E0813"},
      {lambda + "L2 = 800\nL4 = 7\n", "E0814"},
      {lambda, "E0815"},
      {lambda + "L2 = 800\n[[modules.d.modes]]\nq9 = \"+\"\n", "E0816"},
      {lambda + "L2 = 800\n[modules.d.drive.q9]\nspeed = 1\n", "E0817"},
      {lambda + "L2 = 800\n[modules.d.home]\nB = 1\n", "E0818"},
      {plane +
           "[modules.d]\nmodule = \"linear_delta\"\nparameters = { radius = 100, strut = 300 }\n",
       "E0819"},
      {plane + "[modules.d]\nmodule = \"lambda\"\nletters = [\"XZ\"]\n", "E0820"},
      {plane + "[ends.e]\nside = \"tool\"\nchain = \"O tool\"\n", "E0103"},
      {plane + rule + "forbid = [\"part:Z\"]\n", "E0822"},
      {plane + rule + "forbid = [\"part:X\", \"tool:X\", \"tool:Y\"]\n", "E0823"},
      {plane + rule + "forbid = [\"part:X\"]\n" + rule + "forbid = [\"part:Y\"]\n", "E0825"},
      {std::string(kHead) + "[motions.X]\nrange = [0, 1]\nplain = false\n", "E0826"},
      {plane + rule + "forbid = [\"motion:X\"]\n", "E0827"},
      {plane + "[ends.e]\nside = \"tool\"\nchain = \"tool\"\nlayout.tool = { module = \"jett\" }\n",
       "E0828"},
      {plane + "[reference]\nformula = \"part X O Z tool\"\n", "E0831"},
      {plane + rule +
           "forbid = [\"part:X\", \"base:closed\"]\n[reference]\n"
           "formula = \"part X O Y tool\"\n",
       "E0831"},
  };
  for (const auto& [text, code] : bad) {
    EXPECT_THAT(Complaints(text), HasSubstr("[" + code + "]")) << text;
  }
}

TEST(Study, JudgesTheNamesOfMetrics) {
  const std::vector<std::string> known{"footprint", "stiffness"};
  const std::string text = std::string(kHead) + kPlane +
                           "[objectives]\nfootprnt = \"min\"\n[limits.stifness]\nmin = 1\n";
  const auto study = ParseStudy(text, "study.toml", BuiltRegistry(), known);
  ASSERT_FALSE(study);
  const std::string said = RenderAll(study.error(), {});
  EXPECT_THAT(said, HasSubstr("did you mean 'footprint'?"));
  EXPECT_THAT(said, HasSubstr("did you mean 'stiffness'?"));
  EXPECT_THAT(said, HasSubstr("E0824"));
}

TEST(Study, NamesTheRuleThatLeavesNothing) {
  const std::string said =
      Complaints(std::string(kHead) + kPlane +
                 "[[rule]]\nname = \"nowhere\"\nforbid = [\"motion:X\"]\nkind = \"normative\"\n"
                 "reason = \"a trial\"\nauthor = \"me\"\n");
  EXPECT_THAT(said, HasSubstr("no layout is left [E0827]"));
  EXPECT_THAT(said, HasSubstr("without the rule 'nowhere' there would be 4"));
}

TEST(Study, WarnsOfRulesThatDoNothingOrAreBlurred) {
  const std::string rules =
      "[[rule]]\nname = \"idle\"\nforbid = [\"end:part\", \"end:part\"]\nkind = \"logical\"\n"
      "reason = \"\"\nauthor = \"\"\noff = true\n"
      "[[rule]]\nname = \"order\"\nforbid_order = [\"part:X\", \"part:Y\"]\nkind = \"logical\"\n"
      "reason = \"\"\nauthor = \"\"\n";
  const Outcome outcome = BuildStudy(std::string(kHead) + kPlane + rules);
  ASSERT_TRUE(outcome.space) << outcome.complaints;
  const std::string notes = RenderAll(outcome.notes, {});
  EXPECT_THAT(notes, HasSubstr("the rule 'order' looks at what layouts that count as one"));
  const Outcome exact =
      BuildStudy("equivalence = \"string\"\n" + std::string(kHead) + kPlane + rules);
  ASSERT_TRUE(exact.space) << exact.complaints;
  EXPECT_THAT(RenderAll(exact.notes, {}), testing::Not(HasSubstr("W0802")));
}

TEST(Study, SchemaHasEveryKeyAndTheInstalledMechanisms) {
  const auto schema = nlohmann::json::parse(StudySchema(BuiltRegistry(), {}));
  EXPECT_TRUE(schema["properties"].contains("motions"));
  const auto& modules =
      schema["properties"]["modules"]["additionalProperties"]["properties"]["module"]["enum"];
  EXPECT_THAT(modules, testing::Contains("lambda"));
  EXPECT_THAT(modules, testing::Not(testing::Contains("spindle")));
  EXPECT_EQ(schema["required"], (nlohmann::json{"kompono", "study", "motions"}));
}

TEST(Study, IsToldFromALayout) {
  EXPECT_TRUE(LooksLikeStudy(std::string(kHead) + kPlane));
  EXPECT_FALSE(LooksLikeStudy("kompono = 1\nformula = \"part X O tool\"\n"));
}

}  // namespace
}  // namespace kompono::synthesis
