// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_CSV_HPP_
#define KOMPONO_CLI_CSV_HPP_

#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::cli {

/// A table of numbers: a heading line, then one row a line, commas between; lines that begin with
/// '#' and empty lines do not count.
struct NumberTable {
  std::vector<std::string> headings;
  std::vector<SourceSpan> heading_places;
  std::vector<std::vector<double>> rows;
  std::vector<int> lines;  ///< where each row stands
};

/// E0610 for a missing heading, rows of the wrong length and what is no number; all of them.
[[nodiscard]] Parsed<NumberTable> ReadNumberTable(std::string_view text, const std::string& file);

/// A field that may hold commas, quotes and line feeds (RFC 4180).
[[nodiscard]] std::string CsvField(std::string_view text);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_CSV_HPP_
