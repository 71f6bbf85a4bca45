// SPDX-License-Identifier: Apache-2.0
// Plugins refused for where they are or for what stands beside them.
#include "plugin_folder.hpp"

#include <array>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {
namespace {

namespace fs = std::filesystem;

std::string WholeSlideSidecar() {
  return std::string(kSlideSidecar) + std::string(kNoseModule);
}

fs::path AddSlide(const PluginFolder& folder) {
  return folder.Add("slide", WholeSlideSidecar(), "libslide.so", "libslide.so");
}

void LetEveryoneWrite(const fs::path& path) {
  fs::permissions(path, fs::perms::others_write, fs::perm_options::add);
}

void ExpectDisabled(const PluginFolder& folder, const std::string& writable) {
  const Registry registry = folder.Discover();
  ASSERT_EQ(registry.plugins().size(), 1U);
  const PluginRecord& record = registry.plugins()[0];
  EXPECT_FALSE(record.enabled);
  EXPECT_EQ(record.description.id, "org.example.slide") << "it is listed under its name";
  ASSERT_FALSE(record.reasons.empty());
  EXPECT_EQ(record.reasons[0].code, "E0210");
  EXPECT_EQ(folder.Plain(record.reasons[0].message), "everyone may write to '" + writable + "'");
  EXPECT_EQ(folder.Plain(record.reasons[0].help),
            "plugins run as part of this program; take the right away with: chmod o-w '" +
                writable + "'");
  EXPECT_EQ(registry.Find("slide"), nullptr);
  const auto mechanism = registry.CreateMechanism("slide");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(mechanism.error().code, "E0208");
  EXPECT_THAT(mechanism.error().help, testing::HasSubstr("is disabled: everyone may write to"));
}

TEST(UnsafePath, FolderOfThePluginWritableForEveryone) {
  const PluginFolder folder;
  LetEveryoneWrite(AddSlide(folder));
  ExpectDisabled(folder, "<plugins>/slide");
}

TEST(UnsafePath, FolderOfFoldersWritableForEveryone) {
  const PluginFolder folder;
  AddSlide(folder);
  LetEveryoneWrite(folder.root());
  ExpectDisabled(folder, "<plugins>");
}

TEST(UnsafePath, StickyBitDoesNotHelp) {
  const PluginFolder folder;
  AddSlide(folder);
  LetEveryoneWrite(folder.root());
  fs::permissions(folder.root(), fs::perms::sticky_bit, fs::perm_options::add);
  ExpectDisabled(folder, "<plugins>");
}

TEST(UnsafePath, FolderNamedItselfIsJudgedWithoutItsNeighbours) {
  const PluginFolder folder;
  const std::array<fs::path, 1> slide{AddSlide(folder)};
  LetEveryoneWrite(folder.root());
  EXPECT_TRUE(Registry::Discover(slide).CreateMechanism("slide"));
}

TEST(UnsafePath, SidecarWritableForEveryone) {
  const PluginFolder folder;
  LetEveryoneWrite(AddSlide(folder) / "plugin.toml");
  ExpectDisabled(folder, "<plugins>/slide/plugin.toml");
}

TEST(UnsafePath, LibraryWritableForEveryoneIsNotOpened) {
  const PluginFolder folder;
  LetEveryoneWrite(AddSlide(folder) / "libslide.so");
  const auto mechanism = folder.Discover().CreateMechanism("slide");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "<plugins>/slide/libslide.so: error: everyone may write to "
            "'<plugins>/slide/libslide.so' [E0210]\n"
            "  help: plugins run as part of this program; take the right away with: chmod o-w "
            "'<plugins>/slide/libslide.so'\n");
}

TEST(UnsafePath, LinkIsJudgedByWhereItLeads) {
  const PluginFolder folder;
  const fs::path library = AddSlide(folder) / "libslide.so";
  fs::create_directory(folder.root() / "open");
  fs::rename(library, folder.root() / "open" / "real.so");
  fs::create_symlink(folder.root() / "open" / "real.so", library);
  EXPECT_TRUE(folder.Discover().CreateMechanism("slide")) << "a link as such is no harm";
  LetEveryoneWrite(folder.root() / "open");
  const auto mechanism = folder.Discover().CreateMechanism("slide");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(mechanism.error().code, "E0210");
  EXPECT_EQ(folder.Plain(mechanism.error().message), "everyone may write to '<plugins>/open'");
}

TEST(DuplicateId, FirstPluginInTheOrderOfTheSearchIsUsed) {
  const PluginFolder first;
  const PluginFolder second;
  AddSlide(first);
  AddSlide(second);
  const std::array<fs::path, 3> order{second.root(), first.root(), second.root()};
  const Registry registry = Registry::Discover(order);
  ASSERT_EQ(registry.plugins().size(), 2U) << "a folder named twice is read once";
  EXPECT_TRUE(registry.plugins()[0].enabled);
  EXPECT_EQ(registry.plugins()[0].description.sidecar, second.root() / "slide" / "plugin.toml");
  EXPECT_FALSE(registry.plugins()[1].enabled);
  EXPECT_EQ(first.Plain(second.Plain(registry.plugins()[1].reasons)),
            "<plugins>/slide/plugin.toml: error: plugin 'org.example.slide' was already found as "
            "<plugins>/slide/plugin.toml [E0207]\n"
            "  help: the first in the order of the search is used\n"
            "1 error\n");
  EXPECT_TRUE(registry.CreateMechanism("slide"));
}

TEST(DuplicateId, ModuleOfAnotherPlugin) {
  const PluginFolder folder;
  AddSlide(folder);
  folder.Add("taker", R"(kompono = 1
id = "org.example.taker"
version = "0.1.0"
contract = "1.0"
library = "libtaker.so"
[[module]]
id = "nose"
kind = "unit"
title = "Another nose"
stations = ["nose"]
)");
  const Registry registry = folder.Discover();
  ASSERT_EQ(registry.plugins().size(), 2U);
  EXPECT_TRUE(registry.plugins()[0].enabled);
  EXPECT_FALSE(registry.plugins()[1].enabled);
  EXPECT_EQ(folder.Plain(registry.plugins()[1].reasons),
            "<plugins>/taker/plugin.toml: error: module 'nose' is already offered by plugin "
            "'org.example.slide' (<plugins>/slide/plugin.toml) [E0207]\n"
            "  help: rename the module, or leave one of the two plugins out\n"
            "1 error\n");
}

TEST(UnknownModule, NearestKnownOneIsSuggested) {
  const PluginFolder folder;
  AddSlide(folder);
  const auto mechanism = folder.Discover().CreateMechanism("slite");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(Render(mechanism.error(), {}),
            "error: unknown module 'slite' [E0208]\n  help: did you mean 'slide'?\n");
  const auto far = folder.Discover().CreateMechanism("telescope");
  ASSERT_FALSE(far);
  EXPECT_EQ(Render(far.error(), {}),
            "error: unknown module 'telescope' [E0208]\n  help: known are: nose, slide\n");
}

TEST(UnknownModule, UnitIsNoMechanism) {
  const PluginFolder folder;
  AddSlide(folder);
  const Registry registry = folder.Discover();
  const auto mechanism = registry.CreateMechanism("nose");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(Render(mechanism.error(), {}),
            "error: module 'nose' is a unit, not a mechanism [E0208]\n"
            "  help: known are: slide\n");
  const auto unit = registry.CreateUnit("slide");
  ASSERT_FALSE(unit);
  EXPECT_EQ(unit.error().message, "module 'slide' is a mechanism, not a unit");
}

TEST(UnknownModule, NothingFoundSaysWhereItLooked) {
  const PluginFolder folder;
  const auto mechanism = folder.Discover().CreateMechanism("slide");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "error: unknown module 'slide' [E0208]\n"
            "  help: no plugin was found in: <plugins>; name a folder with --plugin-dir or "
            "KOMPONO_PLUGIN_PATH\n");
}

TEST(UnknownModule, BrokenSidecarIsNamedAsTheReason) {
  const PluginFolder folder;
  folder.Add("slide", WholeSlideSidecar() + "titel = \"no such key\"\n");
  const auto mechanism = folder.Discover().CreateMechanism("slide");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "error: unknown module 'slide' [E0208]\n"
            "  help: plugin 'org.example.slide' (<plugins>/slide/plugin.toml) would offer it, but "
            "is disabled: unknown key 'titel' in module 'nose' [E0221]\n");
}

}  // namespace
}  // namespace kompono::plugin
