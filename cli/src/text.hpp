// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_TEXT_HPP_
#define KOMPONO_CLI_TEXT_HPP_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Numbers and tables as people and programs read them.
namespace kompono::cli {

inline constexpr double kDegPerRad = 57.295779513082320877;

/// Millimetres or radians to what people and files use: millimetres or degrees.
[[nodiscard]] inline double Outward(double value, bool angle) {
  return angle ? value * kDegPerRad : value;
}
/// Millimetres or degrees to millimetres or radians.
[[nodiscard]] inline double Inward(double value, bool angle) {
  return angle ? value / kDegPerRad : value;
}
[[nodiscard]] inline std::string_view UnitOf(bool angle) {
  return angle ? "deg" : "mm";
}

/// The shortest text that reads back to the same number; "nan" and "inf" for what is none.
[[nodiscard]] std::string Exact(double value);
/// Six decimals: a nanometre, a few microdegrees. "-" for what is no number.
[[nodiscard]] std::string Fixed(double value);
/// Like Exact, but ten significant digits: ranges and defaults without the dust of a conversion.
[[nodiscard]] std::string Brief(double value);
/// "-500 .. 2500 mm", "any" if both ends are open; limits in mm or rad.
[[nodiscard]] std::string RangeText(const std::optional<double>& lower,
                                    const std::optional<double>& upper,
                                    bool angle);

[[nodiscard]] std::optional<double> ParseNumber(std::string_view text);
[[nodiscard]] std::string_view Trimmed(std::string_view text);
[[nodiscard]] std::string Joined(const std::vector<std::string>& words,
                                 std::string_view separator = ", ");
/// "1 drive", "3 drives".
[[nodiscard]] std::string Counted(std::size_t count, std::string_view word);

/// Columns under headings, as wide as what stands in them, counted in code points; each line
/// indented by two.
class TextTable {
 public:
  struct Column {
    std::string heading;
    bool right = false;  ///< numbers
  };

  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}
  void Row(std::vector<std::string> cells);
  /// A line between the rows that is no row.
  void Line(std::string text);
  [[nodiscard]] bool empty() const { return lines_.empty(); }
  [[nodiscard]] std::string Render() const;

 private:
  struct Entry {
    std::vector<std::string> cells;
    std::string text;  ///< instead of cells
  };
  std::vector<Column> columns_;
  std::vector<Entry> lines_;
};

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_TEXT_HPP_
