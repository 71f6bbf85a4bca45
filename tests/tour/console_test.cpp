// SPDX-License-Identifier: Apache-2.0
// The reader and the comparison behind the tour must themselves be able to find fault.
#include "console.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::tour {
namespace {

using testing::ElementsAre;

TEST(Document, KnowsCommandsAndWhatFollowsThem) {
  const Document document = ReadDocument(
      "# Title\n"
      "```sh\n"
      "$ not a console block\n"
      "```\n"
      "```console\n"
      "$ first\n"
      "one\n"
      "\n"
      "two\n"
      "$ second \\\n"
      "    --long\n"
      "```\n"
      "$ neither is this\n");
  ASSERT_EQ(document.steps.size(), 2U);
  EXPECT_EQ(document.steps[0].command, "first");
  EXPECT_EQ(document.steps[0].line, 6U);
  EXPECT_THAT(document.steps[0].expected, ElementsAre("one", "", "two"));
  EXPECT_EQ(document.steps[1].command, "second \\\n    --long");
  EXPECT_THAT(document.steps[1].expected, ElementsAre());
}

TEST(Document, RefusesABlockThatIsNotClosed) {
  EXPECT_THROW(static_cast<void>(ReadDocument("```console\n$ a\n")), std::runtime_error);
}

TEST(Document, RefusesOutputWithoutACommand) {
  EXPECT_THROW(static_cast<void>(ReadDocument("```console\nout\n```\n")), std::runtime_error);
}

TEST(Matches, NoticesEveryDifferenceInWordsAndNumbers) {
  EXPECT_TRUE(Matches({"q1  1.250 mm", "q2"}, {"q1  1.250 mm", "q2"}));
  EXPECT_FALSE(Matches({"q1  1.250 mm", "q2"}, {"q1  1.251 mm", "q2"}));
  EXPECT_FALSE(Matches({"q1  1.250 mm"}, {"q1 1.250 mm"}));
  EXPECT_FALSE(Matches({"q1"}, {"q1", "q2"}));
  EXPECT_FALSE(Matches({"q1", "q2"}, {"q1"}));
  EXPECT_FALSE(Matches({}, {"q1"}));
}

TEST(Matches, TakesBlanksAtTheEndAndDurationsAsEqual) {
  EXPECT_TRUE(Matches({"done in 1.25 s"}, {"done in 17 s  "}));
  EXPECT_TRUE(Matches({"done in 40 ms"}, {"done in 3.5 ms"}));
  EXPECT_FALSE(Matches({"done in 1.25 mm"}, {"done in 17 mm"}));
}

TEST(Matches, DotsStandForAnyNumberOfLines) {
  EXPECT_TRUE(Matches({"a", "...", "z"}, {"a", "b", "c", "z"}));
  EXPECT_TRUE(Matches({"a", "...", "z"}, {"a", "z"}));
  EXPECT_TRUE(Matches({"a", "..."}, {"a", "b"}));
  EXPECT_TRUE(Matches({"a", "...", "c", "...", "e"}, {"a", "c", "d", "c", "x", "e"}));
  EXPECT_FALSE(Matches({"a", "...", "z"}, {"a", "b", "c"}));
  EXPECT_FALSE(Matches({"...", "b"}, {"b", "c"}));
}

}  // namespace
}  // namespace kompono::tour
