// SPDX-License-Identifier: Apache-2.0
#include "failure.hpp"

#include <fmt/format.h>

#include <cstdint>

#include <sqlite3.h>

namespace kompono::catalog {

Diagnostic Complaint(std::string code, std::string file, std::string message, std::string help) {
  return {.severity = Severity::kError,
          .code = std::move(code),
          .file = std::move(file),
          .message = std::move(message),
          .help = std::move(help)};
}

tl::unexpected<Diagnostics> Refuse(std::string code,
                                   std::string file,
                                   std::string message,
                                   std::string help) {
  return tl::make_unexpected(Diagnostics{
      Complaint(std::move(code), std::move(file), std::move(message), std::move(help))});
}

Diagnostic FromSqlite(int code, std::string_view message, const std::string& file) {
  switch (code & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Complaint("E0509",
                       file,
                       "the catalog is in use by another program",
                       "try again when the other program has finished writing");
    case SQLITE_CORRUPT:
      return Complaint("E0508",
                       file,
                       fmt::format("the catalog is damaged: {}", message),
                       "restore a copy, or rescue what is readable with 'sqlite3 FILE .recover'");
    case SQLITE_NOTADB:
      return Complaint("E0503", file, "this is not an SQLite database");
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return Complaint(
          "E0502",
          file,
          fmt::format("the catalog cannot be opened or written: {}", message),
          "check the permissions of the file and of its folder; SQLite writes beside the file");
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_NOMEM:
      return Complaint("E0510", file, fmt::format("reading or writing failed: {}", message));
    case SQLITE_CONSTRAINT:
      return Complaint("E0511", file, fmt::format("the catalog refuses the row: {}", message));
    case SQLITE_AUTH:
      return Complaint("E0508",
                       file,
                       "the catalog's views do what no view of a catalog does",
                       "see what 'kompono catalog verify' says");
    case SQLITE_ERROR:
    case SQLITE_SCHEMA:
      return Complaint("E0508",
                       file,
                       fmt::format("the catalog's tables are not as they should be: {}", message),
                       "see what 'kompono catalog verify' says");
    default:
      return Complaint("E0510", file, fmt::format("SQLite reports: {}", message));
  }
}

bool IsText(std::string_view bytes) {
  std::size_t i = 0;
  while (i < bytes.size()) {
    const auto first = static_cast<std::uint8_t>(bytes[i]);
    if (first == 0) return false;
    if (first < 0x80) {
      ++i;
      continue;
    }
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || bytes.size() - i < length) return false;
    std::uint32_t point = first & (0xFFU >> (length + 1));
    for (std::size_t k = 1; k < length; ++k) {
      const auto next = static_cast<std::uint8_t>(bytes[i + k]);
      if ((next & 0xC0U) != 0x80U) return false;
      point = (point << 6U) | (next & 0x3FU);
    }
    const bool overlong = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
    if (overlong || point > 0x10FFFF || (point >= 0xD800 && point <= 0xDFFF)) return false;
    i += length;
  }
  return true;
}

}  // namespace kompono::catalog
