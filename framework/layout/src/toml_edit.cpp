// SPDX-License-Identifier: Apache-2.0
#include "toml_edit.hpp"

#include "formula_place.hpp"
#include <fmt/format.h>

#include <algorithm>

namespace kompono::layout {
namespace {

std::string TomlKey(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-';
  });
  return bare ? std::string(key) : TomlString(key);
}

std::string DottedKey(const TomlEdit::Path& path, std::size_t from, std::size_t to) {
  std::string text;
  for (std::size_t i = from; i < to; ++i) {
    if (i > from) text += '.';
    text += TomlKey(path[i]);
  }
  return text;
}

}  // namespace

std::string TomlNumber(double value) {
  return value == 0.0 ? "0" : fmt::format("{}", value);
}

std::string TomlString(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

TomlEdit::TomlEdit(std::string text) : text_(std::move(text)) {
  if (text_.find("\r\n") != std::string::npos) line_end_ = "\r\n";
  root_ = toml::parse(text_);
}

const toml::node* TomlEdit::Find(const Path& path) const {
  const toml::node* node = &root_;
  for (const std::string& key : path) {
    const toml::table* table = node->as_table();
    node = table == nullptr ? nullptr : table->get(key);
    if (node == nullptr) return nullptr;
  }
  return node;
}

std::pair<std::size_t, std::size_t> TomlEdit::Range(const toml::source_region& region) const {
  const auto offset = [this](const toml::source_position& at) {
    return OffsetAt(text_, static_cast<int>(at.line), static_cast<int>(at.column));
  };
  return {offset(region.begin), offset(region.end)};
}

void TomlEdit::Splice(std::size_t begin, std::size_t end, std::string_view with) {
  text_.replace(begin, end - begin, with);
  root_ = toml::parse(text_);
}

void TomlEdit::Replace(const Path& path,
                       const std::vector<std::size_t>& indices,
                       std::string_view value) {
  const toml::node* node = Find(path);
  for (const std::size_t index : indices) node = node->as_array()->get(index);
  const auto [begin, end] = Range(node->source());
  Splice(begin, end, value);
}

/// A table that a header names has that header's place; one that is only implied by the header of a
/// table below shares that one's place; one made by a dotted key has the place of its key.
TomlEdit::Form TomlEdit::FormOf(const toml::table& table) const {
  const std::size_t begin = Range(table.source()).first;
  if (begin < text_.size() && text_[begin] == '{') return Form::kInline;
  if (begin >= text_.size() || text_[begin] != '[') return Form::kDotted;
  const bool implied = std::any_of(table.begin(), table.end(), [&table](const auto& entry) {
    return entry.second.is_table() && entry.second.source().begin == table.source().begin;
  });
  return implied ? Form::kImplied : Form::kHeader;
}

std::vector<TomlEdit::Section> TomlEdit::SectionsOn(const Path& path) const {
  std::vector<Section> sections{{&root_, 0, Form::kRoot}};
  while (sections.back().depth < path.size()) {
    const toml::node* next = sections.back().table->get(path[sections.back().depth]);
    const toml::table* table = next == nullptr ? nullptr : next->as_table();
    if (table == nullptr) break;
    sections.push_back({table, sections.back().depth + 1, FormOf(*table)});
  }
  return sections;
}

bool TomlEdit::Add(const Path& path, std::string_view value, bool in_section) {
  std::vector<Section> sections = SectionsOn(path);
  if (sections.back().depth + 1 > path.size()) return false;
  if (sections.back().table->get(path[sections.back().depth]) != nullptr) return false;
  while (sections.back().form == Form::kDotted) sections.pop_back();
  const Section& in = sections.back();
  const std::string entry = fmt::format("{} = {}", DottedKey(path, in.depth, path.size()), value);
  // A dotted key over more than one new table reads badly; a section of its own does not.
  const std::size_t missing = path.size() - in.depth;
  const bool short_way = missing <= (in_section ? 1 : 2);
  if (in.form == Form::kInline) {
    AddInline(*in.table, entry);
  } else if (in.form == Form::kHeader && (short_way || in.table->contains(path[in.depth]))) {
    AddLine(*in.table, entry);
  } else if (in.form == Form::kRoot && in.table->contains(path[in.depth])) {
    AddLine(root_, entry);
  } else {
    AddSection(path, value);
  }
  return true;
}

void TomlEdit::AddInline(const toml::table& table, const std::string& entry) {
  const auto [begin, end] = Range(table.source());
  const std::size_t last = text_.find_last_not_of(" \t", end - 2);
  if (last <= begin) return Splice(begin, end, "{ " + entry + " }");
  Splice(last + 1, last + 1, ", " + entry);
}

/// The end of the last entry that stands in the table's own section; `end` if there is none.
std::size_t TomlEdit::EndOfEntries(const toml::table& table, std::size_t end) const {
  for (const auto& [key, node] : table) {
    const toml::table* below = node.as_table();
    const Form form = below == nullptr ? Form::kInline : FormOf(*below);
    if (form == Form::kInline) end = std::max(end, Range(node.source()).second);
    if (form == Form::kDotted) end = EndOfEntries(*below, end);
  }
  return end;
}

void TomlEdit::AddLine(const toml::table& table, const std::string& entry) {
  const auto [begin, header_end] = Range(table.source());
  const bool whole_file = &table == &root_;
  const std::size_t last = EndOfEntries(table, whole_file ? 0 : header_end);
  const std::size_t line = text_.rfind('\n', begin);
  const std::size_t line_begin = line == std::string::npos ? 0 : line + 1;
  const std::string indentation = whole_file ? "" : text_.substr(line_begin, begin - line_begin);
  const std::size_t line_end = text_.find('\n', last);
  if (line_end == std::string::npos) {
    Splice(text_.size(), text_.size(), line_end_ + indentation + entry + line_end_);
  } else {
    Splice(line_end + 1, line_end + 1, indentation + entry + line_end_);
  }
}

void TomlEdit::AddSection(const Path& path, std::string_view value) {
  std::string section = text_.empty() || text_.back() == '\n' ? "" : line_end_;
  section += fmt::format("{0}[{1}]{0}{2} = {3}{0}",
                         line_end_,
                         DottedKey(path, 0, path.size() - 1),
                         TomlKey(path.back()),
                         value);
  Splice(text_.size(), text_.size(), section);
}

void TomlEdit::Remove(const Path& path) {
  const std::vector<Section> sections = SectionsOn(path);
  const Section& in = sections.back();
  if (in.depth + 1 != path.size() || (in.form != Form::kHeader && in.form != Form::kRoot)) return;
  const auto entry = in.table->find(path.back());
  if (entry == in.table->end()) return;
  const std::size_t begin = Range(entry->first.source()).first;
  const std::size_t end = Range(entry->second.source()).second;
  const std::size_t before = text_.rfind('\n', begin);
  const std::size_t after = text_.find('\n', end);
  Splice(before == std::string::npos ? 0 : before + 1,
         after == std::string::npos ? text_.size() : after + 1,
         "");
}

}  // namespace kompono::layout
