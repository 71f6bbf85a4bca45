// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_TOML_TABLE_HPP_
#define KOMPONO_PLUGIN_HOST_TOML_TABLE_HPP_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "kompono/diagnostics/diagnostic.hpp"

/// Reads a TOML table key by key, remembering which keys somebody asked for, so that every problem
/// of a file is found in one run and a misspelt key is never silently dropped.
namespace kompono::plugin {

/// The text being judged and what was found wrong with it. Codes: E0220 not TOML, E0221 unknown
/// key, E0222 missing key, E0223 wrong type, E0224 value not allowed, E0225 name given twice, E0226
/// refers to a name that is not there, E0227 presets in a circle.
class Complaints {
 public:
  Complaints(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  [[nodiscard]] SourceSpan Span(const toml::source_region& region) const;
  void Add(std::string_view code, SourceSpan span, std::string message, std::string help = {});
  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] Diagnostics Take() { return std::move(list_); }

 private:
  std::string_view text_;
  std::string_view file_;
  Diagnostics list_;
};

template <class T>
struct Placed {
  T value;
  SourceSpan span;
};

enum class Need { kOptional, kRequired };

class TableReader {
 public:
  /// `name` says to people where we are: "[[module]] 'pyramid'"; empty for the file itself.
  TableReader(const toml::table& table, std::string name, Complaints& complaints);

  [[nodiscard]] std::optional<std::string> String(std::string_view key, Need need);
  [[nodiscard]] std::optional<bool> Bool(std::string_view key);
  [[nodiscard]] std::optional<int> Integer(std::string_view key, Need need);
  [[nodiscard]] std::optional<double> Number(std::string_view key);
  [[nodiscard]] std::vector<Placed<std::string>> Strings(std::string_view key);
  /// A list of tables, written as [[key]] or as key = [ {..}, {..} ].
  [[nodiscard]] std::vector<TableReader> Tables(std::string_view key);
  [[nodiscard]] std::optional<TableReader> Table(std::string_view key);
  /// A number, a list of numbers or a list of lists of numbers, read row by row.
  [[nodiscard]] std::optional<std::vector<double>> FlatNumbers(std::string_view key);

  [[nodiscard]] bool Has(std::string_view key) const { return table_->contains(key); }
  /// All keys as written; for tables whose keys are names and not fixed words.
  [[nodiscard]] std::vector<std::string> Keys() const;
  /// Place of a key's value, or of the table itself if the key is not there.
  [[nodiscard]] SourceSpan At(std::string_view key) const;
  [[nodiscard]] SourceSpan Here() const { return complaints_->Span(table_->source()); }
  /// How many numbers stand in each innermost list of `key`: 0 for a plain number, 3 for [x, y, z]
  /// and for [[x, y, z], ..], -1 if the rows differ. Only after FlatNumbers accepted the value.
  [[nodiscard]] int RowLength(std::string_view key) const;
  [[nodiscard]] bool IsNested(std::string_view key) const;
  [[nodiscard]] bool IsArray(std::string_view key) const;
  [[nodiscard]] bool IsString(std::string_view key) const;

  void Rename(std::string name) { name_ = std::move(name); }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Complaints& complaints() const { return *complaints_; }
  void Complain(std::string_view code,
                std::string_view key,
                std::string message,
                std::string help = {});
  /// Complains of every key nobody asked for. Call it last.
  void RefuseUnknownKeys();

 private:
  const toml::node* Take(std::string_view key, Need need);
  void WrongType(std::string_view key, const toml::node& node, std::string_view wanted);
  bool AppendNumbers(std::string_view key,
                     const toml::node& node,
                     int depth,
                     std::vector<double>& out);

  const toml::table* table_;
  std::string name_;
  Complaints* complaints_;
  std::vector<std::string> known_;
};

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_TOML_TABLE_HPP_
