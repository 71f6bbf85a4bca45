// SPDX-License-Identifier: Apache-2.0
#include "parameter_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::plugin {
namespace {

constexpr int kMostCount = 1000;

/// "points[6]" -> shape and count; false if the text is none.
bool ParseShape(std::string_view text, ParameterDescription& parameter) {
  if (text == "number" || text == "point") {
    parameter.shape = text == "number" ? ParameterShape::kNumber : ParameterShape::kPoint;
    parameter.count = 1;
    return true;
  }
  const std::size_t open = text.find('[');
  if (open == std::string_view::npos || text.back() != ']') return false;
  const std::string_view word = text.substr(0, open);
  if (word != "numbers" && word != "points") return false;
  const std::string_view digits = text.substr(open + 1, text.size() - open - 2);
  int count = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (error != std::errc() || end != digits.data() + digits.size()) return false;
  if (count < 1 || count > kMostCount) return false;
  parameter.shape = word == "numbers" ? ParameterShape::kNumbers : ParameterShape::kPoints;
  parameter.count = count;
  return true;
}

void ReadShape(TableReader& table, ParameterDescription& parameter) {
  const std::string text = table.String("shape", Need::kOptional).value_or("number");
  if (ParseShape(text, parameter)) return;
  table.Complain("E0224",
                 "shape",
                 fmt::format("'{}' is no shape", text),
                 "shapes are number, numbers[n], point, points[n] with n from 1 to 1000");
}

std::string WayToWrite(ParameterShape shape) {
  switch (shape) {
    case ParameterShape::kNumber:
      return "write one plain number";
    case ParameterShape::kNumbers:
      return "write a list of numbers, [a, b, ..]";
    case ParameterShape::kPoint:
      return "write one point, [x, y, z]";
    case ParameterShape::kPoints:
      break;
  }
  return "write a list of points, [[x, y, z], ..]";
}

void ReadDefault(TableReader& table, ParameterDescription& parameter) {
  std::optional<std::vector<double>> values = table.FlatNumbers("default");
  if (!values) return;
  const bool points = parameter.shape == ParameterShape::kPoints;
  const bool list = parameter.shape != ParameterShape::kNumber;
  const bool fits = static_cast<int>(values->size()) == parameter.Numbers() &&
                    table.IsArray("default") == list && table.IsNested("default") == points &&
                    (!points || table.RowLength("default") == 3);
  if (!fits) {
    table.Complain("E0224",
                   "default",
                   fmt::format("'default' does not fit the shape {}", ShapeText(parameter)),
                   WayToWrite(parameter.shape));
    return;
  }
  if (const std::string wrong = OutOfRange(parameter, *values); !wrong.empty())
    table.Complain("E0224", "default", "'default': " + wrong);
  parameter.default_value = std::move(*values);
}

void ReadRange(TableReader& table, ParameterDescription& parameter) {
  const std::optional<std::vector<double>> range = table.FlatNumbers("range");
  if (!range) return;
  if (range->size() != 2 || table.IsNested("range") || (*range)[0] >= (*range)[1]) {
    table.Complain(
        "E0224", "range", "'range' must be two numbers, [least, greatest], least below greatest");
    return;
  }
  parameter.lower = (*range)[0];
  parameter.upper = (*range)[1];
}

}  // namespace

std::string ReadWord(TableReader& table,
                     std::string_view key,
                     Need need,
                     std::initializer_list<std::string_view> words) {
  std::string word = table.String(key, need).value_or("");
  if (std::find(words.begin(), words.end(), word) != words.end()) return word;
  if (table.IsString(key)) {
    const std::vector<std::string> known(words.begin(), words.end());
    table.Complain(
        "E0224", key, fmt::format("'{}' cannot be '{}'", key, word), DidYouMean(word, known));
  }
  return "";
}

std::string ShapeText(const ParameterDescription& parameter) {
  switch (parameter.shape) {
    case ParameterShape::kNumber:
      return "number";
    case ParameterShape::kNumbers:
      return fmt::format("numbers[{}]", parameter.count);
    case ParameterShape::kPoint:
      return "point";
    case ParameterShape::kPoints:
      break;
  }
  return fmt::format("points[{}]", parameter.count);
}

std::string OutOfRange(const ParameterDescription& parameter, const std::vector<double>& values) {
  for (const double value : values) {
    if ((parameter.lower && value < *parameter.lower) ||
        (parameter.upper && value > *parameter.upper)) {
      return fmt::format(
          "{} lies outside the range {} .. {}", value, *parameter.lower, *parameter.upper);
    }
  }
  return "";
}

ParameterDescription ReadParameter(TableReader& table) {
  ParameterDescription parameter;
  ReadShape(table, parameter);
  parameter.unit = ReadWord(table, "unit", Need::kRequired, {"mm", "deg", "1"});
  ReadRange(table, parameter);
  ReadDefault(table, parameter);
  parameter.tolerance = table.Number("tolerance");
  if (parameter.tolerance && *parameter.tolerance < 0)
    table.Complain("E0224", "tolerance", "a tolerance is not negative");
  parameter.identifiable = table.Bool("identifiable").value_or(true);
  parameter.meaning = table.String("meaning", Need::kRequired).value_or("");
  table.RefuseUnknownKeys();
  return parameter;
}

}  // namespace kompono::plugin
