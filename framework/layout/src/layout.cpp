// SPDX-License-Identifier: Apache-2.0
#include "kompono/layout/layout.hpp"

#include "reader.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

#include "kompono/layout/codes.hpp"

namespace kompono::layout {
namespace {

/// Larger files are no layouts; they are not looked into.
constexpr std::size_t kMaxFileBytes = 4U << 20U;

template <class T>
const T* FindByName(const std::vector<T>& list, std::string_view name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [name](const T& item) { return item.name == name; });
  return found == list.end() ? nullptr : &*found;
}

Diagnostic CannotRead(const std::filesystem::path& file, std::string message, std::string help) {
  return {.severity = Severity::kError,
          .code = std::string(codes::kCannotRead.code),
          .file = file.string(),
          .span = {},
          .message = std::move(message),
          .help = std::move(help)};
}

Parsed<std::string> ReadText(const std::filesystem::path& file) {
  const auto refuse = [&file](std::string message, std::string help = {}) {
    return tl::unexpected(Diagnostics{CannotRead(file, std::move(message), std::move(help))});
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(status))
    return refuse("this is a folder", "name a layout file (*.toml)");
  if (!std::filesystem::exists(status)) return refuse("the file does not exist");
  std::ifstream in(file, std::ios::binary);
  std::string text;
  std::array<char, 1U << 14U> part{};
  while (in && text.size() <= kMaxFileBytes) {
    in.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (text.size() > kMaxFileBytes) return refuse("the file is too large for a layout");
  if (!in.eof()) return refuse("the file cannot be read");
  return text;
}

}  // namespace

const Block* Layout::FindBlock(std::string_view name_of_block) const {
  return FindByName(blocks, name_of_block);
}
const Axis* Layout::FindAxis(std::string_view name_of_axis) const {
  return FindByName(axes, name_of_axis);
}
const End* Layout::FindEnd(std::string_view name_of_end) const {
  return FindByName(ends, name_of_end);
}

Parsed<Layout> ParseLayout(std::string_view text,
                           std::string_view file,
                           const plugin::Registry& registry,
                           Diagnostics* notes) {
  return LayoutReader(text, file, registry).Read(notes);
}

Parsed<Layout> ReadLayout(const std::filesystem::path& file,
                          const plugin::Registry& registry,
                          Diagnostics* notes) {
  const Parsed<std::string> text = ReadText(file);
  if (!text) return tl::unexpected(text.error());
  return ParseLayout(*text, file.string(), registry, notes);
}

}  // namespace kompono::layout
