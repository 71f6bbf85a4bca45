// SPDX-License-Identifier: Apache-2.0
#include "csv.hpp"

#include "codes.hpp"
#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>

namespace kompono::cli {
namespace {

struct Field {
  std::string_view text;
  std::size_t begin = 0;  ///< in the whole file
};

std::vector<Field> Fields(std::string_view line, std::size_t line_begin) {
  std::vector<Field> out;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view text = Trimmed(line.substr(begin, end - begin));
    out.push_back(
        {.text = text, .begin = line_begin + static_cast<std::size_t>(text.data() - line.data())});
    begin = end + 1;
  }
  return out;
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Parsed<NumberTable> Read() {
    std::size_t begin = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // a byte order mark
    for (int number = 1; begin < text_.size(); ++number) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      const std::string_view line = text_.substr(begin, end - begin);
      const std::string_view content = Trimmed(line);
      if (!content.empty() && content.front() != '#') ReadLine(line, begin, number);
      begin = end + 1;
    }
    if (table_.headings.empty()) Complain(0, 1, "the table is empty", "begin with a heading line");
    if (!problems_.empty()) return tl::unexpected(problems_);
    return table_;
  }

 private:
  void Complain(std::size_t begin, std::size_t length, std::string message, std::string help) {
    problems_.push_back({.code = std::string(codes::kBadTable.code),
                         .file = file_,
                         .span = SpanOf(text_, begin, begin + length),
                         .message = std::move(message),
                         .help = std::move(help)});
  }

  void ReadLine(std::string_view line, std::size_t begin, int number) {
    const std::vector<Field> fields = Fields(line, begin);
    if (table_.headings.empty()) {
      for (const Field& field : fields) {
        table_.headings.emplace_back(field.text);
        table_.heading_places.push_back(
            SpanOf(text_, field.begin, field.begin + field.text.size()));
      }
      return;
    }
    if (fields.size() != table_.headings.size()) {
      Complain(begin,
               line.size(),
               fmt::format("{} where the heading has {}",
                           Counted(fields.size(), "field"),
                           table_.headings.size()),
               "");
      return;
    }
    std::vector<double> row;
    for (const Field& field : fields) {
      const std::optional<double> value = ParseNumber(field.text);
      if (!value) {
        Complain(field.begin, field.text.size(), fmt::format("'{}' is no number", field.text), "");
      }
      row.push_back(value.value_or(0.0));
    }
    table_.rows.push_back(std::move(row));
    table_.lines.push_back(number);
  }

  std::string_view text_;
  const std::string& file_;
  NumberTable table_;
  Diagnostics problems_;
};

}  // namespace

Parsed<NumberTable> ReadNumberTable(std::string_view text, const std::string& file) {
  return Reader(text, file).Read();
}

std::string CsvField(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace kompono::cli
