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

/// Layouts one after the other, with statements that are kept.
class LayoutReader {
 public:
  explicit LayoutReader(SQLite::Database& db);

  /// Name, formula, numbers and texts, blocks and parameters.
  [[nodiscard]] StoredLayout ReadStructure(std::int64_t id);
  /// All of it.
  [[nodiscard]] StoredLayout Read(std::int64_t id);

 private:
  void ReadMotions(StoredLayout& layout);
  void ReadBlocks(StoredLayout& layout);
  void ReadParameters(StoredLayout& layout);
  void ReadMetrics(StoredLayout& layout);
  void ReadCapabilities(StoredLayout& layout);
  void ReadCalibrations(StoredLayout& layout);

  SQLite::Database& db_;
  SQLite::Statement layout_;
  SQLite::Statement motion_;
  SQLite::Statement block_;
  SQLite::Statement parameter_;
  SQLite::Statement metric_;
  SQLite::Statement capability_;
  SQLite::Statement calibration_;
  std::int64_t provenance_id_ = 0;  // of the layout before: most often the same again
  Provenance provenance_;
};

[[nodiscard]] Provenance ReadProvenance(SQLite::Database& db, std::int64_t id);
[[nodiscard]] std::string ReadToml(SQLite::Database& db, std::int64_t id);
[[nodiscard]] std::vector<LayoutSummary> ReadList(SQLite::Database& db, const ListOptions& options);
[[nodiscard]] Statistics ReadStatistics(SQLite::Database& db);

[[nodiscard]] std::optional<double> NumberAt(SQLite::Statement& row, int column);

/// Row selected as name, value, unit, method, failure.
[[nodiscard]] Metric MetricAt(SQLite::Statement& row);

/// A digest column; all zero if the file holds something else there.
[[nodiscard]] Sha256 DigestAt(SQLite::Statement& row, int column);

/// Row of `calibration` selected as measurements, measurements_hash, status, rms_before_um,
/// rms_after_um, sigma_um, degrees_of_freedom, report from `first` on.
[[nodiscard]] Calibration CalibrationAt(SQLite::Statement& row, int first);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_READING_HPP_
