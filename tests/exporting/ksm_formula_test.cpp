// SPDX-License-Identifier: Apache-2.0
// The control formula that KSM prints for a real table-top machine, met by what we derive from its
// geometry. The printed digits are partly cut, not rounded: the bounds are those of the best unit
// direction (1e-4, 1e-2, 1e-3).
#include "shipped_machines.hpp"
#include <nlohmann/json.hpp>

#include "kompono/exporting/formulas.hpp"

namespace kompono::exporting {
namespace {

nlohmann::json KsmFormulas() {
  const kinematics::Machine machine = tests::LoadMachine("ksm_pyramid");
  const Parsed<MachineFormulas> formulas = DriveFormulas(machine, {});
  if (!formulas) throw std::runtime_error(RenderAll(formulas.error(), {}));
  return FormulaJson(*formulas, {});
}

TEST(KsmFormula, CoefficientsOfThePrintedDriveAreMet) {
  const nlohmann::json drive = KsmFormulas()["drives"][0];
  const nlohmann::json& outside = drive["polynomial"];
  EXPECT_NEAR(outside["x"], 0.2961, 1e-4);
  EXPECT_NEAR(outside["y"], 0.1709, 1e-4);
  EXPECT_NEAR(outside["z"], 0.9397, 1e-4);
  EXPECT_NEAR(outside["1"], -160.1293, 1e-3);
  EXPECT_EQ(drive["root_sign"], 1);
  const nlohmann::json& under = drive["under_root"];
  EXPECT_NEAR(under["x*y"], 0.1012, 1e-4);
  EXPECT_NEAR(under["x^2"], -0.9122, 1e-4);
  EXPECT_NEAR(under["x*z"], 0.5566, 1e-4);
  EXPECT_NEAR(under["y^2"], -0.9707, 1e-4);
  EXPECT_NEAR(under["y*z"], 0.3213, 1e-4);
  EXPECT_NEAR(under["z^2"], -0.1169, 1e-4);
  EXPECT_NEAR(under["x"], -216.1161, 1e-2);
  EXPECT_NEAR(under["y"], -124.7167, 1e-2);
  EXPECT_NEAR(under["z"], 90.8119, 1e-2);
  EXPECT_NEAR(under["1"], 25641.3446, 1e-3);
}

/// The other two drives are the first one turned by ±120° about z: (x, y) -> R(∓120°)(x, y).
TEST(KsmFormula, TheOtherDrivesFollowBySymmetry) {
  const nlohmann::json formulas = KsmFormulas();
  const double c = -0.5;
  const double s = 0.86602540378443864676;
  const double x1 = formulas["drives"][0]["polynomial"]["x"];
  const double y1 = formulas["drives"][0]["polynomial"]["y"];
  std::vector<std::pair<double, double>> wanted{{c * x1 - s * y1, s * x1 + c * y1},
                                                {c * x1 + s * y1, -s * x1 + c * y1}};
  for (std::size_t i = 1; i < 3; ++i) {
    const nlohmann::json& outside = formulas["drives"][i]["polynomial"];
    const bool first = std::abs(static_cast<double>(outside["x"]) - wanted[0].first) < 1e-6;
    const auto& [x, y] = wanted[first ? 0 : 1];
    EXPECT_NEAR(outside["x"], x, 1e-9);
    EXPECT_NEAR(outside["y"], y, 1e-9);
    EXPECT_NEAR(outside["z"], formulas["drives"][0]["polynomial"]["z"], 1e-9);
    EXPECT_NEAR(outside["1"], formulas["drives"][0]["polynomial"]["1"], 1e-6);
    EXPECT_NEAR(formulas["drives"][i]["under_root"]["z^2"],
                formulas["drives"][0]["under_root"]["z^2"],
                1e-9);
    EXPECT_NEAR(
        formulas["drives"][i]["under_root"]["1"], formulas["drives"][0]["under_root"]["1"], 1e-5);
  }
}

TEST(KsmFormula, IsPrintedAsAPersonWouldWriteIt) {
  const kinematics::Machine machine = tests::LoadMachine("ksm_pyramid");
  const FormulaOptions options{.digits = 7, .drives = {machine.drives()[0].name}};
  const Parsed<MachineFormulas> formulas = DriveFormulas(machine, options);
  ASSERT_TRUE(formulas.has_value());
  const std::string text = FormulaText(*formulas, options);
  EXPECT_EQ(text.find("e-"), std::string::npos) << "no leftovers of rounding: " << text;
  EXPECT_THAT(text, testing::StartsWith(machine.drives()[0].name + " = 0.296"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_THAT(text, testing::HasSubstr("sqrt("));
  EXPECT_THAT(FormulaLatex(*formulas, options), testing::HasSubstr("\\sqrt{"));
}

TEST(DriveFormulas, NamesAnUnknownDrive) {
  const kinematics::Machine machine = tests::LoadMachine("ksm_pyramid");
  const Parsed<MachineFormulas> formulas = DriveFormulas(machine, {.drives = {"struts.q9"}});
  ASSERT_FALSE(formulas.has_value());
  EXPECT_EQ(formulas.error()[0].code, "E0711");
  EXPECT_THAT(formulas.error()[0].help, testing::HasSubstr("struts.q"));
}

}  // namespace
}  // namespace kompono::exporting
