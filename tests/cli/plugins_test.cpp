// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <filesystem>

namespace kompono::cli_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Plugins : public Program {
 protected:
  /// A folder with one plugin whose sidecar is `text`.
  [[nodiscard]] std::string BadPlugin(const std::string& text) const {
    std::filesystem::create_directories(folder() / "work/plugins/bad");
    Write("plugins/bad/plugin.toml", text);
    return (folder() / "work/plugins").string();
  }
};

TEST_F(Plugins, AreListedWithTheirModules) {
  const Outcome outcome = Run({"plugins"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("org.kompono.lambda"));
  EXPECT_THAT(outcome.out, HasSubstr("enabled"));
  const nlohmann::json list = Json({"plugins"})["plugins"];
  EXPECT_GE(list.size(), 6U);
  for (const nlohmann::json& plugin : list) EXPECT_EQ(plugin["enabled"], true) << plugin;
}

TEST_F(Plugins, LoadEveryLibrary) {
  const nlohmann::json list = Json({"plugins", "--load"})["plugins"];
  for (const nlohmann::json& plugin : list) {
    EXPECT_EQ(plugin["enabled"], true) << plugin;
    if (!plugin["library"].get<std::string>().empty()) {
      EXPECT_TRUE(plugin.contains("compiler")) << plugin;
    }
  }
}

TEST_F(Plugins, ShowAModulesParametersModesAndDrives) {
  const Outcome outcome = Run({"plugins", "lambda"});
  EXPECT_EQ(outcome.code, 0);
  for (const char* word : {"L1",
                           "link 1, from slider 1 to the tool point",
                           "assembly mode",
                           "q2",
                           "slider1",
                           "0.05",
                           "mm",
                           "yes",
                           "2P 3R",
                           "SO"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
  const nlohmann::json module = Json({"plugins", "lambda"});
  EXPECT_EQ(module["letters"], "XY");
  EXPECT_EQ(module["parameters"].size(), 3U);
  EXPECT_EQ(module["parameters"][0]["name"], "L1");
  EXPECT_EQ(module["parameters"][0]["unit"], "mm");
}

TEST_F(Plugins, ShowAWholePlugin) {
  const Outcome outcome = Run({"plugins", "org.kompono.units"});
  EXPECT_EQ(outcome.code, 0);
  for (const char* module : {"workpiece", "spindle", "jet_head"})
    EXPECT_THAT(outcome.out, HasSubstr(module));
  EXPECT_GE(Json({"plugins", "org.kompono.units"})["modules"].size(), 4U);
}

TEST_F(Plugins, UnknownIdIsGuessed) {
  const Outcome outcome = Run({"plugins", "lamda"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'lambda'?"));
  EXPECT_EQ(Json({"plugins", "lamda"}, 1)["diagnostics"][0]["code"], "E0616");
}

TEST_F(Plugins, DisabledOnesStayInTheListWithTheReason) {
  const std::string folder = BadPlugin("kompono = 1\nid = 'org.example.bad'\nversion = 7\n");
  const Outcome outcome = Run({"plugins", "--plugin-dir", folder});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("disabled"));
  EXPECT_THAT(outcome.out, HasSubstr("[E02"));
  bool seen = false;
  const nlohmann::json list = Json({"plugins", "--plugin-dir", folder})["plugins"];
  for (const nlohmann::json& plugin : list) {
    if (plugin["enabled"] == true) continue;
    seen = true;
    EXPECT_GE(plugin["reasons"].size(), 1U);
  }
  EXPECT_TRUE(seen);
}

TEST_F(Plugins, ALibraryThatIsNoneIsFoundOutByLoading) {
  const std::string folder = BadPlugin(R"(kompono = 1
id = 'org.example.bad'
version = '1.0.0'
contract = '1.0'
library = 'libbad.so'
[[module]]
id = 'bad'
kind = 'unit'
title = 'Bad'
summary = 'Nothing.'
stations = ['s']
)");
  Write("plugins/bad/libbad.so", "this is no library");
  const nlohmann::json list = Json({"plugins", "--load", "--plugin-dir", folder})["plugins"];
  for (const nlohmann::json& plugin : list) {
    if (plugin["id"] != "org.example.bad") continue;
    EXPECT_EQ(plugin["enabled"], false) << plugin;
    EXPECT_GE(plugin["reasons"].size(), 1U);
  }
  EXPECT_THAT(Run({"plugins", "--load", "--plugin-dir", folder}).out, HasSubstr("disabled"));
}

TEST_F(Plugins, NamesAreOneALineForTheShells) {
  const Outcome outcome = Run({"plugins", "--names"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(Lines(outcome.out), Contains("lambda"));
  EXPECT_THAT(Lines(outcome.out), Not(Contains("org.kompono.lambda")));
}

TEST_F(Plugins, NoneAtAllIsANegativeAnswer) {
  std::filesystem::copy_file(KOMPONO_PROGRAM, folder() / "work" / "kompono");
  const Outcome outcome = Shell("./kompono plugins");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("KOMPONO_PLUGIN_PATH"));
}

}  // namespace
}  // namespace kompono::cli_test
