// SPDX-License-Identifier: Apache-2.0
// The gallery of broken layouts: layouts/bad/x.toml must be answered with layouts/bad/x.stderr, to
// the letter, when it is read or, if its text is good, when the machine is built. What was said
// instead is left in <build>/gallery, from where a reviewed text may be copied.
#include "shipped_registry.hpp"

#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "kompono/kinematics/machine.hpp"
#include "kompono/layout/codes.hpp"

namespace kompono::layout {
namespace {

namespace fs = std::filesystem;

/// With their code, unlike those of ShippedRegistry, which are sidecars in the source tree.
const plugin::Registry& BuiltRegistry() {
  static const plugin::Registry registry = [] {
    const fs::path folder = fs::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins";
    return plugin::Registry::Discover({&folder, 1});
  }();
  return registry;
}

Diagnostics ComplaintsOf(const std::string& file) {
  Parsed<Layout> layout = ReadLayout(file, ShippedRegistry());
  if (!layout) return layout.error();
  const auto machine = kinematics::Machine::Build(std::move(*layout), BuiltRegistry());
  return machine ? Diagnostics{} : machine.error();
}

std::string Answer(const std::string& file) {
  const Diagnostics complaints = ComplaintsOf(file);
  return complaints.empty() ? "" : RenderAll(complaints, {});
}

std::string Expected(const std::string& file) {
  return ReadText(fs::path(file).replace_extension(".stderr"));
}

testing::AssertionResult AnswersWith(const std::string& file, const std::string& expected) {
  const std::string answer = Answer(file);
  if (answer == expected && !answer.empty()) return testing::AssertionSuccess();
  const fs::path folder = fs::path(KOMPONO_BINARY_DIR) / "gallery";
  fs::create_directories(folder);
  const fs::path kept = folder / fs::path(file).filename().replace_extension(".stderr");
  std::ofstream(kept, std::ios::binary) << answer;
  return testing::AssertionFailure() << "expected:\n"
                                     << expected << "but " << kept << " says:\n"
                                     << answer;
}

class Gallery : public testing::TestWithParam<std::string> {};

TEST_P(Gallery, IsAnsweredToTheLetter) {
  EXPECT_TRUE(AnswersWith(GetParam(), Expected(GetParam())));
}

TEST_P(Gallery, SaysTheSameThroughJson) {
  const Diagnostics complaints = ComplaintsOf(GetParam());
  ASSERT_FALSE(complaints.empty());
  for (const Diagnostic& said : complaints) {
    EXPECT_EQ(said.file, GetParam());
    EXPECT_GE(said.span.line, 1) << said.message;
    EXPECT_GE(said.span.column, 1) << said.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Bad,
                         Gallery,
                         testing::ValuesIn(TomlFilesIn("layouts/bad")),
                         [](const auto& file) { return fs::path(file.param).stem().string(); });

TEST(GalleryOfBadLayouts, IsLargeAndShowsEveryCodeAFileCanBeBlamedWith) {
  const std::vector<std::string> files = TomlFilesIn("layouts/bad");
  EXPECT_GE(files.size(), 25U);
  std::string all;
  for (const std::string& file : files) all += Expected(file);
  // These speak of a replacement or of the file itself, or only of good files.
  const std::set<std::string_view> elsewhere{codes::kUnknownNumber.code,
                                             codes::kCannotWrite.code,
                                             codes::kCannotRead.code,
                                             codes::kOwnAxes.code,
                                             codes::kBlockFound.code};
  for (const CodeTitle& code : kCodes) {
    if (elsewhere.count(code.code) == 0) {
      EXPECT_NE(all.find(std::string("[") + std::string(code.code) + "]"), std::string::npos)
          << code.code << ' ' << code.title;
    }
  }
}

// The comparison itself is shown to notice a wrong letter, a missing line and a good file.
TEST(GalleryOfBadLayouts, NoticesADifference) {
  const std::string file = "layouts/bad/unknown_keys.toml";
  std::string expected = Expected(file);
  ASSERT_TRUE(AnswersWith(file, expected));
  expected[expected.size() / 2] ^= 1;
  EXPECT_FALSE(AnswersWith(file, expected));
  const std::string shorter = Expected(file).substr(0, expected.rfind('\n', expected.size() - 2));
  EXPECT_FALSE(AnswersWith(file, shorter));
  EXPECT_FALSE(AnswersWith("layouts/machines/knee_mill.toml", ""));
}

}  // namespace
}  // namespace kompono::layout
