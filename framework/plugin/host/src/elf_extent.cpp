// SPDX-License-Identifier: Apache-2.0
#include "elf_extent.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

namespace kompono::plugin {

std::string MissingBytes(const std::filesystem::path& library) {
  constexpr unsigned char kOurClass = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(library, error);
  std::ifstream stream(library, std::ios::binary);
  ElfW(Ehdr) head{};
  if (error || !stream.read(reinterpret_cast<char*>(&head), sizeof head) ||
      std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_ident[EI_CLASS] != kOurClass) {
    return "";
  }
  std::uintmax_t needed = head.e_phoff + std::uintmax_t{head.e_phnum} * sizeof(ElfW(Phdr));
  stream.seekg(static_cast<std::streamoff>(head.e_phoff));
  for (int i = 0; i < head.e_phnum; ++i) {
    ElfW(Phdr) segment{};
    if (!stream.read(reinterpret_cast<char*>(&segment), sizeof segment)) break;
    if (segment.p_type != PT_LOAD) continue;
    // A size that wraps around is as wrong as one that is too large.
    const std::uintmax_t end = std::uintmax_t{segment.p_offset} + segment.p_filesz;
    needed = std::max(needed, end < segment.p_offset ? UINTMAX_MAX : end);
  }
  if (needed <= size) return "";
  return fmt::format("the file is cut off: it has {} bytes of at least {}", size, needed);
}

}  // namespace kompono::plugin
