// SPDX-License-Identifier: Apache-2.0
#include "plugin_folder.hpp"

#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {
namespace {

constexpr std::string_view kDelta = R"(kompono = 1
id = "org.example.delta"
version = "0.1.0"
contract = "1.0"
library = "libdelta.so"
[[module]]
id = "delta"
kind = "mechanism"
title = "Delta"
summary = "the base"
letters = "XYZ"
drives = [{ name = "q1", kind = "linear" }]
modes = [{ name = "q1" }, { name = "side", default = "-" }]
capabilities = ["example.translation"]
sources = ["KSM"]
[[module.parameter]]
name = "arm"
shape = "numbers[3]"
unit = "mm"
range = [1, 1000]
meaning = "arms"
[[module.parameter]]
name = "foot"
shape = "points[2]"
unit = "mm"
meaning = "feet"
)";

std::string Presets(std::string_view id, std::string_view tables) {
  return "kompono = 1\nid = \"org.example." + std::string(id) +
         "\"\nversion = \"2.0.0\"\ncontract = \"1.0\"\n" + std::string(tables);
}

TEST(Presets, PutDefaultsFixedValuesAndModesOnTheirBase) {
  const PluginFolder folder;
  folder.Add("delta", kDelta);
  folder.Add("a_small_one", Presets("small", R"([[preset]]
id = "small"
of = "delta"
title = "Small delta"
fixed = { arm = [10, 20, 30] }
defaults = { foot = [[1, 2, 3], [4, 5, 6]] }
modes = { q1 = "-" }
sources = ["SO"]
)"));
  const Registry registry = folder.Discover();
  const ModuleDescription* small = registry.Find("small");
  ASSERT_NE(small, nullptr) << folder.Plain(registry.plugins()[0].reasons);
  EXPECT_EQ(small->title, "Small delta");
  EXPECT_EQ(small->summary, "");
  EXPECT_EQ(small->implementation, "delta");
  EXPECT_EQ(small->plugin_id, "org.example.small");
  EXPECT_EQ(small->plugin_version, "2.0.0");
  EXPECT_EQ(small->letters, "XYZ");
  EXPECT_THAT(small->FindParameter("arm")->default_value, testing::ElementsAre(10, 20, 30));
  EXPECT_TRUE(small->FindParameter("arm")->fixed);
  EXPECT_THAT(small->FindParameter("foot")->default_value, testing::ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_FALSE(small->FindParameter("foot")->fixed);
  EXPECT_EQ(small->modes[0].default_sign, -1);
  EXPECT_EQ(small->modes[1].default_sign, -1) << "the base's own";
  EXPECT_THAT(small->capabilities, testing::ElementsAre("example.translation"))
      << "kept from the base";
  EXPECT_THAT(small->sources, testing::ElementsAre("SO"));
  EXPECT_TRUE(registry.Find("delta")->FindParameter("arm")->default_value.empty())
      << "the base is untouched";
  EXPECT_EQ(registry.plugins()[0].description.modules.size(), 1U) << "listed with the plugin";
}

TEST(Presets, MayStandOnPresets) {
  const PluginFolder folder;
  folder.Add("a", Presets("a", R"([[preset]]
id = "outer"
of = "inner"
title = "outer"
defaults = { foot = [[0, 0, 0], [1, 1, 1]] }
[[preset]]
id = "inner"
of = "delta"
title = "inner"
fixed = { arm = [10, 20, 30] }
)"));
  folder.Add("delta", kDelta);
  const Registry registry = folder.Discover();
  const ModuleDescription* outer = registry.Find("outer");
  ASSERT_NE(outer, nullptr) << folder.Plain(registry.plugins()[0].reasons);
  EXPECT_EQ(outer->implementation, "delta");
  EXPECT_TRUE(outer->FindParameter("arm")->fixed);
  EXPECT_EQ(outer->FindParameter("foot")->default_value.size(), 6U);
}

TEST(Presets, EverythingThatDoesNotFitIsSaidAtOnce) {
  const PluginFolder folder;
  folder.Add("bad", Presets("bad", R"([[preset]]
id = "bad"
of = "delta"
title = "bad"
fixed = { arm = [10, 20], amr = [1, 2, 3] }
defaults = { foot = [[1, 2, 3]] }
modes = { sid = "+" }
[[preset]]
id = "far"
of = "delta"
title = "far"
fixed = { arm = [10, 20, 3000] }
[[preset]]
id = "near"
of = "good"
title = "near"
defaults = { arm = [1, 2, 3] }
[[preset]]
id = "good"
of = "delta"
title = "good"
fixed = { arm = [10, 20, 30] }
)"));
  folder.Add("delta", kDelta);
  const Registry registry = folder.Discover();
  EXPECT_FALSE(registry.plugins()[0].enabled);
  EXPECT_TRUE(registry.plugins()[1].enabled);
  EXPECT_EQ(
      folder.Plain(registry.plugins()[0].reasons),
      R"(<plugins>/bad/plugin.toml:9:17: error: 'arm' is numbers[3]: 3 numbers are needed, 2 are given [E0224]
 9 | fixed = { arm = [10, 20], amr = [1, 2, 3] }
   |                 ^~~~~~~~
<plugins>/bad/plugin.toml:9:33: error: module 'delta' has no parameter 'amr' [E0226]
 9 | fixed = { arm = [10, 20], amr = [1, 2, 3] }
   |                                 ^~~~~~~~~
  help: did you mean 'arm'?
<plugins>/bad/plugin.toml:10:21: error: 'foot' is points[2]: 6 numbers are needed, 3 are given [E0224]
 10 | defaults = { foot = [[1, 2, 3]] }
    |                     ^~~~~~~~~~~
<plugins>/bad/plugin.toml:11:17: error: module 'delta' has no mode 'sid' [E0226]
 11 | modes = { sid = "+" }
    |                 ^~~
  help: did you mean 'side'?
<plugins>/bad/plugin.toml:16:17: error: 'arm': 3000 lies outside the range 1 .. 1000 [E0224]
 16 | fixed = { arm = [10, 20, 3000] }
    |                 ^~~~~~~~~~~~~~
<plugins>/bad/plugin.toml:21:20: error: preset 'good' fixes 'arm' already [E0224]
 21 | defaults = { arm = [1, 2, 3] }
    |                    ^~~~~~~~~
6 errors
)");
}

TEST(Presets, UnknownBaseDisablesTheirPlugin) {
  const PluginFolder folder;
  folder.Add("delta", kDelta);
  folder.Add("lost",
             Presets("lost", "[[preset]]\nid = \"lost\"\nof = \"dleta\"\ntitle = \"lost\"\n"));
  const Registry registry = folder.Discover();
  EXPECT_FALSE(registry.plugins()[1].enabled);
  EXPECT_EQ(
      folder.Plain(registry.plugins()[1].reasons),
      R"(<plugins>/lost/plugin.toml:7:6: error: preset 'lost' stands on unknown module 'dleta' [E0208]
 7 | of = "dleta"
   |      ^~~~~~~
  help: did you mean 'delta'?
1 error
)");
}

TEST(Presets, CircleIsRefused) {
  const PluginFolder folder;
  folder.Add("ring", Presets("ring", R"([[preset]]
id = "one"
of = "two"
title = "one"
[[preset]]
id = "two"
of = "three"
title = "two"
[[preset]]
id = "three"
of = "one"
title = "three"
[[preset]]
id = "outside"
of = "three"
title = "outside"
)"));
  const Registry registry = folder.Discover();
  EXPECT_EQ(
      folder.Plain(registry.plugins()[0].reasons),
      R"(<plugins>/ring/plugin.toml:7:6: error: presets stand on each other in a circle: one -> two -> three -> one [E0227]
 7 | of = "two"
   |      ^~~~~
  help: one of them must stand on a module
1 error
)");
  EXPECT_TRUE(registry.modules().empty());
}

TEST(Presets, GoDownWithTheirBase) {
  const PluginFolder folder;
  folder.Add("a", Presets("a", "[[preset]]\nid = \"a\"\nof = \"b\"\ntitle = \"a\"\n"));
  folder.Add("b", Presets("b", "[[preset]]\nid = \"b\"\nof = \"delta\"\ntitle = \"b\"\n"));
  folder.Add("delta", std::string(kDelta) + "colour = \"red\"\n");
  const Registry registry = folder.Discover();
  EXPECT_TRUE(registry.modules().empty());
  ASSERT_EQ(registry.plugins().size(), 3U);
  EXPECT_EQ(folder.Plain(registry.plugins()[0].reasons.at(0).help),
            "plugin 'org.example.b' (<plugins>/b/plugin.toml) has it, but is disabled");
  EXPECT_EQ(folder.Plain(registry.plugins()[1].reasons.at(0).help),
            "plugin 'org.example.delta' (<plugins>/delta/plugin.toml) has it, but is disabled");
  EXPECT_EQ(registry.plugins()[2].reasons.at(0).code, "E0221");
}

TEST(Presets, CreateTheModuleTheyStandOn) {
  const PluginFolder folder;
  folder.Add(
      "slide", std::string(kSlideSidecar) + std::string(kNoseModule), "libslide.so", "libslide.so");
  folder.Add("fast", Presets("fast", R"([[preset]]
id = "fast_slide"
of = "slide"
title = "Fast slide"
defaults = { offset = 5 }
)"));
  Registry registry = folder.Discover();
  const auto mechanism = registry.CreateMechanism("fast_slide");
  ASSERT_TRUE(mechanism) << folder.Plain(mechanism.error());
  EXPECT_EQ((*mechanism)->Shape().parameters, 1);
  registry.LoadAll();
  EXPECT_NE(registry.Find("fast_slide"), nullptr) << "and is there after everything was tried";
}

TEST(Presets, GoWhenTheLibraryOfTheirBaseTurnsOutBad) {
  const PluginFolder folder;
  folder.Add("dummy", kDummySidecar, "libmagic.so", "libdummy.so");
  folder.Add("p", Presets("p", "[[preset]]\nid = \"p\"\nof = \"dummy\"\ntitle = \"p\"\n"));
  Registry registry = folder.Discover();
  EXPECT_NE(registry.Find("p"), nullptr);
  registry.LoadAll();
  EXPECT_EQ(registry.Find("p"), nullptr);
  EXPECT_FALSE(registry.plugins()[1].enabled);
  EXPECT_EQ(registry.plugins()[1].reasons.at(0).code, "E0208");
}

}  // namespace
}  // namespace kompono::plugin
