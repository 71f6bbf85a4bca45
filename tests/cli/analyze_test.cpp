// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Analyze : public Program {
 protected:
  void SetUp() override {
    Write("glides.toml",
          "kompono = 1\nname = 'Glides'\nformula = 'part O (XY):glides tool'\n"
          "[block.glides]\nmodule = 'biglide'\nparameters = { L1 = 400, L2 = 350, width = 0 }\n"
          "home = { X = 0, Y = 200 }\nrange = { X = [-100, 100] }\n");
    Write("delta.toml",
          "kompono = 1\nname = 'Delta'\nformula = 'part O (XYZ):delta tool'\n"
          "[block.delta]\nmodule = 'linear_delta'\n"
          "parameters = { radius = 130, azimuth = [90, 210, 330], strut = 270 }\n"
          "[block.delta.drive.q1]\nrange = [100, 400]\n[block.delta.drive.q2]\nrange = [100, 400]\n"
          "[block.delta.drive.q3]\nrange = [100, 400]\n");
  }
};

TEST_F(Analyze, WithoutOptionsTellsZoneDexterityAndTheInnerSingularity) {
  const Outcome outcome = Run({"analyze", "glides.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word : {"work zone over glides.X, glides.Y",
                           "area",
                           "±",
                           "largest rectangle",
                           "largest disc",
                           "its boundary is made of",
                           "glides.q2 out of reach",
                           "glides singular (type 2)",
                           "dexterity of glides",
                           "workspace utilisation",
                           "type 2 within reach and ranges: det A changes its sign",
                           "glides.Y 0.0, 200.0 mm away",
                           "home is 150.0 mm from type 1 of glides, where glides.q2 ends"})
    EXPECT_THAT(outcome.out, HasSubstr(word)) << outcome.out;
}

TEST_F(Analyze, JsonHasTheAreaBetweenItsBounds) {
  // 0 < Y < 350 on home's side, X from -100 to 100.
  const nlohmann::json all = Json({"analyze", "glides.toml", "--tolerance", "0.1"});
  EXPECT_NEAR(
      all["zone"]["content"].get<double>(), 200.0 * 350.0, all["zone"]["bound"].get<double>());
  EXPECT_LT(all["zone"]["bound"].get<double>(), 0.001 * 200.0 * 350.0 * 1.01);
  EXPECT_TRUE(all["singularities"]["type_2"]["crossed"].get<bool>());
  EXPECT_NEAR(
      all["singularities"]["type_2"]["coordinates"]["glides.Y"]["from"].get<double>(), 0, 5);
  EXPECT_EQ(all["dexterity"][0]["block"], "glides");
  EXPECT_GE(all["dexterity"][0]["best"]["condition"].get<double>(), 1.0);
  EXPECT_EQ(all["dexterity"][0]["home"]["ellipsoid"].size(), 2U);
  const nlohmann::json both =
      Json({"analyze", "glides.toml", "--zone", "--any-side", "--tolerance", "0.1"});
  EXPECT_NEAR(
      both["zone"]["content"].get<double>(), 200.0 * 700.0, both["zone"]["bound"].get<double>());
}

TEST_F(Analyze, ABoxFitsOrNotAndTheStatusSaysSo) {
  EXPECT_EQ(Run({"analyze", "glides.toml", "--box", "190x300"}).code, 0);
  const Outcome outcome = Run({"analyze", "glides.toml", "--box", "210x300"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("210 x 300 does not fit"));
}

TEST_F(Analyze, APathIsSingularBetweenItsSamples) {
  Write("path.csv", "glides.X,glides.Y\n0,200\n10,100\n20,-100\n");
  const Outcome outcome = Run({"analyze", "glides.toml", "--path", "path.csv"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("type 2 of glides, crossed at sample 2.5: glides.X 15"));
  Write("good.csv", "x,y\n0,200\n10,100\n20,20\n");
  const Outcome good = Run({"analyze", "glides.toml", "--path", "good.csv"});
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("regular from end to end, between the samples too: proven"));
}

TEST_F(Analyze, WritesSurfaceTableAndPicture) {
  const Outcome outcome = Run({"analyze",
                               "delta.toml",
                               "--tolerance",
                               "5",
                               "--ply",
                               "zone.ply",
                               "--csv",
                               "zone.csv",
                               "--svg",
                               "zone.svg"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(Read("zone.ply"), testing::StartsWith("ply\nformat ascii 1.0\ncomment Delta\n"));
  EXPECT_THAT(Read("zone.csv"), testing::StartsWith("delta.X_from_mm,delta.X_to_mm,"));
  EXPECT_THAT(Read("zone.svg"), HasSubstr("class='zone'"));
  EXPECT_EQ(Run({"analyze", "delta.toml", "--ply", "zone.ply"}).code, 5) << "files are kept";
  EXPECT_EQ(Run({"analyze", "glides.toml", "--ply", "flat.ply"}).code, 2);
}

TEST_F(Analyze, SlicesHaveAreas) {
  const nlohmann::json all =
      Json({"analyze", "delta.toml", "--slice", "Z=60,Z=120", "--tolerance", "1"});
  ASSERT_EQ(all["slices"].size(), 2U);
  for (const nlohmann::json& slice : all["slices"]) {
    EXPECT_GT(slice["content"].get<double>(), 1000.0);
    EXPECT_LE(slice["bound"].get<double>(), 0.0101 * slice["content"].get<double>());
  }
}

TEST_F(Analyze, GeometryAndTheWayOfAPointOnALink) {
  const nlohmann::json all = Json({"analyze",
                                   "glides.toml",
                                   "--geometry",
                                   "--at",
                                   "X=0,Y=175",
                                   "--point",
                                   "glides.carriage2:glides.joint2:0.5"});
  const nlohmann::json& strut = all["geometry"]["struts"][1];
  EXPECT_NEAR(strut["length_mm"].get<double>(), 350.0, 1e-9);
  EXPECT_NEAR(strut["nutation_deg"].get<double>(), 90.0, 1e-9);
  EXPECT_NEAR(strut["precession_deg"].get<double>(), 150.0, 1e-9) << "sin 30 = 175/350";
  EXPECT_NEAR(all["point_mm"][0][1].get<double>(), 87.5, 1e-9);
}

TEST_F(Analyze, ComplainsWithAWayOut) {
  const auto complaint = [this](std::vector<std::string> more, int code, const char* word) {
    std::vector<std::string> arguments{"analyze", "glides.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(word));
  };
  complaint({"--over", "X,Q"}, 2, "E0604");
  complaint({"--region", "Y=5"}, 2, "E06");
  complaint({"--box", "200xbig"}, 2, "--box '200xbig' is no list of sizes");
  complaint({"--joint", "glides.joint9=30"}, 2, "E0721");
  complaint({"--point", "glides.join1"}, 2, "glides.joint1");
  Write("path.csv", "x,w\n1,2\n3,4\n");
  complaint({"--path", "path.csv"}, 3, "'w' is neither a pose component nor a coordinate");
}

TEST_F(Analyze, MachineWithoutMechanismsIsABox) {
  const nlohmann::json mill = Json({"analyze", Machine("knee_mill")});
  EXPECT_NEAR(mill["zone"]["content"].get<double>(), 800.0 * 400.0 * 400.0, 1.0);
  EXPECT_FALSE(mill["singularities"]["type_2"]["possible"].get<bool>());
}

TEST_F(Analyze, CommandsOfTheDocumentWork) {
  std::filesystem::create_directory_symlink(Source("layouts"), folder() / "work/layouts");
  Write("poses.csv", "x,y\n0,200\n10,210\n");
  std::ifstream in(Source("docs/analysis.md"));
  std::string line;
  int run = 0;
  while (std::getline(in, line)) {
    if (line.rfind("kompono analyze ", 0) != 0) continue;
    const Outcome outcome = Shell("\"$K\" " + line.substr(8) + " --tolerance 5");
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << line << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("error"))) << line;
    ++run;
  }
  EXPECT_GE(run, 6);
}

}  // namespace
}  // namespace kompono::cli_test
