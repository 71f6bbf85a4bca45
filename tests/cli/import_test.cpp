// SPDX-License-Identifier: Apache-2.0
// A delta run of Klipper, from its two files to a calibrated layout.
#include "program.hpp"

#include <cmath>
#include <sstream>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;

class Import : public Program {
 protected:
  const std::string csv_ = Source("layouts/measurements/klipper_delta/fzechert_00.csv");
  const std::string json_ = Source("layouts/measurements/klipper_delta/fzechert_00.json");
};

TEST_F(Import, WritesALayoutAndSaysWhatToDoNext) {
  const Outcome outcome = Run({"import", "klipper_delta", csv_, "--layout", "delta.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("kompono calibrate delta.toml " + csv_));
  EXPECT_EQ(Run({"check", "delta.toml"}).code, 0);
  EXPECT_EQ(Run({"import", "klipper_delta", csv_, "--layout", "delta.toml"}).code, 5);
}

TEST_F(Import, CalibrationReachesKlippersOwnCost) {
  ASSERT_EQ(Run({"import", "klipper_delta", csv_, "--layout", "delta.toml"}).code, 0);
  const Outcome text =
      Run({"calibrate", "delta.toml", csv_, "--published", json_, "-o", "calibrated.toml"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("in Klipper's numbers"));
  const nlohmann::json report = Json({"calibrate", "delta.toml", csv_, "--published", json_});
  const nlohmann::json& klipper = report["klipper"];
  EXPECT_LE(klipper["cost_identified"].get<double>(),
            klipper["cost_published"].get<double>() * (1.0 + 1e-6));
  EXPECT_NEAR(klipper["identified"]["delta_radius"].get<double>(),
              klipper["published"]["delta_radius"].get<double>(),
              0.001);
  EXPECT_GT(klipper["cost_nominal"].get<double>(), klipper["cost_identified"].get<double>());
}

TEST_F(Import, PublishedGeometryAndStdout) {
  const Outcome nominal = Run({"import", "klipper_delta", csv_});
  const Outcome published =
      Run({"import", "klipper_delta", csv_, "--geometry", json_, "--which", "published_fit"});
  EXPECT_EQ(nominal.code, 0) << nominal.err;
  EXPECT_EQ(published.code, 0) << published.err;
  EXPECT_THAT(nominal.out, HasSubstr("linear_delta"));
  EXPECT_NE(nominal.out, published.out);
  EXPECT_THAT(Json({"import", "klipper_delta", csv_})["next"].get<std::string>(),
              HasSubstr("kompono calibrate"));
}

TEST_F(Import, OtherFilesAreRefused) {
  Write("points.csv", "x_mm,y_mm\n1,2\n");
  const Outcome other = Run({"import", "klipper_delta", "points.csv"});
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("[E0618]"));
  Write("run.csv", "kind,value_mm,s1_a_mm,s1_b_mm,s1_c_mm,s2_a_mm,s2_b_mm,s2_c_mm\n");
  const Outcome alone = Run({"import", "klipper_delta", "run.csv"});
  EXPECT_EQ(alone.code, 5) << alone.err;
  EXPECT_THAT(alone.err, HasSubstr("run.json"));
}

TEST_F(Import, AConfigurationBecomesALayoutAndARun) {
  std::string config =
      "[printer]\nkinematics: delta\ndelta_radius: 161.75\n[stepper_a]\nstep_distance: 0.01\n"
      "position_endstop: 421\narm_length: 345\n[stepper_b]\nstep_distance: 0.01\n"
      "[stepper_c]\nstep_distance: 0.01\n[delta_calibrate]\n";
  std::size_t count = 0;
  for (const std::string& line : Lines(Read(csv_))) {
    if (!line.starts_with("height,")) continue;
    std::istringstream cells(line);
    std::vector<std::string> cell(5);
    for (std::string& text : cell) std::getline(cells, text, ',');
    const std::string key = "height" + std::to_string(count++);
    config.append(key).append(": ").append(cell[1]).append("\n").append(key).append("_pos: ");
    for (std::size_t i = 2; i < 5; ++i) {
      config.append(std::to_string(100.0 * std::stod(cell[i]))).append(i < 4 ? "," : "\n");
    }
  }
  Write("printer.cfg", config);
  const Outcome outcome = Run(
      {"import", "klipper_config", "printer.cfg", "--layout", "delta.toml", "--run", "run.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("7 heights and 0 distances probed"));
  const nlohmann::json ours = Json({"calibrate", "delta.toml", "run.csv"});
  ASSERT_EQ(Run({"import", "klipper_delta", csv_, "--layout", "other.toml"}).code, 0);
  const nlohmann::json theirs = Json({"calibrate", "other.toml", csv_});
  EXPECT_NEAR(ours["chi_squared"].get<double>(),
              theirs["chi_squared"].get<double>(),
              1e-3 * theirs["chi_squared"].get<double>());
  Write("empty.cfg", "[printer]\nkinematics: delta\n");
  const Outcome bad = Run({"import", "klipper_config", "empty.cfg", "--layout", "no.toml"});
  EXPECT_EQ(bad.code, 3);
  EXPECT_THAT(bad.err, HasSubstr("[printer] has no 'delta_radius'"));
}

TEST_F(Import, TrackerPointsBecomeMeasurements) {
  const std::string machine = Machine("hexapod_reference");
  Write("readings.csv",
        "name,q1,q2,q3,q4,q5,q6\n"
        "A,955,955,955,955,955,955\nB,960,955,955,955,955,955\nC,955,955,960,955,955,955\n"
        "D,955,955,955,955,962,955\n");
  Write("points.txt", "A 0 0 1\nB 0 1 1\n");
  const Outcome few =
      Run({"import", "tracker", "points.txt", "readings.csv", "--layout", machine, "--align"});
  EXPECT_EQ(few.code, 3);
  EXPECT_THAT(few.err, HasSubstr("[E0467]"));
  Write("points.txt", "A 0 0\n");
  EXPECT_THAT(Run({"import", "tracker", "points.txt", "readings.csv", "--layout", machine}).err,
              HasSubstr("[E0466]"));
}

}  // namespace
}  // namespace kompono::cli_test
