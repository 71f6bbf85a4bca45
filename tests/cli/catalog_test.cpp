// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <filesystem>

namespace kompono::cli_test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

class Catalog : public Program {
 protected:
  const std::string lambda_ = Machine("so_waterjet_lambda");
  const std::string mill_ = Machine("knee_mill");
  void Fill() const {
    const Outcome outcome = Run({"catalog", "add", "machines.db", lambda_, mill_});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
};

TEST_F(Catalog, AddTellsWhatIsNew) {
  const nlohmann::json first = Json({"catalog", "add", "machines.db", lambda_, mill_})["added"];
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0]["status"], "added");
  const nlohmann::json second = Json({"catalog", "add", "machines.db", lambda_})["added"];
  EXPECT_EQ(second[0]["status"], "unchanged");
  EXPECT_EQ(second[0]["id"], first[0]["id"]);
}

TEST_F(Catalog, AddTakesEveryMachineOfTheTree) {
  std::vector<std::string> arguments{"catalog", "add", "machines.db"};
  for (const auto& entry : std::filesystem::directory_iterator(Source("layouts/machines")))
    arguments.push_back(entry.path().string());
  const Outcome outcome = Run(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Json({"catalog", "stats", "machines.db"})["layouts"], arguments.size() - 3);
  EXPECT_EQ(Run({"catalog", "verify", "machines.db"}).code, 0);
}

TEST_F(Catalog, OneBadFileAddsNothing) {
  Write("bad.toml", "kompono = 1\nformula = 'X Q7_v O tool'\n");
  const Outcome outcome = Run({"catalog", "add", "machines.db", mill_, "bad.toml", "no.toml"});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("bad.toml:2:"));
  EXPECT_THAT(outcome.err, HasSubstr("no.toml"));
  EXPECT_THAT(Files(), ElementsAre("bad.toml"));
}

TEST_F(Catalog, QueryFindsSortsAndLimits) {
  Fill();
  const nlohmann::json open = Json({"catalog", "query", "machines.db", "base = 'open'"});
  ASSERT_EQ(open["rows"].size(), 1U);
  EXPECT_EQ(open["rows"][0]["formula"], "part_xy (XY):drive O|O Z P_z");
  const nlohmann::json all =
      Json({"catalog", "query", "machines.db", "--sort", "name desc", "--columns", "name, drives"});
  ASSERT_EQ(all["rows"].size(), 2U);
  EXPECT_EQ(all["rows"][1]["name"], "Knee mill");
  EXPECT_EQ(all["rows"][1]["drives"], 3);
  const Outcome one = Run({"catalog", "query", "machines.db", "--limit", "1"});
  EXPECT_EQ(one.code, 0);
  EXPECT_THAT(one.err, HasSubstr("--limit"));
  const Outcome csv =
      Run({"catalog", "query", "machines.db", "drives = 3", "--csv", "--columns", "name"});
  EXPECT_THAT(csv.out, HasSubstr("name\r\n"));
  EXPECT_THAT(Run({"catalog", "query", "machines.db"}).out, HasSubstr("Knee mill"));
}

TEST_F(Catalog, QueryCanUseMetricsMotionsAndModules) {
  Fill();
  const auto names = [this](const std::string& where) {
    std::vector<std::string> out;
    const nlohmann::json found =
        Json({"catalog", "query", "machines.db", where, "--columns", "name"});
    for (const nlohmann::json& row : found["rows"]) out.push_back(row["name"]);
    return out;
  };
  EXPECT_THAT(names("id in (select layout_id from modules where module = 'lambda')"),
              ElementsAre(HasSubstr("water-jet")));
  EXPECT_THAT(names("id in (select layout_id from motions where axis = 'C_v')"),
              ElementsAre("Knee mill"));
  EXPECT_THAT(
      names("id in (select layout_id from metrics where name = 'mobility.drive' and value = 2)"),
      ElementsAre(HasSubstr("water-jet")));
  EXPECT_THAT(names("id in (select layout_id from parameters where name = 'drive.L1' and value = "
                    "1200 and unit = 'mm')"),
              ElementsAre(HasSubstr("water-jet")));
  EXPECT_THAT(names("plugins like '%org.kompono.lambda 0.1.0%'"),
              ElementsAre(HasSubstr("water-jet")));
}

TEST_F(Catalog, NothingFoundIsANegativeAnswerAndAWrongQueryUsage) {
  Fill();
  const Outcome nothing = Run({"catalog", "query", "machines.db", "drives > 99"});
  EXPECT_EQ(nothing.code, 1);
  EXPECT_THAT(nothing.err, HasSubstr("nothing found"));
  EXPECT_EQ(Json({"catalog", "query", "machines.db", "drives > 99"}, 1)["rows"].size(), 0U);
  const Outcome wrong = Run({"catalog", "query", "machines.db", "drivez > 99"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("[E0521]"));
  const Outcome evil = Run({"catalog", "query", "machines.db", "1); delete from layout; --"});
  EXPECT_EQ(evil.code, 2);
}

TEST_F(Catalog, ShowAndExportGiveBackWhatWasAdded) {
  Fill();
  const Outcome shown = Run({"catalog", "show", "machines.db", "Knee mill"});
  EXPECT_EQ(shown.code, 0) << shown.err;
  for (const char* word : {"part X Y Z O C_v tool", "singularity_margin", "org.kompono.units"})
    EXPECT_THAT(shown.out, HasSubstr(word));
  const nlohmann::json entry = Json({"catalog", "show", "machines.db", "Knee mill"});
  const std::string hash = entry["hash"];
  const Outcome exported = Run({"catalog", "export", "machines.db", hash.substr(0, 8)});
  EXPECT_EQ(exported.code, 0) << exported.err;
  EXPECT_EQ(exported.out, Shell("cat '" + mill_ + "'").out);
  EXPECT_EQ(Json({"catalog", "export", "machines.db", hash})["text"], exported.out);
  EXPECT_EQ(Run({"catalog", "export", "machines.db", "1", "-o", "out.toml"}).code, 0);
  EXPECT_EQ(Run({"check", "out.toml"}).code, 0);
  EXPECT_EQ(Run({"catalog", "export", "machines.db", "1", "-o", "out.toml"}).code, 5);
  const Outcome unknown = Run({"catalog", "show", "machines.db", "Lathe"});
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("[E0512]"));
}

TEST_F(Catalog, CalibrationsComeWithTheirReport) {
  ASSERT_EQ(
      Run({"measure", lambda_, "--set", "drive.L1=1200.8", "--sigma-mm", "0.004", "-o", "p.csv"})
          .code,
      0);
  ASSERT_EQ(Run({"calibrate", lambda_, "p.csv", "-o", "out.toml", "--report", "report.json"}).code,
            0);
  const Outcome plain = Run({"catalog", "add", "machines.db", "out.toml"});
  ASSERT_EQ(plain.code, 0) << plain.err;
  nlohmann::json entry = Json({"catalog", "show", "machines.db", "1"});
  EXPECT_THAT(entry.dump(), HasSubstr("p.csv"));

  const Outcome reported = Run({"catalog", "add", "all.db", "out.toml", "--report", "report.json"});
  ASSERT_EQ(reported.code, 0) << reported.err;
  const nlohmann::json found = Json({"catalog",
                                     "query",
                                     "all.db",
                                     "rms_after_um < 20",
                                     "--columns",
                                     "name, rms_before_um, rms_after_um"});
  ASSERT_EQ(found["rows"].size(), 1U);
  EXPECT_GT(found["rows"][0]["rms_before_um"].get<double>(), 100.0);
  EXPECT_EQ(Run({"catalog", "add", "all.db", "out.toml", lambda_, "--report", "report.json"}).code,
            2);
  Write("wrong.json", "{\"status\": 1}");
  EXPECT_EQ(Run({"catalog", "add", "all.db", "out.toml", "--report", "wrong.json"}).code, 3);
}

TEST_F(Catalog, MergeTakesLayoutsFromOthers) {
  ASSERT_EQ(Run({"catalog", "add", "one.db", lambda_}).code, 0);
  ASSERT_EQ(Run({"catalog", "add", "two.db", mill_, lambda_}).code, 0);
  const nlohmann::json merged = Json({"catalog", "merge", "all.db", "one.db", "two.db"})["merged"];
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_EQ(merged[0]["layouts_added"], 1);
  EXPECT_EQ(merged[1]["layouts_added"], 1);
  EXPECT_EQ(merged[1]["layouts_unchanged"], 1);
  EXPECT_THAT(Run({"catalog", "merge", "all.db", "one.db"}).out, HasSubstr("unchanged"));
  EXPECT_EQ(Run({"catalog", "merge", "all.db", "all.db"}).code, 2);
  EXPECT_EQ(Json({"catalog", "stats", "all.db"})["layouts"], 2);
  EXPECT_EQ(Run({"catalog", "verify", "all.db"}).code, 0);
}

TEST_F(Catalog, SearchFindsWords) {
  Fill();
  const nlohmann::json found = Json({"catalog", "search", "machines.db", "lambda water"})["found"];
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0]["kind"], "layout");
  EXPECT_THAT(Run({"catalog", "search", "machines.db", "mill*"}).out, HasSubstr("Knee mill"));
  EXPECT_EQ(Run({"catalog", "search", "machines.db", "zeppelin"}).code, 1);
  EXPECT_EQ(Run({"catalog", "search", "machines.db", "\" OR NEAR( --"}).code, 1);
  const Outcome none = Run({"catalog", "search", "machines.db", "();--"});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("[E0548]"));
}

TEST_F(Catalog, SimilarComparesStructures) {
  ASSERT_EQ(
      Run({"catalog", "add", "machines.db", mill_, lambda_, Machine("so_waterjet_gantry")}).code,
      0);
  const nlohmann::json similar =
      Json({"catalog", "similar", "machines.db", "Knee mill"})["similar"];
  ASSERT_EQ(similar.size(), 2U);
  EXPECT_GE(similar[0]["similarity"], similar[1]["similarity"]);
  EXPECT_EQ(
      Json({"catalog", "similar", "machines.db", "Knee mill", "--limit", "1"})["similar"].size(),
      1U);
  EXPECT_THAT(Run({"catalog", "similar", "machines.db", "Knee mill"}).out, HasSubstr("similarity"));
  EXPECT_EQ(Run({"catalog", "similar", "machines.db", "Lathe"}).code, 1);
}

TEST_F(Catalog, ExportWritesEverythingInAFixedOrder) {
  ASSERT_EQ(Run({"catalog", "add", "one.db", lambda_, mill_}).code, 0);
  ASSERT_EQ(Run({"catalog", "add", "two.db", mill_, lambda_}).code, 0);
  for (const char* name : {"one", "two"}) {
    const std::string db = std::string(name) + ".db";
    const Outcome json =
        Run({"catalog", "export", db, "--as", "json", "-o", std::string(name) + ".json"});
    EXPECT_EQ(json.code, 0) << json.err;
    const nlohmann::json csv = Json({"catalog", "export", db, "--as", "csv", "-o", name});
    EXPECT_EQ(csv["layouts"], 2);
  }
  EXPECT_EQ(Shell("cmp one.json two.json").code, 0);
  EXPECT_EQ(Shell("diff -r one two").code, 0);
  EXPECT_EQ(Json({"catalog", "export", "one.db", "--as", "toml", "-o", "files"})["files"], 2);
  EXPECT_EQ(Run({"catalog", "add", "again.db", "--", "one.json"}).code, 3);
  EXPECT_EQ(Run({"catalog", "export", "one.db", "--as", "json", "-o", "one.json"}).code, 5);
  EXPECT_EQ(Run({"catalog", "export", "one.db", "--as", "csv", "-o", "one"}).code, 5);
  EXPECT_EQ(Run({"catalog", "export", "one.db", "--as", "csv"}).code, 2);
  EXPECT_EQ(Run({"catalog", "export", "one.db"}).code, 2);
  EXPECT_EQ(Run({"catalog", "export", "one.db", "1", "--as", "csv", "-o", "x"}).code, 2);
}

TEST_F(Catalog, QueryAsksForMetricsByName) {
  Fill();
  const nlohmann::json found = Json({"catalog",
                                     "query",
                                     "machines.db",
                                     "metric.\"mobility.drive\" = 2",
                                     "--columns",
                                     "name, metric.singularity_margin as margin"});
  ASSERT_EQ(found["rows"].size(), 1U);
  EXPECT_GT(found["rows"][0]["margin"], 0.0);
  const Outcome wrong = Run({"catalog", "query", "machines.db", "metric.singularity > 1"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("[E0543]"));
}

TEST_F(Catalog, StatsAndVerify) {
  Fill();
  const Outcome stats = Run({"catalog", "stats", "machines.db"});
  EXPECT_EQ(stats.code, 0);
  EXPECT_THAT(stats.out, HasSubstr("layouts"));
  EXPECT_THAT(stats.out, HasSubstr("lambda"));
  const Outcome verify = Run({"catalog", "verify", "machines.db"});
  EXPECT_EQ(verify.out, "machines.db: 2 layouts, 0 calibrations, ok\n");
  EXPECT_EQ(Json({"catalog", "verify", "machines.db"})["ok"], true);
  EXPECT_EQ(Run({"catalog", "stats", "nowhere.db"}).code, 5);
  Write("text.db", "this is no database at all, only some text that is long enough to be one\n");
  EXPECT_EQ(Run({"catalog", "stats", "text.db"}).code, 3);
}

}  // namespace
}  // namespace kompono::cli_test
