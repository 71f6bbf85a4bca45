// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_OPENING_HPP_
#define KOMPONO_CATALOG_SRC_OPENING_HPP_

#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <memory>

#include "kompono/catalog/store.hpp"
#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::catalog {

struct Opened {
  std::unique_ptr<SQLite::Database> db;
  bool immutable = false;  ///< on a medium that cannot be written; read without locks
  Diagnostics notes;
};

/// Judges the file by its first bytes before SQLite may touch it, then opens, creates or migrates
/// it.
[[nodiscard]] Parsed<Opened> OpenCatalog(const std::filesystem::path& path,
                                         const OpenOptions& options);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_OPENING_HPP_
