// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_SEARCHING_HPP_
#define KOMPONO_CATALOG_SRC_SEARCHING_HPP_

#include <SQLiteCpp/Database.h>

#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kompono/catalog/search.hpp"
#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::catalog {

/// E0548 no words, or more than a search may have.
[[nodiscard]] Parsed<std::vector<SearchHit>> SearchWords(SQLite::Database& db,
                                                         std::string_view text,
                                                         std::int64_t limit);

/// E0526 if not all formulas could be compared in time.
[[nodiscard]] Parsed<std::vector<SimilarLayout>> SearchSimilar(SQLite::Database& db,
                                                               std::int64_t layout,
                                                               std::int64_t limit,
                                                               std::chrono::milliseconds deadline);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_SEARCHING_HPP_
