// SPDX-License-Identifier: Apache-2.0
#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr int kMostOfOneCode = 50;

bool IsBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

Cell Trimmed(std::string_view text, std::size_t begin, std::size_t end) {
  while (begin < end && IsBlank(text[begin])) ++begin;
  while (end > begin && IsBlank(text[end - 1])) --end;
  if (end - begin >= 2 && text[begin] == '"' && text[end - 1] == '"') {
    ++begin;
    --end;
  }
  return {text.substr(begin, end - begin), begin, end};
}

TableRow SplitLine(
    std::string_view text, std::size_t begin, std::size_t end, int line, char separator) {
  TableRow row;
  row.line = line;
  row.begin = begin;
  row.end = end;
  bool quoted = false;
  std::size_t cell_begin = begin;
  for (std::size_t i = begin; i <= end; ++i) {
    if (i < end && text[i] == '"') quoted = !quoted;
    if (i == end || (text[i] == separator && !quoted)) {
      row.cells.push_back(Trimmed(text, cell_begin, i));
      cell_begin = i + 1;
    }
  }
  return row;
}

char SeparatorOf(std::string_view header) {
  constexpr std::array<char, 3> kSeparators{',', ';', '\t'};
  return *std::max_element(kSeparators.begin(), kSeparators.end(), [header](char a, char b) {
    return std::count(header.begin(), header.end(), a) <
           std::count(header.begin(), header.end(), b);
  });
}

}  // namespace

Diagnostics JudgeText(std::string_view text, std::string_view file) {
  const auto refused = [file](std::string message, std::string help) {
    return Diagnostics{{.code = codes::kNoText.code,
                        .file = std::string(file),
                        .message = std::move(message),
                        .help = std::move(help)}};
  };
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    return refused("the file is UTF-16", "save it as UTF-8: \"CSV UTF-8\" in spreadsheets");
  }
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    return refused(fmt::format("byte {} is zero: the file is no text", zero + 1),
                   "give the file as text in UTF-8, not the program's own format");
  }
  if (text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos) {
    return refused("the lines end with a carriage return alone",
                   "save the file with the line ends of Unix or Windows");
  }
  return {};
}

Table SplitTable(std::string_view text) {
  Table table;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::size_t begin = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  int line = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    ++line;
    const Cell whole = Trimmed(text, begin, end);
    if (!whole.text.empty() && whole.text.front() != '#') {
      const bool is_header = table.header.cells.empty();
      if (is_header) table.separator = SeparatorOf(text.substr(begin, end - begin));
      TableRow row = SplitLine(text, begin, end, line, table.separator);
      if (is_header) {
        table.header = std::move(row);
      } else {
        table.rows.push_back(std::move(row));
      }
    }
    begin = end + 1;
  }
  return table;
}

void Complaints::Add(Severity severity,
                     std::string code,
                     std::size_t begin,
                     std::size_t end,
                     std::string message,
                     std::string help) {
  if (++said_[code] > kMostOfOneCode) return;
  list_.push_back({.severity = severity,
                   .code = std::move(code),
                   .file = std::string(file_),
                   .span = SpanOf(text_, begin, end),
                   .message = std::move(message),
                   .help = std::move(help)});
}

void Complaints::ErrorWithoutPlace(std::string code, std::string message, std::string help) {
  list_.push_back({.severity = Severity::kError,
                   .code = std::move(code),
                   .file = std::string(file_),
                   .span = {},
                   .message = std::move(message),
                   .help = std::move(help)});
}

Diagnostics Complaints::Take() {
  for (const auto& [code, count] : said_) {
    if (count <= kMostOfOneCode) continue;
    list_.push_back(
        {.severity = Severity::kNote,
         .code = code,
         .file = std::string(file_),
         .span = {},
         .message = fmt::format("{} more of {} are not shown", count - kMostOfOneCode, code),
         .help = ""});
  }
  said_.clear();
  return std::move(list_);
}

}  // namespace kompono::calibration
