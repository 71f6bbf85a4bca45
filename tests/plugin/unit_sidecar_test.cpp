// SPDX-License-Identifier: Apache-2.0
// What sidecars say of units: words for capabilities, states, and the parameter that counts them.
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/plugin/capability_words.hpp"
#include "kompono/plugin/description.hpp"

namespace kompono::plugin {
namespace {

std::string Complaints(std::string_view text) {
  const Parsed<Sidecar> sidecar = ParseSidecar(text, "plugin.toml");
  return sidecar ? "no complaint" : RenderAll(sidecar.error(), {});
}

TEST(Sidecar, CapabilitiesAreWordsOfTheListOrHaveADot) {
  const std::string unit = R"(kompono = 1
id = "org.example.units"
version = "0.1.0"
contract = "1.0"
library = "libunits.so"
[[module]]
id = "nose"
kind = "unit"
title = "Nose"
stations = ["nose"]
)";
  EXPECT_EQ(Complaints(unit + "capabilities = ['carries_tool', 'example.milling']\n"),
            "no complaint");
  EXPECT_EQ(Complaints(unit + "capabilities = ['carries_tols', 'many_tools', 'many_tools']\n"),
            R"(plugin.toml:11:17: error: 'carries_tols' is no word for a capability [E0224]
 11 | capabilities = ['carries_tols', 'many_tools', 'many_tools']
    |                 ^~~~~~~~~~~~~~
  help: did you mean 'carries_tool'? (a word of your own has a dot: "example.milling")
plugin.toml:11:47: error: 'many_tools' is given twice [E0225]
 11 | capabilities = ['carries_tols', 'many_tools', 'many_tools']
    |                                               ^~~~~~~~~~~~
2 errors
)");
}

TEST(Sidecar, PageExplainsEveryWordForACapability) {
  std::ifstream in(KOMPONO_SOURCE_DIR "/docs/plugins.md");
  const std::string page(std::istreambuf_iterator<char>(in), {});
  for (const CapabilityWord& word : kCapabilityWords) {
    std::ostringstream row;
    row << "| `" << word.word << "` | " << word.meaning << " |";
    EXPECT_THAT(page, testing::HasSubstr(row.str()));
  }
}

TEST(Sidecar, StatesAreCountedByAPlainNumber) {
  const std::string unit = R"(kompono = 1
id = "org.example.units"
version = "0.1.0"
contract = "1.0"
library = "libunits.so"
[[module]]
id = "nose"
kind = "unit"
title = "Nose"
stations = ["nose1", "nose2"]
)";
  const Parsed<Sidecar> good =
      ParseSidecar(unit +
                       "states = 3\ncounted_by = 'noses'\n[[module.parameter]]\nname = "
                       "'noses'\nunit = '1'\nmeaning = 'm'\n",
                   "p");
  ASSERT_TRUE(good) << RenderAll(good.error(), {});
  EXPECT_EQ(good->plugin.modules[0].states, 3);
  EXPECT_EQ(good->plugin.modules[0].counted_by, "noses");
  EXPECT_EQ(Complaints(unit + "states = 0\ncounted_by = 'noses'\n[[module.parameter]]\nname = "
                              "'noses'\nunit = 'mm'\nmeaning = 'm'\n"),
            R"(plugin.toml:11:10: error: a unit has at least one state [E0224]
 11 | states = 0
    |          ^
plugin.toml:12:14: error: 'noses' is no parameter that counts: a number in unit "1" [E0226]
 12 | counted_by = 'noses'
    |              ^~~~~~~
2 errors
)");
}

}  // namespace
}  // namespace kompono::plugin
