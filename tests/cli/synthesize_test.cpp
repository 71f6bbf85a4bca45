// SPDX-License-Identifier: Apache-2.0
// kompono synthesize: the space of a study.
#include "program.hpp"

#include <string>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;

class Synthesize : public Program {
 protected:
  static std::string Study(const std::string& name) {
    return Source("layouts/studies/" + name + ".toml");
  }
};

TEST_F(Synthesize, CountsTheLayoutsOfAStudy) {
  const Outcome text = Run({"synthesize", Study("five_axis_milling"), "--count"});
  EXPECT_EQ(text.code, 0);
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, HasSubstr("layouts     40\n"));
  EXPECT_EQ(Json({"synthesize", Study("five_axis_milling"), "--count"})["count"], "40");
}

TEST_F(Synthesize, AnswersWhatIf) {
  const auto count = [this](std::vector<std::string> more) {
    more.insert(more.begin(), {"synthesize", Study("five_axis_milling"), "--count"});
    return Json(more)["count"].get<std::string>();
  };
  EXPECT_EQ(count({"--without", "C on the part under a head that tilts"}), "48");
  EXPECT_EQ(count({"--formula", "part C A Y O X Z tool"}), "1");
  EXPECT_EQ(count({"--fix", "p1=O", "--fix", "p6=A.tool"}), "1");
}

TEST_F(Synthesize, ListsLayoutsFromAnyIndex) {
  const auto all = Json({"synthesize", Study("so_waterjet"), "--list", "200"});
  const auto some = Json({"synthesize", Study("so_waterjet"), "--list", "3", "--from", "5"});
  EXPECT_EQ(all["layouts"].size(), 122U);
  ASSERT_EQ(some["layouts"].size(), 3U);
  EXPECT_EQ(some["layouts"][0], all["layouts"][5]);
}

TEST_F(Synthesize, PrintsLayoutFilesThatOtherCommandsRead) {
  const Outcome layout = Run({"synthesize",
                              Study("so_waterjet"),
                              "--formula",
                              "part_xy (XY):drive O|O Z P_z",
                              "--layout",
                              "0"});
  ASSERT_EQ(layout.code, 0) << layout.err;
  Write("layout.toml", layout.out);
  const Outcome check = Run({"check", "layout.toml"});
  EXPECT_EQ(check.code, 0) << check.err;
}

TEST_F(Synthesize, ExplainsWhatTheRulesKeepOut) {
  const auto json = Json({"synthesize", Study("five_axis_milling"), "--explain"});
  EXPECT_EQ(json["structural"], "384");
  EXPECT_EQ(json["count"], "40");
  EXPECT_EQ(json["rules"].size(), 3U) << "the fourth is off";
  EXPECT_EQ(json["pairs"][0]["gained"], "8");
}

TEST_F(Synthesize, RefusesWhatTheStudyDoesNotHave) {
  const Outcome feature = Run({"synthesize", Study("so_waterjet"), "--fix", "bse=open"});
  EXPECT_EQ(feature.code, 2);
  EXPECT_THAT(feature.err, HasSubstr("did you mean 'base'?"));
  const Outcome rule = Run({"synthesize", Study("so_waterjet"), "--without", "gravity"});
  EXPECT_EQ(rule.code, 2);
  const Outcome index = Run({"synthesize", Study("so_waterjet"), "--layout", "122"});
  EXPECT_EQ(index.code, 2);
  EXPECT_THAT(index.err, HasSubstr("there are 122"));
  EXPECT_EQ(Run({"synthesize", "nothing.toml"}).code, 5);
}

TEST_F(Synthesize, StudiesAreCheckedLikeLayouts) {
  const Outcome good = Run({"check", Study("so_waterjet")});
  EXPECT_EQ(good.code, 0) << good.err;
  Write("bad.toml", "kompono = 1\nstudy = \"s\"\n[motions.X]\nrange = [1, 0]\n");
  const Outcome bad = Run({"check", "bad.toml"});
  EXPECT_EQ(bad.code, 1);
  EXPECT_THAT(bad.err, HasSubstr("bad.toml:4:9: error"));
  EXPECT_THAT(Run({"schema", "study"}).out, HasSubstr("kompono study"));
}

}  // namespace
}  // namespace kompono::cli_test
