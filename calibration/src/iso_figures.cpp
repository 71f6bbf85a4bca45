// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/iso_figures.hpp"

#include "residuals.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace kompono::calibration {
namespace {

constexpr std::size_t kLeastRepeats = 3;
constexpr std::size_t kLeastOfARun = 8;
constexpr double kSameReading = 1e-6;  ///< mm, rad
constexpr double kSameTarget = 0.05;   ///< mm; readings may be those of encoders, not commands
constexpr double kSameLine = 0.5;      ///< mm
constexpr double kRadPerMm = 1e-3;     ///< the same limits for angles
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

using Rows = std::vector<const Measurement*>;

/// Where the nominal machine was sent, and what it missed that by before and after.
struct Approached {
  const Measurement* row = nullptr;
  std::array<double, 6> commanded{};  ///< X, Y, Z, A, B, C; mm, rad
  double before = 0.0, after = 0.0;   ///< actual less predicted along the axis; mm or rad
  [[nodiscard]] std::size_t axis() const {
    return static_cast<std::size_t>(row->approach->component() + (row->approach->rotary() ? 3 : 0));
  }
  [[nodiscard]] double position() const { return commanded[axis()]; }
};

double Limit(std::size_t axis, double mm) {
  return axis < 3 ? mm : mm * kRadPerMm;
}

bool OnOneLine(const Approached& a, const Approached& b) {
  if (a.axis() != b.axis()) return false;
  for (std::size_t i = 0; i < 6; ++i) {
    if (i == a.axis()) continue;
    if (std::abs(a.commanded[i] - b.commanded[i]) > Limit(i, kSameLine)) return false;
  }
  return true;
}

/// "Y 0, Z 100": what stood still; angles only where they are not 0.
std::string LineOf(const Approached& row) {
  constexpr std::string_view kNames = "XYZABC";
  std::string text;
  for (std::size_t i = 0; i < 6; ++i) {
    const double shown =
        std::round(row.commanded[i] * (i < 3 ? 1.0 : kDegPerRad) * 1000.0) / 1000.0;
    if (i == row.axis() || (i >= 3 && shown == 0.0)) continue;
    text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", kNames[i], shown + 0.0);
  }
  return text;
}

/// `error`: of an approached row, before or after.
std::vector<TargetDeviations> TargetsOf(const std::vector<Approached>& line,
                                        double Approached::*error) {
  std::vector<TargetDeviations> targets;
  for (const Approached& row : line) {  // ascending
    if (targets.empty() ||
        row.position() - targets.back().target > Limit(row.axis(), kSameTarget)) {
      targets.push_back({.target = row.position()});
    }
    TargetDeviations& target = targets.back();
    (row.row->approach->positive ? target.positive : target.negative).push_back(row.*error);
  }
  return targets;
}

AxisTest TestOf(std::vector<Approached> line) {
  std::stable_sort(line.begin(), line.end(), [](const Approached& a, const Approached& b) {
    return a.position() < b.position();
  });
  AxisTest test{.axis = line.front().row->approach->axis,
                .line = LineOf(line.front()),
                .first_row = line.front().row->row,
                .rows = static_cast<int>(line.size()),
                .from = line.front().position(),
                .to = line.back().position()};
  for (const Approached& row : line) test.first_row = std::min(test.first_row, row.row->row);
  const std::vector<TargetDeviations> before = TargetsOf(line, &Approached::before);
  test.targets = static_cast<int>(before.size());
  test.missing = MissingForPositioning(before, test.rotary());
  if (!test.missing.empty()) return test;
  test.before = PositioningFiguresOf(before);
  test.after = PositioningFiguresOf(TargetsOf(line, &Approached::after));
  return test;
}

class FigureMaker {
 public:
  FigureMaker(const kinematics::Machine& machine,
              const MeasurementSet& set,
              const Eigen::VectorXd& identified)
      : machine_(machine), set_(set), nominal_(AllNominal(machine, set)), identified_(nominal_) {
    identified_.head(identified.size()) = identified;
  }

  IsoFigures Make() {
    std::map<std::vector<double>, Rows> repeated;
    std::map<int, Rows> circles;
    std::vector<std::vector<Approached>> lines;
    for (const Measurement& m : set_.measurements) {
      if (m.kind == MeasurementKind::kBallBar && KnownCentre(m)) circles[m.fixture].push_back(&m);
      if (m.approach) AddApproach(m, &lines);
      const bool located =
          (m.kind == MeasurementKind::kPosition || m.kind == MeasurementKind::kPose) &&
          m.Numbers() >= 3 && m.target < 0;
      if (!located) continue;
      std::vector<double> key;
      for (const double reading : m.readings) key.push_back(std::round(reading / kSameReading));
      repeated[std::move(key)].push_back(&m);
    }
    IsoFigures figures;
    for (const auto& [key, rows] : repeated) {
      if (rows.size() >= kLeastRepeats) AddPose(rows, &figures);
    }
    std::sort(figures.poses.begin(), figures.poses.end(), [](const auto& a, const auto& b) {
      return a.first_row < b.first_row;
    });
    for (const auto& [fixture, rows] : circles) {
      if (rows.size() >= kLeastOfARun) AddRun(fixture, rows, &figures);
    }
    for (std::vector<Approached>& line : lines) figures.axes.push_back(TestOf(std::move(line)));
    return figures;
  }

 private:
  /// About a socket whose place is a guess no circle is judged.
  [[nodiscard]] bool KnownCentre(const Measurement& m) const {
    return m.fixture >= 0 && set_.fixtures[static_cast<std::size_t>(m.fixture)].known;
  }

  /// Predicted minus measured of a row; `X_WT` receives the predicted pose, if not null.
  [[nodiscard]] std::optional<RowErrors> AllErrorsAt(const Measurement& m,
                                                     const Eigen::VectorXd& theta,
                                                     Pose<double>* X_WT = nullptr) const {
    RowModel row(machine_, m, 1.0, 1.0);
    const RowModel::Prediction prediction = row.FindStart(theta, nullptr);
    if (!prediction.ok()) return std::nullopt;
    const auto own = static_cast<Eigen::Index>(machine_.parameters().size());
    if (X_WT != nullptr) *X_WT = prediction.first.X_WT;
    return row.Errors(prediction, {.fixtures = &set_.fixtures, .value = nominal_.data() + own});
  }

  /// The lengths among them.
  [[nodiscard]] std::optional<Eigen::VectorXd> ErrorAt(const Measurement& m,
                                                       const Eigen::VectorXd& theta) const {
    const std::optional<RowErrors> errors = AllErrorsAt(m, theta);
    if (!errors) return std::nullopt;
    return Eigen::VectorXd(errors->value.head(errors->lengths));
  }

  void AddApproach(const Measurement& m, std::vector<std::vector<Approached>>* lines) const {
    Pose<double> X_WT;
    const std::optional<RowErrors> nominal = AllErrorsAt(m, nominal_, &X_WT);
    const std::optional<RowErrors> identified = AllErrorsAt(m, identified_);
    if (!nominal || !identified) return;
    // A position has only its measured components, an angle stands behind all lengths.
    Eigen::Index at = m.approach->rotary() ? nominal->lengths + m.approach->component() : 0;
    for (int i = 0;
         !m.approach->rotary() && m.kind != MeasurementKind::kHeight && i < m.approach->component();
         ++i) {
      at += m.position_mm[static_cast<std::size_t>(i)] ? 1 : 0;
    }
    // Half a turn is one place, whichever sign its angle has got.
    Approached row{
        .row = &m,
        .commanded = kinematics::NumbersFromPose(X_WT, machine_.layout().rotation_order).value,
        .before = -nominal->value[at],
        .after = -identified->value[at]};
    for (std::size_t i = 3; i < 6; ++i) {
      if (row.commanded[i] < Limit(i, kSameTarget) - std::numbers::pi) {
        row.commanded[i] += 2.0 * std::numbers::pi;
      }
    }
    const auto line = std::find_if(lines->begin(), lines->end(), [&row](const auto& other) {
      return OnOneLine(other.front(), row);
    });
    if (line == lines->end()) {
      lines->push_back({row});
    } else {
      line->push_back(row);
    }
  }

  void AddPose(const Rows& rows, IsoFigures* figures) const {
    Eigen::MatrixXd before(3, static_cast<Eigen::Index>(rows.size()));
    Eigen::MatrixXd after = before;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto nominal = ErrorAt(*rows[i], nominal_);
      const auto identified = ErrorAt(*rows[i], identified_);
      if (!nominal || !identified || nominal->size() != 3) return;
      before.col(static_cast<Eigen::Index>(i)) = *nominal;
      after.col(static_cast<Eigen::Index>(i)) = *identified;
    }
    // The prediction is the same for all, so that errors scatter as the measurements do.
    const Eigen::Vector3d centre = before.rowwise().mean();
    const Eigen::VectorXd distance = (before.colwise() - centre).colwise().norm().transpose();
    const double mean = distance.mean();
    const double variance =
        (distance.array() - mean).square().sum() / static_cast<double>(distance.size() - 1);
    figures->poses.push_back({.first_row = rows.front()->row,
                              .repeats = static_cast<int>(rows.size()),
                              .accuracy_before_mm = centre.norm(),
                              .accuracy_after_mm = after.rowwise().mean().norm(),
                              .repeatability_mm = mean + 3.0 * std::sqrt(variance)});
  }

  void AddRun(int fixture, const Rows& rows, IsoFigures* figures) const {
    std::vector<double> before;
    std::vector<double> after;
    for (const Measurement* m : rows) {
      const auto nominal = ErrorAt(*m, nominal_);
      const auto identified = ErrorAt(*m, identified_);
      if (!nominal || !identified) return;
      before.push_back(-(*nominal)[0]);
      after.push_back(-(*identified)[0]);
    }
    const auto [least, most] = std::minmax_element(before.begin(), before.end());
    const auto [least_after, most_after] = std::minmax_element(after.begin(), after.end());
    figures->runs.push_back({.centre = set_.fixtures[static_cast<std::size_t>(fixture)].name,
                             .rows = static_cast<int>(rows.size()),
                             .deviation_before_mm = *most - *least,
                             .deviation_after_mm = *most_after - *least_after,
                             .radial_most_before_mm = *most,
                             .radial_least_before_mm = *least});
  }

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  Eigen::VectorXd nominal_, identified_;
};

}  // namespace

IsoFigures IsoFiguresOf(const kinematics::Machine& machine,
                        const MeasurementSet& set,
                        const Eigen::VectorXd& identified) {
  return FigureMaker(machine, set, identified).Make();
}

namespace {

std::string RenderSide(char sign, const UnidirectionalFigures& f, double factor) {
  return fmt::format("; {}: A {:.4f}, R {:.4f}, E {:.4f}",
                     sign,
                     f.accuracy * factor,
                     f.repeatability * factor,
                     f.systematic * factor);
}

std::string RenderPositioning(std::string_view when, const PositioningFigures& f, double factor) {
  std::string text = fmt::format("    {:<7}", when);
  if (f.bidirectional) {
    text += fmt::format("A {:.4f}, R {:.4f}, B {:.4f} (mean {:+.4f}), E {:.4f}, M {:.4f}",
                        f.bidirectional->accuracy * factor,
                        f.bidirectional->repeatability * factor,
                        f.bidirectional->reversal * factor,
                        f.bidirectional->mean_reversal * factor,
                        f.bidirectional->systematic * factor,
                        f.bidirectional->mean_deviation * factor);
  } else {
    text += "one direction only";
  }
  if (f.positive) text += RenderSide('+', *f.positive, factor);
  if (f.negative) text += RenderSide('-', *f.negative, factor);
  return text + "\n";
}

std::string RenderAxis(const AxisTest& test) {
  const double factor = test.rotary() ? kDegPerRad : 1.0;
  std::string text = fmt::format("  {} from {:.6g} to {:.6g} {}{}{}, {} targets, {} rows from {}\n",
                                 test.axis,
                                 test.from * factor,
                                 test.to * factor,
                                 test.rotary() ? "deg" : "mm",
                                 test.line.empty() ? "" : " at ",
                                 test.line,
                                 test.targets,
                                 test.rows,
                                 test.first_row);
  if (!test.missing.empty()) {
    constexpr std::size_t kMostWords = 3;
    text += "    no figures: ";
    for (std::size_t i = 0; i < std::min(kMostWords, test.missing.size()); ++i) {
      text += (i == 0 ? "" : "; ") + test.missing[i];
    }
    if (test.missing.size() > kMostWords) {
      text += fmt::format("; and {} more", test.missing.size() - kMostWords);
    }
    return text + "\n";
  }
  return text + RenderPositioning("before", test.before, factor) +
         RenderPositioning("after", test.after, factor);
}

}  // namespace

std::string RenderIso(const IsoFigures& figures) {
  std::string text;
  if (!figures.axes.empty()) text += "\nISO 230-2, positioning of an axis (mm, deg)\n";
  for (const AxisTest& test : figures.axes) text += RenderAxis(test);
  if (!figures.poses.empty()) text += "\nISO 9283, poses measured again and again (mm)\n";
  for (const RepeatedPose& p : figures.poses) {
    text += fmt::format("  row {:>4}, {:>3} times: AP {:.4f} before, {:.4f} after; RP {:.4f}\n",
                        p.first_row,
                        p.repeats,
                        p.accuracy_before_mm,
                        p.accuracy_after_mm,
                        p.repeatability_mm);
  }
  if (!figures.runs.empty()) text += "\nISO 230-4, ball-bar runs (mm)\n";
  for (const CircularRun& r : figures.runs) {
    text += fmt::format(
        "  centre {}, {} rows: G {:.4f} before, {:.4f} after; Fmax {:+.4f}, Fmin {:+.4f} before\n",
        r.centre,
        r.rows,
        r.deviation_before_mm,
        r.deviation_after_mm,
        r.radial_most_before_mm,
        r.radial_least_before_mm);
  }
  return text;
}

}  // namespace kompono::calibration
