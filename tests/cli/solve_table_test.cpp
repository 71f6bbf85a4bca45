// SPDX-License-Identifier: Apache-2.0
// kompono solve --poses and --drives-file.
#include "program.hpp"

#include <cmath>
#include <cstdlib>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;

class SolveTable : public Program {
 protected:
  const std::string lambda_ = Machine("so_waterjet_lambda");
  static double Number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }
};

TEST_F(SolveTable, EveryRowIsWhatASingleSolveGives) {
  Write("path.csv", "# a path\nx,y,z\n0,0,1\n\n-120,45,12.5\n200,-30,0\n");
  const Outcome outcome = Run({"solve", lambda_, "--poses", "path.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto rows = Csv(outcome.out);
  ASSERT_EQ(rows.size(), 3U);
  const nlohmann::json single = Json({"solve", lambda_, "--pose", "X=-120,Y=45,Z=12.5"});
  EXPECT_EQ(rows[1].at("row"), "2");
  EXPECT_EQ(rows[1].at("status"), "converged");
  EXPECT_EQ(Number(rows[1].at("drive.q1_mm")), single["drives"]["drive.q1"].get<double>());
  EXPECT_EQ(Number(rows[1].at("drive.q2_mm")), single["drives"]["drive.q2"].get<double>());
  EXPECT_EQ(Number(rows[1].at("singularity_margin")),
            single["singularity"]["margin"].get<double>());
}

TEST_F(SolveTable, DrivesFileTakesPosesBack) {
  Write("path.csv", "X_mm,Y_mm,Z_mm\n10,20,30\n-250,60.5,7\n");
  const auto there = Csv(Run({"solve", lambda_, "--poses", "path.csv"}).out);
  ASSERT_EQ(there.size(), 2U);
  std::string drives = "q1,drive.q2_mm,Z\n";
  for (const auto& row : there)
    drives += row.at("drive.q1_mm") + "," + row.at("drive.q2_mm") + "," + row.at("Z_mm") + "\n";
  Write("drives.csv", drives);
  const Outcome outcome = Run({"solve", lambda_, "--drives-file", "drives.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto back = Csv(outcome.out);
  ASSERT_EQ(back.size(), 2U);
  EXPECT_NEAR(Number(back[0].at("x_mm")), 10.0, 1e-9);
  EXPECT_NEAR(Number(back[1].at("x_mm")), -250.0, 1e-9);
  EXPECT_NEAR(Number(back[1].at("y_mm")), 60.5, 1e-9);
}

TEST_F(SolveTable, BadRowsKeepTheirPlaceAndTheWorstDecidesTheExitCode) {
  Write("path.csv", "x,y\n0,0\n0,-700\n900,0\n");
  const Outcome outcome = Run({"solve", lambda_, "--poses", "path.csv"});
  EXPECT_EQ(outcome.code, 1);
  const auto rows = Csv(outcome.out);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].at("status"), "converged");
  EXPECT_EQ(rows[1].at("status"), "out of reach");
  EXPECT_EQ(rows[1].at("drive.q1_mm"), "");
  EXPECT_EQ(rows[2].at("status"), "outside limits");
  EXPECT_THAT(rows[2].at("message"), HasSubstr("limit"));
  EXPECT_THAT(outcome.err, HasSubstr("2 of 3 rows"));
  Write("path.csv", "x,y\n0,-700\n0,-600\n");
  EXPECT_EQ(Run({"solve", lambda_, "--poses", "path.csv"}).code, 4);
}

TEST_F(SolveTable, JsonHasARowForEveryRow) {
  Write("path.csv", "x,y\n0,0\n0,-700\n");
  const nlohmann::json document = Json({"solve", lambda_, "--poses", "path.csv"}, 1);
  ASSERT_EQ(document["rows"].size(), 2U);
  EXPECT_EQ(document["rows"][0]["row"], 1);
  EXPECT_EQ(document["rows"][1]["status"], "out of reach");
  EXPECT_TRUE(document["rows"][1]["drives"]["drive.q1"].is_null());
  EXPECT_EQ(document["failed"], 1);
}

TEST_F(SolveTable, AnglesAreInDegrees) {
  const std::string machine = Machine("hexapod_reference");
  const nlohmann::json home = Json({"describe", machine})["home"]["pose"];
  const std::string z = home["Z"].dump();
  Write("path.csv", "z,a,b_deg,c\n" + z + ",5,-3,8\n");
  const auto rows = Csv(Run({"solve", machine, "--poses", "path.csv"}).out);
  ASSERT_EQ(rows.size(), 1U);
  const nlohmann::json single = Json({"solve", machine, "--pose", "Z=" + z + ",A=5,B=-3,C=8"});
  for (const auto& [name, value] : single["drives"].items())
    EXPECT_EQ(Number(rows[0].at(name + "_mm")), value.get<double>()) << name;
}

TEST_F(SolveTable, WrongTablesAreRefusedWithEveryFault) {
  Write("bad.csv", "x,q\n1,2\n");
  const Outcome heading = Run({"solve", lambda_, "--poses", "bad.csv"});
  EXPECT_EQ(heading.code, 3);
  EXPECT_EQ(heading.out, "");
  EXPECT_THAT(heading.err, HasSubstr("bad.csv:1:3: error: column 'q' is unknown [E0610]"));
  Write("bad.csv", "x,y\n1\n2,two\n3,4,5\n");
  const Outcome rows = Run({"solve", lambda_, "--poses", "bad.csv"});
  EXPECT_EQ(rows.code, 3);
  EXPECT_THAT(rows.err, HasSubstr("bad.csv:2:1: error: 1 field where the heading has 2"));
  EXPECT_THAT(rows.err, HasSubstr("bad.csv:3:3: error: 'two' is no number"));
  EXPECT_THAT(rows.err, HasSubstr("bad.csv:4:1: error: 3 fields"));
  Write("bad.csv", "q1,q2\n1,2\n");
  EXPECT_THAT(Run({"solve", lambda_, "--drives-file", "bad.csv"}).err,
              HasSubstr("no column for Z"));
  EXPECT_EQ(Run({"solve", lambda_, "--poses", "nowhere.csv"}).code, 5);
  Write("bad.csv", "");
  EXPECT_EQ(Run({"solve", lambda_, "--poses", "bad.csv"}).code, 3);
}

}  // namespace
}  // namespace kompono::cli_test
