// SPDX-License-Identifier: Apache-2.0
#include "console.hpp"

#include <regex>
#include <stdexcept>

namespace kompono::tour {
namespace {

constexpr std::string_view kOpen = "```console";
constexpr std::string_view kClose = "```";
constexpr std::string_view kPrompt = "$ ";
constexpr std::string_view kAnyLines = "...";

std::string Comparable(const std::string& line) {
  static const std::regex duration(R"(\b[0-9]+(\.[0-9]+)? (s|ms)\b)");
  std::string result = std::regex_replace(line, duration, "<duration>");
  result.erase(result.find_last_not_of(" \t\r") + 1);
  return result;
}

bool MatchesFrom(const std::vector<std::string>& expected,
                 std::size_t e,
                 const std::vector<std::string>& actual,
                 std::size_t a) {
  for (; e < expected.size(); ++e, ++a) {
    if (expected[e] == kAnyLines) {
      for (std::size_t rest = a; rest <= actual.size(); ++rest) {
        if (MatchesFrom(expected, e + 1, actual, rest)) return true;
      }
      return false;
    }
    if (a == actual.size() || Comparable(expected[e]) != Comparable(actual[a])) return false;
  }
  return a == actual.size();
}

[[noreturn]] void Refuse(std::size_t line, const std::string& what) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + what);
}

/// Reads the steps of the block that opens at `open`; returns the index of its closing line.
std::size_t ReadBlock(std::size_t open, Document* document) {
  const std::vector<std::string>& lines = document->lines;
  bool block_has_command = false;
  std::size_t i = open + 1;
  for (; i < lines.size() && lines[i] != kClose; ++i) {
    if (lines[i].starts_with(kPrompt)) {
      Step step{.command = lines[i].substr(kPrompt.size()),
                .expected = {},
                .line = i + 1,
                .first_expected = 0,
                .end_expected = 0};
      while (step.command.ends_with('\\') && i + 1 < lines.size()) {
        step.command += "\n" + lines[++i];
      }
      step.first_expected = step.end_expected = i + 1;
      document->steps.push_back(step);
      block_has_command = true;
    } else if (!block_has_command) {
      Refuse(i + 1, "output without a command");
    } else {
      document->steps.back().expected.push_back(lines[i]);
      document->steps.back().end_expected = i + 1;
    }
  }
  if (i == lines.size()) Refuse(open + 1, "the console block is not closed");
  return i;
}

}  // namespace

std::vector<std::string> Lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

Document ReadDocument(std::string_view text) {
  Document document{.lines = Lines(text), .steps = {}};
  for (std::size_t i = 0; i < document.lines.size(); ++i) {
    if (document.lines[i] == kOpen) i = ReadBlock(i, &document);
  }
  return document;
}

bool Matches(const std::vector<std::string>& expected, const std::vector<std::string>& actual) {
  return MatchesFrom(expected, 0, actual, 0);
}

}  // namespace kompono::tour
