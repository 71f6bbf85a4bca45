// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_READING_HPP_
#define KOMPONO_CATALOG_SRC_READING_HPP_

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/catalog/hash.hpp"
#include "kompono/catalog/store.hpp"

namespace kompono::catalog {

/// The layout a name, id or hash prefix stands for; `file` is named in complaints (E0512 unknown,
/// E0513 ambiguous).
[[nodiscard]] Parsed<std::int64_t> FindLayout(SQLite::Database& db,
                                              std::string_view key,
                                              const std::string& file);

[[nodiscard]] StoredLayout ReadLayout(SQLite::Database& db, std::int64_t id);
[[nodiscard]] std::string ReadToml(SQLite::Database& db, std::int64_t id);
[[nodiscard]] std::vector<LayoutSummary> ReadList(SQLite::Database& db, const ListOptions& options);
[[nodiscard]] Statistics ReadStatistics(SQLite::Database& db);

[[nodiscard]] std::optional<double> NumberAt(SQLite::Statement& row, int column);

/// A digest column; all zero if the file holds something else there.
[[nodiscard]] Sha256 DigestAt(SQLite::Statement& row, int column);

/// Row of `calibration` selected as measurements, measurements_hash, status, rms_before_um,
/// rms_after_um, sigma_um, degrees_of_freedom, report from `first` on.
[[nodiscard]] Calibration CalibrationAt(SQLite::Statement& row, int first);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_READING_HPP_
