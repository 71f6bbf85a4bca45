// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_VERIFYING_HPP_
#define KOMPONO_CATALOG_SRC_VERIFYING_HPP_

#include <SQLiteCpp/Database.h>

#include <string>

#include "kompono/catalog/store.hpp"

namespace kompono::catalog {

/// E0530 SQLite's integrity check, E0531 foreign keys, E0532 a layout's hash, E0533 a calibration's
/// hash or a residual that is not that of the newest calibration, E0534 tables or views other than
/// this program's.
[[nodiscard]] VerifyReport VerifyCatalog(SQLite::Database& db, const std::string& file);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_VERIFYING_HPP_
