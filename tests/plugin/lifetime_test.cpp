// SPDX-License-Identifier: Apache-2.0
// Libraries stay mapped as long as anything made from them lives, and no longer.
#include "plugin_folder.hpp"

#include <array>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {
namespace {

/// Asks the kernel, not the dynamic loader, whose books are what is being tested.
bool IsMapped(const std::filesystem::path& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.ends_with(library.string())) return true;
  }
  return false;
}

std::filesystem::path AddSlide(const PluginFolder& folder) {
  return folder.Add("slide",
                    std::string(kSlideSidecar) + std::string(kNoseModule),
                    "libslide.so",
                    "libslide.so") /
         "libslide.so";
}

double DriveOf(const Mechanism& slide) {
  const std::array<double, 1> x{7.0};
  const std::array<double, 1> theta{2.0};
  std::array<double, 1> q{};
  EXPECT_EQ(slide.Evaluate(Quantity::kDrives,
                           {.coordinates = x, .drives = {}, .parameters = theta, .modes = {}},
                           {.values = q}),
            Status::kOk);
  return q[0];
}

TEST(Lifetime, ListingMapsNothing) {
  const PluginFolder folder;
  const auto library = AddSlide(folder);
  const Registry registry = folder.Discover();
  EXPECT_EQ(registry.modules().size(), 2U);
  EXPECT_FALSE(IsMapped(library));
}

TEST(Lifetime, ModuleOutlivesItsRegistryAndTheLibraryGoesWithTheLastModule) {
  const PluginFolder folder;
  const auto library = AddSlide(folder);
  std::shared_ptr<const Mechanism> slide;
  std::shared_ptr<const Unit> nose;
  {
    const Registry registry = folder.Discover();
    slide = registry.CreateMechanism("slide").value();
    nose = registry.CreateUnit("nose").value();
  }
  EXPECT_TRUE(IsMapped(library));
  EXPECT_EQ(DriveOf(*slide), 5.0);
  slide.reset();
  EXPECT_TRUE(IsMapped(library)) << "the unit still needs it";
  std::array<double, 12> pose{};
  EXPECT_EQ(nose->StationPose(0, 0, {}, pose, {}), Status::kOk);
  EXPECT_EQ(pose[5], 1.0);
  nose.reset();
  EXPECT_FALSE(IsMapped(library));
}

TEST(Lifetime, RegistryKeepsWhatItOpened) {
  const PluginFolder folder;
  const auto library = AddSlide(folder);
  std::optional<Registry> registry(folder.Discover());
  registry->CreateMechanism("slide").value().reset();
  EXPECT_TRUE(IsMapped(library)) << "the next one need not open it again";
  registry.reset();
  EXPECT_FALSE(IsMapped(library));
}

TEST(Lifetime, RefusedLibraryIsNotKept) {
  const PluginFolder folder;
  const auto library =
      folder.Add("dummy", kDummySidecar, "libmagic.so", "libdummy.so") / "libdummy.so";
  std::optional<Registry> registry(folder.Discover());
  EXPECT_FALSE(registry->CreateMechanism("dummy"));
  EXPECT_FALSE(IsMapped(library));
}

TEST(Lifetime, ErrorOutlivesTheLibraryWhoseFactoryThrew) {
  const PluginFolder folder;
  const std::string sidecar = R"(kompono = 1
id = "org.example.throws"
version = "0.1.0"
contract = "1.0"
library = "libthrows.so"
)";
  std::string modules;
  for (const char* id : {"throws", "throws_number", "raw", "raw_number", "nothing", "endless"}) {
    modules += std::string("[[module]]\nid = \"") + id +
               "\"\nkind = \"mechanism\"\ntitle = \"t\"\nletters = \"X\"\n"
               "drives = [{ name = \"q\", kind = \"linear\" }]\n";
  }
  const auto library =
      folder.Add("throws", sidecar + modules, "libthrows.so", "libthrows.so") / "libthrows.so";
  std::optional<Diagnostic> error;
  {
    const Registry registry = folder.Discover();
    error = registry.CreateMechanism("raw").error();
  }
  EXPECT_FALSE(IsMapped(library));
  EXPECT_EQ(error->message, "module 'raw' could not be created: it threw: raw exception");
}

TEST(Lifetime, ManyThreadsOpenALibraryOnce) {
  const PluginFolder folder;
  AddSlide(folder);
  const Registry registry = folder.Discover();
  std::vector<std::shared_ptr<const Mechanism>> made(8);
  std::vector<std::thread> threads;
  for (auto& place : made) {
    threads.emplace_back([&registry, &place] {
      for (int i = 0; i < 50; ++i) place = registry.CreateMechanism("slide").value();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& slide : made) EXPECT_EQ(DriveOf(*slide), 5.0);
}

}  // namespace
}  // namespace kompono::plugin
