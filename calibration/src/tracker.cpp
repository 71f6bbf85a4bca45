// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/tracker.hpp"

#include "residuals.hpp"
#include "table.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/SVD>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr double kOtherFrame = 5.0;         ///< mm; no datum is set up that badly
constexpr double kOtherFrameFactor = 10.0;  ///< times what the best fit leaves

constexpr int kAlignments = 4;      ///< passes, each without the points far off in the last
constexpr double kFarFactor = 6.0;  ///< times the median
constexpr double kStraight = 1e-4;  ///< points on a line: second over first singular value
constexpr double kExactMm = 1e-6;   ///< smaller errors are rounding

/// "1,5 2,5 3,5": blanks between numbers whose every comma stands between digits, one in each.
bool BlanksAndDecimalCommas(std::string_view line) {
  const auto digit = [&line](std::size_t at) {
    return at < line.size() && std::isdigit(static_cast<unsigned char>(line[at])) != 0;
  };
  int words = 0;
  bool commas = false;
  for (std::size_t begin = line.find_first_not_of(" \r"); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \r", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    const std::size_t comma = word.find(',');
    if (comma != std::string_view::npos) {
      const bool decimal = comma > 0 && digit(begin + comma - 1) && digit(begin + comma + 1) &&
                           word.find_first_of(",.", comma + 1) == std::string_view::npos &&
                           word.find('.') == std::string_view::npos;
      if (!decimal) return false;
      commas = true;
    }
    ++words;
    begin = line.find_first_not_of(" \r", end);
  }
  return commas && words >= 3;
}

std::vector<std::string> Words(std::string_view line) {
  const bool decimal_commas =
      line.find_first_of(";\t") != std::string_view::npos || BlanksAndDecimalCommas(line);
  const std::string_view separators = decimal_commas ? " \t;\r" : " \t,\r";
  std::vector<std::string> words;
  std::size_t begin = line.find_first_not_of(separators);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    words.emplace_back(line.substr(begin, end - begin));
    std::replace(words.back().begin(), words.back().end(), ',', '.');
    begin = line.find_first_not_of(separators, end);
  }
  return words;
}

std::optional<double> NumberIn(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

std::optional<Eigen::Vector3d> PointAt(const std::vector<std::string>& words, std::size_t first) {
  if (words.size() < first + 3) return std::nullopt;
  Eigen::Vector3d p;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = NumberIn(words[first + i]);
    if (!number) return std::nullopt;
    p[static_cast<Eigen::Index>(i)] = *number;
  }
  return p;
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Diagnostic Mismatch(std::string_view file, std::string message, std::string help) {
  return {.code = codes::kTrackerMismatch.code,
          .file = std::string(file),
          .message = std::move(message),
          .help = std::move(help)};
}

/// Two clouds of points, the first measured in L, the second in W.
struct Pairs {
  std::vector<Eigen::Vector3d> measured, predicted;
};

/// The turn and shift with the least squares over the pairs that are kept; nothing if they lie on
/// a line (Kabsch).
std::optional<Pose<double>> BestFit(const Pairs& pairs, const std::vector<bool>& kept) {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    from += pairs.measured[i];
    to += pairs.predicted[i];
    count += 1.0;
  }
  if (count < 3.0) return std::nullopt;
  from /= count;
  to /= count;
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) product += (pairs.predicted[i] - to) * (pairs.measured[i] - from).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] <= kStraight * svd.singularValues()[0]) return std::nullopt;
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Pose<double> X;
  X.R = svd.matrixU() * sign * svd.matrixV().transpose();
  X.p = to - X.R * from;
  return X;
}

/// Best fit to what the nominal machine predicts; `rms` of the points that are kept.
std::optional<Pose<double>> Align(const kinematics::Machine& machine,
                                  const MeasurementSet& set,
                                  double* rms) {
  Pairs pairs;
  for (const Measurement& m : set.measurements) {
    RowModel row(machine, m, 1.0, 1.0);
    const RowModel::Prediction prediction = row.Predict(machine.nominal(), false);
    if (!prediction.ok()) continue;
    pairs.measured.emplace_back(*m.position_mm[0], *m.position_mm[1], *m.position_mm[2]);
    pairs.predicted.push_back(prediction.first.X_WT.p);
  }
  std::vector<bool> kept(pairs.measured.size(), true);
  std::optional<Pose<double>> X_WL;
  for (int pass = 0; pass < kAlignments; ++pass) {
    X_WL = BestFit(pairs, kept);
    if (!X_WL) return std::nullopt;
    std::vector<double> errors;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      errors.push_back((*X_WL * pairs.measured[i] - pairs.predicted[i]).norm());
    }
    const double far = std::max(kFarFactor * MedianOf(errors), kExactMm);
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      kept[i] = errors[i] <= far;
      if (!kept[i]) continue;
      sum += errors[i] * errors[i];
      ++count;
    }
    *rms = std::sqrt(sum / std::max(1, count));
  }
  return X_WL;
}

class Joiner {
 public:
  Joiner(const std::vector<TrackerPoint>& points,
         std::string_view points_file,
         std::string_view readings_text,
         std::string_view readings_file)
      : points_(points),
        points_file_(points_file),
        readings_file_(readings_file),
        text_(readings_text),
        table_(SplitTable(readings_text)) {}

  /// The readings' table with the points' coordinates behind each row.
  Parsed<std::string> Join() {
    if (table_.rows.empty()) {
      return tl::unexpected(Diagnostics{{.code = codes::kNoRows.code,
                                         .file = std::string(readings_file_),
                                         .message = "the file has no rows of readings"}});
    }
    const std::optional<std::size_t> names = NameColumn();
    const bool named = std::all_of(
        points_.begin(), points_.end(), [](const TrackerPoint& p) { return !p.name.empty(); });
    if (names && named) {
      ByName(*names);
    } else {
      ByOrder();
    }
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    return std::move(joined_);
  }

 private:
  [[nodiscard]] std::optional<std::size_t> NameColumn() const {
    for (std::size_t i = 0; i < table_.header.cells.size(); ++i) {
      if (table_.header.cells[i].text == "name") return i;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string_view Line(const TableRow& row) const {
    std::string_view line = text_.substr(row.begin, row.end - row.begin);
    while (line.ends_with('\r') || line.ends_with('\n')) line.remove_suffix(1);
    return line;
  }

  void AddHeader() {
    joined_ = Line(table_.header);
    for (const char axis : {'x', 'y', 'z'})
      joined_ += fmt::format("{}{}_mm", table_.separator, axis);
    joined_ += '\n';
  }

  void AddRow(const TableRow& row, const TrackerPoint& point) {
    joined_ += Line(row);
    for (const double coordinate : point.p_mm) {
      joined_ += fmt::format("{}{}", table_.separator, coordinate);
    }
    joined_ += '\n';
  }

  void ByName(std::size_t column) {
    AddHeader();
    std::map<std::string_view, const TableRow*> rows;
    for (const TableRow& row : table_.rows) {
      if (column < row.cells.size()) rows[row.cells[column].text] = &row;
    }
    for (const TrackerPoint& point : points_) {
      const auto found = rows.find(point.name);
      if (found != rows.end()) {
        AddRow(*found->second, point);
        continue;
      }
      complaints_.push_back(
          Mismatch(points_file_,
                   fmt::format("line {}: no readings are called '{}'", point.line, point.name),
                   fmt::format("name a row of {} so, or take the point out", readings_file_)));
    }
  }

  void ByOrder() {
    AddHeader();
    if (points_.size() != table_.rows.size()) {
      complaints_.push_back(Mismatch(points_file_,
                                     fmt::format("{} points, but {} rows of readings in {}",
                                                 points_.size(),
                                                 table_.rows.size(),
                                                 readings_file_),
                                     "give both files a point for a point, or names to join them "
                                     "by: a column 'name' and a first word in every line"));
      return;
    }
    for (std::size_t i = 0; i < points_.size(); ++i) AddRow(table_.rows[i], points_[i]);
  }

  const std::vector<TrackerPoint>& points_;
  std::string_view points_file_, readings_file_, text_;
  Table table_;
  std::string joined_;
  Diagnostics complaints_;
};

/// A best fit that moves the points far and leaves little says that they stand in a frame of their
/// own.
void WarnOfOtherFrame(const kinematics::Machine& machine,
                      std::string_view points_file,
                      TrackerMeasurements* out) {
  double rms_mm = 0.0;
  const std::optional<Pose<double>> X_WL = Align(machine, out->set, &rms_mm);
  if (!X_WL) return;
  double moved_mm = 0.0;
  for (const Measurement& m : out->set.measurements) {
    const Eigen::Vector3d p(*m.position_mm[0], *m.position_mm[1], *m.position_mm[2]);
    moved_mm += (*X_WL * p - p).norm() / static_cast<double>(out->set.measurements.size());
  }
  if (moved_mm < std::max(kOtherFrame, kOtherFrameFactor * rms_mm)) return;
  Diagnostic warning{.severity = Severity::kWarning,
                     .code = codes::kOtherFrame.code,
                     .file = std::string(points_file),
                     .message = fmt::format("the points stand {:.4g} mm beside where the nominal "
                                            "machine has them, and {:.4g} mm after the best fit",
                                            moved_mm,
                                            rms_mm),
                     .help =
                         "they seem to be in the tracker's own frame: --align brings them into "
                         "the workpiece datum"};
  out->warnings.push_back(std::move(warning));
}

}  // namespace

Parsed<std::vector<TrackerPoint>> ReadTrackerPoints(std::string_view text,
                                                    std::string_view file,
                                                    double mm_per_unit) {
  if (Diagnostics refused = JudgeText(text, file); !refused.empty()) {
    return tl::unexpected(std::move(refused));
  }
  Complaints complaints(text, file);
  std::vector<TrackerPoint> points;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const std::vector<std::string> words = Words(line);
    const std::size_t line_begin = begin;
    begin = end + 1;
    ++number;
    if (words.empty() || words[0].starts_with('#') || words[0].starts_with("//")) continue;
    const std::optional<Eigen::Vector3d> bare = PointAt(words, 0);
    const std::optional<Eigen::Vector3d> named = bare ? std::nullopt : PointAt(words, 1);
    // A number before three numbers is the point's.
    const std::optional<Eigen::Vector3d> after_number =
        words.size() == 4 && bare ? PointAt(words, 1) : std::nullopt;
    if (after_number || named) {
      points.push_back({.name = words[0],
                        .p_mm = mm_per_unit * (named ? *named : *after_number),
                        .line = number});
    } else if (bare) {
      points.push_back({.name = {}, .p_mm = mm_per_unit * *bare, .line = number});
    } else if (!points.empty() || std::any_of(words.begin(), words.end(), NumberIn)) {
      complaints.Add(Severity::kError,
                     codes::kTrackerLine.code,
                     line_begin,
                     end,
                     "the line is no point",
                     "x y z, or name x y z, in one unit");
    }
  }
  if (points.empty() && !complaints.HasErrors()) {
    complaints.ErrorWithoutPlace(
        codes::kNoRows.code, "the file has no points", "a line for each: x y z, or name x y z");
  }
  if (complaints.HasErrors()) return tl::unexpected(complaints.Take());
  return points;
}

Parsed<TrackerMeasurements> JoinTracker(const std::vector<TrackerPoint>& points,
                                        std::string_view points_file,
                                        std::string_view readings_text,
                                        std::string_view readings_file,
                                        const kinematics::Machine& machine,
                                        const TrackerOptions& options) {
  if (Diagnostics refused = JudgeText(readings_text, readings_file); !refused.empty()) {
    return tl::unexpected(std::move(refused));
  }
  Parsed<std::string> joined = Joiner(points, points_file, readings_text, readings_file).Join();
  if (!joined) return tl::unexpected(std::move(joined.error()));
  const std::string file = fmt::format("{} with {}", readings_file, points_file);
  Parsed<MeasurementSet> set = ParseMeasurements(
      *joined, file, machine, {.check_units = !options.align, .keep_slips = true});
  if (!set) return tl::unexpected(std::move(set.error()));
  TrackerMeasurements out{.set = std::move(*set)};
  for (Measurement& m : out.set.measurements) {
    if (options.sigma_mm) m.sigma_mm = options.sigma_mm;
  }
  if (!options.align) {
    WarnOfOtherFrame(machine, points_file, &out);
    return out;
  }
  out.X_WL = Align(machine, out.set, &out.fit_rms_mm);
  if (!out.X_WL) {
    return tl::unexpected(
        Diagnostics{Mismatch(points_file,
                             "the points cannot be aligned with the nominal machine",
                             "three points are needed that the machine reaches and that do not "
                             "lie on a line")});
  }
  for (Measurement& m : out.set.measurements) {
    const Eigen::Vector3d p =
        *out.X_WL * Eigen::Vector3d(*m.position_mm[0], *m.position_mm[1], *m.position_mm[2]);
    for (std::size_t i = 0; i < 3; ++i) m.position_mm[i] = p[static_cast<Eigen::Index>(i)];
  }
  // Again as a file of its own, so that its columns are judged where they stand now.
  Parsed<MeasurementSet> judged = ParseMeasurements(
      WriteMeasurements(out.set, machine, {}), file, machine, {.keep_slips = true});
  if (!judged) return tl::unexpected(std::move(judged.error()));
  return out;
}

}  // namespace kompono::calibration
