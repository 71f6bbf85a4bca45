// SPDX-License-Identifier: Apache-2.0
#include "complaints.hpp"

#include <algorithm>
#include <limits>

namespace kompono::synthesis {

SourceSpan Complaints::Span(const toml::source_region& region) const {
  const auto line = static_cast<int>(region.begin.line);
  const auto column = static_cast<int>(region.begin.column);
  const int length = region.end.line == region.begin.line
                         ? static_cast<int>(region.end.column) - column
                         : std::numeric_limits<int>::max();
  return SpanAt(text_, line, column, std::max(1, length));
}

void Complaints::Say(Severity severity,
                     std::string_view code,
                     SourceSpan span,
                     std::string message,
                     std::string help) {
  list_.push_back({severity,
                   std::string(code),
                   std::string(file_),
                   std::move(span),
                   std::move(message),
                   std::move(help)});
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

}  // namespace kompono::synthesis
