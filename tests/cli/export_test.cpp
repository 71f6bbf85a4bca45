// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

namespace kompono::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Export : public Program {
 protected:
  const std::string lambda_ = Machine("so_waterjet_lambda");
};

TEST_F(Export, FormulaHasALineForEveryDrive) {
  const Outcome outcome = Run({"export", lambda_, "--to", "formula"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* drive : {"drive.q1 = ", "drive.q2 = ", "Z = "})
    EXPECT_THAT(outcome.out, HasSubstr(drive));
  const Outcome one = Run({"export", lambda_, "--to", "formula", "--drive", "q1"});
  EXPECT_THAT(one.out, HasSubstr("drive.q1 = "));
  EXPECT_THAT(one.out, Not(HasSubstr("drive.q2 = ")));
}

TEST_F(Export, LatexAndCAndTheirFiles) {
  EXPECT_THAT(Run({"export", lambda_, "--to", "latex"}).out, HasSubstr("align*"));
  const Outcome outcome = Run({"export", lambda_, "--to", "c", "-o", "machine.c"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(Shell("cc -std=c99 -Wall -Wextra -Werror -c machine.c -o machine.o").code, 0);
  EXPECT_EQ(Run({"export", lambda_, "--to", "c", "-o", "machine.c"}).code, 5);
}

TEST_F(Export, DigitsAreOfFormulas) {
  const Outcome three = Run({"export", lambda_, "--to", "formula", "--digits", "3"});
  const Outcome twelve = Run({"export", lambda_, "--to", "formula", "--digits", "12"});
  EXPECT_EQ(three.code, 0);
  EXPECT_LE(three.out.size(), twelve.out.size());
  EXPECT_EQ(Run({"export", lambda_, "--to", "formula", "--digits", "0"}).code, 2);
}

TEST_F(Export, JsonHasFormulasAndText) {
  const nlohmann::json document = Json({"export", lambda_, "--to", "formula"});
  EXPECT_EQ(document["format"], "formula");
  EXPECT_THAT(document["text"].get<std::string>(), HasSubstr("drive.q1 = "));
  EXPECT_FALSE(document["formulas"].empty());
}

TEST_F(Export, UnknownDrivesAreListed) {
  const Outcome outcome = Run({"export", lambda_, "--to", "formula", "--drive", "q7"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("known are: drive.q1, drive.q2, Z"));
  EXPECT_EQ(Run({"export", lambda_}).code, 2);
}

}  // namespace
}  // namespace kompono::cli_test
