// SPDX-License-Identifier: Apache-2.0
// One real plugin, built three times: like the host, by another compiler, and for wider registers.
// Only doubles cross the boundary, so the host runs all three and they agree.
#include "plugin_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include "kompono/plugin/checked.hpp"
#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {
namespace {

/// A plugin folder with the pyramid's own sidecar and one of the three libraries.
class Build {
 public:
  explicit Build(std::string_view library) {
    std::ifstream sidecar(KOMPONO_SOURCE_DIR "/plugins/pyramid/plugin.toml");
    const std::string text{std::istreambuf_iterator<char>(sidecar), {}};
    folder_.Add("pyramid", text, library, "libpyramid.so");
  }
  [[nodiscard]] Registry Discover() const { return folder_.Discover(); }

 private:
  PluginFolder folder_;
};

bool ThisProcessorRunsTheWideBuild() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return true;
#endif
}

/// Three upright rails on a circle, struts of 500 mm.
std::vector<double> Parameters(const ModuleDescription& module) {
  std::vector<double> theta;
  for (const ParameterDescription& parameter : module.parameters) {
    std::vector<double> values = parameter.default_value;
    if (parameter.name == "radius") values = {250.0};
    if (parameter.name == "inclination") values = {80.0, 85.0, 90.0};
    if (parameter.name == "strut") values = {500.0, 510.0, 520.0};
    for (const double value : values) theta.push_back(value * parameter.ToInternal());
  }
  return theta;
}

struct Answers {
  std::vector<double> drives, by_coordinates, by_parameters, batch;
};

Answers Ask(const Registry& registry) {
  const ModuleDescription* module = registry.Find("pyramid_by_angle");
  EXPECT_NE(module, nullptr);
  const auto made = registry.CreateMechanism("pyramid_by_angle");
  EXPECT_TRUE(made) << made.error().message;
  Answers answers;
  if (module == nullptr || !made) return answers;
  const std::vector<double> theta = Parameters(*module);
  const std::vector<double> modes(module->modes.size(), 1.0);
  const std::array<double, 3> x{12.0, -34.0, 56.0};
  answers.drives.resize(3);
  answers.by_coordinates.resize(9);
  answers.by_parameters.resize(3 * theta.size());
  const auto refusal =
      EvaluateChecked(**made,
                      module->id,
                      Quantity::kDrives,
                      {.coordinates = x, .drives = {}, .parameters = theta, .modes = modes},
                      {.values = answers.drives,
                       .by_coordinates = answers.by_coordinates,
                       .by_drives = {},
                       .by_parameters = answers.by_parameters});
  EXPECT_FALSE(refusal) << refusal->message;

  // Thirteen poses: a full pack of any width and a rest.
  constexpr std::size_t kPoses = 13;
  std::array<std::vector<double>, 3> columns;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < kPoses; ++k)
      columns[i].push_back(10.0 * static_cast<double>(k) - 20.0 * static_cast<double>(i));
  }
  answers.batch.resize(3 * kPoses);
  const std::array<const double*, 3> in{columns[0].data(), columns[1].data(), columns[2].data()};
  const std::array<double*, 3> out{
      answers.batch.data(), answers.batch.data() + kPoses, answers.batch.data() + 2 * kPoses};
  EXPECT_EQ((*made)->EvaluateBatch(Quantity::kDrives,
                                   {.count = kPoses,
                                    .coordinates = in.data(),
                                    .parameters = theta,
                                    .modes = modes,
                                    .values = out.data()}),
            Status::kOk);
  return answers;
}

void ExpectSame(const std::vector<double>& expected, const std::vector<double>& got) {
  ASSERT_EQ(expected.size(), got.size());
  ASSERT_FALSE(expected.empty());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(std::isfinite(expected[i]));
    // Both round differently (fused operations), nothing more.
    EXPECT_NEAR(got[i], expected[i], 1e-11 * std::max(1.0, std::abs(expected[i]))) << i;
  }
}

void ExpectSame(const Answers& expected, const Answers& got) {
  ExpectSame(expected.drives, got.drives);
  ExpectSame(expected.by_coordinates, got.by_coordinates);
  ExpectSame(expected.by_parameters, got.by_parameters);
  ExpectSame(expected.batch, got.batch);
}

TEST(Boundary, PluginOfAnotherCompilerGivesTheSameNumbers) {
  const Build plain("libpyramid_plain.so");
  const Build clang("libpyramid_clang.so");
  Registry registry = clang.Discover();
  ExpectSame(Ask(plain.Discover()), Ask(registry));
  registry.LoadAll();
  EXPECT_THAT(registry.plugins()[0].compiler, testing::HasSubstr("Clang"));
}

TEST(Boundary, PluginForWiderRegistersGivesTheSameNumbers) {
  const Build plain("libpyramid_plain.so");
  const Build wide("libpyramid_wide.so");
  Registry registry = wide.Discover();
  ASSERT_NE(registry.Find("pyramid_by_angle"), nullptr);
  if (ThisProcessorRunsTheWideBuild()) {
    ExpectSame(Ask(plain.Discover()), Ask(registry));
  } else {
    // Its instructions cannot run here; opening it and judging its manifest runs none of them.
    const auto refused = registry.CreateMechanism("no_such_module");
    ASSERT_FALSE(refused);
    EXPECT_GT(std::filesystem::file_size(Fixture("libpyramid_wide.so")), 0U);
    EXPECT_TRUE(registry.plugins()[0].enabled);
  }
}

TEST(Boundary, MatcherNoticesAWrongNumber) {
  const Build plain("libpyramid_plain.so");
  const Answers answers = Ask(plain.Discover());
  Answers wrong = answers;
  wrong.batch[5] *= 1.0 + 1e-9;
  EXPECT_NONFATAL_FAILURE(ExpectSame(answers.batch, wrong.batch), "");
}

/// The variable for one test.
class LevelAllowed {
 public:
  explicit LevelAllowed(const char* level) { setenv("KOMPONO_X86_LEVEL", level, 1); }
  LevelAllowed(const LevelAllowed&) = delete;
  LevelAllowed& operator=(const LevelAllowed&) = delete;
  ~LevelAllowed() { unsetenv("KOMPONO_X86_LEVEL"); }
};

TEST(ProcessorLevel, TheBuildForTheBestLevelThatRunsIsOpened) {
  const PluginFolder folder;
  const std::string sidecar = std::string(kSlideSidecar).append(kNoseModule);
  const std::filesystem::path better =
      folder.Add("slide", sidecar, "libslide.so", "libslide.so") / "x86-64-v3";
  std::filesystem::create_directory(better);
  std::ofstream(better / "libslide.so") << "no library, so that opening it is noticed";
  {
    const LevelAllowed none("x86-64");
    EXPECT_TRUE(folder.Discover().CreateMechanism("slide"))
        << "the variable forbids the better one";
  }
  const LevelAllowed wide("x86-64-v3");
  const auto made = folder.Discover().CreateMechanism("slide");
  EXPECT_EQ(made.has_value(), !ThisProcessorRunsTheWideBuild());
  if (!made) {
    EXPECT_THAT(made.error().file, testing::EndsWith("slide/x86-64-v3/libslide.so"));
  }
}

}  // namespace
}  // namespace kompono::plugin
