// SPDX-License-Identifier: Apache-2.0
#include "kompono/layout/places.hpp"

#include "complaints.hpp"

namespace kompono::layout {

SourceSpan PlaceOf(const Layout& layout,
                   const std::vector<std::string>& keys,
                   std::optional<std::size_t> element) {
  toml::table root;
  try {
    root = toml::parse(layout.text);
  } catch (const toml::parse_error&) {
    return {};  // made by a program, without a text
  }
  const toml::node* node = &root;
  for (const std::string& key : keys) {
    const toml::table* table = node->as_table();
    const toml::node* next = table != nullptr ? table->get(key) : nullptr;
    if (next == nullptr) {
      element.reset();
      break;
    }
    node = next;
  }
  const toml::array* list = node->as_array();
  if (element && list != nullptr && *element < list->size()) node = list->get(*element);
  if (node == &root) return {};
  return Complaints(layout.text, {}).Span(*node);
}

}  // namespace kompono::layout
