// SPDX-License-Identifier: Apache-2.0
// The scripts for the shells, run in the shells that are installed.
#include "program.hpp"

namespace kompono::cli_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

class Completion : public Program {
 protected:
  /// What bash offers when the last of `words` is being typed.
  [[nodiscard]] std::vector<std::string> Offers(const std::string& words) const {
    const Outcome outcome = Shell(
        "set -u; kompono() { \"$K\" \"$@\"; }; source <(\"$K\" completion bash); COMP_WORDS=(" +
        words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _kompono; "
        "printf '%s\\n' \"${COMPREPLY[@]-}\"");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return Lines(outcome.out);
  }
  [[nodiscard]] bool Installed(const std::string& shell) const {
    return Shell("command -v " + shell).code == 0;
  }
};

TEST_F(Completion, BashCompletesCommands) {
  EXPECT_THAT(Offers("kompono so"), ElementsAre("solve"));
  EXPECT_THAT(Offers("kompono ''"), IsSupersetOf({"solve", "plugins", "catalog", "completion"}));
  EXPECT_THAT(Offers("kompono catalog q"), ElementsAre("query"));
  EXPECT_THAT(Offers("kompono --color always so"), ElementsAre("solve"));
}

TEST_F(Completion, BashCompletesOptionsOfTheCommandAndOfEvery) {
  EXPECT_THAT(Offers("kompono solve --po"), ElementsAre("--pose", "--poses"));
  EXPECT_THAT(Offers("kompono solve --js"), ElementsAre("--json"));
  EXPECT_THAT(Offers("kompono catalog query db --li"), ElementsAre("--limit"));
  EXPECT_THAT(Offers("kompono plugins --po"), ElementsAre(""));
}

TEST_F(Completion, BashCompletesValues) {
  Write("machine.toml", "");
  Write("my file.csv", "");
  EXPECT_THAT(Offers("kompono solve ma"), ElementsAre("machine.toml"));
  EXPECT_THAT(Offers("kompono solve machine.toml --poses my"), ElementsAre("my file.csv"));
  EXPECT_THAT(Offers("kompono solve machine.toml --rotation ''"), ElementsAre("xyz", "zyx"));
  EXPECT_THAT(Offers("kompono export machine.toml --to l"), ElementsAre("latex"));
  EXPECT_THAT(Offers("kompono --json so"), ElementsAre("solve"));
  EXPECT_THAT(Offers("kompono solve --json ma"), ElementsAre("machine.toml"));
  EXPECT_THAT(Offers("kompono completion z"), ElementsAre("zsh"));
  EXPECT_THAT(Offers("kompono plugins lam"), ElementsAre("lambda"));
  EXPECT_THAT(Offers("kompono measure machine.toml --points ''"), ElementsAre(""));
}

TEST_F(Completion, EveryCommandAndOptionIsInEveryScript) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const Outcome outcome = Run({"completion", shell});
    EXPECT_EQ(outcome.code, 0);
    for (const char* word : {"solve",
                             "klipper_delta",
                             "verify",
                             "max-iterations",
                             "plugin-dir",
                             "published",
                             "no-expand",
                             "completion"})
      EXPECT_THAT(outcome.out, HasSubstr(word)) << shell;
    EXPECT_EQ(Json({"completion", shell})["script"], outcome.out);
  }
  EXPECT_EQ(Run({"completion", "tcsh"}).code, 2);
}

TEST_F(Completion, ScriptsHaveNoSyntaxErrors) {
  ASSERT_TRUE(Installed("bash"));
  for (const char* shell : {"bash", "zsh", "fish"}) {
    if (!Installed(shell)) continue;
    const Outcome outcome =
        Shell(std::string("\"$K\" completion ") + shell + " > script && " + shell + " -n script");
    EXPECT_EQ(outcome.code, 0) << shell << ": " << outcome.err;
  }
}

TEST_F(Completion, QuotesAndBracketsAreBalancedInTheScriptsOfOtherShells) {
  // Where zsh and fish are not installed this is what can be known.
  for (const char* shell : {"zsh", "fish"}) {
    const std::string script = Run({"completion", shell}).out;
    for (const std::string& line : Lines(script)) {
      bool inside = false;
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '\\') {
          ++i;
        } else if (line[i] == '\'') {
          inside = !inside;
        }
      }
      EXPECT_FALSE(inside) << shell << ": " << line;
    }
  }
  const std::string zsh = Run({"completion", "zsh"}).out;
  EXPECT_THAT(zsh, testing::StartsWith("#compdef kompono\n"));
  EXPECT_EQ(Lines(Shell("\"$K\" completion zsh | grep -c 'case '").out).front(), "4");
  EXPECT_EQ(Lines(Shell("\"$K\" completion zsh | grep -c '^ *esac$'").out).front(), "4");
}

}  // namespace
}  // namespace kompono::cli_test
