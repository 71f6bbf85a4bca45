// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_SCHEMA_HPP_
#define KOMPONO_CATALOG_SRC_SCHEMA_HPP_

#include <SQLiteCpp/Database.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::catalog {

/// "KOMP" in SQLite's header: what tells our files from other databases.
inline constexpr std::int32_t kApplicationId = 0x4B4F4D50;

/// The public interface of the file; queries read these and nothing else.
inline constexpr std::array<std::string_view, 17> kViews = {"layouts",
                                                            "metrics",
                                                            "metric_values",
                                                            "measures",
                                                            "parameters",
                                                            "capabilities",
                                                            "calibrations",
                                                            "measurements",
                                                            "modules",
                                                            "motions",
                                                            "formulas",
                                                            "plugins",
                                                            "studies",
                                                            "rules",
                                                            "runs",
                                                            "evaluations",
                                                            "evaluation_metrics"};

struct Migration {
  int version;
  const char* name;
  const char* sql;
};

/// schema/NNNN_name.sql in order, numbered from 1 without gaps.
[[nodiscard]] std::span<const Migration> Migrations();

[[nodiscard]] int NewestVersion();
[[nodiscard]] int VersionOf(SQLite::Database& db);

/// "file:..." for sqlite3_open_v2 with SQLITE_OPEN_URI; `immutable`: SQLite takes no locks and
/// writes nothing beside.
[[nodiscard]] std::string UriOf(const std::filesystem::path& path, bool immutable);

/// UTC, "2025-03-01T12:00:00Z".
[[nodiscard]] std::string Now();

/// Settings of a connection that may write: foreign keys, write-ahead log, defences against a
/// doctored file.
void Configure(SQLite::Database& db);

/// A catalog without layouts in an empty database.
void CreateSchema(SQLite::Database& db);

/// Brings `db` at `path` to the newest version, one transaction per step, after copying it to
/// `<path>.v<N>.bak`. Returns the notes to show, or why it stays as it is.
[[nodiscard]] Parsed<Diagnostics> Upgrade(SQLite::Database& db, const std::filesystem::path& path);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_SCHEMA_HPP_
