// SPDX-License-Identifier: Apache-2.0
// TOML knows nan and inf. In the place of any number of any shipped layout they are refused, with
// the number's own line.
#include "shipped_registry.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <toml++/toml.h>

namespace kompono::layout {
namespace {

void Collect(const toml::node& node, std::vector<toml::source_region>* numbers) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) Collect(value, numbers);
  } else if (const toml::array* list = node.as_array()) {
    for (const toml::node& element : *list) Collect(element, numbers);
  } else if (node.is_number()) {
    numbers->push_back(node.source());
  }
}

/// The text with what stands at `place` replaced; lines and columns count from 1, and no line with
/// a number has a letter outside ASCII before it.
std::string With(const std::string& text, const toml::source_region& place, std::string_view word) {
  std::size_t begin = 0;
  for (unsigned line = 1; line < place.begin.line; ++line) begin = text.find('\n', begin) + 1;
  begin += place.begin.column - 1;
  std::size_t end = begin;
  while (end < text.size() &&
         std::string_view("+-.eE0123456789_").find(text[end]) != std::string_view::npos)
    ++end;
  return text.substr(0, begin) + std::string(word) + text.substr(end);
}

class NotFinite : public testing::TestWithParam<std::string> {};

TEST_P(NotFinite, IsRefusedInThePlaceOfAnyNumber) {
  const std::string text = ReadText(GetParam());
  std::vector<toml::source_region> numbers;
  Collect(toml::parse(text), &numbers);
  ASSERT_FALSE(numbers.empty());
  for (const toml::source_region& place : numbers) {
    for (const std::string_view word : {"nan", "inf", "-inf"}) {
      const Parsed<Layout> layout =
          ParseLayout(With(text, place, word), "x.toml", ShippedRegistry());
      ASSERT_FALSE(layout) << word << " in line " << place.begin.line << " was taken";
      EXPECT_TRUE(std::any_of(layout.error().begin(),
                              layout.error().end(),
                              [&](const Diagnostic& d) {
                                return d.span.line == static_cast<int>(place.begin.line) &&
                                       d.code != "E0301";
                              }))
          << word << " in line " << place.begin.line << '\n'
          << RenderAll(layout.error(), {});
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         NotFinite,
                         testing::ValuesIn(TomlFilesIn("layouts/machines")),
                         [](const auto& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

}  // namespace
}  // namespace kompono::layout
