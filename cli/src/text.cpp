// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace kompono::cli {
namespace {

std::size_t CodePoints(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

std::string Exact(double value) {
  return fmt::format("{}", value);
}

std::string Fixed(double value) {
  if (!std::isfinite(value)) return "-";
  std::string text = fmt::format("{:.6f}", value);
  return text == "-0.000000" ? text.substr(1) : text;
}

std::string Brief(double value) {
  const std::string text = fmt::format("{:.10g}", value);
  return text == "-0" ? "0" : text;
}

std::string RangeText(const std::optional<double>& lower,
                      const std::optional<double>& upper,
                      bool angle) {
  if (!lower && !upper) return "any";
  const std::string_view unit = UnitOf(angle);
  if (!upper) return fmt::format("from {} {}", Brief(Outward(*lower, angle)), unit);
  if (!lower) return fmt::format("up to {} {}", Brief(Outward(*upper, angle)), unit);
  return fmt::format(
      "{} .. {} {}", Brief(Outward(*lower, angle)), Brief(Outward(*upper, angle)), unit);
}

std::optional<double> ParseNumber(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return text.substr(text.size());
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string Joined(const std::vector<std::string>& words, std::string_view separator) {
  return fmt::format("{}", fmt::join(words, separator));
}

std::string Counted(std::size_t count, std::string_view word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

void TextTable::Row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  lines_.push_back({.cells = std::move(cells)});
}

void TextTable::Line(std::string text) {
  lines_.push_back({.text = std::move(text)});
}

std::string TextTable::Render() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t width = CodePoints(columns_[i].heading);
    for (const Entry& entry : lines_) {
      if (!entry.cells.empty()) width = std::max(width, CodePoints(entry.cells[i]));
    }
    widths.push_back(width);
  }
  std::string out;
  const auto put = [&](const auto& cell_of) {
    std::string line = " ";
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string& cell = cell_of(i);
      const std::string blank(widths[i] - CodePoints(cell), ' ');
      line += ' ';
      line += columns_[i].right ? blank + cell : cell + blank;
      if (i + 1 < columns_.size()) line += ' ';
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + '\n';
  };
  const bool headed = std::any_of(columns_.begin(), columns_.end(), [](const Column& column) {
    return !column.heading.empty();
  });
  if (headed) put([&](std::size_t i) -> const std::string& { return columns_[i].heading; });
  for (const Entry& entry : lines_) {
    if (entry.cells.empty()) {
      out += entry.text + '\n';
    } else {
      put([&](std::size_t i) -> const std::string& { return entry.cells[i]; });
    }
  }
  return out;
}

}  // namespace kompono::cli
