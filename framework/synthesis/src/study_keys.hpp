// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_STUDY_KEYS_HPP_
#define KOMPONO_SYNTHESIS_STUDY_KEYS_HPP_

#include "complaints.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The one table of a study file's keys. The reader judges by it, suggestions come from it, the
/// JSON Schema is printed from it.
namespace kompono::synthesis {

enum class ValueKind {
  kVersion,  ///< the integer 1
  kText,
  kWord,   ///< one of KeyRule::words
  kWords,  ///< a list of them, each once, at least one
  kNumber,
  kInterval,  ///< [lower, upper], lower less than upper
  kTriple,
  kFlag,
  kTexts,
  kTable,         ///< KeyRule::table
  kTablesByName,  ///< names chosen by the user, each a KeyRule::table
  kTableList,     ///< [[rule]]
  kWordsByName,   ///< each one of KeyRule::words
  kTextsByName,
  kAnything,  ///< judged elsewhere
};

struct TableRule;

struct KeyRule {
  std::string_view key;
  ValueKind kind = ValueKind::kText;
  std::string_view meaning;
  const TableRule* table = nullptr;
  std::span<const std::string_view> words = {};
  bool required = false;
  bool positive = false;  ///< numbers must be greater than 0
};

struct TableRule {
  std::string_view title;  ///< "[motions.<name>]", for the schema
  std::span<const KeyRule> keys;

  [[nodiscard]] const KeyRule* Find(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> KeyNames() const;
};

/// The rule of the whole file.
[[nodiscard]] const TableRule& StudyRuleOfFile();

/// Everything that can be said of keys and types without knowing modules.
void JudgeShape(const toml::table& table,
                const TableRule& rule,
                const std::string& where,
                Complaints& complaints);

/// What stands in the table if it has the right type, for reading after JudgeShape.
[[nodiscard]] std::optional<double> NumberOf(const toml::node* node);
[[nodiscard]] std::optional<double> NumberAt(const toml::table& table, std::string_view key);
[[nodiscard]] std::optional<std::array<double, 2>> IntervalOf(const toml::node* node);
[[nodiscard]] std::optional<std::array<double, 3>> TripleAt(const toml::table& table,
                                                            std::string_view key);
[[nodiscard]] std::optional<std::string> TextAt(const toml::table& table, std::string_view key);
[[nodiscard]] std::vector<std::string> TextsAt(const toml::table& table, std::string_view key);
[[nodiscard]] const toml::table* TableAt(const toml::table& table, std::string_view key);
/// Tables by name, in the order of the file.
struct NamedTable {
  std::string name;
  const toml::table* table = nullptr;
  toml::source_region place;  ///< of the name
};
[[nodiscard]] std::vector<NamedTable> TablesAt(const toml::table& table, std::string_view key);

/// The number, or nothing after a complaint.
[[nodiscard]] std::optional<double> JudgeNumber(const toml::node& node,
                                                std::string_view what,
                                                Complaints& complaints);
/// [lower, upper] with lower less than upper, or nothing after a complaint.
[[nodiscard]] std::optional<std::array<double, 2>> JudgeInterval(const toml::node& node,
                                                                 std::string_view what,
                                                                 Complaints& complaints);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_STUDY_KEYS_HPP_
