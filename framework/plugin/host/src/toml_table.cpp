// SPDX-License-Identifier: Apache-2.0
#include "toml_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::plugin {
namespace {

std::string_view TypeName(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

}  // namespace

SourceSpan Complaints::Span(const toml::source_region& region) const {
  const auto line = static_cast<int>(region.begin.line);
  const auto column = static_cast<int>(region.begin.column);
  // A value over several lines is marked to the end of its first line, where SpanAt stops anyway.
  const int length = region.end.line == region.begin.line
                         ? static_cast<int>(region.end.column) - column
                         : std::numeric_limits<int>::max();
  return SpanAt(text_, line, column, std::max(1, length));
}

void Complaints::Add(std::string_view code,
                     SourceSpan span,
                     std::string message,
                     std::string help) {
  list_.push_back({Severity::kError,
                   std::string(code),
                   std::string(file_),
                   std::move(span),
                   std::move(message),
                   std::move(help)});
}

TableReader::TableReader(const toml::table& table, std::string name, Complaints& complaints)
    : table_(&table), name_(std::move(name)), complaints_(&complaints) {}

const toml::node* TableReader::Take(std::string_view key, Need need) {
  known_.emplace_back(key);
  const toml::node* node = table_->get(key);
  if (node == nullptr && need == Need::kRequired) {
    complaints_->Add("E0222",
                     Here(),
                     name_.empty() ? fmt::format("'{}' is missing", key)
                                   : fmt::format("{} has no '{}'", name_, key));
  }
  return node;
}

void TableReader::WrongType(std::string_view key, const toml::node& node, std::string_view wanted) {
  complaints_->Add("E0223",
                   complaints_->Span(node.source()),
                   fmt::format("'{}' must be {}, not {}", key, wanted, TypeName(node)));
}

std::optional<std::string> TableReader::String(std::string_view key, Need need) {
  const toml::node* node = Take(key, need);
  if (node == nullptr) return std::nullopt;
  if (auto value = node->value_exact<std::string>()) return value;
  WrongType(key, *node, "a string");
  return std::nullopt;
}

std::optional<bool> TableReader::Bool(std::string_view key) {
  const toml::node* node = Take(key, Need::kOptional);
  if (node == nullptr) return std::nullopt;
  if (auto value = node->value_exact<bool>()) return value;
  WrongType(key, *node, "true or false");
  return std::nullopt;
}

std::optional<int> TableReader::Integer(std::string_view key, Need need) {
  const toml::node* node = Take(key, need);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value_exact<std::int64_t>();
  if (!value) {
    WrongType(key, *node, "an integer");
    return std::nullopt;
  }
  if (std::abs(static_cast<double>(*value)) > std::numeric_limits<int>::max()) {
    Complain("E0224", key, fmt::format("{} is too large for '{}'", *value, key));
    return std::nullopt;
  }
  return static_cast<int>(*value);
}

bool TableReader::AppendNumbers(std::string_view key,
                                const toml::node& node,
                                int depth,
                                std::vector<double>& out) {
  if (const toml::array* array = node.as_array(); array != nullptr && depth < 2) {
    bool good = true;
    for (const toml::node& element : *array)
      good = AppendNumbers(key, element, depth + 1, out) && good;
    return good;
  }
  if (!node.is_number()) {
    WrongType(key, node, depth == 0 ? "a number or a list of numbers" : "made of numbers");
    return false;
  }
  // node.value<double>() would refuse integers that a double can only round.
  const auto integer = node.value_exact<std::int64_t>();
  const double value =
      integer ? static_cast<double>(*integer) : node.value_exact<double>().value_or(NAN);
  if (!std::isfinite(value)) {
    complaints_->Add("E0224",
                     complaints_->Span(node.source()),
                     fmt::format("'{}' must be made of finite numbers", key));
    return false;
  }
  out.push_back(value);
  return true;
}

std::optional<std::vector<double>> TableReader::FlatNumbers(std::string_view key) {
  const toml::node* node = Take(key, Need::kOptional);
  std::vector<double> numbers;
  if (node == nullptr || !AppendNumbers(key, *node, 0, numbers)) return std::nullopt;
  return numbers;
}

std::optional<double> TableReader::Number(std::string_view key) {
  const toml::node* node = Take(key, Need::kOptional);
  if (node == nullptr) return std::nullopt;
  if (!node->is_number()) {
    WrongType(key, *node, "a number");
    return std::nullopt;
  }
  std::vector<double> numbers;
  if (!AppendNumbers(key, *node, 0, numbers)) return std::nullopt;
  return numbers.front();
}

std::vector<Placed<std::string>> TableReader::Strings(std::string_view key) {
  const toml::node* node = Take(key, Need::kOptional);
  std::vector<Placed<std::string>> strings;
  if (node == nullptr) return strings;
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    WrongType(key, *node, "a list of strings");
    return strings;
  }
  for (const toml::node& element : *array) {
    if (auto value = element.value_exact<std::string>()) {
      strings.push_back({std::move(*value), complaints_->Span(element.source())});
    } else {
      WrongType(key, element, "made of strings");
    }
  }
  return strings;
}

std::vector<TableReader> TableReader::Tables(std::string_view key) {
  const toml::node* node = Take(key, Need::kOptional);
  std::vector<TableReader> tables;
  if (node == nullptr) return tables;
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    WrongType(key, *node, "a list of tables");
    return tables;
  }
  for (const toml::node& element : *array) {
    if (const toml::table* table = element.as_table()) {
      tables.emplace_back(*table, fmt::format("'{}'", key), *complaints_);
    } else {
      WrongType(key, element, "made of tables");
    }
  }
  return tables;
}

std::optional<TableReader> TableReader::Table(std::string_view key) {
  const toml::node* node = Take(key, Need::kOptional);
  if (node == nullptr) return std::nullopt;
  if (const toml::table* table = node->as_table())
    return TableReader(*table, fmt::format("'{}'", key), *complaints_);
  WrongType(key, *node, "a table");
  return std::nullopt;
}

std::vector<std::string> TableReader::Keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, node] : *table_) keys.emplace_back(key.str());
  return keys;
}

SourceSpan TableReader::At(std::string_view key) const {
  const toml::node* node = table_->get(key);
  return node == nullptr ? Here() : complaints_->Span(node->source());
}

int TableReader::RowLength(std::string_view key) const {
  const toml::node* node = table_->get(key);
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr) return 0;
  const auto innermost = [](const toml::node& element) {
    const toml::array* row = element.as_array();
    return row == nullptr ? 0 : static_cast<int>(row->size());
  };
  if (!IsNested(key)) return static_cast<int>(array->size());
  const int length = innermost(array->front());
  const bool same =
      std::all_of(array->begin(), array->end(), [length, innermost](const toml::node& element) {
        return innermost(element) == length;
      });
  return same ? length : -1;
}

bool TableReader::IsNested(std::string_view key) const {
  const toml::node* node = table_->get(key);
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  return array != nullptr && std::any_of(array->begin(), array->end(), [](const toml::node& e) {
           return e.is_array();
         });
}

bool TableReader::IsArray(std::string_view key) const {
  const toml::node* node = table_->get(key);
  return node != nullptr && node->is_array();
}

bool TableReader::IsString(std::string_view key) const {
  const toml::node* node = table_->get(key);
  return node != nullptr && node->is_string();
}

void TableReader::Complain(std::string_view code,
                           std::string_view key,
                           std::string message,
                           std::string help) {
  complaints_->Add(code, At(key), std::move(message), std::move(help));
}

void TableReader::RefuseUnknownKeys() {
  for (const auto& [key, node] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    complaints_->Add("E0221",
                     complaints_->Span(key.source()),
                     name_.empty() ? fmt::format("unknown key '{}'", key.str())
                                   : fmt::format("unknown key '{}' in {}", key.str(), name_),
                     DidYouMean(key.str(), known_));
  }
}

}  // namespace kompono::plugin
