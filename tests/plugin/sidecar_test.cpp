// SPDX-License-Identifier: Apache-2.0
// The sidecar reader: what it understands, and the whole text of what it complains about.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/plugin/description.hpp"

namespace kompono::plugin {
namespace {

constexpr std::string_view kGood = R"(kompono  = 1
id       = "org.example.tilt-head"
version  = "1.2.3-rc1"
contract = "1.0"
library  = "libtilt.so"

[[module]]
id = "tilt"
kind = "mechanism"
title = "Tilting head"
summary = "One sentence."
letters = "ZA"
drives = [ { name = "q1", kind = "linear" }, { name = "q2", kind = "rotary" } ]
modes = [ { name = "q1", default = "-", meaning = "elbow" }, { name = "q2" } ]
points = ["A1", "B1", "tool"]
links = [ { from = "A1", to = "B1", kind = "strut" }, { from = "B1", to = "tool", kind = "platform" } ]
structure = { links = 5, pairs = { P = 1, R = 4 }, planar = true }
capabilities = ["swivels_tool"]
sources = ["KSM", "KDD"]
[[module.parameter]]
name = "arm"
shape = "numbers[3]"
unit = "mm"
default = [1, 2.5, 3]
range = [0.5, 1e5]
tolerance = 0.05
identifiable = false
meaning = "the arms"
[[module.parameter]]
name = "lean"
unit = "deg"
meaning = "how far it leans"
[[module.parameter]]
name = "foot"
shape = "point"
unit = "mm"
default = [0, 0, 1]
meaning = "its foot"
[[module.parameter]]
name = "base"
shape = "points[2]"
unit = "mm"
default = [[1, 2, 3], [4, 5, 6]]
meaning = "its joints"

[[module]]
id = "nose"
kind = "unit"
title = "Nose"
stations = ["front", "back"]

[[preset]]
id = "upright"
of = "tilt"
title = "Upright"
fixed = { lean = 90 }
defaults = { arm = [9, 9, 9] }
modes = { q2 = "-" }
)";

std::string Complaints(std::string_view text) {
  const Parsed<Sidecar> sidecar = ParseSidecar(text, "plugin.toml");
  return sidecar ? "no complaint" : RenderAll(sidecar.error(), {});
}

TEST(Sidecar, SaysWhatThePluginIs) {
  const Parsed<Sidecar> sidecar = ParseSidecar(kGood, "some/plugin.toml");
  ASSERT_TRUE(sidecar) << RenderAll(sidecar.error(), {});
  const PluginDescription& plugin = sidecar->plugin;
  EXPECT_EQ(plugin.id, "org.example.tilt-head");
  EXPECT_EQ(plugin.version, "1.2.3-rc1");
  EXPECT_EQ(plugin.contract_major, 1);
  EXPECT_EQ(plugin.contract_minor, 0);
  EXPECT_EQ(plugin.library, "libtilt.so");
  EXPECT_EQ(plugin.sidecar, "some/plugin.toml");
  ASSERT_EQ(plugin.modules.size(), 2U);
  EXPECT_EQ(plugin.modules[1].kind, ModuleKind::kUnit);
  EXPECT_THAT(plugin.modules[1].stations, testing::ElementsAre("front", "back"));
}

TEST(Sidecar, DescribesAMechanism) {
  const ModuleDescription tilt = ParseSidecar(kGood, "p").value().plugin.modules[0];
  EXPECT_EQ(tilt.kind, ModuleKind::kMechanism);
  EXPECT_EQ(tilt.letters, "ZA");
  EXPECT_EQ(tilt.implementation, "tilt");
  EXPECT_EQ(tilt.plugin_id, "org.example.tilt-head");
  ASSERT_EQ(tilt.drives.size(), 2U);
  EXPECT_FALSE(tilt.drives[0].rotary);
  EXPECT_TRUE(tilt.drives[1].rotary);
  ASSERT_EQ(tilt.modes.size(), 2U);
  EXPECT_EQ(tilt.modes[0].default_sign, -1);
  EXPECT_EQ(tilt.modes[0].meaning, "elbow");
  EXPECT_EQ(tilt.modes[1].default_sign, 1);
  EXPECT_THAT(tilt.points, testing::ElementsAre("A1", "B1", "tool"));
  ASSERT_EQ(tilt.links.size(), 2U);
  EXPECT_EQ(tilt.links[1].from, "B1");
  EXPECT_EQ(tilt.links[1].kind, "platform");
  ASSERT_TRUE(tilt.structure);
  EXPECT_EQ(tilt.structure->links, 5);
  EXPECT_EQ(tilt.structure->pairs, (std::map<std::string, int>{{"P", 1}, {"R", 4}}));
  EXPECT_TRUE(tilt.structure->planar);
  EXPECT_THAT(tilt.sources, testing::ElementsAre("KSM", "KDD"));
}

TEST(Sidecar, CountsAndNamesTheNumbersOfParameters) {
  const ModuleDescription tilt = ParseSidecar(kGood, "p").value().plugin.modules[0];
  ASSERT_EQ(tilt.parameters.size(), 4U);
  EXPECT_EQ(tilt.ParameterNumbers(), 3 + 1 + 3 + 6);
  const ParameterDescription& arm = *tilt.FindParameter("arm");
  EXPECT_EQ(arm.offset, 0);
  EXPECT_THAT(arm.default_value, testing::ElementsAre(1, 2.5, 3));
  EXPECT_EQ(arm.lower, 0.5);
  EXPECT_EQ(arm.upper, 1e5);
  EXPECT_EQ(arm.tolerance, 0.05);
  EXPECT_FALSE(arm.identifiable);
  EXPECT_EQ(arm.ToInternal(), 1.0);
  EXPECT_THAT(arm.NumberNames(), testing::ElementsAre("arm[1]", "arm[2]", "arm[3]"));
  const ParameterDescription& lean = *tilt.FindParameter("lean");
  EXPECT_EQ(lean.offset, 3);
  EXPECT_TRUE(lean.default_value.empty());
  EXPECT_TRUE(lean.identifiable);
  EXPECT_DOUBLE_EQ(lean.ToInternal() * 180.0, std::numbers::pi);
  EXPECT_THAT(lean.NumberNames(), testing::ElementsAre("lean"));
  const ParameterDescription& foot = *tilt.FindParameter("foot");
  EXPECT_EQ(foot.offset, 4);
  EXPECT_THAT(foot.NumberNames(), testing::ElementsAre("foot.x", "foot.y", "foot.z"));
  const ParameterDescription& base = *tilt.FindParameter("base");
  EXPECT_EQ(base.offset, 7);
  EXPECT_EQ(base.Numbers(), 6);
  EXPECT_THAT(base.default_value, testing::ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(base.NumberNames().back(), "base[2].z");
  EXPECT_EQ(tilt.FindParameter("bass"), nullptr);
}

TEST(Sidecar, KeepsPresetsUnresolved) {
  const Sidecar sidecar = ParseSidecar(kGood, "p").value();
  ASSERT_EQ(sidecar.presets.size(), 1U);
  const PresetDescription& upright = sidecar.presets[0];
  EXPECT_EQ(upright.own.id, "upright");
  EXPECT_EQ(upright.own.implementation, "tilt");
  EXPECT_THAT(upright.fixed.at("lean"), testing::ElementsAre(90));
  EXPECT_THAT(upright.defaults.at("arm"), testing::ElementsAre(9, 9, 9));
  EXPECT_EQ(upright.mode_defaults.at("q2"), -1);
}

TEST(Sidecar, AllProblemsOfAFileAreReportedTogether) {
  EXPECT_EQ(Complaints(R"(kompono = 1
id = "pyramid"
version = "0.1"
contract = "1.0"
libary = "libpyramid.so"
[[module]]
id = "pyramid"
kind = "mechanizm"
letters = "XYYK"
drives = [ { name = "q1", kind = "linear" }, { name = "q1", kind = "lin" } ]
modes = [ { name = "side", default = "up" } ]
points = ["A1", "B1", "A1", "2"]
links = [ { from = "A1", to = "B2", kind = "strut" } ]
structure = { links = 1, pairs = { P = 3, S = 6.5, T = 1 } }
[[module.parameter]]
name = "arm"
shape = "numbers[3]"
unit = "m"
default = [1, 2]
range = [5, 1]
tolerance = "x"
meaning = "arms"
[[module.parameter]]
name = "лапа"
unit = "mm"
default = [[1, 2, 3],
           [2, 3]]
shape = "points[2]"
[[module.parameter]]
name = "arm"
shape = "number[2]"
unit = "1"
default = nan
meaning = "again"
[[module.parameter]]
name = "leg"
unit = "mm"
default = 7
range = [1, 5]
tolerance = -1
meaning = "too long"
[[preset]]
id = "Delta"
of = "pyramid"
fixed = { arm = [90, 90, "x"], leg = 1 }
defaults = { leg = 2 }
)"),
            R"(plugin.toml:1:1: error: 'library' is missing [E0222]
 1 | kompono = 1
   | ^~~~~~~~~~~
  help: modules need the library that holds their code; only presets do without
plugin.toml:2:6: error: 'pyramid' is no id of a plugin [E0224]
 2 | id = "pyramid"
   |      ^~~~~~~~~
  help: an id is lower-case words joined by dots, as in org.example.crane
plugin.toml:3:11: error: '0.1' is no version [E0224]
 3 | version = "0.1"
   |           ^~~~~
  help: a version is three numbers, as in 0.1.0
plugin.toml:5:1: error: unknown key 'libary' [E0221]
 5 | libary = "libpyramid.so"
   | ^~~~~~
  help: did you mean 'library'?
plugin.toml:6:1: error: module 'pyramid' has no 'title' [E0222]
 6 | [[module]]
   | ^~~~~~~~~~
plugin.toml:8:8: error: 'kind' cannot be 'mechanizm' [E0224]
 8 | kind = "mechanizm"
   |        ^~~~~~~~~~~
  help: did you mean 'mechanism'?
plugin.toml:9:11: error: letter Y is given twice [E0225]
 9 | letters = "XYYK"
   |           ^~~~~~
plugin.toml:9:11: error: 'K' is no letter of motion [E0224]
 9 | letters = "XYYK"
   |           ^~~~~~
  help: letters are XYZUVWPQRABCDE
plugin.toml:10:55: error: 'q1' is given twice [E0225]
 10 | drives = [ { name = "q1", kind = "linear" }, { name = "q1", kind = "lin" } ]
    |                                                       ^~~~
plugin.toml:10:68: error: 'kind' cannot be 'lin' [E0224]
 10 | drives = [ { name = "q1", kind = "linear" }, { name = "q1", kind = "lin" } ]
    |                                                                    ^~~~~
  help: known are: linear, rotary
plugin.toml:11:38: error: 'default' cannot be 'up' [E0224]
 11 | modes = [ { name = "side", default = "up" } ]
    |                                      ^~~~
  help: known are: +, -
plugin.toml:12:23: error: 'A1' is given twice [E0225]
 12 | points = ["A1", "B1", "A1", "2"]
    |                       ^~~~
plugin.toml:12:29: error: '2' is no name [E0224]
 12 | points = ["A1", "B1", "A1", "2"]
    |                             ^~~
  help: a name is letters, digits and '_', and begins with a letter
plugin.toml:13:31: error: 'B2' is not one of this module's points [E0226]
 13 | links = [ { from = "A1", to = "B2", kind = "strut" } ]
    |                               ^~~~
  help: did you mean 'B1'?
plugin.toml:14:23: error: a structure has at least two links, base and platform [E0224]
 14 | structure = { links = 1, pairs = { P = 3, S = 6.5, T = 1 } }
    |                       ^
plugin.toml:14:47: error: 'S' must be an integer, not a number [E0223]
 14 | structure = { links = 1, pairs = { P = 3, S = 6.5, T = 1 } }
    |                                               ^~~
plugin.toml:14:52: error: unknown key 'T' in 'pairs' [E0221]
 14 | structure = { links = 1, pairs = { P = 3, S = 6.5, T = 1 } }
    |                                                    ^
  help: did you mean 'R'?
plugin.toml:18:8: error: 'unit' cannot be 'm' [E0224]
 18 | unit = "m"
    |        ^~~
  help: did you mean 'mm'?
plugin.toml:19:11: error: 'default' does not fit the shape numbers[3] [E0224]
 19 | default = [1, 2]
    |           ^~~~~~
  help: write a list of numbers, [a, b, ..]
plugin.toml:20:9: error: 'range' must be two numbers, [least, greatest], least below greatest [E0224]
 20 | range = [5, 1]
    |         ^~~~~~
plugin.toml:21:13: error: 'tolerance' must be a number, not a string [E0223]
 21 | tolerance = "x"
    |             ^~~
plugin.toml:23:1: error: parameter 'лапа' has no 'meaning' [E0222]
 23 | [[module.parameter]]
    | ^~~~~~~~~~~~~~~~~~~~
plugin.toml:24:8: error: 'лапа' is no name [E0224]
 24 | name = "лапа"
    |        ^~~~~~
  help: a name is letters, digits and '_', and begins with a letter
plugin.toml:26:11: error: 'default' does not fit the shape points[2] [E0224]
 26 | default = [[1, 2, 3],
    |           ^~~~~~~~~~~
  help: write a list of points, [[x, y, z], ..]
plugin.toml:30:8: error: 'arm' is given twice [E0225]
 30 | name = "arm"
    |        ^~~~~
plugin.toml:31:9: error: 'number[2]' is no shape [E0224]
 31 | shape = "number[2]"
    |         ^~~~~~~~~~~
  help: shapes are number, numbers[n], point, points[n] with n from 1 to 1000
plugin.toml:33:11: error: 'default' must be made of finite numbers [E0224]
 33 | default = nan
    |           ^~~
plugin.toml:38:11: error: 'default': 7 lies outside the range 1 .. 5 [E0224]
 38 | default = 7
    |           ^
plugin.toml:40:13: error: a tolerance is not negative [E0224]
 40 | tolerance = -1
    |             ^~
plugin.toml:42:1: error: preset 'Delta' has no 'title' [E0222]
 42 | [[preset]]
    | ^~~~~~~~~~
plugin.toml:43:6: error: 'Delta' is no id of a module [E0224]
 43 | id = "Delta"
    |      ^~~~~~~
  help: an id is lower-case letters, digits and '_', and begins with a letter
plugin.toml:45:26: error: 'arm' must be made of numbers, not a string [E0223]
 45 | fixed = { arm = [90, 90, "x"], leg = 1 }
    |                          ^~~
plugin.toml:46:12: error: 'leg' stands in 'fixed' and in 'defaults' [E0225]
 46 | defaults = { leg = 2 }
    |            ^~~~~~~~~~~
33 errors
)");
}

TEST(Sidecar, MisplacedWordsAreUnknownToTheOtherKindOfModule) {
  EXPECT_EQ(Complaints(R"(kompono = 1
id = "org.example.units"
version = "0.1.0"
contract = "1.0"
library = "libunits.so"
[[module]]
id = "nose"
kind = "unit"
title = "Nose"
stations = []
letters = "X"
[[module]]
id = "slide"
kind = "mechanism"
title = "Slide"
letters = ""
drives = []
stations = ["nose"]
)"),
            R"(plugin.toml:10:12: error: a unit has at least one station [E0224]
 10 | stations = []
    |            ^~
plugin.toml:11:1: error: unknown key 'letters' in module 'nose' [E0221]
 11 | letters = "X"
    | ^~~~~~~
  help: known are: id, kind, title, summary, stations, states, counted_by, capabilities, sources, parameter
plugin.toml:16:11: error: a mechanism has at least one letter [E0224]
 16 | letters = ""
    |           ^~
plugin.toml:17:10: error: a mechanism has at least one drive [E0224]
 17 | drives = []
    |          ^~
plugin.toml:18:1: error: unknown key 'stations' in module 'slide' [E0221]
 18 | stations = ["nose"]
    | ^~~~~~~~
  help: known are: id, kind, title, summary, letters, drives, modes, points, links, structure, capabilities, sources, …
5 errors
)");
}

TEST(Sidecar, EmptyWordsAreNoNames) {
  EXPECT_EQ(Complaints(R"(kompono = 1
id = ""
version = ""
contract = ""
library = "libx.so"
[[module]]
id = ""
kind = ""
title = "t"
letters = "X"
drives = [{ name = "", kind = "linear" }]
points = [""]
links = [{ from = "", to = "A", kind = "rail" }]
)"),
            R"(plugin.toml:2:6: error: '' is no id of a plugin [E0224]
 2 | id = ""
   |      ^~
  help: an id is lower-case words joined by dots, as in org.example.crane
plugin.toml:3:11: error: '' is no version [E0224]
 3 | version = ""
   |           ^~
  help: a version is three numbers, as in 0.1.0
plugin.toml:4:12: error: '' is no contract version [E0224]
 4 | contract = ""
   |            ^~
  help: this kompono offers contract 1.0
plugin.toml:7:6: error: '' is no id of a module [E0224]
 7 | id = ""
   |      ^~
  help: an id is lower-case letters, digits and '_', and begins with a letter
plugin.toml:8:8: error: 'kind' cannot be '' [E0224]
 8 | kind = ""
   |        ^~
  help: known are: mechanism, unit
plugin.toml:11:20: error: '' is no name [E0224]
 11 | drives = [{ name = "", kind = "linear" }]
    |                    ^~
  help: a name is letters, digits and '_', and begins with a letter
plugin.toml:12:11: error: '' is no name [E0224]
 12 | points = [""]
    |           ^~
  help: a name is letters, digits and '_', and begins with a letter
plugin.toml:13:19: error: '' is not one of this module's points [E0226]
 13 | links = [{ from = "", to = "A", kind = "rail" }]
    |                   ^~
plugin.toml:13:28: error: 'A' is not one of this module's points [E0226]
 13 | links = [{ from = "", to = "A", kind = "rail" }]
    |                            ^~~
9 errors
)");
}

TEST(Sidecar, TextThatIsNotTomlSaysWhere) {
  // The words after the colon are the TOML library's.
  EXPECT_THAT(Complaints("kompono = 1\nid = \"open\nversion = 1\n"),
              testing::MatchesRegex("plugin.toml:2:11: error: this is not TOML: [^\n]+ .E0220.\n"
                                    " 2 . id = \"open\n"
                                    "   .           .\n"
                                    "1 error\n"));
}

TEST(Sidecar, EmptyFileLacksEverything) {
  EXPECT_EQ(Complaints(""),
            R"(plugin.toml:1:1: error: 'id' is missing [E0222]
 1 | 
   | ^
plugin.toml:1:1: error: 'version' is missing [E0222]
 1 | 
   | ^
plugin.toml:1:1: error: 'kompono' is missing [E0222]
 1 | 
   | ^
plugin.toml:1:1: error: 'contract' is missing [E0222]
 1 | 
   | ^
plugin.toml:1:1: error: there is neither a [[module]] nor a [[preset]] [E0222]
 1 | 
   | ^
5 errors
)");
}

TEST(Sidecar, NewerContractIsAllThatIsSaid) {
  EXPECT_EQ(
      Complaints(R"(kompono = 1
id = "org.example.new"
version = "0.1.0"
contract = "2.0"
library = "libnew.so"
telemetry = "a key of contract 2"
)"),
      R"(plugin.toml:4:12: error: the plugin needs contract 2.0, this kompono offers 1.0 [E0203]
 4 | contract = "2.0"
   |            ^~~~~
  help: install a newer kompono, or a build of the plugin for this one
1 error
)");
}

TEST(Sidecar, OlderContractIsAllThatIsSaid) {
  EXPECT_EQ(Complaints("kompono = 1\nid = \"org.example.old\"\nversion = \"0.1.0\"\ncontract = "
                       "\"0.9\"\nx = 1\n"),
            "plugin.toml:4:12: error: the plugin needs contract 0.9, this kompono offers 1.0 "
            "[E0204]\n"
            " 4 | contract = \"0.9\"\n"
            "   |            ^~~~~\n"
            "  help: build the plugin again with the SDK of this kompono\n"
            "1 error\n");
}

TEST(Sidecar, NewerFormatIsAllThatIsSaid) {
  EXPECT_EQ(Complaints("kompono = 2\nid = \"org.example.new\"\nversion = \"0.1.0\"\ncontract = "
                       "\"1.0\"\nx = 1\n"),
            "plugin.toml:1:11: error: this sidecar has format 2, this kompono reads format 1 "
            "[E0203]\n"
            " 1 | kompono = 2\n"
            "   |           ^\n"
            "  help: install a newer kompono\n"
            "1 error\n");
}

TEST(Sidecar, LibraryIsAPlainFileNameBesideIt) {
  for (const char* name : {"../libx.so", "/usr/lib/libx.so", "sub/libx.so", "..", ".", ""}) {
    std::string text(kGood);
    text.replace(text.find("libtilt.so"), 10, name);
    EXPECT_EQ(Complaints(text),
              std::string("plugin.toml:5:12: error: '") + name +
                  "' is not the plain name of a file [E0224]\n 5 | library  = \"" + name +
                  "\"\n   |            ^" + std::string(std::string_view(name).size() + 1, '~') +
                  "\n  help: the library stands beside its plugin.toml; paths are not followed\n"
                  "1 error\n");
  }
}

TEST(Sidecar, MissingFileSaysSo) {
  const Parsed<Sidecar> sidecar = ReadSidecar("no/such/plugin.toml");
  ASSERT_FALSE(sidecar);
  EXPECT_EQ(RenderAll(sidecar.error(), {}),
            "no/such/plugin.toml: error: this file cannot be read: No such file or directory "
            "[E0220]\n1 error\n");
}

TEST(Sidecar, EverySidecarOfThisTreeIsGood) {
  int read = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(KOMPONO_SOURCE_DIR "/plugins")) {
    if (entry.path().filename() != "plugin.toml") continue;
    const Parsed<Sidecar> sidecar = ReadSidecar(entry.path());
    EXPECT_TRUE(sidecar) << RenderAll(sidecar.error(), {});
    ++read;
  }
  EXPECT_GE(read, 6);
}

TEST(Sidecar, GuideQuotesWhatIsReallySaid) {
  std::ifstream file(KOMPONO_SOURCE_DIR "/docs/writing-a-plugin.md");
  const std::string guide{std::istreambuf_iterator<char>(file), {}};
  const std::string fence = "```toml plugin.toml\n";
  const std::size_t begin = guide.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t text_begin = begin + fence.size();
  std::string text = guide.substr(text_begin, guide.find("```", text_begin) - text_begin);
  EXPECT_EQ(Complaints(text), "no complaint");
  const std::string right = "letters = \"X\"";
  text.replace(text.find(right), right.size(), "letter = \"X\"");
  const Parsed<Sidecar> sidecar = ParseSidecar(text, "plugin.toml");
  ASSERT_FALSE(sidecar);
  const auto unknown = std::find_if(sidecar.error().begin(),
                                    sidecar.error().end(),
                                    [](const Diagnostic& d) { return d.code == "E0221"; });
  ASSERT_NE(unknown, sidecar.error().end());
  EXPECT_THAT(guide, testing::HasSubstr(Render(*unknown, {})));
}

/// Damages the good sidecar in many ways; whatever comes out is a value or complaints with a place
/// inside the text, never a crash.
TEST(Sidecar, DamagedTextNeverCrashesTheReader) {
  const std::uint32_t seed = 20240611;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const std::string_view pieces[] = {"[",
                                     "]",
                                     "{",
                                     "}",
                                     "\"",
                                     "=",
                                     "\n",
                                     "1e999",
                                     "\xd0",
                                     "\\u0",
                                     "[[module]]\n",
                                     "-",
                                     "nan",
                                     "true",
                                     ","};
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text(kGood);
    for (int i = 0; i < 3; ++i) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0) {
        text.erase(at, 1 + random() % 12);
      } else {
        text.insert(at, pieces[random() % std::size(pieces)]);
      }
    }
    const Parsed<Sidecar> sidecar = ParseSidecar(text, "plugin.toml");
    if (sidecar) continue;
    ++refused;
    const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
    for (const Diagnostic& diagnostic : sidecar.error()) {
      ASSERT_FALSE(diagnostic.message.empty());
      ASSERT_FALSE(diagnostic.code.empty());
      ASSERT_GE(diagnostic.span.line, 1) << text;
      ASSERT_LE(diagnostic.span.line, lines);
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace kompono::plugin
