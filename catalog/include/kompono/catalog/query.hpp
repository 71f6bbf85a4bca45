// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_QUERY_HPP_
#define KOMPONO_CATALOG_QUERY_HPP_

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

/// Questions to the catalog and how the answers are printed. docs/catalog.md lists the views and
/// their columns.
namespace kompono::catalog {

/// Bounds on what one query may cost.
struct QueryLimits {
  std::chrono::milliseconds deadline{5000};
  std::size_t memory_bytes =
      256U << 20U;  ///< growth of SQLite's memory in this process while the query runs
  std::size_t result_bytes = 64U << 20U;
};

/// All texts are SQL expressions over the view `layouts`; sub-selects may read the other views.
struct QueryRequest {
  std::string where;    ///< "rms_after_um < 100 and formula like '%(XY)%'"; empty: every layout
  std::string columns;  ///< "name, rms_before_um / rms_after_um as gain"; "*": all; empty:
                        ///< `kDefaultColumns`
  std::string sort;     ///< "rms_after_um desc, name"; empty: as stored
  std::int64_t limit = 1000;  ///< most rows; 0: all of them, as far as `limits` allow
  QueryLimits limits;
};

inline constexpr const char* kDefaultColumns =
    "id, name, formula, coordinates, drives, modules, rms_before_um, rms_after_um";

using Value = std::variant<std::monostate, std::int64_t, double, std::string>;

struct Column {
  std::string name;  ///< unique within its table
  std::string type;  ///< "integer", "real", "text", "mixed", or "null" if no row has a value
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<Value>> rows;
  bool more = false;  ///< the limit cut off further rows
};

/// For people: aligned columns under a ruled heading, numbers to the right with six significant
/// digits, control characters shown as \xNN. Ends with a line feed; an empty table is its heading
/// only.
[[nodiscard]] std::string RenderText(const Table& table);

/// RFC 4180 with a heading line and CRLF; NULL is an empty field, empty text is "". Numbers read
/// back exactly.
[[nodiscard]] std::string RenderCsv(const Table& table);

/// {"columns": [{"name", "type"}], "rows": [{name: value}], "more": bool}
[[nodiscard]] nlohmann::ordered_json ToJson(const Table& table);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_QUERY_HPP_
