// SPDX-License-Identifier: Apache-2.0
// Good libraries whose modules are bad: factories that fail, numbers that disagree, values that are
// none.
#include "plugin_folder.hpp"

#include <array>
#include <cmath>
#include <csignal>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/plugin/checked.hpp"
#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {
namespace {

std::string FactorySidecar(std::initializer_list<std::string_view> modules) {
  std::string text = R"(kompono = 1
id = "org.example.throws"
version = "0.1.0"
contract = "1.0"
library = "libthrows.so"
)";
  for (const std::string_view module : modules) {
    text += "[[module]]\nid = \"" + std::string(module) +
            "\"\nkind = \"mechanism\"\ntitle = \"t\"\nletters = \"X\"\n"
            "drives = [{ name = \"q\", kind = \"linear\" }]\n";
  }
  return text;
}

TEST(BadModule, FactoriesThatFailAreRefusedWithTheirReason) {
  const PluginFolder folder;
  folder.Add("throws",
             FactorySidecar({"throws", "throws_number", "raw", "raw_number", "nothing", "endless"}),
             "libthrows.so",
             "libthrows.so");
  const Registry registry = folder.Discover();
  const auto text = [&folder, &registry](std::string_view id) {
    const auto mechanism = registry.CreateMechanism(id);
    if (mechanism) return std::string("created");
    EXPECT_EQ(mechanism.error().code, "E0209");
    return folder.Plain(mechanism.error());
  };
  const std::string begin = "<plugins>/throws/libthrows.so: error: module '";
  EXPECT_EQ(text("throws"),
            begin + "throws' could not be created: the spindle tables are missing [E0209]\n");
  EXPECT_EQ(text("throws_number"),
            begin +
                "throws_number' could not be created: the constructor threw something that is "
                "no std::exception [E0209]\n");
  EXPECT_EQ(text("raw"), begin + "raw' could not be created: it threw: raw exception [E0209]\n");
  EXPECT_EQ(text("raw_number"),
            begin +
                "raw_number' could not be created: it threw something that is no "
                "std::exception [E0209]\n");
  EXPECT_EQ(text("nothing"),
            begin + "nothing' could not be created: the plugin gave no reason [E0209]\n");
  EXPECT_EQ(text("endless"),
            begin + "endless' could not be created: " + std::string(511, 'x') + " [E0209]\n")
      << "a reason without its end is cut";
}

TEST(BadModule, FactoryInPlainCMayRefuse) {
  const PluginFolder folder;
  folder.Add("dummy", kDummySidecar, "libmanifest.so", "libdummy.so");
  const auto mechanism = folder.Discover().CreateMechanism("dummy");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "<plugins>/dummy/libdummy.so: error: module 'dummy' could not be created: no licence "
            "for this machine [E0209]\n");
}

TEST(BadModule, EveryCountThatDisagreesWithTheSidecarIsNamed) {
  const PluginFolder folder;
  folder.Add("slide",
             std::string(kSlideSidecar) + std::string(kNoseModule),
             "libwrong_numbers.so",
             "libslide.so");
  Registry registry = folder.Discover();
  const auto mechanism = registry.CreateMechanism("slide");
  ASSERT_FALSE(mechanism);
  EXPECT_EQ(mechanism.error().code, "E0206");
  EXPECT_EQ(folder.Plain(mechanism.error()),
            "<plugins>/slide/libslide.so: error: the library and its plugin.toml disagree about "
            "module 'slide': 2 coordinates in the library, 1 in plugin.toml; 4 parameters in the "
            "library, 1 in plugin.toml; 1 modes in the library, 0 in plugin.toml; -1 points in the "
            "library, 0 in plugin.toml [E0206]\n"
            "  help: a point counts as three parameters; install library and plugin.toml of the "
            "same build\n");
  const auto unit = registry.CreateUnit("nose");
  ASSERT_FALSE(unit);
  EXPECT_EQ(folder.Plain(unit.error()),
            "<plugins>/slide/libslide.so: error: unit 'nose' says it has 0 states; one that does "
            "not move has 1 [E0206]\n");
  registry.LoadAll();
  ASSERT_EQ(registry.plugins().size(), 1U);
  EXPECT_FALSE(registry.plugins()[0].enabled);
  EXPECT_EQ(registry.plugins()[0].reasons.at(0).code, "E0206");
}

class NotANumber : public testing::Test {
 protected:
  void SetUp() override {
    folder_.Add("slide", kSlideSidecar, "libnot_a_number.so", "libslide.so");
    auto made = folder_.Discover().CreateMechanism("slide");
    ASSERT_TRUE(made) << folder_.Plain(made.error());
    mechanism_ = *made;
  }
  PluginFolder folder_;
  std::shared_ptr<const Mechanism> mechanism_;
  std::array<double, 1> x_{5.0}, q_{5.0}, theta_{1.0};
  const MechanismState state_{.coordinates = x_, .drives = q_, .parameters = theta_, .modes = {}};
};

TEST_F(NotANumber, PassesThroughTheBareInterface) {
  std::array<double, 12> pose{};
  EXPECT_EQ(mechanism_->Evaluate(Quantity::kPlatform, state_, {.values = pose}), Status::kOk);
  for (const double value : pose) EXPECT_TRUE(std::isnan(value));
}

TEST_F(NotANumber, IsRefusedByACheckedEvaluation) {
  std::array<double, 12> pose{};
  const auto refusal =
      EvaluateChecked(*mechanism_, "slide", Quantity::kPlatform, state_, {.values = pose});
  ASSERT_TRUE(refusal);
  EXPECT_EQ(Render(*refusal, {}),
            "error: module 'slide' gave something that is no finite number as value 1 of 12 of its "
            "platform [E0211]\n"
            "  help: check the parameters; if they are sound, the fault lies in the plugin\n");
}

TEST_F(NotANumber, IsAnAnswerWhereADriveCannotReach) {
  std::array<double, 1> drives{};
  EXPECT_FALSE(
      EvaluateChecked(*mechanism_, "slide", Quantity::kDrives, state_, {.values = drives}));
  EXPECT_TRUE(std::isnan(drives[0]));
  std::array<double, 1> by_parameters{};
  const auto refusal = EvaluateChecked(*mechanism_,
                                       "slide",
                                       Quantity::kDrives,
                                       state_,
                                       {.values = drives, .by_parameters = by_parameters});
  ASSERT_TRUE(refusal) << "infinite is never an answer";
  EXPECT_EQ(refusal->message,
            "module 'slide' gave something that is no finite number as value 1 of 1 of its drives "
            "derivatives by parameters");
}

TEST_F(NotANumber, FailedStatusIsRefusedByACheckedEvaluation) {
  std::array<double, 1> home{};
  const auto refusal =
      EvaluateChecked(*mechanism_, "slide", Quantity::kHome, state_, {.values = home});
  ASSERT_TRUE(refusal);
  EXPECT_EQ(Render(*refusal, {}),
            "error: module 'slide' failed to give its home: its code threw an exception [E0211]\n"
            "  help: the fault lies in the plugin\n");
}

TEST(BadModuleDeathTest, ThrowingStaticConstructorEndsTheChildAndIsNamed) {
  const PluginFolder folder;
  folder.Add("slide", kSlideSidecar, "libstatic_throw.so", "libslide.so");
  const Registry registry = folder.Discover();
  EXPECT_NE(registry.Find("slide"), nullptr) << "listing runs no plugin code";
  EXPECT_EXIT((void)registry.CreateMechanism("slide"),
              testing::KilledBySignal(SIGABRT),
              "the plugin library .*/slide/libslide.so ended the program while it was being "
              "opened; a static object of it threw.\n"
              "Move its folder out of the plugin folders");
}

}  // namespace
}  // namespace kompono::plugin
