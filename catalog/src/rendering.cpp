// SPDX-License-Identifier: Apache-2.0
#include "csv.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "kompono/catalog/query.hpp"

namespace kompono::catalog {
namespace {

std::size_t Width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// A catalog from elsewhere must not be able to steer the terminal: C0, DEL and C1 (U+0080 to
/// U+009F, in UTF-8 0xC2 and the same byte) become visible.
std::string Visible(std::string_view text) {
  std::string visible;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    if (byte < 0x20 || byte == 0x7F) {
      visible += fmt::format("\\x{:02x}", byte);
    } else if (byte == 0xC2 && next >= 0x80 && next < 0xA0) {
      visible += fmt::format("\\x{:02x}", next);
      ++i;
    } else {
      visible += text[i];
    }
  }
  return visible;
}

bool IsNumber(const Value& value) {
  return std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value);
}

std::string ForPeople(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{:.6g}", *real);
  if (const auto* text = std::get_if<std::string>(&value)) return Visible(*text);
  return "";
}

nlohmann::ordered_json JsonValue(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return *integer;
  if (const auto* real = std::get_if<double>(&value)) {
    return std::isfinite(*real) ? nlohmann::ordered_json(*real) : nlohmann::ordered_json(nullptr);
  }
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;
}

std::string Padded(const std::string& text, std::size_t width, bool right) {
  const std::string space(width - std::min(width, Width(text)), ' ');
  return right ? space + text : text + space;
}

std::string Line(const std::vector<std::string>& cells) {
  std::string line = fmt::format("{}", fmt::join(cells, "  "));
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string CsvText(std::string_view text) {
  if (!text.empty() && text.find_first_of(",\"\r\n") == std::string_view::npos &&
      text.front() != ' ' && text.back() != ' ') {
    return std::string(text);
  }
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string CsvField(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{}", *real);
  if (const auto* text = std::get_if<std::string>(&value)) return CsvText(*text);
  return "";
}

std::string RenderText(const Table& table) {
  const std::size_t count = table.columns.size();
  std::vector<std::size_t> widths(count, 0);
  std::vector<bool> numeric(count, !table.rows.empty());
  for (std::size_t i = 0; i < count; ++i) {
    widths[i] = Width(Visible(table.columns[i].name));
    bool any = false;
    for (const std::vector<Value>& row : table.rows) {
      widths[i] = std::max(widths[i], Width(ForPeople(row[i])));
      any = any || IsNumber(row[i]);
      numeric[i] = numeric[i] && !std::holds_alternative<std::string>(row[i]);
    }
    numeric[i] = numeric[i] && any;
  }
  std::vector<std::string> cells(count);
  for (std::size_t i = 0; i < count; ++i)
    cells[i] = Padded(Visible(table.columns[i].name), widths[i], numeric[i]);
  std::string text = Line(cells);
  for (std::size_t i = 0; i < count; ++i) cells[i] = std::string(widths[i], '-');
  text += Line(cells);
  for (const std::vector<Value>& row : table.rows) {
    for (std::size_t i = 0; i < count; ++i)
      cells[i] = Padded(ForPeople(row[i]), widths[i], numeric[i]);
    text += Line(cells);
  }
  return text;
}

std::string RenderCsv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += (i == 0 ? "" : ",") + CsvText(table.columns[i].name);
  }
  text += "\r\n";
  for (const std::vector<Value>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + CsvField(row[i]);
    text += "\r\n";
  }
  return text;
}

nlohmann::ordered_json ToJson(const Table& table) {
  nlohmann::ordered_json columns = nlohmann::ordered_json::array();
  for (const Column& column : table.columns)
    columns.push_back({{"name", column.name}, {"type", column.type}});
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::vector<Value>& row : table.rows) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.size(); ++i) object[table.columns[i].name] = JsonValue(row[i]);
    rows.push_back(std::move(object));
  }
  return {{"columns", std::move(columns)}, {"rows", std::move(rows)}, {"more", table.more}};
}

}  // namespace kompono::catalog
