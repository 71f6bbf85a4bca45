// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <cmath>
#include <filesystem>

namespace kompono::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Calibrate : public Program {
 protected:
  const std::string lambda_ = Machine("so_waterjet_lambda");

  /// Measurements of a machine whose L1 and foundation are off.
  void Measurements(const std::string& file, const std::string& sigma_mm = "0.005") {
    const Outcome outcome = Run({"measure",
                                 lambda_,
                                 "--set",
                                 "drive.L1=1200.12,open_base.x=501.5,open_base.y=599.25",
                                 "--points",
                                 "60",
                                 "--sigma-mm",
                                 sigma_mm,
                                 "--seed",
                                 "11",
                                 "-o",
                                 file});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
};

TEST_F(Calibrate, FindsTheRealGeometryAndWritesALayout) {
  Measurements("p.csv");
  const Outcome outcome =
      Run({"calibrate", lambda_, "p.csv", "-o", "out.toml", "--report", "report.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("identification converged"));
  EXPECT_THAT(outcome.out, HasSubstr("drive.L1"));
  EXPECT_THAT(outcome.err, HasSubstr("out.toml written"));
  EXPECT_EQ(Run({"check", "out.toml"}).code, 0);
  EXPECT_THAT(Read("out.toml"), HasSubstr("[calibrated"));
  EXPECT_THAT(Read("out.toml"), HasSubstr("p.csv (sha256 "));
  EXPECT_THAT(Files(), ElementsAre("out.toml", "p.csv", "report.json"));

  const nlohmann::json report = nlohmann::json::parse(Read("report.json"));
  EXPECT_EQ(report["status"], "converged");
  for (const nlohmann::json& parameter : report["parameters"]) {
    const double sigma = parameter.value("sigma_mm", 0.0);
    const auto expect = [&](const char* name, double truth) {
      if (parameter["name"] == name) {
        EXPECT_NEAR(parameter["after_mm"].get<double>(), truth, 5.0 * sigma) << name;
      }
    };
    expect("drive.L1", 1200.12);
    expect("open_base.x", 501.5);
    expect("open_base.y", 599.25);
  }
  // The calibrated layout predicts what the report says is left.
  const nlohmann::json again = Json({"calibrate", "out.toml", "p.csv"});
  EXPECT_NEAR(again["errors"][0]["rms_before_mm"].get<double>(),
              report["errors"][0]["rms_after_mm"].get<double>(),
              1e-9);
}

TEST_F(Calibrate, RoundingOfRowsWithoutNoiseIsNoOutlier) {
  const std::string hexapod = Machine("hexapod_reference");
  ASSERT_EQ(Run({"measure",
                 hexapod,
                 "--points",
                 "1000",
                 "--kind",
                 "pose",
                 "--seed",
                 "3",
                 "-o",
                 "p.csv",
                 "--region",
                 "X=-100:100,Y=-100:100,Z=500:700,A=-10:10,B=-10:10,C=-10:10"})
                .code,
            0);
  const Outcome outcome = Run({"calibrate", hexapod, "p.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1000 rows with 6000 numbers"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("left out as outliers")));
}

TEST_F(Calibrate, JsonIsTheWholeReport) {
  Measurements("p.csv");
  const nlohmann::json report =
      Json({"calibrate", lambda_, "p.csv", "--held-out", "0.3", "--seed", "5"});
  EXPECT_EQ(report["rows_held_out"], 18);
  EXPECT_EQ(report["measurements"][0]["file"], "p.csv");
  EXPECT_EQ(report["measurements"][0]["sha256"].get<std::string>().size(), 64U);
  EXPECT_TRUE(report["errors"].is_array());
}

TEST_F(Calibrate, FreeAndLockDecideWhatChanges) {
  Measurements("p.csv");
  const auto names = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"calibrate", lambda_, "p.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::vector<std::string> out;
    const nlohmann::json report = Json(arguments);
    for (const nlohmann::json& parameter : report["parameters"]) out.push_back(parameter["name"]);
    return out;
  };
  EXPECT_THAT(names({"--free", "drive.L1,drive.L3"}), ElementsAre("drive.L1", "drive.L3"));
  EXPECT_THAT(names({"--free", "drive.L1", "--free", "drive.L2"}),
              ElementsAre("drive.L1", "drive.L2"));
  EXPECT_THAT(names({"--free", "drive.L*", "--lock", "drive.L3"}),
              ElementsAre("drive.L1", "drive.L2"));
}

TEST_F(Calibrate, PriorsAndBoundsHoldParameters) {
  Measurements("p.csv");
  const auto l1 = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"calibrate", lambda_, "p.csv", "--free", "drive.L1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Json(arguments)["parameters"][0];
  };
  const double free = std::abs(l1({})["change_mm"].get<double>());
  EXPECT_LT(std::abs(l1({"--prior", "drive.L1=1e-6"})["change_mm"].get<double>()), 0.01 * free);
  const nlohmann::json bounded = l1({"--bounds", "drive.L1=1199.99:1200.01"});
  EXPECT_LE(std::abs(bounded["change_mm"].get<double>()), 0.0100001);
  EXPECT_EQ(bounded["at_bound"], true);
}

TEST_F(Calibrate, ParametersThatNobodyHasAreUsageErrors) {
  Measurements("p.csv");
  const Outcome prior = Run({"calibrate", lambda_, "p.csv", "--prior", "drive.L9=1,drive.L1=x"});
  EXPECT_EQ(prior.code, 2);
  EXPECT_THAT(prior.err, HasSubstr("'drive.L9' names no number of the geometry"));
  EXPECT_THAT(prior.err, HasSubstr("'x' is no number"));
  const Outcome free = Run({"calibrate", lambda_, "p.csv", "--free", "drive.L9"});
  EXPECT_EQ(free.code, 2) << free.err;
  EXPECT_THAT(free.err, HasSubstr("drive.L9"));
}

TEST_F(Calibrate, WithoutConvergenceNothingIsWritten) {
  Measurements("p.csv");
  const Outcome outcome =
      Run({"calibrate", lambda_, "p.csv", "-o", "out.toml", "--max-iterations", "1"});
  EXPECT_EQ(outcome.code, 4) << outcome.out;
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Calibrate, BadMeasurementsChangeNothing) {
  Write("bad.csv", "x_mm,y_mm\n1,2\n");
  const Outcome outcome = Run({"calibrate", lambda_, "bad.csv", "-o", "out.toml"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("bad.csv"));
  EXPECT_THAT(Files(), ElementsAre("bad.csv"));
  EXPECT_EQ(Run({"calibrate", lambda_, "nowhere.csv"}).code, 5);
}

TEST_F(Calibrate, ExistingFilesAreKeptAndNoWorkIsLostForThem) {
  Measurements("p.csv");
  Write("out.toml", "precious\n");
  const Outcome refused = Run({"calibrate", lambda_, "p.csv", "-o", "out.toml"});
  EXPECT_EQ(refused.code, 5);
  EXPECT_EQ(refused.out, "");
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(Read("out.toml"), "precious\n");
  EXPECT_EQ(Run({"calibrate", lambda_, "p.csv", "-o", "out.toml", "--force"}).code, 0);
  EXPECT_THAT(Read("out.toml"), HasSubstr("[calibrated"));
}

TEST_F(Calibrate, SeveralFilesAreOneFit) {
  Measurements("p.csv");
  ASSERT_EQ(Run({"measure",
                 lambda_,
                 "--set",
                 "drive.L1=1200.12,open_base.x=501.5,open_base.y=599.25",
                 "--sigma-mm",
                 "0.005",
                 "--points",
                 "10",
                 "-o",
                 "q.csv"})
                .code,
            0);
  const nlohmann::json report = Json({"calibrate", lambda_, "p.csv", "q.csv"});
  EXPECT_EQ(report["rows_fitted"], 70);
  EXPECT_EQ(report["measurements"].size(), 2U);
}

TEST_F(Calibrate, ResidualsOfEveryRowOnRequest) {
  Measurements("p.csv");
  const auto lines = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"calibrate", lambda_, "p.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Lines(Run(arguments).out).size();
  };
  EXPECT_GE(lines({"--residuals"}), lines({}) + 60);
}

TEST_F(Calibrate, ADescriptionTiesFilesToTheirLayout) {
  Measurements("a.csv");
  std::filesystem::create_directory(folder() / "work/runs");
  std::filesystem::rename(folder() / "work/a.csv", folder() / "work/runs/a.csv");
  std::filesystem::copy_file(lambda_, folder() / "work/machine.toml");
  Write("runs/jet.toml",
        "measurements = 1\nlayout = \"../machine.toml\"\n"
        "[[file]]\ncsv = \"a.csv\"\nsigma_mm = 0.005\n"
        "[fit]\nfree = [\"open_base.x\", \"drive.L1\"]\nprior = { \"drive.L1\" = 0.1 }\n");
  const nlohmann::json described = Json({"calibrate", "runs/jet.toml"});
  const nlohmann::json named = Json({"calibrate",
                                     "machine.toml",
                                     "runs/a.csv",
                                     "--free",
                                     "open_base.x,drive.L1",
                                     "--prior",
                                     "drive.L1=0.1"});
  EXPECT_EQ(described["free_parameters"], 2);
  EXPECT_EQ(described["chi_squared"], named["chi_squared"]);
  EXPECT_EQ(described["measurements"], named["measurements"]);
  EXPECT_EQ(Json({"calibrate", "runs/jet.toml", "--free", "open_base.x"})["free_parameters"], 1);
}

TEST_F(Calibrate, AWrongDescriptionIsJudgedAtOnce) {
  Write("jet.toml",
        "measurements = 2\nlayut = \"m.toml\"\n"
        "[[file]]\ncsv = 4\nheld_out = \"no\"\nsigma_mm = -1\n[fit]\nfree = \"all\"\n");
  const Outcome outcome = Run({"calibrate", "jet.toml", "-o", "out.toml"});
  EXPECT_EQ(outcome.code, 3);
  for (const char* said : {"jet.toml:1:16: error: 'measurements' must be 1",
                           "jet.toml:2:1: error: unknown key 'layut' [E0468]",
                           "did you mean 'layout'?",
                           "'csv' must be the name of a file",
                           "'held_out' is true or false",
                           "'sigma_mm' must be a number greater than 0",
                           "'free' must be a list of patterns"}) {
    EXPECT_THAT(outcome.err, HasSubstr(said));
  }
  EXPECT_THAT(Files(), ElementsAre("jet.toml"));
}

TEST_F(Calibrate, TheMapTellsHowWellTheToolIsKnownOverTheZone) {
  Measurements("p.csv");
  const nlohmann::json report =
      Json({"calibrate", lambda_, "p.csv", "--map", "map.csv", "--map-steps", "4"});
  const nlohmann::json& zone = report["zone"];
  EXPECT_EQ(zone["points"].get<int>() + zone["out_of_reach"].get<int>(), 64);
  EXPECT_GT(zone["points"].get<int>(), 32);
  const double rms = zone["tool_sigma_rms_mm"].get<double>();
  // The rows lie in the same zone: what is predicted for them is of the same size.
  EXPECT_NEAR(rms, report["tool_sigma_rms_mm"].get<double>(), 0.6 * rms);
  EXPECT_GE(zone["tool_sigma_max_mm"].get<double>(), rms);
  const std::vector<std::string> lines = Lines(Read("map.csv"));
  EXPECT_EQ(lines.size(), 1 + zone["points"].get<std::size_t>());
  EXPECT_THAT(lines[0], HasSubstr("drive.X_mm,drive.Y_mm,Z_mm,x_mm"));
}

TEST_F(Calibrate, FixturesOfSeveralFilesStayApart) {
  const std::string header =
      "kind,value_mm,centre,centre_x_mm,centre_y_mm,centre_z_mm,"
      "drive.q1_mm,drive.q2_mm,Z_mm\n";
  // The same bar about two sockets: as one file and as two.
  const std::string a = "ball_bar,100,A,0,0,0,-900,400,0\n";
  const std::string b = "ball_bar,300,B,200,100,50,-905,420,0\n";
  Write("both.csv", header + a + b);
  Write("a.csv", header + a);
  Write("b.csv", header + b);
  const auto cost = [&](std::vector<std::string> files) {
    std::vector<std::string> words{"calibrate", lambda_};
    words.insert(words.end(), files.begin(), files.end());
    words.insert(words.end(), {"--free", "open_base.x"});
    words.emplace_back("--json");
    return nlohmann::json::parse(Run(words).out)["cost_before"].get<double>();
  };
  const double whole = cost({"both.csv"});
  EXPECT_GT(whole, 0.0);
  EXPECT_NEAR(cost({"a.csv", "b.csv"}), whole, 1e-9 * whole);
}

}  // namespace
}  // namespace kompono::cli_test
