// SPDX-License-Identifier: Apache-2.0
#include "kompono/plugin/registry.hpp"

#include "plugin_folder.hpp"
#include <stdlib.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::plugin {
namespace {

namespace fs = std::filesystem;

void AddSlide(const PluginFolder& folder) {
  folder.Add(
      "slide", std::string(kSlideSidecar) + std::string(kNoseModule), "libslide.so", "libslide.so");
}

/// Sets an environment variable for the length of one test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { unsetenv(name_); }

 private:
  const char* name_;
};

TEST(PluginFolders, GivenOnesThenTheVariableThenBesideTheProgram) {
  const Variable variable("KOMPONO_PLUGIN_PATH", "/opt/first::/opt/second:");
  const std::array<fs::path, 2> given{"mine", "yours"};
  const std::vector<fs::path> folders = PluginFolders(given);
  ASSERT_EQ(folders.size(), 5U);
  EXPECT_EQ(folders[0], "mine");
  EXPECT_EQ(folders[1], "yours");
  EXPECT_EQ(folders[2], "/opt/first");
  EXPECT_EQ(folders[3], "/opt/second");
  const fs::path program = fs::read_symlink("/proc/self/exe");
  EXPECT_EQ(folders[4].parent_path().parent_path(),
            program.parent_path().parent_path() / KOMPONO_LIBRARY_FOLDER);
  EXPECT_EQ(folders[4].filename(), "plugins");
}

TEST(PluginFolders, WithoutTheVariableOnlyGivenOnesAndBesideTheProgram) {
  EXPECT_EQ(PluginFolders({}).size(), 1U);
}

TEST(Registry, DescribesModulesWithoutOpeningTheirLibrary) {
  const PluginFolder folder;
  folder.Add("slide", std::string(kSlideSidecar) + std::string(kNoseModule));  // no library there
  const Registry registry = folder.Discover();
  ASSERT_EQ(registry.plugins().size(), 1U);
  EXPECT_TRUE(registry.plugins()[0].enabled);
  ASSERT_EQ(registry.modules().size(), 2U);
  const ModuleDescription* slide = registry.Find("slide");
  ASSERT_NE(slide, nullptr);
  EXPECT_EQ(slide->plugin_id, "org.example.slide");
  EXPECT_EQ(slide->plugin_version, "0.1.0");
  EXPECT_EQ(slide->implementation, "slide");
  EXPECT_EQ(slide->ParameterNumbers(), 1);
  EXPECT_EQ(registry.Find("slid"), nullptr);
  EXPECT_THAT(registry.ModuleIds(ModuleKind::kMechanism), testing::ElementsAre("slide"));
  EXPECT_THAT(registry.ModuleIds(ModuleKind::kUnit), testing::ElementsAre("nose"));
}

TEST(Registry, CreatesMechanismsAndUnits) {
  const PluginFolder folder;
  AddSlide(folder);
  const Registry registry = folder.Discover();
  const auto slide = registry.CreateMechanism("slide");
  ASSERT_TRUE(slide) << slide.error().message;
  EXPECT_EQ((*slide)->Shape().coordinates, 1);
  const auto nose = registry.CreateUnit("nose");
  ASSERT_TRUE(nose) << nose.error().message;
  EXPECT_EQ((*nose)->Shape().stations, 1);
}

TEST(Registry, PluginsComeByNameWhateverTheDiskSays) {
  const PluginFolder folder;
  for (const char* name : {"delta", "alpha", "charlie", "bravo"}) {
    folder.Add(name,
               std::string("kompono = 1\nid = \"org.example.") + name +
                   "\"\nversion = \"0.1.0\"\ncontract = \"1.0\"\nlibrary = \"lib.so\"\n"
                   "[[module]]\nid = \"" +
                   name + "\"\nkind = \"unit\"\ntitle = \"t\"\nstations = [\"s\"]\n");
  }
  const Registry registry = folder.Discover();
  std::vector<std::string> ids;
  for (const PluginRecord& record : registry.plugins()) ids.push_back(record.description.id);
  EXPECT_THAT(
      ids,
      testing::ElementsAre(
          "org.example.alpha", "org.example.bravo", "org.example.charlie", "org.example.delta"));
  EXPECT_THAT(registry.ModuleIds(ModuleKind::kUnit),
              testing::ElementsAre("alpha", "bravo", "charlie", "delta"));
}

TEST(Registry, FolderThatIsItselfAPluginIsRead) {
  const PluginFolder folder;
  AddSlide(folder);
  const std::array<fs::path, 1> folders{folder.root() / "slide"};
  EXPECT_NE(Registry::Discover(folders).Find("slide"), nullptr);
}

TEST(Registry, FoldersThatDoNotExistArePassedOver) {
  const PluginFolder folder;
  AddSlide(folder);
  std::ofstream(folder.root() / "README") << "not a plugin\n";
  fs::create_directory(folder.root() / "empty");
  fs::create_directories(folder.root() / "odd" / "plugin.toml");
  const std::array<fs::path, 2> folders{folder.root() / "nowhere", folder.root()};
  const Registry registry = Registry::Discover(folders);
  ASSERT_EQ(registry.plugins().size(), 2U);
  EXPECT_EQ(folder.Plain(registry.plugins()[0].reasons),
            "<plugins>/odd/plugin.toml: error: this file cannot be read: it is not a file [E0220]\n"
            "1 error\n");
  EXPECT_EQ(registry.plugins()[0].description.id, "odd") << "named by its folder";
  EXPECT_TRUE(registry.plugins()[1].enabled);
}

TEST(Registry, EverythingShippedLoadsAndAgreesWithItsSidecars) {
  const std::array<fs::path, 1> folders{fs::path(KOMPONO_BINARY_DIR) / "lib" / "kompono" /
                                        "plugins"};
  Registry registry = Registry::Discover(folders);
  registry.LoadAll();
  EXPECT_GE(registry.plugins().size(), 6U);
  for (const PluginRecord& record : registry.plugins())
    EXPECT_TRUE(record.enabled) << RenderAll(record.reasons, {});
}

TEST(Registry, ReadsAHundredSidecarsInAMoment) {
  const PluginFolder folder;
  std::ifstream file(KOMPONO_SOURCE_DIR "/plugins/pyramid/plugin.toml");
  const std::string pyramid{std::istreambuf_iterator<char>(file), {}};
  for (int i = 0; i < 100; ++i) {
    std::string text = pyramid;
    for (const std::string word : {"pyramid_by_angle\"",
                                   "\"pyramid\"",
                                   "linear_delta",
                                   "triglide",
                                   "v100_head",
                                   "org.kompono.pyramid"}) {
      const bool quoted = word.back() == '"';
      const std::string renamed = (quoted ? word.substr(0, word.size() - 1) : word) + "_" +
                                  std::to_string(i) + (quoted ? "\"" : "");
      for (std::size_t at = text.find(word); at != std::string::npos;
           at = text.find(word, at + renamed.size()))
        text.replace(at, word.size(), renamed);
    }
    folder.Add("plugin" + std::to_string(i), text);
  }
  const auto begin = std::chrono::steady_clock::now();
  const Registry registry = folder.Discover();
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  for (const PluginRecord& record : registry.plugins())
    ASSERT_TRUE(record.enabled) << RenderAll(record.reasons, {});
  EXPECT_EQ(registry.modules().size(), 500U);
  RecordProperty("milliseconds", std::to_string(taken.count()));
  std::printf("100 sidecars, 500 modules: %.1f ms\n", taken.count());
  EXPECT_LT(taken.count(), 5000.0) << "also in a build with sanitizers";
}

}  // namespace
}  // namespace kompono::plugin
