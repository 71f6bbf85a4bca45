// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_EXPORTING_HPP_
#define KOMPONO_CATALOG_SRC_EXPORTING_HPP_

#include <SQLiteCpp/Database.h>

#include <filesystem>

#include "kompono/catalog/store.hpp"

namespace kompono::catalog {

/// The caller holds a transaction, so that everything is as of one moment.
[[nodiscard]] Parsed<ExportSummary> ExportCatalog(SQLite::Database& db,
                                                  ExportFormat format,
                                                  const std::filesystem::path& out);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_EXPORTING_HPP_
