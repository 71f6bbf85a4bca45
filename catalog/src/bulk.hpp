// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_BULK_HPP_
#define KOMPONO_CATALOG_SRC_BULK_HPP_

#include <SQLiteCpp/Database.h>

#include <array>
#include <string_view>

namespace kompono::catalog {

/// What a writer keeps of the file in memory outside bulk loads: it adds to indexes at random
/// places.
inline constexpr int kWriterCacheKib = 262'144;

/// Indexes whose entries come in random order: with a million layouts nearly every new row dirties
/// another page of them, while sorting all entries once takes seconds.
struct DeferredIndex {
  std::string_view name;
  std::string_view sql;  ///< word for word as in the schema
};
inline constexpr std::array<DeferredIndex, 5> kDeferredIndexes = {{
    {"layout_by_hash", "CREATE INDEX layout_by_hash ON layout(hash_key)"},
    {"layout_by_name", "CREATE INDEX layout_by_name ON layout(name)"},
    {"layout_by_formula", "CREATE INDEX layout_by_formula ON layout(formula_id)"},
    {"layout_block_by_module", "CREATE INDEX layout_block_by_module ON layout_block(module_id)"},
    {"metric_by_value", "CREATE INDEX metric_by_value ON metric(measure_id, value)"},
}};

/// True from `BeginBulk` to `EndBulk`, whoever called them, and after a load that was cut short.
[[nodiscard]] bool BulkLoading(SQLite::Database& db);

/// One transaction each.
void BeginBulk(SQLite::Database& db);
void EndBulk(SQLite::Database& db);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_BULK_HPP_
