// SPDX-License-Identifier: Apache-2.0
// A delta run of Klipper, from its two files to a calibrated layout.
#include "program.hpp"

#include <cmath>

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

}  // namespace
}  // namespace kompono::cli_test
