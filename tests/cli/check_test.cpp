// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <filesystem>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;
using testing::Not;

using Check = Program;

TEST_F(Check, AllLayoutsOfTheTreeAreGood) {
  std::vector<std::string> arguments{"check"};
  for (const auto& entry : std::filesystem::directory_iterator(Source("layouts/machines")))
    arguments.push_back(entry.path().string());
  ASSERT_GT(arguments.size(), 5U);
  const Outcome outcome = Run(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<std::string> lines = Lines(outcome.out);
  ASSERT_EQ(lines.size(), arguments.size() - 1);
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i], arguments[i + 1] + ": ok");
}

TEST_F(Check, EveryFaultOfEveryFileIsReportedInOneRun) {
  Write("one.toml", "kompono = 1\nformula = 'X Y O tool'\ncolour = 'red'\nsize = 3\n");
  Write("two.toml", "kompono = 1\nformula = 'X Q7_v O tool'\n");
  const std::string good = Machine("knee_mill");
  const Outcome outcome = Run({"check", "one.toml", good, "two.toml"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("one.toml: 2 errors\n"));
  EXPECT_THAT(outcome.out, HasSubstr(good + ": ok\n"));
  EXPECT_THAT(outcome.out, HasSubstr("two.toml: 1 error\n"));
  EXPECT_THAT(outcome.err, HasSubstr("one.toml:3:1: error: "));
  EXPECT_THAT(outcome.err, HasSubstr("one.toml:4:1: error: "));
  EXPECT_THAT(outcome.err, HasSubstr("two.toml:2:"));
  EXPECT_THAT(outcome.err, HasSubstr("3 errors"));
}

TEST_F(Check, JsonJudgesFileByFile) {
  Write("one.toml", "kompono = 1\nformula = 'X Y O tool'\ncolour = 'red'\n");
  const nlohmann::json files = Json({"check", "one.toml", Machine("knee_mill")}, 1)["files"];
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0]["ok"], false);
  EXPECT_EQ(files[0]["kind"], "layout");
  EXPECT_EQ(files[0]["diagnostics"].size(), 1U);
  EXPECT_EQ(files[1]["ok"], true);
}

TEST_F(Check, UnreadableFilesAreInputOutputButTheOthersAreJudged) {
  const Outcome outcome = Run({"check", "nowhere.toml", Machine("knee_mill")});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(outcome.out, HasSubstr("knee_mill.toml: ok"));
  EXPECT_THAT(outcome.err, HasSubstr("nowhere.toml: error: cannot be read: No such file"));
  EXPECT_EQ(Run({"check", "."}).code, 5);
}

TEST_F(Check, MeasurementsNeedTheirLayout) {
  const std::string layout = Machine("knee_mill");
  ASSERT_EQ(Run({"measure", layout, "--points", "5", "-o", "p.csv"}).code, 0);
  const Outcome alone = Run({"check", "p.csv"});
  EXPECT_EQ(alone.code, 1);
  EXPECT_THAT(alone.err, HasSubstr("--layout"));
  const Outcome with = Run({"check", "--layout", layout, "p.csv"});
  EXPECT_EQ(with.code, 0) << with.err;
  EXPECT_EQ(with.out, "p.csv: ok\n");
  Write("p.csv", Read("p.csv") + "1,2\n");
  EXPECT_EQ(Run({"check", "--layout", layout, "p.csv"}).code, 1);
}

TEST_F(Check, ADescriptionOfMeasurementsIsJudgedWithItsFiles) {
  const std::string layout = Machine("knee_mill");
  ASSERT_EQ(Run({"measure", layout, "--points", "12", "-o", "p.csv"}).code, 0);
  Write("campaign.toml",
        "measurements = 1\nlayout = '" + layout +
            "'\n[[file]]\ncsv = 'p.csv'\n[fit]\nfree = ['*.zero']\n");
  const Outcome good = Run({"check", "campaign.toml"});
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_EQ(good.out, "campaign.toml: ok\n");
  EXPECT_EQ(Json({"check", "campaign.toml"})["files"][0]["kind"], "measurement description");
  EXPECT_THAT(Files(), testing::ElementsAre("campaign.toml", "p.csv"));
}

TEST_F(Check, EveryFaultOfADescriptionIsNamed) {
  const std::string layout = Machine("knee_mill");
  Write("words.toml",
        "measurements = 2\nlayot = 'x.toml'\n[[file]]\ncsv = 'p.csv'\nsigma_mm = -1\n");
  const Outcome words = Run({"check", "words.toml"});
  EXPECT_EQ(words.code, 1);
  EXPECT_EQ(words.out, "words.toml: 4 errors\n") << words.err;
  EXPECT_THAT(words.err, HasSubstr("words.toml:2:1: error: unknown key 'layot' [E0468]"));
  EXPECT_THAT(words.err, HasSubstr("words.toml:5:12: error: 'sigma_mm' must be a number greater"));

  ASSERT_EQ(Run({"measure", layout, "--points", "12", "-o", "p.csv"}).code, 0);
  Write("q.csv", Read("p.csv") + "1,2\n");
  const std::string head = "measurements = 1\nlayout = '" + layout + "'\n[[file]]\ncsv = ";
  Write("rows.toml", head + "'q.csv'\n[[file]]\ncsv = 'nowhere.csv'\n");
  const Outcome rows = Run({"check", "rows.toml"});
  EXPECT_EQ(rows.code, 1);
  EXPECT_THAT(rows.err, HasSubstr("q.csv:"));
  EXPECT_THAT(rows.err, HasSubstr("the row has 2 cells"));
  EXPECT_THAT(rows.err, HasSubstr("nowhere.csv: error: cannot be read"));
  Write("patterns.toml", head + "'p.csv'\n[fit]\nfree = ['X.zerro']\n");
  const Outcome patterns = Run({"check", "patterns.toml"});
  EXPECT_EQ(patterns.code, 1);
  EXPECT_THAT(patterns.err, HasSubstr("patterns.toml: error: "));
  EXPECT_THAT(patterns.err, HasSubstr("[E0431]"));
  Write("lost.toml", "measurements = 1\nlayout = 'lost_machine.toml'\n[[file]]\ncsv = 'p.csv'\n");
  const Outcome lost = Run({"check", "lost.toml"});
  EXPECT_EQ(lost.code, 1);
  EXPECT_THAT(lost.err, HasSubstr("lost_machine.toml: error: cannot be read"));
}

TEST_F(Check, SidecarsAndUnknownFiles) {
  EXPECT_EQ(Run({"check", Source("plugins/lambda/plugin.toml")}).code, 0);
  Write("plugin.toml", "kompono = 1\nid = 'x'\n");
  EXPECT_EQ(Run({"check", "plugin.toml"}).code, 1);
  Write("notes.txt", "hello\n");
  const Outcome outcome = Run({"check", "notes.txt"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("[E0618]"));
  Write("layout.txt", "kompono = 1\nformula = 'X Y O tool'\n");
  EXPECT_EQ(Run({"check", "layout.txt"}).code, 0);
}

TEST_F(Check, TheSchemaIsJsonWithTheInstalledModules) {
  const Outcome outcome = Run({"schema"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json schema = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(schema.is_discarded());
  EXPECT_THAT(schema["$schema"].get<std::string>(), HasSubstr("2020-12"));
  EXPECT_THAT(outcome.out, HasSubstr("\"lambda\""));
  EXPECT_EQ(Run({"schema", "--json"}).out, outcome.out);
}

TEST_F(Check, JudgesTheGeometryOfAGoodTextUnlessNoCodeMayRun) {
  const std::string file = Source("layouts/bad/geometry_rail_without_length.toml");
  const Outcome judged = Run({"check", file});
  EXPECT_EQ(judged.code, 1);
  EXPECT_THAT(judged.err, HasSubstr("geometry_rail_without_length.toml:12:28: error: "));
  EXPECT_THAT(judged.err, HasSubstr("[E0703]"));
  EXPECT_EQ(Run({"check", "--no-code", file}).code, 0);
}

}  // namespace
}  // namespace kompono::cli_test
