// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_TABLE_HPP_
#define KOMPONO_CALIBRATION_SRC_TABLE_HPP_

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

/// Text with separators, cut into cells that know their place.
namespace kompono::calibration {

struct Cell {
  std::string_view text;  ///< without surrounding blanks and quotes
  std::size_t begin = 0;  ///< byte offsets into the whole text
  std::size_t end = 0;
};

struct TableRow {
  std::vector<Cell> cells;
  int line = 0;
  std::size_t begin = 0, end = 0;
};

struct Table {
  TableRow header;
  std::vector<TableRow> rows;
  char separator = ',';
};

/// E0477 for what no line of can be read: UTF-16 and other files with zero bytes, and lines that
/// end with a carriage return alone; empty for texts.
[[nodiscard]] Diagnostics JudgeText(std::string_view text, std::string_view file);

/// Lines that are empty or start with '#' are passed over; the separator is the one of , ; tab that
/// the header has most of. The header has no cells if the text has none. Views point into `text`.
[[nodiscard]] Table SplitTable(std::string_view text);

/// Collects complaints about one text, so that a file with thousands of equal mistakes stays
/// readable.
class Complaints {
 public:
  Complaints(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  void Add(Severity severity,
           std::string code,
           std::size_t begin,
           std::size_t end,
           std::string message,
           std::string help = "");
  void Error(std::string code, const Cell& cell, std::string message, std::string help = "") {
    Add(Severity::kError,
        std::move(code),
        cell.begin,
        cell.end,
        std::move(message),
        std::move(help));
  }
  /// About the file as a whole.
  void ErrorWithoutPlace(std::string code, std::string message, std::string help = "");
  [[nodiscard]] bool HasErrors() const { return kompono::HasErrors(list_); }
  /// Everything said, with one closing note per code of which too many were found.
  [[nodiscard]] Diagnostics Take();

 private:
  std::string_view text_;
  std::string_view file_;
  Diagnostics list_;
  std::map<std::string, int> said_;
};

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_TABLE_HPP_
