// SPDX-License-Identifier: Apache-2.0
// kompono synthesize: running a study, shards, the catalog, what it says of the shipped studies.
#include "program.hpp"

#include <algorithm>
#include <string>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;

class SynthesizeRun : public Program {
 protected:
  static std::string Study(const std::string& name) {
    return Source("layouts/studies/" + name + ".toml");
  }
  /// Everything that the catalog holds, in its fixed order.
  std::string Everything(const std::string& db) {
    const std::string file = std::string(db).append(".json");
    const Outcome outcome = Run({"catalog", "export", db, "--as", "json", "--out", file});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Read(file);
  }
};

TEST_F(SynthesizeRun, TellsStagesFrontAndReference) {
  const Outcome outcome = Run({"synthesize", Study("pyramid_or_delta")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Pyramid, delta or plain axes: 12 candidates"));
  EXPECT_THAT(outcome.out, HasSubstr("12 evaluated now"));
  EXPECT_THAT(outcome.out, HasSubstr("<- knee"));
  EXPECT_THAT(outcome.out, HasSubstr("reference: part O (XYZ):delta tool"));
}

TEST_F(SynthesizeRun, FindsTheOpenBaseWaterJetOfSoOnItsFront) {
  const auto json = Json({"synthesize", Study("so_waterjet")});
  EXPECT_EQ(json["candidates"], "122");
  EXPECT_EQ(json["evaluated"], 122);
  EXPECT_EQ(json["reference"]["formula"], "part_xy (XY):drive O|O Z P_z");
  EXPECT_GT(json["reference"]["on_front"], 0);
  const auto& front = json["front"];
  EXPECT_TRUE(std::any_of(front.begin(), front.end(), [](const auto& row) {
    return row["formula"] == "part_xy (XY):drive O|O Z P_z";
  }));
  std::uint64_t rejected = 0;
  for (const auto& stage : json["stages"]) rejected += stage["rejected"].get<std::uint64_t>();
  EXPECT_EQ(json["ok"].get<std::uint64_t>() + rejected, 122U) << "nothing failed";
}

TEST_F(SynthesizeRun, ThinsTheFrontAndKeepsItsEndsAndKnee) {
  const auto whole = Json({"synthesize", Study("so_waterjet")});
  const auto thin = Json({"synthesize", Study("so_waterjet"), "--epsilon", "0.2"});
  EXPECT_EQ(whole["front_size"], whole["front"].size());
  EXPECT_EQ(thin["front_size"], whole["front"].size());
  EXPECT_EQ(thin["epsilon"], 0.2);
  EXPECT_LT(thin["front"].size(), whole["front"].size() / 2);
  for (const auto& row : whole["front"]) {
    const bool marked = row.value("knee", false) || row.contains("best_in");
    const bool kept =
        std::any_of(thin["front"].begin(), thin["front"].end(), [&row](const auto& other) {
          return other["index"] == row["index"];
        });
    EXPECT_TRUE(kept || !marked) << row["index"];
  }
  const Outcome text = Run({"synthesize", Study("so_waterjet"), "--epsilon", "0.2"});
  EXPECT_THAT(text.out,
              HasSubstr(", one for each box of 0.2 of its extent, ends and knee besides"));
  EXPECT_EQ(Run({"synthesize", Study("so_waterjet"), "--epsilon", "2"}).code, 2);
}

TEST_F(SynthesizeRun, AnUnknownTagOfAOneTermRuleIsNamedOnce) {
  Write("study.toml",
        Read(Study("pyramid_or_delta")) +
            "\n[[rule]]\nname = \"nonsense\"\nkind = \"empirical\"\nreason = \"none\"\nauthor = "
            "\"test\"\nforbid = [\"no-such-tag\"]\n");
  const Outcome outcome = Run({"check", "study.toml"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "study.toml: 1 error\n") << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no alternative has the tag 'no-such-tag'"));
}

TEST_F(SynthesizeRun, SaysWhatBeatsTheReference) {
  const auto json = Json({"synthesize", Study("kdd_lathes")});
  const auto& reference = json["reference"];
  EXPECT_EQ(reference["on_front"], 0);
  EXPECT_GE(reference["dominators"], 1);
  bool better = false;
  for (const auto& [metric, by] : reference["better_by"].items()) {
    EXPECT_GE(by.get<double>(), 0.0) << metric;
    better = better || by.get<double>() > 0.0;
  }
  EXPECT_TRUE(better);
}

TEST_F(SynthesizeRun, FourShardsMergedAreOneRun) {
  const std::string study = Study("pyramid_or_delta");
  EXPECT_EQ(Run({"synthesize", study, "--catalog", "whole.db"}).code, 0);
  std::vector<std::string> merge{"catalog", "merge", "merged.db"};
  for (const char* k : {"3", "1", "4", "2"}) {
    const std::string db = std::string("shard").append(k).append(".db");
    const Outcome shard = Run({"synthesize",
                               study,
                               "--catalog",
                               db,
                               "--shard",
                               std::string(k).append("/4"),
                               "--threads",
                               k});
    EXPECT_LE(shard.code, 1) << shard.err;
    merge.push_back(db);
  }
  EXPECT_EQ(Run(merge).code, 0);
  const std::string whole = Everything("whole.db");
  EXPECT_THAT(whole, HasSubstr("(XYZ):delta"));
  EXPECT_EQ(Everything("merged.db"), whole);
}

TEST_F(SynthesizeRun, ResumesWithWhatIsMissing) {
  const std::string study = Study("pyramid_or_delta");
  EXPECT_THAT(Run({"synthesize", study, "--catalog", "s.db", "--limit", "5"}).out,
              HasSubstr("5 evaluated now"));
  EXPECT_THAT(Run({"synthesize", study, "--catalog", "s.db"}).out,
              HasSubstr("7 evaluated now, 5 done before"));
  const Outcome third = Run({"synthesize", study, "--catalog", "s.db"});
  EXPECT_EQ(third.code, 0);
  EXPECT_THAT(third.out, HasSubstr("0 evaluated now, 12 done before"));
  EXPECT_EQ(Run({"synthesize", study, "--catalog", "w.db"}).code, 0);
  EXPECT_EQ(Everything("s.db"), Everything("w.db"));
  // The rows that were kept say the same as those that were just computed.
  const auto kept = Json({"synthesize", study, "--catalog", "s.db"});
  const auto fresh = Json({"synthesize", study});
  EXPECT_EQ(kept["front"], fresh["front"]);
  EXPECT_EQ(kept["stages"], fresh["stages"]);
}

TEST_F(SynthesizeRun, RefusesWrongShardsMetricsAndSettings) {
  const Outcome shard = Run({"synthesize", Study("kdd_lathes"), "--shard", "5/4"});
  EXPECT_EQ(shard.code, 2);
  EXPECT_THAT(shard.err, HasSubstr("'5/4' is no shard [E0845]"));
  Write("bad.toml",
        "kompono = 1\nstudy = \"s\"\n[motions.X]\nrange = [0, 1]\n[objectives]\n"
        "stifness = \"max\"\n");
  const Outcome metric = Run({"synthesize", "bad.toml"});
  EXPECT_EQ(metric.code, 3);
  EXPECT_THAT(metric.err, HasSubstr("did you mean 'stiffness'?"));
  Write("worse.toml",
        "kompono = 1\nstudy = \"s\"\n[motions.X]\nrange = [0, 1]\n[evaluation]\npose = 5\n");
  const Outcome setting = Run({"synthesize", "worse.toml"});
  EXPECT_EQ(setting.code, 3);
  EXPECT_THAT(setting.err, HasSubstr("worse.toml:6:1: error: unknown key 'pose' in [evaluation]"));
}

}  // namespace
}  // namespace kompono::cli_test
