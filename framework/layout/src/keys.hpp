// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_KEYS_HPP_
#define KOMPONO_LAYOUT_KEYS_HPP_

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The one table of a layout file's keys. The reader judges by it, suggestions come from it, the
/// JSON Schema is printed from it.
namespace kompono::layout {

enum class ValueKind {
  kVersion,  ///< the integer 1
  kText,
  kWord,  ///< one of KeyRule::words
  kNumber,
  kInterval,  ///< [lower, upper]
  kTriple,    ///< [x, y, z] or [a, b, c]
  kSign,      ///< "+", "-", 1 or -1
  kFlag,
  kIndex,  ///< an integer from 0
  kTexts,
  kTable,         ///< KeyRule::table
  kTablesByName,  ///< names chosen by the user, each a KeyRule::table
  kNumbersByName,
  kIntervalsByName,
  kSignsByName,
  kParameters,  ///< judged by the module's description
  kAnything,
};

/// What a number measures; its unit in the file follows from `units`.
enum class Quantity {
  kNone,
  kLength,
  kAngle,
  kByLetter,      ///< length or angle, as the axis, drive or parameter is
  kSpeed,         ///< length or angle per minute
  kAcceleration,  ///< length or angle per second squared
  kStiffness,     ///< N/µm, for rotary drives N·m/rad
};

struct TableRule;

struct KeyRule {
  std::string_view key;
  ValueKind kind = ValueKind::kText;
  std::string_view meaning;
  Quantity quantity = Quantity::kNone;
  const TableRule* table = nullptr;
  std::span<const std::string_view> words = {};
  bool required = false;
  bool positive = false;  ///< numbers must be greater than 0
  bool numbered = false;  ///< the key may carry digits: part, part1, part2
};

struct TableRule {
  std::string_view title;  ///< "[axis.<name>]", for the schema and the documentation
  std::span<const KeyRule> keys;
  bool open = false;  ///< unknown keys are kept and not judged

  [[nodiscard]] const KeyRule* Find(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> KeyNames() const;
};

/// The rule of the whole file.
[[nodiscard]] const TableRule& FileRule();

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_KEYS_HPP_
