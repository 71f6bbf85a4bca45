// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_FORMULA_PLACE_HPP_
#define KOMPONO_LAYOUT_FORMULA_PLACE_HPP_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::layout {

/// Where the characters of a TOML string stand in the file, so that a complaint about the formula
/// points inside the string, escapes and multi-line strings included.
class FormulaPlace {
 public:
  /// `region` is the string's place in `text`, `value` what TOML made of it.
  FormulaPlace(std::string_view text, const toml::source_region& region, std::string_view value);

  /// A span of the value, as a span of the file.
  [[nodiscard]] SourceSpan InFile(const SourceSpan& span) const;
  /// The place of ":name", or of the whole string if it is not written like that.
  [[nodiscard]] SourceSpan OfBlock(std::string_view name) const;
  /// The place of some text that stands there once, or of the whole string.
  [[nodiscard]] SourceSpan OfText(std::string_view text) const;
  /// The place of the whole string.
  [[nodiscard]] SourceSpan Whole() const { return whole_; }

 private:
  [[nodiscard]] SourceSpan Between(std::size_t begin, std::size_t end) const;

  std::string_view text_;
  std::string value_;
  SourceSpan whole_;
  /// Where every byte of the value, and its end, begins in the file.
  std::vector<std::size_t> begin_;
  /// Where the file's text for every byte of the value ends.
  std::vector<std::size_t> end_;
};

/// Byte offset of a 1-based line and column (code points) of `text`.
[[nodiscard]] std::size_t OffsetAt(std::string_view text, int line, int column);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_FORMULA_PLACE_HPP_
