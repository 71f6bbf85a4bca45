// SPDX-License-Identifier: Apache-2.0
// Every --help, found by walking through the commands that the helps themselves list.
#include "program.hpp"

#include <algorithm>
#include <sstream>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Help : public Program {
 protected:
  /// The names in the block "Commands:".
  static std::vector<std::string> Commands(const std::string& help) {
    std::vector<std::string> names;
    bool inside = false;
    for (const std::string& line : Lines(help)) {
      if (line == "Commands:") {
        inside = true;
      } else if (line.empty()) {
        inside = false;
      } else if (inside && line.size() > 2 && line[2] != ' ') {
        names.push_back(line.substr(2, line.find(' ', 2) - 2));
      }
    }
    return names;
  }

  void Walk(const std::vector<std::string>& command, std::vector<std::string>& helps) {
    std::vector<std::string> arguments = command;
    arguments.emplace_back("--help");
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
    helps.push_back(outcome.out);
    for (const std::string& name : Commands(outcome.out)) {
      std::vector<std::string> below = command;
      below.push_back(name);
      Walk(below, helps);
    }
  }
};

TEST_F(Help, OfEveryCommandBeginsWithExamplesOfThatCommand) {
  std::vector<std::string> helps;
  Walk({}, helps);
  ASSERT_GE(helps.size(), 21U);  // the program, 12 commands, 7 of catalog, 1 of import
  for (const std::string& help : helps) {
    EXPECT_THAT(help, StartsWith("Examples:\n  "));
    EXPECT_THAT(help, HasSubstr("\nUsage: kompono"));
    EXPECT_THAT(help, HasSubstr("--json"));
    EXPECT_LT(help.find("Examples:"), help.find("Options"));
    for (const std::string& line : Lines(help)) EXPECT_LE(line.size(), 100U) << line;
  }
}

TEST_F(Help, FlagsTakeNoValueAndHelpStandsOnce) {
  const std::string help = Run({"calibrate", "--help"}).out;
  EXPECT_THAT(help, HasSubstr("\n  --residuals             A line"));
  EXPECT_THAT(help, HasSubstr("\n  --json                  Data"));
  EXPECT_THAT(help, HasSubstr("\n  -o --out FILE           Calibrated"));
  EXPECT_EQ(help.find("-h --help"), help.rfind("-h --help"));
}

TEST_F(Help, ListsTheExitCodes) {
  const Outcome outcome = Run({"solve", "-h"});
  for (const char* code : {"  0  ", "  1  ", "  2  ", "  3  ", "  4  ", "  5  ", "  70 "})
    EXPECT_THAT(outcome.out, HasSubstr(std::string("\n") + code));
}

TEST_F(Help, ExamplesNameOnlyOptionsThatExist) {
  std::vector<std::string> helps;
  Walk({}, helps);
  for (const std::string& help : helps) {
    const std::string examples = help.substr(0, help.find("\n\n"));
    for (const std::string& line : Lines(examples)) {
      std::istringstream words(line);
      std::string program;
      std::string command;
      words >> program >> command;
      if (program != "kompono") continue;
      std::vector<std::string> arguments{command};
      std::vector<std::string> rest;
      for (std::string word; words >> word;) rest.push_back(word);
      // catalog, import and calibrate have commands of their own below them.
      const std::vector<std::string> below = Commands(Run({command, "--help"}).out);
      if (!rest.empty() && std::find(below.begin(), below.end(), rest.front()) != below.end()) {
        arguments.push_back(rest.front());
      }
      arguments.emplace_back("--help");
      const std::string described = Run(arguments).out;
      for (const std::string& word : rest) {
        if (word.starts_with("--")) {
          EXPECT_THAT(described, HasSubstr(word.substr(0, word.find('=')))) << line;
        }
      }
    }
  }
}

}  // namespace
}  // namespace kompono::cli_test
