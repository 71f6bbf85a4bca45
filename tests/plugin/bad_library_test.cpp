// SPDX-License-Identifier: Apache-2.0
// Every way a library can be refused before one of its functions is called: which check refused, by
// code and by the whole text.
#include "plugin_folder.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {
namespace {

/// What is said when the plugin "dummy" is built from `library`.
std::string RefusalOf(std::string_view library, std::string_view code) {
  const PluginFolder folder;
  folder.Add("dummy", kDummySidecar, library, "libdummy.so");
  const Registry registry = folder.Discover();
  EXPECT_NE(registry.Find("dummy"), nullptr) << "listing needs no library";
  const auto mechanism = registry.CreateMechanism("dummy");
  if (mechanism) return "created";
  EXPECT_EQ(mechanism.error().code, code);
  return folder.Plain(mechanism.error());
}

TEST(BadLibrary, MissingFileIsNamed) {
  const PluginFolder folder;
  folder.Add("dummy", kDummySidecar);
  const auto mechanism = folder.Discover().CreateMechanism("dummy");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(mechanism.error().code, "E0201");
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "<plugins>/dummy/libdummy.so: error: the library cannot be opened: cannot open shared "
            "object file: No such file or directory [E0201]\n"
            "  help: build or install the plugin again, or move its folder out of the plugin "
            "folders\n");
}

TEST(BadLibrary, TextFileIsNoLibrary) {
  const PluginFolder folder;
  std::ofstream(folder.Add("dummy", kDummySidecar) / "libdummy.so")
      << "this is a text and no library, but it is long enough for the head of one\n";
  const auto mechanism = folder.Discover().CreateMechanism("dummy");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(mechanism.error().code, "E0201");
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "<plugins>/dummy/libdummy.so: error: the library cannot be opened: invalid ELF header "
            "[E0201]\n"
            "  help: build or install the plugin again, or move its folder out of the plugin "
            "folders\n");
}

TEST(BadLibrary, FolderIsNoLibrary) {
  const PluginFolder folder;
  std::filesystem::create_directory(folder.Add("dummy", kDummySidecar) / "libdummy.so");
  const auto mechanism = folder.Discover().CreateMechanism("dummy");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(mechanism.error().code, "E0201");
  EXPECT_THAT(mechanism.error().message, testing::EndsWith("cannot be opened: it is not a file"));
}

TEST(BadLibrary, TruncatedLibraryIsRefusedBeforeTheLoaderTouchesIt) {
  const auto size = static_cast<std::uintmax_t>(file_size(Fixture("libslide.so")));
  int refused = 0;
  for (std::uintmax_t part = 1; part < 32; ++part) {
    const PluginFolder folder;
    const auto library = folder.Add("slide",
                                    std::string(kSlideSidecar) + std::string(kNoseModule),
                                    "libslide.so",
                                    "libslide.so") /
                         "libslide.so";
    std::filesystem::resize_file(library, size * part / 32);
    const auto mechanism = folder.Discover().CreateMechanism("slide");
    if (mechanism) continue;  // only debug information or the section table is gone
    ++refused;
    EXPECT_EQ(mechanism.error().code, "E0201");
    EXPECT_THAT(mechanism.error().message,
                testing::MatchesRegex("the library cannot be opened: the file is cut off: it has "
                                      "[0-9]+ bytes of at least [0-9]+"));
  }
  EXPECT_GT(refused, 0);
}

TEST(BadLibrary, StumpShorterThanItsHeadIsRefusedInTheSystemsWords) {
  const PluginFolder folder;
  const auto library =
      folder.Add("dummy", kDummySidecar, "libmanifest.so", "libdummy.so") / "libdummy.so";
  std::filesystem::resize_file(library, 20);
  const auto mechanism = folder.Discover().CreateMechanism("dummy");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(mechanism.error().code, "E0201");
  EXPECT_EQ(mechanism.error().message, "the library cannot be opened: file too short");
}

TEST(BadLibrary, UnresolvedSymbolIsFoundOnOpeningAndNotOnFirstUse) {
  EXPECT_EQ(RefusalOf("libunresolved.so", "E0201"),
            "<plugins>/dummy/libdummy.so: error: the library cannot be opened: undefined symbol: "
            "kompono_test_nobody_defines_this [E0201]\n"
            "  help: build or install the plugin again, or move its folder out of the plugin "
            "folders\n");
}

TEST(BadLibrary, LibraryWithoutTheSymbolIsNoPlugin) {
  EXPECT_EQ(RefusalOf("libempty.so", "E0202"),
            "<plugins>/dummy/libdummy.so: error: the library has no symbol 'kompono_plugin' "
            "[E0202]\n"
            "  help: make it with KOMPONO_PLUGIN of the SDK\n");
}

TEST(BadLibrary, WrongMagicIsNoPlugin) {
  EXPECT_EQ(RefusalOf("libmagic.so", "E0202"),
            "<plugins>/dummy/libdummy.so: error: the library's symbol 'kompono_plugin' is no "
            "manifest: it begins with 0x0000000000001234 instead of 0x314e47504f504d4b [E0202]\n"
            "  help: make it with KOMPONO_PLUGIN of the SDK\n");
}

TEST(BadLibrary, NewerContractIsTooNew) {
  EXPECT_EQ(RefusalOf("libcontract_major_newer.so", "E0203"),
            "<plugins>/dummy/libdummy.so: error: the plugin needs contract 2.0, this kompono "
            "offers 1.0 [E0203]\n"
            "  help: install a newer kompono, or a build of the plugin for this one\n");
  EXPECT_EQ(RefusalOf("libcontract_minor_newer.so", "E0203"),
            "<plugins>/dummy/libdummy.so: error: the plugin needs contract 1.7, this kompono "
            "offers 1.0 [E0203]\n"
            "  help: install a newer kompono, or a build of the plugin for this one\n");
}

TEST(BadLibrary, OlderContractIsTooOld) {
  EXPECT_EQ(RefusalOf("libcontract_older.so", "E0204"),
            "<plugins>/dummy/libdummy.so: error: the plugin needs contract 0.0, this kompono "
            "offers 1.0 [E0204]\n"
            "  help: build the plugin again with the SDK of this kompono\n");
}

TEST(BadLibrary, OtherSizeOfTheManifestIsAnotherToolchain) {
  EXPECT_EQ(RefusalOf("libstruct_size.so", "E0205"),
            "<plugins>/dummy/libdummy.so: error: the library's manifest is 80 bytes long, contract "
            "1.0 has 72 [E0205]\n"
            "  help: build the plugin with the settings this kompono was built with\n");
  EXPECT_EQ(
      RefusalOf("libstruct_size_tiny.so", "E0202"),
      "<plugins>/dummy/libdummy.so: error: the library's manifest is damaged: it says it is 4 "
      "bytes long [E0202]\n"
      "  help: make it with KOMPONO_PLUGIN of the SDK\n");
}

TEST(BadLibrary, EveryDifferenceOfTheToolchainIsNamed) {
  EXPECT_EQ(RefusalOf("libtoolchain.so", "E0205"),
            "<plugins>/dummy/libdummy.so: error: the library was built with other settings: bytes "
            "of a pointer is 4 in the library and 8 here; _GLIBCXX_USE_CXX11_ABI is 0 in the "
            "library and 1 here; _GLIBCXX_DEBUG is 1 in the library and 0 here [E0205]\n"
            "  help: build the plugin with the settings this kompono was built with\n");
}

TEST(BadLibrary, DamagedTableOfModulesIsNoPlugin) {
  EXPECT_EQ(RefusalOf("libno_modules.so", "E0202"),
            "<plugins>/dummy/libdummy.so: error: the library's manifest is damaged: a table of 0 "
            "modules [E0202]\n"
            "  help: make it with KOMPONO_PLUGIN of the SDK\n");
  EXPECT_EQ(RefusalOf("libno_factory.so", "E0202"),
            "<plugins>/dummy/libdummy.so: error: the library's manifest is damaged: module 1 of 1 "
            "is not filled in [E0202]\n"
            "  help: make it with KOMPONO_PLUGIN of the SDK\n");
}

TEST(BadLibrary, EverythingInWhichTheSidecarDisagreesIsNamed) {
  EXPECT_EQ(RefusalOf("libother_words.so", "E0206"),
            "<plugins>/dummy/libdummy.so: error: the library and its plugin.toml disagree: the id "
            "is 'org.example.other' in the library and 'org.example.dummy' in plugin.toml; the "
            "version is '9.9.9' in the library and '0.1.0' in plugin.toml; module 'dummy' is only "
            "in plugin.toml; module 'dumy' is only in the library [E0206]\n"
            "  help: install library and plugin.toml of the same build\n");
}

TEST(BadLibrary, MissingIdDisagreesToo) {
  EXPECT_EQ(RefusalOf("libother_id_only.so", "E0206"),
            "<plugins>/dummy/libdummy.so: error: the library and its plugin.toml disagree: the id "
            "is '(nothing)' in the library and 'org.example.dummy' in plugin.toml [E0206]\n"
            "  help: install library and plugin.toml of the same build\n");
}

TEST(BadLibrary, OtherInterfaceDisagreesWithTheSidecar) {
  EXPECT_EQ(RefusalOf("libother_interface.so", "E0206"),
            "<plugins>/dummy/libdummy.so: error: the library and its plugin.toml disagree: the "
            "interface of 'dummy' is 'kompono.mechanism/2' in the library and "
            "'kompono.mechanism/1' in plugin.toml [E0206]\n"
            "  help: install library and plugin.toml of the same build\n");
}

TEST(BadLibrary, LoadAllListsItAsDisabledWithTheReason) {
  const PluginFolder folder;
  folder.Add("dummy", kDummySidecar, "libmagic.so", "libdummy.so");
  folder.Add(
      "slide", std::string(kSlideSidecar) + std::string(kNoseModule), "libslide.so", "libslide.so");
  Registry registry = folder.Discover();
  ASSERT_EQ(registry.plugins().size(), 2U);
  EXPECT_TRUE(registry.plugins()[0].enabled) << "not yet opened";
  registry.LoadAll();
  EXPECT_FALSE(registry.plugins()[0].enabled);
  ASSERT_EQ(registry.plugins()[0].reasons.size(), 1U);
  EXPECT_EQ(registry.plugins()[0].reasons[0].code, "E0202");
  EXPECT_TRUE(registry.plugins()[1].enabled);
  EXPECT_FALSE(registry.plugins()[1].compiler.empty());
  EXPECT_EQ(registry.Find("dummy"), nullptr);
  EXPECT_TRUE(registry.CreateMechanism("slide"));

  const auto mechanism = registry.CreateMechanism("dummy");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "error: unknown module 'dummy' [E0208]\n"
            "  help: plugin 'org.example.dummy' (<plugins>/dummy/plugin.toml) would offer it, but "
            "is disabled: the library's symbol 'kompono_plugin' is no manifest: it begins with "
            "0x0000000000001234 instead of 0x314e47504f504d4b [E0202]\n");
}

}  // namespace
}  // namespace kompono::plugin
