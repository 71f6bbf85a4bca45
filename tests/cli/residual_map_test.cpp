// SPDX-License-Identifier: Apache-2.0
// calibrate --residual-map and compensate --residual-map on a gantry whose X guideway is bowed.
#include "program.hpp"
#include <fmt/format.h>

#include <cmath>
#include <string>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class ResidualMaps : public Program {
 protected:
  void SetUp() override {
    Write("gantry.toml",
          "kompono = 1\nname = \"Gantry\"\nformula = \"part O X Y Z tool\"\n"
          "[axis.X]\nrange = [-500, 500]\n[axis.Y]\nrange = [-300, 300]\n[axis.Z]\nrange = [-200, "
          "200]\n");
  }

  /// X at -450 .. 450, Y at three places; y is off by 60 µm at the middle if `bowed`.
  void Measurements(const std::string& file, bool bowed, int columns = 31) const {
    std::string text = "X_mm,Y_mm,Z_mm,x_mm,y_mm,z_mm,sigma_mm,approach\n";
    for (int i = 0; i < columns; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const double x = -450.0 + 900.0 * i / std::max(1, columns - 1);
        const double y = 200.0 * j;
        const double bow = bowed ? 0.06 * (1.0 - x * x / (450.0 * 450.0)) : 0.0;
        // Deterministic, of 1 µm: nothing smooth can tell it.
        const auto noise = [&](int k) {
          return 1e-3 * std::sin(1e4 * (i + 37 * j + 101 * k) + 0.3);
        };
        text += fmt::format("{:.6f},{},0,{:.6f},{:.6f},{:.6f},0.001,+X\n",
                            x,
                            y,
                            x + noise(1),
                            y + bow + noise(2),
                            noise(3));
      }
    }
    Write(file, text);
  }
};

TEST_F(ResidualMaps, ABowedGuidewayIsMappedAndCompensated) {
  Measurements("p.csv", true);
  const Outcome made = Run({"calibrate",
                            "gantry.toml",
                            "p.csv",
                            "--free",
                            "*.zero",
                            "-o",
                            "real.toml",
                            "--residual-map",
                            "map.toml",
                            "--html",
                            "page.html"});
  ASSERT_EQ(made.code, 0) << made.err << made.out;
  EXPECT_THAT(
      made.out,
      HasSubstr("map of what the geometry leaves: kept, for it tells the errors of rows that "
                "it has not seen"));
  EXPECT_THAT(made.err, HasSubstr("map.toml written"));
  EXPECT_THAT(Read("page.html"), HasSubstr("<h2>Residual map</h2>"));
  EXPECT_THAT(Read("page.html"), HasSubstr("<h2>Figures of the standards</h2>"));
  EXPECT_THAT(Read("page.html"), HasSubstr("no figures: 1 of 5 approaches in + at -450 mm"));

  Write("program.csv", "X_mm,Y_mm,Z_mm\n0,0,0\n450,0,0\n480,0,0\n");
  const Outcome outcome =
      Run({"compensate", "gantry.toml", "real.toml", "program.csv", "--residual-map", "map.toml"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("map.toml: warning: 1 of 3 poses lie outside the map, the "
                        "first is row 3"));
  EXPECT_THAT(outcome.err, HasSubstr("[W0476]"));
  const auto rows = Csv(outcome.out);
  ASSERT_EQ(rows.size(), 3U);
  // Between middle and end the guideway bows by 60 µm, whatever the zero took of it.
  const double bow =
      std::stod(rows[1].at("corrected_Y_mm")) - std::stod(rows[0].at("corrected_Y_mm"));
  EXPECT_NEAR(bow, 0.06, 0.006);
}

TEST_F(ResidualMaps, ThatDoNotHelpAreNotWritten) {
  Measurements("p.csv", false);
  const Outcome outcome =
      Run({"calibrate", "gantry.toml", "p.csv", "--free", "*.zero", "--residual-map", "map.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("map of what the geometry leaves: refused: "));
  EXPECT_THAT(outcome.err, HasSubstr("map.toml: warning: the residual map is refused: "));
  EXPECT_THAT(outcome.err, HasSubstr("[W0472]"));
  EXPECT_THAT(Files(), Not(testing::Contains("map.toml")));
}

TEST_F(ResidualMaps, OfTooFewRowsAreRefused) {
  Measurements("p.csv", true, 2);
  const Outcome outcome =
      Run({"calibrate", "gantry.toml", "p.csv", "--free", "*.zero", "--residual-map", "map.toml"});
  EXPECT_NE(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("[E0470]"));
  EXPECT_THAT(Files(), Not(testing::Contains("map.toml")));
}

TEST_F(ResidualMaps, ThatAreNoneAreNamedWithAllTheirProblems) {
  Write("map.toml", "residual_map = 1\nerror_mm = [[0, 0]]\n[[axis]]\ncoordinate = \"Q\"\n");
  Write("program.csv", "X_mm,Y_mm,Z_mm\n0,0,0\n");
  const Outcome outcome = Run(
      {"compensate", "gantry.toml", "gantry.toml", "program.csv", "--residual-map", "map.toml"});
  EXPECT_NE(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("[E0471]"));
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace kompono::cli_test
