// SPDX-License-Identifier: Apache-2.0
// Counting, numbering and walking against each other, against plain loops and against clingo.
#include "studies.hpp"
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::synthesis {
namespace {

/// Every selection, one after the other, all pairs of each looked up in the list of conflicts.
std::vector<Selection> ByLoops(const Space& space) {
  std::set<std::pair<Choice, Choice>> forbidden;
  for (const Space::Conflict& conflict : space.conflicts()) {
    if (!space.off(conflict.rule)) forbidden.emplace(conflict.first, conflict.second);
  }
  const auto& features = space.features();
  std::vector<Selection> found;
  Selection selection(features.size(), 0);
  const auto allowed = [&forbidden, &selection] {
    for (std::size_t f = 0; f < selection.size(); ++f) {
      for (std::size_t g = f; g < selection.size(); ++g) {
        const Choice first{static_cast<int>(f), selection[f]};
        const Choice second{static_cast<int>(g), selection[g]};
        if (forbidden.contains({first, second})) return false;
      }
    }
    return true;
  };
  for (;;) {
    if (allowed()) found.push_back(selection);
    std::size_t f = features.size();
    while (f > 0 && ++selection[f - 1] == features[f - 1].alternatives.size()) {
      selection[--f] = 0;
    }
    if (f == 0) return found;
  }
}

double SecondsOf(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Enumeration, IsThatOfPlainLoopsInTheirOrder) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Space space = RandomSpace(5, 2 + static_cast<int>(seed % 5), 0.25, 4, seed);
    const int rule = space.Add(RuleTitle{.name = "single"});
    space.Forbid({2, 1}, rule);
    const std::vector<Selection> expected = ByLoops(space);
    for (const std::size_t most_nodes : {0U, 3U, 20U, 100000U}) {
      const Enumeration all(space, {}, {.most_nodes = most_nodes});
      ASSERT_EQ(CountText(all.count()), std::to_string(expected.size())) << "seed " << seed;
      std::vector<Selection> walked;
      all.VisitAll([&](Count index, const Selection& selection) {
        EXPECT_EQ(CountText(index), std::to_string(walked.size()));
        walked.push_back(selection);
        return true;
      });
      EXPECT_EQ(walked, expected) << "seed " << seed << ", nodes " << most_nodes;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(all.Unrank(i), expected[i]);
        EXPECT_TRUE(all.Rank(expected[i]) == Count{i});
      }
    }
  }
}

TEST(Enumeration, HandlesFeaturesOfAnyWidth) {
  for (const int width : {1, 31, 62, 63, 64, 65}) {
    const Space space = RandomSpace(3, width, 0.4, 2, static_cast<unsigned>(width));
    const std::size_t expected = ByLoops(space).size();
    EXPECT_EQ(CountText(Enumeration(space).count()), std::to_string(expected)) << width;
    EXPECT_EQ(CountText(CountDepthFirst(space)), std::to_string(expected)) << width;
  }
}

TEST(Enumeration, HandlesFeaturesOfSeveralWords) {
  const Space space = RandomSpace(2, 200, 0.9, 1, 1);
  const std::vector<Selection> expected = ByLoops(space);
  const Enumeration all(space);
  ASSERT_EQ(CountText(all.count()), std::to_string(expected.size()));
  for (std::size_t i = 0; i < expected.size(); i += 97) EXPECT_EQ(all.Unrank(i), expected[i]);
}

TEST(Enumeration, VisitsAnyStretchAndStopsWhenAsked) {
  const Space space = RandomSpace(6, 4, 0.15, 5, 7);
  const Enumeration all(space);
  const Count count = all.count();
  ASSERT_GT(count, 100);
  for (const auto& [begin, end] :
       std::vector<std::pair<Count, Count>>{{0, 1}, {17, 60}, {count - 5, count}, {50, 50}}) {
    Count next = begin;
    all.Visit(begin, end, [&](Count index, const Selection& selection) {
      EXPECT_TRUE(index == next);
      EXPECT_EQ(selection, all.Unrank(index));
      ++next;
      return true;
    });
    EXPECT_TRUE(next == end);
  }
  int visits = 0;
  all.VisitAll([&](Count, const Selection&) { return ++visits < 3; });
  EXPECT_EQ(visits, 3);
}

TEST(Enumeration, FixedChoicesAreASubset) {
  const Space space = RandomSpace(5, 4, 0.2, 4, 11);
  Count sum = 0;
  for (int a = 0; a < 4; ++a) sum += Enumeration(space, {{2, a}}).count();
  EXPECT_TRUE(sum == Enumeration(space).count());
  const Enumeration two(space, {{2, 1}, {2, 3}});
  EXPECT_TRUE(two.count() ==
              Enumeration(space, {{2, 1}}).count() + Enumeration(space, {{2, 3}}).count());
  two.VisitAll([](Count, const Selection& selection) {
    EXPECT_THAT(selection[2], testing::AnyOf(1, 3));
    return true;
  });
}

TEST(Enumeration, RanksNoneThatIsForbidden) {
  const Space space = RandomSpace(4, 3, 0.5, 3, 3);
  const Enumeration all(space);
  std::size_t ranked = 0;
  for (std::uint16_t i = 0; i < 81; ++i) {
    const Selection selection{static_cast<std::uint16_t>(i / 27),
                              static_cast<std::uint16_t>(i / 9 % 3),
                              static_cast<std::uint16_t>(i / 3 % 3),
                              static_cast<std::uint16_t>(i % 3)};
    ranked += all.Rank(selection) ? 1 : 0;
  }
  EXPECT_EQ(ranked, ByLoops(space).size());
}

TEST(Enumeration, CountsLargeSpacesWithLocalRulesAtOnce) {
  const Space space = RandomSpace(20, 8, 0.25, 3, 1);
  EXPECT_GT(space.RawLog10(), 18.0);
  Count count = 0;
  const double seconds = SecondsOf([&] { count = Enumeration(space).count(); });
  EXPECT_GT(count, 1000000);
  EXPECT_LT(seconds, 0.1);
}

TEST(Counts128, StayAtTooMany) {
  Space space;
  for (int f = 0; f < 30; ++f) {
    Feature feature{.name = std::to_string(f)};
    for (int a = 0; a < 40; ++a) feature.alternatives.push_back({.name = std::to_string(a)});
    space.Add(std::move(feature));
  }
  EXPECT_TRUE(space.Raw() == kTooMany);
  EXPECT_NEAR(space.RawLog10(), 48.06, 0.01);
  EXPECT_TRUE(Enumeration(space).count() == kTooMany);
  EXPECT_EQ(CountText(kTooMany), "2^128 or more");
  EXPECT_EQ(GroupedText(1234567), "1,234,567");
  EXPECT_EQ(GroupedText(999), "999");
  EXPECT_TRUE(ParseCount("340282366920938463463374607431768211454") == kTooMany - 1);
  EXPECT_FALSE(ParseCount("340282366920938463463374607431768211455"));
  EXPECT_FALSE(ParseCount("12a"));
  EXPECT_FALSE(ParseCount(""));
}

/// The space for clingo: one alternative of each feature, no forbidden pair.
std::string Program(const Space& space) {
  std::string text;
  for (std::size_t f = 0; f < space.features().size(); ++f) {
    text += fmt::format("1 {{ x({},0..{}) }} 1.\n", f, space.features()[f].alternatives.size() - 1);
  }
  for (const Space::Conflict& conflict : space.conflicts()) {
    text += fmt::format(":- x({},{}), x({},{}).\n",
                        conflict.first.feature,
                        conflict.first.alternative,
                        conflict.second.feature,
                        conflict.second.alternative);
  }
  return text + "#show.\n";
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kFactor = 1.0;  // instrumented, while clingo is not
#else
constexpr double kFactor = 10.0;
#endif

TEST(Enumeration, AgreesWithClingoAndIsTenTimesFaster) {
  const Space space = RandomSpace(12, 6, 0.144, 11, 1);
  EXPECT_EQ(CountText(space.Raw()), "2176782336");
  const std::filesystem::path program =
      std::filesystem::temp_directory_path() / fmt::format("kompono_space_{}.lp", getpid());
  std::filesystem::path result = program;
  result.replace_extension("out");
  std::ofstream(program) << Program(space);
  const std::string command =
      fmt::format("clingo 0 -q --outf=0 {} > {} 2>&1", program.string(), result.string());
  Count count = 0;
  double ours = 1e9;
  double theirs = 1e9;
  int status = 0;
  for (int run = 0; run < 3; ++run) {  // the fastest: other programs run too
    ours = std::min(ours, SecondsOf([&] { count = Enumeration(space).count(); }));
    theirs = std::min(theirs, SecondsOf([&] { status = std::system(command.c_str()); }));
  }
  ASSERT_NE(WEXITSTATUS(status), 127) << "clingo is missing: ./dev test installs it (gringo)";
  std::string models;
  {
    std::ifstream in(result);
    std::string line;
    while (std::getline(in, line)) {
      if (line.starts_with("Models")) models = line.substr(line.rfind(' ') + 1);
    }
  }
  std::filesystem::remove(program);
  std::filesystem::remove(result);
  EXPECT_EQ(CountText(count), models);
  EXPECT_LT(kFactor * ours, theirs) << "ours " << ours << " s, clingo's " << theirs << " s";
  RecordProperty("ratio", fmt::format("{:.1f}", theirs / ours));
}

}  // namespace
}  // namespace kompono::synthesis
