// SPDX-License-Identifier: Apache-2.0
#include "codes.hpp"

#include "exit_code.hpp"

#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::cli {
namespace {

using testing::HasSubstr;

std::string Commands() {
  std::ifstream in(KOMPONO_SOURCE_DIR "/docs/commands.md", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Codes, AscendAndStandInTheDocumentation) {
  const std::string text = Commands();
  for (std::size_t i = 0; i < kCodes.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(kCodes[i - 1].code, kCodes[i].code);
    }
    EXPECT_THAT(text,
                HasSubstr("| " + std::string(kCodes[i].code) + " | " +
                          std::string(kCodes[i].title) + " |"));
  }
}

TEST(ExitCodes, StandInTheDocumentation) {
  const std::string text = Commands();
  for (const ExitCodeMeaning& entry : kExitCodes) {
    EXPECT_THAT(text,
                HasSubstr("| " + std::to_string(static_cast<int>(entry.code)) + " | " +
                          std::string(entry.meaning) + " |"));
  }
}

TEST(ExitCodes, FollowFromTheWorstError) {
  const auto of = [](const std::vector<std::string>& codes) {
    Diagnostics diagnostics;
    for (const std::string& code : codes) {
      diagnostics.push_back(
          {.severity = code.front() == 'E' ? Severity::kError : Severity::kNote, .code = code});
    }
    return ExitCodeOf(diagnostics);
  };
  EXPECT_EQ(of({"E0304"}), ExitCode::kBadInput);
  EXPECT_EQ(of({"E0604"}), ExitCode::kUsage);
  EXPECT_EQ(of({"E0610"}), ExitCode::kBadInput);
  EXPECT_EQ(of({"E0615"}), ExitCode::kInputOutput);
  EXPECT_EQ(of({"E0333"}), ExitCode::kInputOutput);
  EXPECT_EQ(of({"N0101", "E0512"}), ExitCode::kNegative);
  EXPECT_EQ(of({"E0604", "E0304", "E0401"}), ExitCode::kInputOutput);
  EXPECT_EQ(of({"E9999"}), ExitCode::kBadInput);
}

}  // namespace
}  // namespace kompono::cli
