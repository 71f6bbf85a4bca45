// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

using FormulaCommand = Program;

TEST_F(FormulaCommand, PrintsCanonicalTextExplanationAndKeys) {
  const Outcome outcome = Run({"formula", "XYZOC_v"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("part X Y Z O C_v tool\n"));
  EXPECT_THAT(outcome.out, HasSubstr("same relative motion"));
}

TEST_F(FormulaCommand, NotesWhatWasChangedOnStderr) {
  const Outcome outcome = Run({"formula", "Z_{xy}XYOP_zZ"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("part_xy X Y O Z P_z\n"));
  EXPECT_THAT(outcome.err, HasSubstr("note: "));
}

TEST_F(FormulaCommand, IsoInBracketsIsOneArgument) {
  const Outcome outcome = Run({"formula", "[w X' b Y Z (C) t]"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("N0106"));
}

TEST_F(FormulaCommand, JsonHasEverything) {
  const nlohmann::json document = Json({"formula", "part_xy (XY):drive O|O Z P_z"});
  EXPECT_EQ(document["formula"], "part_xy (XY):drive O|O Z P_z");
  EXPECT_EQ(document["open_base"], true);
  EXPECT_GE(document["explanation"].size(), 4U);
  for (const char* key : {"string", "distribution", "relative_motion"})
    EXPECT_TRUE(document["keys"][key].is_string()) << key;
  EXPECT_FALSE(document.contains("diagnostics"));
  EXPECT_EQ(Json({"formula", "XYZ0C_v"})["diagnostics"][0]["code"], "N0103");
}

TEST_F(FormulaCommand, CountsClassesAsPublished) {
  const nlohmann::json counts = Json({"formula", "XYZO", "--counts"})["counts"];
  EXPECT_EQ(counts["strings"], 24);
  EXPECT_EQ(counts["distributions"], 8);
  EXPECT_EQ(counts["relative_motions"], 1);
  EXPECT_THAT(Run({"formula", "XYCOZ", "--counts"}).out,
              HasSubstr("120 strings, 54 distributions, 8 relative motions"));
  const Outcome group = Run({"formula", "(XY):drive O Z", "--counts"});
  EXPECT_EQ(group.code, 0);
  EXPECT_THAT(group.err, HasSubstr("serial formulas"));
}

TEST_F(FormulaCommand, EveryFaultIsShownUnderItsPlace) {
  const Outcome outcome = Run({"formula", "part X Y Q7_v X O O tool"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("formula:1:"));
  EXPECT_THAT(outcome.err, HasSubstr("^"));
  EXPECT_THAT(outcome.err, HasSubstr("errors"));
  EXPECT_GE(Json({"formula", "part X Y Q7_v X O O tool"}, 3)["diagnostics"].size(), 2U);
}

TEST_F(FormulaCommand, ReadsStandardInput) {
  const Outcome outcome = Run({"formula", "-"}, "XYZOC_v\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("part X Y Z O C_v tool\n"));
}

TEST_F(FormulaCommand, SeveralArgumentsAreAskedToBeQuoted) {
  const Outcome outcome = Run({"formula", "part", "X", "O"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("quotes"));
}

}  // namespace
}  // namespace kompono::cli_test
