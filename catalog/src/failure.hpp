// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_FAILURE_HPP_
#define KOMPONO_CATALOG_SRC_FAILURE_HPP_

#include <SQLiteCpp/Exception.h>

#include <string>
#include <string_view>
#include <utility>

#include <tl/expected.hpp>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::catalog {

/// One error about a whole file.
[[nodiscard]] Diagnostic Complaint(std::string code,
                                   std::string file,
                                   std::string message,
                                   std::string help = "");

[[nodiscard]] tl::unexpected<Diagnostics> Refuse(std::string code,
                                                 std::string file,
                                                 std::string message,
                                                 std::string help = "");

/// What a result code of SQLite means to the person who named `file`.
[[nodiscard]] Diagnostic FromSqlite(int code, std::string_view message, const std::string& file);

/// Runs `work`, which returns a Parsed<T>, and turns SQLite's exceptions into diagnostics about
/// `file`.
template <class Work>
auto Guarded(const std::string& file, Work&& work) -> decltype(work()) {
  try {
    return std::forward<Work>(work)();
  } catch (const SQLite::Exception& e) {
    return tl::make_unexpected(Diagnostics{FromSqlite(e.getErrorCode(), e.what(), file)});
  }
}

/// True for well-formed UTF-8 (RFC 3629) without NUL.
[[nodiscard]] bool IsText(std::string_view bytes);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_FAILURE_HPP_
