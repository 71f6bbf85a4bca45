// SPDX-License-Identifier: Apache-2.0
#include "study_keys.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::synthesis {
namespace {

std::string Quoted(std::string_view key) {
  return fmt::format("'{}'", key);
}

std::string Below(const std::string& where, std::string_view key) {
  if (where.empty()) return fmt::format("[{}]", key);
  return fmt::format("{}.{}]", where.substr(0, where.size() - 1), key);
}

class Judge {
 public:
  explicit Judge(Complaints& complaints) : complaints_(complaints) {}

  void Table(const toml::table& table, const TableRule& rule, const std::string& where) {
    for (const auto& [key, node] : table) {
      if (const KeyRule* known = rule.Find(key.str())) {
        Value(node, *known, where);
        continue;
      }
      complaints_.Error(
          codes::kUnknownKey,
          complaints_.Span(key.source()),
          fmt::format("unknown key '{}'{}{}", key.str(), where.empty() ? "" : " in ", where),
          DidYouMean(key.str(), rule.KeyNames(), 20));
    }
    for (const KeyRule& key : rule.keys) {
      if (!key.required || table.contains(key.key)) continue;
      complaints_.Error(codes::kMissingKey,
                        where.empty() ? SpanAt(complaints_.text(), 1, 1) : complaints_.Span(table),
                        fmt::format("{} has no '{}'", where.empty() ? "the file" : where, key.key),
                        std::string(key.meaning));
    }
  }

 private:
  void WrongType(const toml::node& node, std::string_view what, std::string_view wanted) {
    complaints_.Error(codes::kWrongType,
                      complaints_.Span(node),
                      fmt::format("{} must be {}, not {}", what, wanted, TypeName(node)));
  }

  void Value(const toml::node& node, const KeyRule& rule, const std::string& where) {
    const std::string what = Quoted(rule.key);
    switch (rule.kind) {
      case ValueKind::kVersion:
        return Version(node);
      case ValueKind::kText:
        return node.is_string() ? void() : WrongType(node, what, "a string");
      case ValueKind::kWord:
        return Word(node, rule, what);
      case ValueKind::kWords:
        return Words(node, rule, what);
      case ValueKind::kNumber:
        return Number(node, rule, what);
      case ValueKind::kInterval:
        return static_cast<void>(JudgeInterval(node, what, complaints_));
      case ValueKind::kTriple:
        return Triple(node, what);
      case ValueKind::kFlag:
        return node.is_boolean() ? void() : WrongType(node, what, "true or false");
      case ValueKind::kTexts:
        return Texts(node, what);
      case ValueKind::kTable:
        if (const toml::table* table = node.as_table())
          return Table(*table, *rule.table, Below(where, rule.key));
        return WrongType(node, what, "a table");
      case ValueKind::kTablesByName:
      case ValueKind::kWordsByName:
      case ValueKind::kTextsByName:
        return ByName(node, rule, where);
      case ValueKind::kTableList:
        return TableList(node, rule, what);
      case ValueKind::kAnything:
        return;
    }
  }

  void Version(const toml::node& node) {
    const auto version = node.value_exact<std::int64_t>();
    if (!version) return WrongType(node, "'kompono'", "the integer 1");
    if (*version == 1) return;
    complaints_.Error(codes::kNewerFormat,
                      complaints_.Span(node),
                      fmt::format("study format {} is not known", *version),
                      *version > 1 ? "this program reads format 1; a newer one may read this file"
                                   : "write kompono = 1");
  }

  void Word(const toml::node& node, const KeyRule& rule, std::string_view what) {
    const auto word = node.value_exact<std::string>();
    if (!word) return WrongType(node, what, "a string");
    if (std::find(rule.words.begin(), rule.words.end(), *word) != rule.words.end()) return;
    complaints_.Error(codes::kUnknownWord,
                      complaints_.Span(node),
                      fmt::format("{} cannot be '{}'", what, *word),
                      fmt::format("known are: {}", fmt::join(rule.words, ", ")));
  }

  void Words(const toml::node& node, const KeyRule& rule, std::string_view what) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return WrongType(node, what, "a list of strings");
    std::set<std::string> seen;
    for (const toml::node& element : *list) {
      Word(element, rule, fmt::format("each entry of {}", what));
      const auto word = element.value_exact<std::string>();
      if (!word || seen.insert(*word).second) continue;
      complaints_.Error(codes::kNameTaken,
                        complaints_.Span(element),
                        fmt::format("'{}' stands twice in {}", *word, what));
    }
    if (!list->empty()) return;
    complaints_.Error(codes::kWrongCount,
                      complaints_.Span(node),
                      fmt::format("{} must not be empty", what),
                      fmt::format("known are: {}", fmt::join(rule.words, ", ")));
  }

  void Number(const toml::node& node, const KeyRule& rule, std::string_view what) {
    const auto value = JudgeNumber(node, what, complaints_);
    if (!value || !rule.positive || *value > 0.0) return;
    complaints_.Error(codes::kOutOfRange,
                      complaints_.Span(node),
                      fmt::format("{} must be greater than 0, not {}", what, *value));
  }

  void Triple(const toml::node& node, std::string_view what) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return WrongType(node, what, "a list of 3 numbers");
    for (const toml::node& element : *list) {
      static_cast<void>(JudgeNumber(element, fmt::format("each number of {}", what), complaints_));
    }
    if (list->size() == 3) return;
    complaints_.Error(codes::kWrongCount,
                      complaints_.Span(node),
                      fmt::format("{} needs 3 numbers, not {}", what, list->size()));
  }

  void Texts(const toml::node& node, std::string_view what) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return WrongType(node, what, "a list of strings");
    for (const toml::node& element : *list) {
      if (!element.is_string()) {
        WrongType(element, fmt::format("each entry of {}", what), "a string");
      }
    }
  }

  void ByName(const toml::node& node, const KeyRule& rule, const std::string& where) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return WrongType(node, Quoted(rule.key), "a table");
    for (const auto& [name, value] : *table) {
      const std::string what = Quoted(name.str());
      if (rule.kind == ValueKind::kWordsByName) {
        Word(value, rule, what);
      } else if (rule.kind == ValueKind::kTextsByName) {
        if (!value.is_string()) WrongType(value, what, "a string");
      } else if (const toml::table* inner = value.as_table()) {
        Table(*inner, *rule.table, Below(Below(where, rule.key), name.str()));
      } else {
        WrongType(value, what, "a table");
      }
    }
  }

  void TableList(const toml::node& node, const KeyRule& rule, std::string_view what) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return WrongType(node, what, fmt::format("tables [[{}]]", rule.key));
    for (const toml::node& element : *list) {
      if (const toml::table* table = element.as_table()) {
        Table(*table, *rule.table, std::string(rule.table->title));
      } else {
        WrongType(element, fmt::format("each entry of {}", what), "a table");
      }
    }
  }

  Complaints& complaints_;
};

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

std::optional<std::array<double, 2>> JudgeInterval(const toml::node& node,
                                                   std::string_view what,
                                                   Complaints& complaints) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != 2) {
    complaints.Error(list == nullptr ? codes::kWrongType : codes::kWrongCount,
                     complaints.Span(node),
                     fmt::format("{} must be a list of 2 numbers", what),
                     "write [lower, upper]");
    return std::nullopt;
  }
  const std::string each = fmt::format("each number of {}", what);
  const auto lower = JudgeNumber(*list->get(0), each, complaints);
  const auto upper = JudgeNumber(*list->get(1), each, complaints);
  if (!lower || !upper) return std::nullopt;
  if (*lower < *upper) return std::array<double, 2>{*lower, *upper};
  complaints.Error(
      codes::kReversedRange,
      complaints.Span(node),
      fmt::format("lower limit {} of {} is not below the upper one, {}", *lower, what, *upper),
      *lower > *upper ? fmt::format("write [{}, {}]", *upper, *lower)
                      : "a motion or size that cannot change needs no range");
  return std::nullopt;
}

std::optional<double> NumberOf(const toml::node* node) {
  if (node == nullptr) return std::nullopt;
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
  if (!lower || !upper || *lower >= *upper) return std::nullopt;
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

std::vector<std::string> TextsAt(const toml::table& table, std::string_view key) {
  std::vector<std::string> texts;
  const toml::node* node = table.get(key);
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr) return texts;
  for (const toml::node& element : *list) {
    if (auto text = element.value_exact<std::string>()) texts.push_back(std::move(*text));
  }
  return texts;
}

const toml::table* TableAt(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  return node == nullptr ? nullptr : node->as_table();
}

std::vector<NamedTable> TablesAt(const toml::table& table, std::string_view key) {
  std::vector<NamedTable> tables;
  const toml::table* outer = TableAt(table, key);
  if (outer == nullptr) return tables;
  for (const auto& [name, node] : *outer) {
    if (const toml::table* inner = node.as_table()) {
      tables.push_back({std::string(name.str()), inner, name.source()});
    }
  }
  std::stable_sort(tables.begin(), tables.end(), [](const auto& a, const auto& b) {
    return a.place.begin.line != b.place.begin.line ? a.place.begin.line < b.place.begin.line
                                                    : a.place.begin.column < b.place.begin.column;
  });
  return tables;
}

}  // namespace kompono::synthesis
