// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_SHAPE_HPP_
#define KOMPONO_LAYOUT_SHAPE_HPP_

#include "complaints.hpp"
#include "keys.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace kompono::layout {

/// Judges keys, types, counts and finiteness of a table and everything below it, except what only a
/// module's description or the formula can tell. `where` says to people which table it is; empty
/// for the file itself.
void JudgeShape(const toml::table& table,
                const TableRule& rule,
                const std::string& where,
                Complaints& complaints);

/// A finite number, or nothing after a complaint. `what` is the subject of the sentence: "'speed'".
[[nodiscard]] std::optional<double> JudgeNumber(const toml::node& node,
                                                std::string_view what,
                                                Complaints& complaints);

/// What JudgeShape has already judged, read without further words: nothing if the key is missing or
/// its value was refused.
[[nodiscard]] std::optional<double> NumberAt(const toml::table& table, std::string_view key);
[[nodiscard]] std::optional<double> NumberOf(const toml::node* node);
[[nodiscard]] std::optional<std::array<double, 2>> IntervalOf(const toml::node* node);
[[nodiscard]] std::optional<std::array<double, 3>> TripleAt(const toml::table& table,
                                                            std::string_view key);
[[nodiscard]] std::optional<std::string> TextAt(const toml::table& table, std::string_view key);
[[nodiscard]] std::optional<int> SignOf(const toml::node* node);
[[nodiscard]] const toml::table* TableAt(const toml::table& table, std::string_view key);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_SHAPE_HPP_
