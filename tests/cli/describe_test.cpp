// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <filesystem>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;

using Describe = Program;

TEST_F(Describe, TellsMotionsDrivesMobilityAndHome) {
  const Outcome outcome = Run({"describe", Machine("so_waterjet_lambda")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word : {"part_xy (XY):drive O|O Z P_z",
                           "drive.X",
                           "drive.q1",
                           "lambda",
                           "open base",
                           "jet_head",
                           "mobility",
                           "singularity margin",
                           "0 .. 150 mm"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
}

TEST_F(Describe, JsonOfTheLambdaMachine) {
  const nlohmann::json sheet = Json({"describe", Machine("so_waterjet_lambda")});
  ASSERT_EQ(sheet["coordinates"].size(), 3U);
  EXPECT_EQ(sheet["coordinates"][0]["name"], "drive.X");
  EXPECT_EQ(sheet["coordinates"][0]["range"], nlohmann::json::parse("[0.0, 1000.0]"));
  EXPECT_EQ(sheet["coordinates"][0]["home"], 500.0);
  ASSERT_EQ(sheet["drives"].size(), 3U);
  EXPECT_NEAR(sheet["drives"][0]["speed_per_s"].get<double>(), 40000.0 / 60.0, 1e-9);
  ASSERT_EQ(sheet["mechanisms"].size(), 1U);
  const nlohmann::json& lambda = sheet["mechanisms"][0];
  EXPECT_EQ(lambda["mobility"], 2);
  // 5 links and 5 pairs: one loop, 3 (5 - 1) - 2 * 5 = 2 motions in the plane.
  EXPECT_EQ(lambda["links"], 5);
  EXPECT_EQ(lambda["pairs"], 5);
  EXPECT_EQ(lambda["loops"], 1);
  EXPECT_EQ(lambda["gruebler"], 2);
  EXPECT_EQ(sheet["open_base"]["position_mm"], nlohmann::json::parse("[500.0, 600.0, 134.0]"));
  // Home is X 500, Y 600: the jet stands over the sheet's datum.
  for (const char* letter : {"X", "Y", "Z", "A", "B", "C"})
    EXPECT_NEAR(sheet["home"]["pose"][letter].get<double>(), 0.0, 1e-9) << letter;
  EXPECT_EQ(sheet["home"]["singularity"]["type"], 0);
  EXPECT_GT(sheet["home"]["singularity"]["margin"].get<double>(), 1e-3);
}

TEST_F(Describe, CapabilitiesOfModulesAreTheMachines) {
  // A preset of another plugin's unit; the catalog keeps the versions of both.
  std::filesystem::create_directories(folder() / "work/plugins/cutter");
  Write("plugins/cutter/plugin.toml",
        "kompono = 1\nid = 'org.example.cutter'\nversion = '2.5.0'\ncontract = '1.0'\n"
        "[[preset]]\nid = 'cutter'\ntitle = 'Cutter'\nof = 'tool'\ncapabilities = "
        "['example.milling']\n");
  Write("mill.toml",
        "kompono = 1\nname = 'Mill'\nformula = 'X O Z tool'\n"
        "[axis.X]\nrange = [0, 1]\n[axis.Z]\nrange = [0, 1]\n[tool]\nmodule = 'cutter'\n");
  Set("KOMPONO_PLUGIN_PATH", (folder() / "work/plugins").string());
  EXPECT_EQ(Json({"describe", "mill.toml"})["capabilities"]["example.milling"],
            nlohmann::json::array({"tool"}));
  EXPECT_THAT(Run({"describe", "mill.toml"}).out, HasSubstr("example.milling (tool)"));
  ASSERT_EQ(Run({"catalog", "add", "machines.db", "mill.toml"}).code, 0);
  const nlohmann::json found =
      Json({"catalog",
            "query",
            "machines.db",
            "id in (select layout_id from capabilities where name = 'example.milling')",
            "--columns",
            "name, plugins"});
  ASSERT_EQ(found["rows"].size(), 1U);
  EXPECT_EQ(found["rows"][0]["plugins"], "org.example.cutter 2.5.0, org.kompono.units 0.1.0");
}

TEST_F(Describe, TellsWhatALatheMakesPossibleAndWhy) {
  Write("lathe.toml",
        "kompono = 1\nname = 'Lathe'\nformula = '(part1 C_h + part2 C2_h Z2) O X Z tool'\n"
        "[part1]\nmodule = 'headstock'\n"
        "[part2]\nmodule = 'counter_spindle'\nmount = { position = [0, 0, 1000] }\n"
        "[axis.Z2]\nrange = [-600, 0]\n[tool]\nmodule = 'tool'\n");
  const Outcome outcome = Run({"describe", "lathe.toml"});
  EXPECT_THAT(outcome.out, HasSubstr("sequential work on two short parts"));
  EXPECT_THAT(outcome.out, HasSubstr("40 to 640 mm apart by Z2"));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("two tools on a long part")));
  const nlohmann::json abilities = Json({"describe", "lathe.toml"})["abilities"];
  ASSERT_EQ(abilities.size(), 9U);
  EXPECT_EQ(abilities[1]["name"], "take_over");
  EXPECT_EQ(abilities[1]["possible"], true);
  EXPECT_EQ(abilities[1]["by"], nlohmann::json({"part1", "part2", "Z2"}));
  EXPECT_EQ(abilities[5]["name"], "parallel_parts");
  EXPECT_EQ(abilities[5]["possible"], false);
  EXPECT_EQ(abilities[5]["reason"], "tool is the only tool");
  EXPECT_EQ(abilities[5]["by"], nlohmann::json::array());
  ASSERT_EQ(Run({"catalog", "add", "machines.db", "lathe.toml"}).code, 0);
  const nlohmann::json found =
      Json({"catalog",
            "query",
            "machines.db",
            "id in (select layout_id from capabilities where name = 'take_over')",
            "--columns",
            "name"});
  ASSERT_EQ(found["rows"].size(), 1U);
}

TEST_F(Describe, WorksForEveryMachineOfTheTree) {
  for (const auto& entry : std::filesystem::directory_iterator(Source("layouts/machines"))) {
    const nlohmann::json sheet = Json({"describe", entry.path().string()});
    EXPECT_GT(sheet["drives"].size(), 0U) << entry.path();
    EXPECT_GT(sheet["parameters"]["count"].get<int>(), 0) << entry.path();
    EXPECT_EQ(Run({"describe", entry.path().string()}).code, 0);
  }
}

TEST_F(Describe, FreedomsOfFourStruts) {
  const nlohmann::json table =
      Json({"describe", Machine("kdd_four_strut_lathe"), "--freedoms", "--radian", "150"});
  ASSERT_EQ(table["mechanisms"].size(), 1U);
  const nlohmann::json& choices = table["mechanisms"][0]["choices"];
  ASSERT_EQ(choices.size(), 15U);
  EXPECT_EQ(choices[0]["letters"], "YZBC");
  EXPECT_NEAR(choices[0]["condition"].get<double>(), 350.0 / 300.0, 1e-9);
  EXPECT_TRUE(choices[14]["condition"].is_null());
  const Outcome text = Run({"describe", Machine("kdd_four_strut_lathe"), "--freedoms"});
  EXPECT_THAT(text.out, HasSubstr("YZBC"));
  EXPECT_THAT(text.out, HasSubstr("singular"));
  EXPECT_EQ(Run({"describe", Machine("knee_mill"), "--radian", "0"}).code, 2);
}

}  // namespace
}  // namespace kompono::cli_test
