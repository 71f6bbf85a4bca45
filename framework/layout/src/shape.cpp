// SPDX-License-Identifier: Apache-2.0
#include "shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::layout {
namespace {

std::string Quoted(std::string_view key) {
  return fmt::format("'{}'", key);
}

std::string InTable(const std::string& where) {
  return where.empty() ? "" : " in " + where;
}

std::string Below(const std::string& where, std::string_view key) {
  if (where.empty()) return fmt::format("[{}]", key);
  return fmt::format("{}.{}]", where.substr(0, where.size() - 1), key);
}

class Judge {
 public:
  explicit Judge(Complaints& complaints) : complaints_(complaints) {}

  void Table(const toml::table& table, const TableRule& rule, const std::string& where);

 private:
  void Value(const toml::node& node,
             const KeyRule& rule,
             std::string_view key,
             const std::string& where);
  void WrongType(const toml::node& node, std::string_view what, std::string_view wanted);
  void Version(const toml::node& node);
  void Word(const toml::node& node, const KeyRule& rule);
  void Number(const toml::node& node, const KeyRule& rule, std::string_view what);
  void List(const toml::node& node, std::string_view what, std::size_t count);
  void Interval(const toml::node& node, std::string_view what);
  void Sign(const toml::node& node, std::string_view what);
  void Index(const toml::node& node, std::string_view what);
  void Texts(const toml::node& node, std::string_view what);
  template <class Function>
  void ByName(const toml::node& node, std::string_view what, const Function& judge);

  Complaints& complaints_;
};

void Judge::WrongType(const toml::node& node, std::string_view what, std::string_view wanted) {
  complaints_.Error(codes::kWrongType,
                    complaints_.Span(node),
                    fmt::format("{} must be {}, not {}", what, wanted, TypeName(node)));
}

void Judge::Table(const toml::table& table, const TableRule& rule, const std::string& where) {
  for (const auto& [key, node] : table) {
    if (const KeyRule* known = rule.Find(key.str())) {
      Value(node, *known, key.str(), where);
    } else if (!rule.open) {
      complaints_.Error(codes::kUnknownKey,
                        complaints_.Span(key.source()),
                        fmt::format("unknown key '{}'{}", key.str(), InTable(where)),
                        ForeignLetters(key.str(), DidYouMean(key.str(), rule.KeyNames(), 20)));
    }
  }
  for (const KeyRule& key : rule.keys) {
    if (!key.required || table.contains(key.key)) continue;
    const SourceSpan place =
        where.empty() ? SpanAt(complaints_.text(), 1, 1) : complaints_.Span(table);
    complaints_.Error(codes::kMissingKey,
                      place,
                      fmt::format("{} has no '{}'", where.empty() ? "the file" : where, key.key),
                      std::string(key.meaning));
  }
}

void Judge::Value(const toml::node& node,
                  const KeyRule& rule,
                  std::string_view key,
                  const std::string& where) {
  const std::string what = Quoted(key);
  switch (rule.kind) {
    case ValueKind::kVersion:
      return Version(node);
    case ValueKind::kText:
      return node.is_string() ? void() : WrongType(node, what, "a string");
    case ValueKind::kWord:
      return Word(node, rule);
    case ValueKind::kNumber:
      return Number(node, rule, what);
    case ValueKind::kInterval:
      return Interval(node, what);
    case ValueKind::kTriple:
      return List(node, what, 3);
    case ValueKind::kSign:
      return Sign(node, what);
    case ValueKind::kFlag:
      return node.is_boolean() ? void() : WrongType(node, what, "true or false");
    case ValueKind::kIndex:
      return Index(node, what);
    case ValueKind::kTexts:
      return Texts(node, what);
    case ValueKind::kTable:
      if (const toml::table* table = node.as_table())
        return Table(*table, *rule.table, Below(where, key));
      return WrongType(node, what, "a table");
    case ValueKind::kTablesByName:
      return ByName(node, what, [&](const toml::node& value, std::string_view name) {
        if (const toml::table* table = value.as_table())
          return Table(*table, *rule.table, Below(Below(where, key), name));
        WrongType(value, Quoted(name), "a table");
      });
    case ValueKind::kNumbersByName:
      return ByName(node, what, [&](const toml::node& value, std::string_view name) {
        Number(value, rule, Quoted(name));
      });
    case ValueKind::kIntervalsByName:
      return ByName(node, what, [&](const toml::node& value, std::string_view name) {
        Interval(value, Quoted(name));
      });
    case ValueKind::kSignsByName:
      return ByName(node, what, [&](const toml::node& value, std::string_view name) {
        Sign(value, Quoted(name));
      });
    case ValueKind::kParameters:
      return node.is_table() ? void() : WrongType(node, what, "a table");
    case ValueKind::kAnything:
      return;
  }
}

template <class Function>
void Judge::ByName(const toml::node& node, std::string_view what, const Function& judge) {
  const toml::table* table = node.as_table();
  if (table == nullptr) return WrongType(node, what, "a table");
  for (const auto& [name, value] : *table) judge(value, name.str());
}

void Judge::Version(const toml::node& node) {
  const auto version = node.value_exact<std::int64_t>();
  if (!version) return WrongType(node, "'kompono'", "the integer 1");
  if (*version == 1) return;
  complaints_.Error(codes::kNewerFormat,
                    complaints_.Span(node),
                    fmt::format("layout format {} is not known", *version),
                    *version > 1 ? "this program reads format 1; a newer one may read this file"
                                 : "write kompono = 1");
}

void Judge::Word(const toml::node& node, const KeyRule& rule) {
  const auto word = node.value_exact<std::string>();
  if (!word) return WrongType(node, Quoted(rule.key), "a string");
  if (std::find(rule.words.begin(), rule.words.end(), *word) != rule.words.end()) return;
  const std::vector<std::string> words(rule.words.begin(), rule.words.end());
  complaints_.Error(codes::kUnknownWord,
                    complaints_.Span(node),
                    fmt::format("'{}' cannot be '{}'", rule.key, *word),
                    fmt::format("known are: {}", fmt::join(words, ", ")));
}

void Judge::Number(const toml::node& node, const KeyRule& rule, std::string_view what) {
  const auto value = JudgeNumber(node, what, complaints_);
  if (!value || !rule.positive || *value > 0.0) return;
  complaints_.Error(codes::kOutOfRange,
                    complaints_.Span(node),
                    fmt::format("{} must be greater than 0, not {}", what, *value));
}

void Judge::List(const toml::node& node, std::string_view what, std::size_t count) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return WrongType(node, what, fmt::format("a list of {} numbers", count));
  for (const toml::node& element : *list)
    static_cast<void>(JudgeNumber(element, fmt::format("each number of {}", what), complaints_));
  if (list->size() == count) return;
  complaints_.Error(codes::kWrongCount,
                    complaints_.Span(node),
                    fmt::format("{} needs {} numbers, not {}", what, count, list->size()));
}

void Judge::Interval(const toml::node& node, std::string_view what) {
  List(node, what, 2);
  const auto interval = IntervalOf(&node);
  if (!node.is_array() || node.as_array()->size() != 2 || interval) return;
  const auto lower = NumberOf(node.as_array()->get(0));
  const auto upper = NumberOf(node.as_array()->get(1));
  if (!lower || !upper) return;
  complaints_.Error(
      codes::kReversedRange,
      complaints_.Span(node),
      fmt::format("lower limit {} of {} is above the upper one, {}", *lower, what, *upper),
      fmt::format("write [{}, {}]", *upper, *lower));
}

void Judge::Sign(const toml::node& node, std::string_view what) {
  if (!node.is_string() && !node.is_integer()) return WrongType(node, what, "\"+\" or \"-\"");
  if (SignOf(&node)) return;
  complaints_.Error(
      codes::kBadSign, complaints_.Span(node), fmt::format("{} must be \"+\" or \"-\"", what));
}

void Judge::Index(const toml::node& node, std::string_view what) {
  const auto value = node.value_exact<std::int64_t>();
  if (!value) return WrongType(node, what, "an integer");
  if (*value >= 0 && *value <= std::numeric_limits<int>::max()) return;
  complaints_.Error(codes::kOutOfRange,
                    complaints_.Span(node),
                    fmt::format("{} counts from 0, {} is not possible", what, *value));
}

void Judge::Texts(const toml::node& node, std::string_view what) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return WrongType(node, what, "a list of strings");
  for (const toml::node& element : *list) {
    if (!element.is_string()) WrongType(element, fmt::format("each entry of {}", what), "a string");
  }
}

}  // namespace

void JudgeShape(const toml::table& table,
                const TableRule& rule,
                const std::string& where,
                Complaints& complaints) {
  Judge(complaints).Table(table, rule, where);
}

std::optional<double> JudgeNumber(const toml::node& node,
                                  std::string_view what,
                                  Complaints& complaints) {
  if (!node.is_number()) {
    complaints.Error(codes::kWrongType,
                     complaints.Span(node),
                     fmt::format("{} must be a number, not {}", what, TypeName(node)));
    return std::nullopt;
  }
  if (const auto value = NumberOf(&node)) return value;
  complaints.Error(
      codes::kNotFinite, complaints.Span(node), fmt::format("{} must be finite", what));
  return std::nullopt;
}

std::optional<double> NumberOf(const toml::node* node) {
  if (node == nullptr) return std::nullopt;
  // node->value<double>() would refuse integers that a double can only round.
  if (const auto integer = node->value_exact<std::int64_t>()) return static_cast<double>(*integer);
  const auto value = node->value_exact<double>();
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> NumberAt(const toml::table& table, std::string_view key) {
  return NumberOf(table.get(key));
}

std::optional<std::array<double, 2>> IntervalOf(const toml::node* node) {
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr || list->size() != 2) return std::nullopt;
  const auto lower = NumberOf(list->get(0));
  const auto upper = NumberOf(list->get(1));
  if (!lower || !upper || *lower > *upper) return std::nullopt;
  return std::array<double, 2>{*lower, *upper};
}

std::optional<std::array<double, 3>> TripleAt(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr || list->size() != 3) return std::nullopt;
  std::array<double, 3> triple{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = NumberOf(list->get(i));
    if (!number) return std::nullopt;
    triple[i] = *number;
  }
  return triple;
}

std::optional<std::string> TextAt(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  return node == nullptr ? std::nullopt : node->value_exact<std::string>();
}

std::optional<int> SignOf(const toml::node* node) {
  if (node == nullptr) return std::nullopt;
  if (const auto text = node->value_exact<std::string>()) {
    if (*text == "+") return 1;
    if (*text == "-") return -1;
    return std::nullopt;
  }
  const auto number = node->value_exact<std::int64_t>();
  if (number && (*number == 1 || *number == -1)) return static_cast<int>(*number);
  return std::nullopt;
}

const toml::table* TableAt(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  return node == nullptr ? nullptr : node->as_table();
}

}  // namespace kompono::layout
