// SPDX-License-Identifier: Apache-2.0
// kompono solve against formulas written down here once more.
#include "program.hpp"

#include <cmath>

namespace kompono::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kL1 = 1200.0, kL2 = 820.0, kL3 = 600.0;

/// SO's lambda: slider 1, link of L1 to the tool point; slider 2, link of L2 to the joint at L3.
struct Sliders {
  double q1 = 0.0, q2 = 0.0;
};
Sliders Lambda(double x, double y) {
  const double q1 = x - std::sqrt(kL1 * kL1 - y * y);
  const double joint_x = q1 + kL3 / kL1 * (x - q1);
  const double joint_y = kL3 / kL1 * y;
  return {.q1 = q1, .q2 = joint_x + std::sqrt(kL2 * kL2 - joint_y * joint_y)};
}

class Solve : public Program {
 protected:
  const std::string lambda_ = Machine("so_waterjet_lambda");
  const std::string mill_ = Machine("knee_mill");
};

TEST_F(Solve, InverseOfTheLambdaMachine) {
  // The mechanism moves the sheet: the jet stands at 500 - X, 600 - Y of it.
  const double x = 620.0;
  const double y = 555.0;
  const nlohmann::json solved = Json({"solve", lambda_, "--pose", "X=-120,Y=45,Z=12.5"});
  const Sliders sliders = Lambda(x, y);
  EXPECT_NEAR(solved["drives"]["drive.q1"].get<double>(), sliders.q1, 1e-9);
  EXPECT_NEAR(solved["drives"]["drive.q2"].get<double>(), sliders.q2, 1e-9);
  EXPECT_NEAR(solved["drives"]["Z"].get<double>(), 12.5, 1e-9);
  EXPECT_NEAR(solved["coordinates"]["drive.X"].get<double>(), x, 1e-9);
  EXPECT_NEAR(solved["coordinates"]["drive.Y"].get<double>(), y, 1e-9);
  EXPECT_NEAR(solved["pose"]["X"].get<double>(), -120.0, 1e-9);
  EXPECT_EQ(solved["status"], "converged");
  EXPECT_EQ(solved["message"], "");
  EXPECT_EQ(solved["singularity"]["type"], 0);
  EXPECT_EQ(solved["singularity"]["mechanisms"][0]["block"], "drive");
}

TEST_F(Solve, JsonHasTheMembersPromised) {
  const nlohmann::json solved = Json({"solve", lambda_, "--pose", "X=0,Y=0,Z=0"});
  std::vector<std::string> members;
  for (const auto& [name, value] : solved.items()) members.push_back(name);
  for (const char* member : {"pose",
                             "coordinates",
                             "drives",
                             "jacobian",
                             "jacobian_rows",
                             "jacobian_columns",
                             "singularity",
                             "status",
                             "message",
                             "iterations",
                             "residual_mm",
                             "struts"})
    EXPECT_THAT(members, testing::Contains(member));
}

TEST_F(Solve, JacobianOfTheLambdaMachine) {
  const nlohmann::json solved = Json({"solve", lambda_, "--pose", "X=0,Y=0,Z=0"});
  EXPECT_EQ(solved["jacobian_rows"], nlohmann::json({"drive.q1", "drive.q2", "Z"}));
  EXPECT_EQ(solved["jacobian_columns"], nlohmann::json({"X", "Y", "Z"}));
  const double step = 1e-3;
  const Sliders up = Lambda(500.0, 600.0 - step);
  const Sliders down = Lambda(500.0, 600.0 + step);
  const auto entry = [&solved](int i, int j) { return solved["jacobian"][i][j].get<double>(); };
  EXPECT_NEAR(entry(0, 0), -1.0, 1e-12);
  EXPECT_NEAR(entry(1, 0), -1.0, 1e-12);
  EXPECT_NEAR(entry(0, 1), (up.q1 - down.q1) / (2 * step), 1e-8);
  EXPECT_NEAR(entry(1, 1), (up.q2 - down.q2) / (2 * step), 1e-8);
  EXPECT_NEAR(entry(2, 2), 1.0, 1e-12);
  EXPECT_NEAR(entry(2, 0), 0.0, 1e-12);
}

TEST_F(Solve, StrutsHaveTheirLengths) {
  const nlohmann::json solved = Json({"solve", lambda_, "--pose", "X=33,Y=-44,Z=5"});
  ASSERT_EQ(solved["struts"].size(), 2U);
  EXPECT_EQ(solved["struts"][0]["from"], "drive.slider1");
  EXPECT_NEAR(solved["struts"][0]["length_mm"].get<double>(), kL1, 1e-9);
  EXPECT_NEAR(solved["struts"][1]["length_mm"].get<double>(), kL2, 1e-9);
}

TEST_F(Solve, ForwardUndoesInverseToTheLastDigits) {
  const nlohmann::json there = Json({"solve", lambda_, "--pose", "X=81.25,Y=-13.5,Z=42"});
  std::string drives;
  for (const auto& [name, value] : there["drives"].items())
    drives += (drives.empty() ? "" : ",") + name + "=" + value.dump();
  const nlohmann::json back = Json({"solve", lambda_, "--drives", drives});
  EXPECT_NEAR(back["pose"]["X"].get<double>(), 81.25, 1e-9);
  EXPECT_NEAR(back["pose"]["Y"].get<double>(), -13.5, 1e-9);
  EXPECT_NEAR(back["pose"]["Z"].get<double>(), 42.0, 1e-9);
}

TEST_F(Solve, ShortDriveNamesAndSeveralUsesAreTheSame) {
  const Outcome full =
      Run({"solve", lambda_, "--drives", "drive.q1=-500,drive.q2=780,Z=3", "--json"});
  const Outcome brief =
      Run({"solve", lambda_, "--drives", "q1=-500,q2=780", "--drives", "z=3", "--json"});
  EXPECT_EQ(full.code, 0) << full.out;
  EXPECT_EQ(full.out, brief.out);
}

TEST_F(Solve, TableOnThePlainMill) {
  // Table X 10, Y 20, Z 100 under a tool point at 450 - 100 mm.
  const nlohmann::json solved = Json({"solve", mill_, "--drives", "X=10,Y=20,Z=100"});
  EXPECT_NEAR(solved["pose"]["X"].get<double>(), -10.0, 1e-12);
  EXPECT_NEAR(solved["pose"]["Y"].get<double>(), -20.0, 1e-12);
  EXPECT_NEAR(solved["pose"]["Z"].get<double>(), 250.0, 1e-9);
  EXPECT_EQ(solved["jacobian_columns"], nlohmann::json({"X", "Y", "Z"}));
  EXPECT_EQ(solved["singularity"]["margin"], 1.0);
  EXPECT_EQ(solved["struts"].size(), 0U);
}

TEST_F(Solve, TextShowsTablesForPeople) {
  const Outcome outcome = Run({"solve", lambda_, "--pose", "X=0,Y=0,Z=10"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* word : {"tool pose in the workpiece, Rx(A) Ry(B) Rz(C)",
                           "drive.q1",
                           "-539.230485",
                           "-1300 .. 500 mm",
                           "Jacobian",
                           "d/dX",
                           "margin",
                           "1200.000000",
                           "converged"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
}

TEST_F(Solve, OutsideADrivesLimitsIsANegativeAnswerWithAllNumbers) {
  const Outcome text = Run({"solve", mill_, "--pose", "X=500,Y=0,Z=300"});
  EXPECT_EQ(text.code, 1);
  EXPECT_THAT(text.out, HasSubstr("outside"));
  EXPECT_THAT(text.err, HasSubstr("drive X at -500.000000 mm lies below its limit -400 mm"));
  const nlohmann::json solved = Json({"solve", mill_, "--pose", "X=500,Y=0,Z=300"}, 1);
  EXPECT_EQ(solved["status"], "outside limits");
  EXPECT_NEAR(solved["drives"]["X"].get<double>(), -500.0, 1e-9);
  EXPECT_EQ(solved["limits"].size(), 1U);
}

TEST_F(Solve, OutsideTheSwingOfAJointIsANegativeAnswerToo) {
  Write("pods.toml", R"(
kompono = 1
formula = "part O (XYZ):pods tool"
[block.pods]
module = "tripod"
parameters = { foot = [[0, 0, 0], [500, 0, 0], [0, 500, 0]] }
home = { X = 0, Y = 0, Z = 400 }
swing = { "foot*" = 30 }
strut_diameter = 60
)");
  const nlohmann::json solved = Json({"solve", "pods.toml", "--pose", "X=400,Y=0,Z=400"}, 1);
  EXPECT_EQ(solved["status"], "outside limits");
  EXPECT_EQ(solved["limits"][0],
            "swing of pods.foot1 by 45.000000 deg lies above its limit 30 deg");
  EXPECT_EQ(Json({"solve", "pods.toml", "--pose", "X=0,Y=0,Z=400"}, 0)["limits"].size(), 0U);
}

TEST_F(Solve, ASwingThatCannotBeJudgedIsSaidAndNotDropped) {
  Write("lambda.toml", R"(
kompono = 1
formula = "part O (XY):drive tool"
[block.drive]
module = "lambda"
parameters = { L1 = 1200, L2 = 820, L3 = 600 }
home = { X = 0, Y = 600 }
swing = { "joint" = 30 }
)");
  const nlohmann::json solved = Json({"solve", "lambda.toml", "--pose", "X=0,Y=600"}, 1);
  EXPECT_EQ(solved["limits"][0],
            "no strut has a joint 'drive.joint' on base, carriage or platform");
}

TEST_F(Solve, OutOfReachIsANegativeAnswerWithoutNumbers) {
  // Y = 1300 mm is farther from the rail than link 1 is long.
  const nlohmann::json solved = Json({"solve", lambda_, "--pose", "X=0,Y=-700,Z=0"}, 1);
  EXPECT_EQ(solved["status"], "out of reach");
  EXPECT_TRUE(solved["drives"]["drive.q1"].is_null());
  EXPECT_EQ(solved["jacobian"].size(), 0U);
  EXPECT_THAT(Run({"solve", lambda_, "--pose", "X=0,Y=-700,Z=0"}).err, HasSubstr("out of reach"));
}

TEST_F(Solve, ASingularPoseIsNoSolution) {
  // At Y = L1 link 1 stands upright on its rail.
  const nlohmann::json solved = Json({"solve", lambda_, "--pose", "X=0,Y=-600,Z=0"}, 4);
  EXPECT_EQ(solved["status"], "singular");
  EXPECT_EQ(solved["singularity"]["type"], 1);
  EXPECT_LT(solved["singularity"]["margin"].get<double>(), 1e-6);
}

TEST_F(Solve, ReadingsThatFitNoPoseDoNotConverge) {
  // Pods of 1 mm do not reach from the base to the platform.
  const nlohmann::json solved =
      Json({"solve", Machine("hexapod_reference"), "--drives", "q1=1,q2=1,q3=1,q4=1,q5=1,q6=1"}, 4);
  EXPECT_NE(solved["status"], "converged");
  EXPECT_NE(solved["message"], "");
}

TEST_F(Solve, MoreComponentsThanTheMachineHasAreNegative) {
  const nlohmann::json solved = Json({"solve", mill_, "--pose", "X=0,Y=0,Z=300,A=10"}, 1);
  EXPECT_EQ(solved["status"], "overdetermined");
}

TEST_F(Solve, HexapodJacobianIsTheDifferenceOfItsDrives) {
  const std::string machine = Machine("hexapod_reference");
  const nlohmann::json home = Json({"describe", machine})["home"]["pose"];
  std::map<std::string, double> pose;
  for (const char* letter : {"X", "Y", "Z", "A", "B", "C"})
    pose[letter] = home[letter].get<double>() + 3.0;
  const auto text = [](const std::map<std::string, double>& numbers) {
    std::string out;
    for (const auto& [letter, value] : numbers)
      out += (out.empty() ? "" : ",") + letter + "=" + nlohmann::json(value).dump();
    return out;
  };
  for (const char* rotation : {"xyz", "zyx"}) {
    const nlohmann::json here =
        Json({"solve", machine, "--pose", text(pose), "--rotation", rotation});
    ASSERT_EQ(here["jacobian_columns"], nlohmann::json({"X", "Y", "Z", "A", "B", "C"}));
    for (std::size_t column = 0; column < 6; ++column) {
      const std::string letter = here["jacobian_columns"][column];
      const bool angle = column > 2;
      const double step = 1e-3;  // mm or deg
      auto up = pose;
      auto down = pose;
      up[letter] += step;
      down[letter] -= step;
      const nlohmann::json above =
          Json({"solve", machine, "--pose", text(up), "--rotation", rotation});
      const nlohmann::json below =
          Json({"solve", machine, "--pose", text(down), "--rotation", rotation});
      const double width = 2 * step * (angle ? std::acos(-1.0) / 180.0 : 1.0);
      for (std::size_t row = 0; row < 6; ++row) {
        const std::string drive = here["jacobian_rows"][row];
        const double difference =
            (above["drives"][drive].get<double>() - below["drives"][drive].get<double>()) / width;
        EXPECT_NEAR(here["jacobian"][row][column].get<double>(),
                    difference,
                    2e-6 * std::max(1.0, std::abs(difference)))
            << rotation << " " << drive << " by " << letter;
      }
    }
  }
}

TEST_F(Solve, RotationOrderIsTheLayoutsUnlessGiven) {
  const std::string machine = Machine("hexapod_reference");
  const nlohmann::json home = Json({"describe", machine})["home"]["pose"];
  const std::string pose = "Z=" + home["Z"].dump() + ",A=5,B=7,C=11";
  const auto q1 = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"solve", machine, "--pose", pose};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Json(arguments)["drives"].begin().value().get<double>();
  };
  EXPECT_EQ(q1({}), q1({"--rotation", "xyz"}));
  EXPECT_NE(q1({}), q1({"--rotation", "zyx"}));
}

TEST_F(Solve, WrongNamesAreAllReportedWithTheKnownOnes) {
  const Outcome outcome = Run({"solve", lambda_, "--pose", "X=1,Q=2,X=3,Y=abc,Z"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("--pose:1:5: error: unknown pose component 'Q' [E0604]"));
  EXPECT_THAT(outcome.err, HasSubstr("known are: X, Y, Z, A, B, C"));
  EXPECT_THAT(outcome.err, HasSubstr("'X' is given twice [E0605]"));
  EXPECT_THAT(outcome.err, HasSubstr("'abc' is no number [E0608]"));
  EXPECT_THAT(outcome.err, HasSubstr("'Z' has no value [E0609]"));
  EXPECT_THAT(outcome.err, HasSubstr("4 errors"));
}

TEST_F(Solve, UnknownDrivesAndMissingOnesAreUsageErrors) {
  const Outcome unknown = Run({"solve", lambda_, "--drives", "drive.q9=1"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("known are: drive.q1, drive.q2, Z"));
  const Outcome missing = Run({"solve", lambda_, "--drives", "q1=1"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("no reading is given for drive.q2, Z [E0607]"));
}

TEST_F(Solve, ExactlyOneQuestionIsAnswered) {
  EXPECT_EQ(Run({"solve", lambda_}).code, 2);
  EXPECT_THAT(Run({"solve", lambda_}).err, HasSubstr("nothing to solve"));
  EXPECT_EQ(Run({"solve", lambda_, "--pose", "X=1", "--drives", "q1=1"}).code, 2);
}

TEST_F(Solve, StartChoosesWhereIterationsBegin) {
  const Outcome good =
      Run({"solve", lambda_, "--pose", "X=0,Y=0,Z=1", "--start", "drive.X=400,Y=500"});
  EXPECT_EQ(good.code, 0) << good.err;
  const Outcome bad = Run({"solve", lambda_, "--pose", "X=0", "--start", "W=1"});
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("known are: drive.X, drive.Y, Z"));
}

TEST_F(Solve, AllAssemblyModesOfALambdaAreEnumerated) {
  const Sliders at = Lambda(620.0, 555.0);
  const std::string drives =
      "drive.q1=" + std::to_string(at.q1) + ",drive.q2=" + std::to_string(at.q2) + ",Z=0";
  const nlohmann::json all = Json({"solve", lambda_, "--drives", drives, "--all"});
  EXPECT_EQ(all["complete"], true);
  ASSERT_EQ(all["assembly_modes"].size(), 2U) << all.dump(2) << " two circles meet twice";
  const nlohmann::json& first = all["assembly_modes"][0];
  EXPECT_EQ(first["as_laid_out"], true);
  EXPECT_NEAR(first["coordinates"]["drive.X"].get<double>(), 620.0, 1e-5);
  EXPECT_NEAR(first["coordinates"]["drive.Y"].get<double>(), 555.0, 1e-5);
  const nlohmann::json& mirrored = all["assembly_modes"][1];
  EXPECT_NEAR(mirrored["coordinates"]["drive.X"].get<double>(), 620.0, 1e-5);
  EXPECT_NEAR(mirrored["coordinates"]["drive.Y"].get<double>(), -555.0, 1e-5);
}

TEST_F(Solve, AllAssemblyModesOfAHexapodAreSaidToBeSearchedFor) {
  const nlohmann::json home =
      Json({"solve", Machine("linuxcnc_genhexkins"), "--pose", "X=1,Y=2,Z=20,A=3,B=-4,C=5"});
  std::string drives;
  for (const auto& [name, value] : home["drives"].items()) {
    drives += (drives.empty() ? "" : ",") + name + "=" + value.dump();
  }
  const nlohmann::json all =
      Json({"solve", Machine("linuxcnc_genhexkins"), "--drives", drives, "--all"});
  EXPECT_EQ(all["complete"], false);
  EXPECT_GT(all["starts"].get<int>(), 0);
  ASSERT_GE(all["assembly_modes"].size(), 2U) << "at least the one mirrored in the base";
  EXPECT_LE(all["assembly_modes"].size(), 40U) << "more than any hexapod has";
  EXPECT_EQ(all["assembly_modes"].size() % 2, 0U) << "with flat joints they come in mirrored pairs";
  EXPECT_EQ(all["assembly_modes"][0]["as_laid_out"], true);
  EXPECT_NEAR(all["assembly_modes"][0]["pose"]["Z"].get<double>(), 20.0, 1e-9);
}

TEST_F(Solve, AllNeedsDrives) {
  const Outcome outcome = Run({"solve", lambda_, "--pose", "X=0,Y=0,Z=0", "--all"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--all lists the assembly modes for given drives"));
}

TEST_F(Solve, PartAndToolOfAForkedFormula) {
  Write("fork.toml",
        "kompono = 1\nformula = '(part1 X + part2 X2) O Z (tool1 + tool2)'\n"
        "[axis.X]\nrange = [-100, 100]\n[axis.X2]\nrange = [-100, 100]\n[axis.Z]\nrange = [0, "
        "200]\n");
  const nlohmann::json first = Json({"solve", "fork.toml", "--pose", "X=5,Z=10"});
  EXPECT_TRUE(first["drives"].contains("X")) << first;
  EXPECT_FALSE(first["drives"].contains("X2")) << first;
  const nlohmann::json second =
      Json({"solve", "fork.toml", "--pose", "X=5,Z=10", "--part", "part2", "--tool", "tool2"});
  EXPECT_NEAR(second["drives"]["X2"].get<double>(), -5.0, 1e-9) << second;
  const Outcome bad = Run({"solve", "fork.toml", "--pose", "X=5", "--part", "part9"});
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("part9"));
}

}  // namespace
}  // namespace kompono::cli_test
