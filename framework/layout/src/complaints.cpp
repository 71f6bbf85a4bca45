// SPDX-License-Identifier: Apache-2.0
#include "complaints.hpp"

#include <algorithm>
#include <limits>

namespace kompono::layout {

SourceSpan Complaints::Span(const toml::source_region& region) const {
  const auto line = static_cast<int>(region.begin.line);
  const auto column = static_cast<int>(region.begin.column);
  const int length = region.end.line == region.begin.line
                         ? static_cast<int>(region.end.column) - column
                         : std::numeric_limits<int>::max();
  return SpanAt(text_, line, column, std::max(1, length));
}

void Complaints::Say(Severity severity,
                     const CodeTitle& code,
                     SourceSpan span,
                     std::string message,
                     std::string help) {
  list_.push_back({severity,
                   std::string(code.code),
                   std::string(file_),
                   std::move(span),
                   std::move(message),
                   std::move(help)});
}

std::string ForeignLetters(std::string_view word, std::string otherwise) {
  const bool foreign = std::any_of(
      word.begin(), word.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80U; });
  return foreign ? "some of its letters are not Latin, even if they look it; type it anew"
                 : std::move(otherwise);
}

std::string_view TypeName(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

}  // namespace kompono::layout
