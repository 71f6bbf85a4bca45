// SPDX-License-Identifier: Apache-2.0
#include "assignments.hpp"

#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::cli {
namespace {

constexpr std::size_t kMostListed = 24;

bool SameLetters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

std::string_view ShortName(std::string_view name) {
  return name.substr(name.find('.') + 1);  // npos + 1 is 0: names without a dot stay whole
}

}  // namespace

Argument::Argument(std::string option, const std::vector<std::string>& uses)
    : option_(std::move(option)), text_(Joined(uses, ",")), given_(!uses.empty()) {}

Diagnostic Argument::Complaint(const CodeTitle& code,
                               std::size_t begin,
                               std::size_t length,
                               std::string message,
                               std::string help) const {
  return {.code = std::string(code.code),
          .file = option_,
          .span = SpanOf(text_, begin, begin + length),
          .message = std::move(message),
          .help = std::move(help)};
}

std::vector<Assignment> Argument::Split(Diagnostics& problems) const {
  std::vector<Assignment> out;
  std::size_t begin = 0;
  while (given_ && begin <= text_.size()) {
    const std::size_t end = std::min(text_.find(',', begin), text_.size());
    const std::string_view piece = std::string_view(text_).substr(begin, end - begin);
    const std::size_t equals = piece.find('=');
    const std::string_view name = Trimmed(piece.substr(0, equals));
    if (equals == std::string_view::npos || name.empty()) {
      problems.push_back(Complaint(codes::kBadAssignment,
                                   begin,
                                   piece.size(),
                                   piece.empty() ? std::string("nothing between the commas")
                                                 : fmt::format("'{}' has no value", piece),
                                   "write name=value, several with commas between them"));
    } else {
      const std::string_view value = Trimmed(piece.substr(equals + 1));
      out.push_back({.name = std::string(name),
                     .value = std::string(value),
                     .name_begin = static_cast<std::size_t>(name.data() - text_.data()),
                     .value_begin = static_cast<std::size_t>(value.data() - text_.data())});
    }
    begin = end + 1;
  }
  return out;
}

std::optional<double> Argument::Number(const Assignment& assignment, Diagnostics& problems) const {
  std::optional<double> number = ParseNumber(assignment.value);
  if (!number) {
    problems.push_back(Complaint(codes::kBadNumber,
                                 assignment.value_begin,
                                 assignment.value.size(),
                                 fmt::format("'{}' is no number", assignment.value),
                                 "lengths are in mm and angles in deg, without a unit"));
  }
  return number;
}

std::optional<Argument::Interval> Argument::Range(const Assignment& assignment,
                                                  Diagnostics& problems) const {
  const std::size_t colon = assignment.value.find(':');
  if (colon != std::string::npos) {
    const std::optional<double> lower =
        ParseNumber(Trimmed(std::string_view(assignment.value).substr(0, colon)));
    const std::optional<double> upper =
        ParseNumber(Trimmed(std::string_view(assignment.value).substr(colon + 1)));
    if (lower && upper && *lower <= *upper) return Interval{*lower, *upper};
  }
  problems.push_back(Complaint(codes::kBadNumber,
                               assignment.value_begin,
                               assignment.value.size(),
                               fmt::format("'{}' is no range", assignment.value),
                               "write lower:upper, such as -50:50"));
  return std::nullopt;
}

NameTable::NameTable(std::string what, std::vector<std::vector<std::string>> forms)
    : what_(std::move(what)) {
  for (std::vector<std::string>& form : forms) {
    names_.push_back(form.front());
    others_.emplace_back(form.begin() + 1, form.end());
  }
}

std::vector<std::size_t> NameTable::Matches(std::string_view name) const {
  for (const bool whole : {true, false}) {
    std::vector<std::size_t> exact;
    std::vector<std::size_t> loose;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      bool same = false;
      bool alike = false;
      const auto compare = [&](const std::string& form) {
        const std::string_view known = whole ? std::string_view(form) : ShortName(form);
        same = same || known == name;
        alike = alike || SameLetters(known, name);
      };
      compare(names_[i]);
      for (const std::string& other : others_[i]) compare(other);
      if (same) exact.push_back(i);
      if (alike) loose.push_back(i);
    }
    if (!exact.empty()) return exact;
    if (!loose.empty()) return loose;
  }
  return {};
}

std::optional<std::size_t> NameTable::Find(const Argument& argument,
                                           const Assignment& assignment,
                                           std::vector<bool>& taken,
                                           Diagnostics& problems) const {
  const std::vector<std::size_t> matches = Matches(assignment.name);
  const auto complain = [&](const CodeTitle& code, std::string message, std::string help) {
    problems.push_back(argument.Complaint(
        code, assignment.name_begin, assignment.name.size(), std::move(message), std::move(help)));
    return std::nullopt;
  };
  if (matches.empty()) {
    return complain(codes::kUnknownName,
                    fmt::format("unknown {} '{}'", what_, assignment.name),
                    names_.empty()                 ? fmt::format("the machine has no {}s", what_)
                    : names_.size() <= kMostListed ? "known are: " + Joined(names_)
                                                   : DidYouMean(assignment.name, names_));
  }
  if (matches.size() > 1) {
    std::vector<std::string> meant;
    meant.reserve(matches.size());
    for (const std::size_t i : matches) meant.push_back(names_[i]);
    return complain(codes::kAmbiguousName,
                    fmt::format("'{}' may be any of several {}s", assignment.name, what_),
                    "write one of " + Joined(meant));
  }
  if (taken[matches.front()]) {
    return complain(codes::kRepeatedName,
                    fmt::format("{} '{}' is given twice", what_, names_[matches.front()]),
                    "give it once");
  }
  taken[matches.front()] = true;
  return matches.front();
}

std::vector<std::optional<double>> ReadNumbers(const Argument& argument,
                                               const NameTable& table,
                                               Diagnostics& problems) {
  std::vector<std::optional<double>> out(table.names().size());
  std::vector<bool> taken(table.names().size(), false);
  for (const Assignment& assignment : argument.Split(problems)) {
    const std::optional<std::size_t> index = table.Find(argument, assignment, taken, problems);
    const std::optional<double> number = argument.Number(assignment, problems);
    if (index && number) out[*index] = *number;
  }
  return out;
}

}  // namespace kompono::cli
