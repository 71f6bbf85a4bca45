// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_TOML_EDIT_HPP_
#define KOMPONO_LAYOUT_TOML_EDIT_HPP_

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace kompono::layout {

/// Changes single values of a TOML text and leaves every other character as it is, comments, order
/// and blank lines included. Each call parses the text anew: a layout is small, and places that are
/// never stale are worth more than speed.
class TomlEdit {
 public:
  using Path = std::vector<std::string>;

  /// `text` must be valid TOML.
  explicit TomlEdit(std::string text);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const toml::table& root() const { return root_; }
  /// The value at `path` (tables and, last, a key), or null.
  [[nodiscard]] const toml::node* Find(const Path& path) const;

  /// Replaces the value at `path`, or the element of a list in it; the place must exist.
  void Replace(const Path& path, const std::vector<std::size_t>& indices, std::string_view value);
  /// Adds `path` = `value`, with the tables that are missing on the way; it must not exist. False
  /// if a value on the way is no table. `in_section`: a missing table gets a header of its own
  /// rather than a dotted key.
  bool Add(const Path& path, std::string_view value, bool in_section = false);
  /// Takes out a key that stands on lines of its own; others stay.
  void Remove(const Path& path);

 private:
  enum class Form { kRoot, kHeader, kImplied, kDotted, kInline };
  struct Section {
    const toml::table* table;
    std::size_t depth;  ///< keys of the path that lead to it
    Form form;
  };

  [[nodiscard]] std::pair<std::size_t, std::size_t> Range(const toml::source_region& region) const;
  [[nodiscard]] Form FormOf(const toml::table& table) const;
  [[nodiscard]] std::vector<Section> SectionsOn(const Path& path) const;
  [[nodiscard]] std::size_t EndOfEntries(const toml::table& table, std::size_t end) const;
  void AddInline(const toml::table& table, const std::string& entry);
  void AddLine(const toml::table& table, const std::string& entry);
  void AddSection(const Path& path, std::string_view value);
  void Splice(std::size_t begin, std::size_t end, std::string_view with);

  std::string text_;
  std::string line_end_ = "\n";
  toml::table root_;
};

/// The number in its shortest form that reads back the same.
[[nodiscard]] std::string TomlNumber(double value);
[[nodiscard]] std::string TomlString(std::string_view text);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_TOML_EDIT_HPP_
