// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_CSV_HPP_
#define KOMPONO_CATALOG_SRC_CSV_HPP_

#include <string>
#include <string_view>

#include "kompono/catalog/query.hpp"

namespace kompono::catalog {

/// RFC 4180; NULL is empty, empty text "".
[[nodiscard]] std::string CsvText(std::string_view text);
[[nodiscard]] std::string CsvField(const Value& value);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_CSV_HPP_
