// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <cmath>
#include <cstdlib>

namespace kompono::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Measure : public Program {
 protected:
  const std::string lambda_ = Machine("so_waterjet_lambda");
  /// Data rows of a measurement file.
  static std::size_t Rows(const std::string& text) { return Csv(text).size(); }
};

TEST_F(Measure, WritesRowsThatTheLayoutReadsBack) {
  const Outcome outcome =
      Run({"measure", lambda_, "--points", "20", "--held-out", "0.25", "-o", "p.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(Rows(Read("p.csv")), 20U);
  EXPECT_EQ(Run({"check", "--layout", lambda_, "p.csv"}).code, 0);
  const nlohmann::json told =
      Json({"measure", lambda_, "--points", "20", "--held-out", "0.25", "-o", "q.csv"});
  EXPECT_EQ(told["rows"], 20);
  EXPECT_EQ(told["held_out"], 5);
  EXPECT_EQ(Read("p.csv"), Read("q.csv"));
}

TEST_F(Measure, PrintsToStdoutAndSeedsDecide) {
  const auto run = [this](const char* seed) {
    return Run({"measure", lambda_, "--points", "5", "--sigma-mm", "0.01", "--seed", seed}).out;
  };
  EXPECT_EQ(run("3"), run("3"));
  EXPECT_NE(run("3"), run("4"));
  EXPECT_EQ(Rows(run("3")), 5U);
}

TEST_F(Measure, TrueGeometryShowsInTheResult) {
  // Every position moves with the foundation of the jet.
  const auto nominal = Csv(Run({"measure", lambda_, "--points", "4"}).out);
  const auto shifted =
      Csv(Run({"measure", lambda_, "--points", "4", "--set", "open_base.x=500.75"}).out);
  const auto changed =
      Csv(Run({"measure", lambda_, "--points", "4", "--change", "open_base.x=0.75"}).out);
  ASSERT_EQ(nominal.size(), 4U);
  std::string column;
  for (const auto& [name, value] : nominal.front()) {
    if (name == "x_mm") column = name;
  }
  ASSERT_EQ(column, "x_mm");
  for (std::size_t i = 0; i < 4; ++i) {
    const double before = std::strtod(nominal[i].at(column).c_str(), nullptr);
    EXPECT_NEAR(std::strtod(shifted[i].at(column).c_str(), nullptr), before + 0.75, 1e-9);
    EXPECT_NEAR(std::strtod(changed[i].at(column).c_str(), nullptr), before + 0.75, 1e-9);
  }
}

TEST_F(Measure, OtherLayoutsAndManufacturedMachinesServeAsTruth) {
  const Outcome truth = Run({"measure",
                             lambda_,
                             "--true",
                             Source("layouts/measurements/so_waterjet_true.toml"),
                             "--points",
                             "3"});
  EXPECT_EQ(truth.code, 0) << truth.err;
  const Outcome plain = Run({"measure", lambda_, "--points", "3"});
  const Outcome made = Run({"measure", lambda_, "--as-made", "7", "--points", "3"});
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_NE(plain.out, made.out);
  EXPECT_NE(plain.out, truth.out);
}

TEST_F(Measure, NamesAndRangesAreJudged) {
  const Outcome outcome =
      Run({"measure", lambda_, "--set", "open_bas.x=1", "--region", "drive.X=5:1,W=0:1"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("unknown number of the geometry 'open_bas.x' [E0604]"));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'open_base.x'?"));
  EXPECT_THAT(outcome.err, HasSubstr("'5:1' is no range"));
  EXPECT_THAT(outcome.err, HasSubstr("unknown coordinate 'W'"));
  EXPECT_EQ(Run({"measure", lambda_, "--points", "0"}).code, 2);
  EXPECT_EQ(Run({"measure", lambda_, "--sigma-mm", "-1"}).code, 2);
  EXPECT_EQ(Run({"measure", lambda_, "--seed", "-1"}).code, 2);
  EXPECT_EQ(Run({"measure", lambda_, "--as-made", "-1"}).code, 2);
  const Outcome mixed = Run({"measure", lambda_, "--change", "open_base=1"});
  EXPECT_EQ(mixed.code, 2);
  EXPECT_THAT(mixed.err, HasSubstr("[E0611]"));
}

TEST_F(Measure, FilesThatExistAreKept) {
  Write("p.csv", "precious\n");
  const Outcome refused = Run({"measure", lambda_, "-o", "p.csv"});
  EXPECT_EQ(refused.code, 5);
  EXPECT_THAT(refused.err, HasSubstr("exists already"));
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(Read("p.csv"), "precious\n");
  EXPECT_EQ(Run({"measure", lambda_, "-o", "p.csv", "--force"}).code, 0);
  EXPECT_NE(Read("p.csv"), "precious\n");
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

}  // namespace
}  // namespace kompono::cli_test
