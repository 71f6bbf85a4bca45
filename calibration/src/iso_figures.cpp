// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/iso_figures.hpp"

#include "residuals.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace kompono::calibration {
namespace {

constexpr std::size_t kLeastRepeats = 3;
constexpr std::size_t kLeastOfARun = 8;
constexpr double kSameReading = 1e-6;  ///< mm, rad

using Rows = std::vector<const Measurement*>;

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
    for (const Measurement& m : set_.measurements) {
      if (m.kind == MeasurementKind::kBallBar && KnownCentre(m)) circles[m.fixture].push_back(&m);
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
    return figures;
  }

 private:
  /// About a socket whose place is a guess no circle is judged.
  [[nodiscard]] bool KnownCentre(const Measurement& m) const {
    return m.fixture >= 0 && set_.fixtures[static_cast<std::size_t>(m.fixture)].known;
  }

  /// Predicted minus measured lengths of a row.
  [[nodiscard]] std::optional<Eigen::VectorXd> ErrorAt(const Measurement& m,
                                                       const Eigen::VectorXd& theta) const {
    RowModel row(machine_, m, 1.0, 1.0);
    const RowModel::Prediction prediction = row.FindStart(theta, nullptr);
    if (!prediction.ok()) return std::nullopt;
    const auto own = static_cast<Eigen::Index>(machine_.parameters().size());
    const RowErrors errors =
        row.Errors(prediction, {.fixtures = &set_.fixtures, .value = nominal_.data() + own});
    return Eigen::VectorXd(errors.value.head(errors.lengths));
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

std::string RenderIso(const IsoFigures& figures) {
  std::string text;
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
