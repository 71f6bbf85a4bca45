// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/report.hpp"
#include "kompono/layout/layout.hpp"

namespace kompono::calibration {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// Three significant digits in a unit that suits: "0.123 mm", "35.1 µm", "0.0021 deg".
std::string Length(double mm) {
  return std::abs(mm) >= 0.0995 ? fmt::format("{:.3g} mm", mm) : fmt::format("{:.3g} µm", 1e3 * mm);
}
std::string Angle(double rad) {
  return fmt::format("{:.3g} deg", rad * kDegPerRad);
}
std::string Quantity(double value, bool angle) {
  return angle ? Angle(value) : Length(value);
}

/// Code points, so that µ counts one.
std::size_t Width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// Rows of cells, the first column left, the others right aligned.
class TextTable {
 public:
  void Add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  [[nodiscard]] std::string Render() const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_) {
      widths.resize(std::max(widths.size(), row.size()));
      for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
    }
    std::string text;
    for (const auto& row : rows_) {
      std::string line = " ";
      for (std::size_t i = 0; i < row.size(); ++i) {
        const std::string gap(widths[i] - Width(row[i]), ' ');
        line += i == 0 ? " " + row[i] + gap : "  " + gap + row[i];
      }
      while (line.ends_with(' ')) line.pop_back();
      text += line + "\n";
    }
    return text;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string StatusSentence(const CalibrationReport& report) {
  switch (report.status) {
    case IdentifyStatus::kConverged:
      return "converged";
    case IdentifyStatus::kRankDeficient:
      return fmt::format(
          "converged; {} not determined, see below",
          report.unidentifiable.size() == 1
              ? std::string("one combination of parameters is")
              : fmt::format("{} combinations of parameters are", report.unidentifiable.size()));
    case IdentifyStatus::kIterationLimit:
      return "did not converge; the numbers below are not to be used";
    case IdentifyStatus::kTooFewMeasurements:
      return "too few measurements; the numbers below are not to be used";
    case IdentifyStatus::kForwardFailed:
      return "failed: some rows have readings at which the machine has no pose";
    case IdentifyStatus::kBadInput:
      break;
  }
  return "not started";
}

std::string Summary(const CalibrationReport& report) {
  std::string text = fmt::format("identification {}\n", StatusSentence(report));
  if (report.iterations == 0 && report.numbers == 0) return text;
  text += fmt::format("  {} rows with {} numbers for {} parameters, rank {}; {} rows held out\n",
                      report.rows_fitted,
                      report.numbers,
                      report.free.size(),
                      report.rank,
                      report.rows_held_out);
  if (!report.rejected.empty()) {
    text += fmt::format("  left out as outliers: {} {}\n",
                        report.rejected.size() == 1 ? "row" : "rows",
                        fmt::join(report.rejected, ", "));
  }
  text += fmt::format("  cost {:.6g} -> {:.6g} in {} iterations, {:.1f} ms ({:.1f} ms in all)\n",
                      report.cost_before,
                      report.cost_after,
                      report.iterations,
                      report.solver_ms,
                      report.total_ms);
  if (report.dof > 0) {
    text += fmt::format("  sigma0 {:.3g} with {} degrees of freedom{}\n",
                        report.sigma0,
                        report.dof,
                        report.sigma_assumed
                            ? "; standard deviations were not given, those below are scaled by it"
                            : "");
  }
  if (!report.verdict.empty()) text += fmt::format("  {}\n", report.verdict);
  if (report.observability[0] > 0.0) {
    text += fmt::format("  observability O1 {:.3g}, O2 {:.3g}, O3 {:.3g}, O4 {:.3g}, O5 {:.3g}\n",
                        report.observability[0],
                        report.observability[1],
                        report.observability[2],
                        report.observability[3],
                        report.observability[4]);
  }
  if (!report.frozen.empty()) {
    text += fmt::format("  kept at their start: {}\n", fmt::join(report.frozen, ", "));
  }
  return text;
}

std::string Errors(const CalibrationReport& report) {
  if (report.statistics.empty()) return {};
  TextTable table;
  table.Add({"error", "rows", "RMS before", "RMS after", "max before", "max after"});
  for (const ErrorStatistics& s : report.statistics) {
    table.Add({fmt::format("{} {}", s.quantity, s.held_out ? "(held out)" : "(fitted)"),
               fmt::format("{}", s.count),
               Quantity(s.rms_before, s.angle),
               Quantity(s.rms_after, s.angle),
               Quantity(s.max_before, s.angle),
               Quantity(s.max_after, s.angle)});
  }
  return "\n" + table.Render();
}

std::string Parameters(const CalibrationReport& report) {
  if (report.parameters.empty()) return {};
  TextTable table;
  table.Add({"parameter", "before", "after", "", "change", "deviation", ""});
  for (const IdentifiedParameter& p : report.parameters) {
    const double factor = p.angle ? kDegPerRad : 1.0;
    table.Add({p.name,
               fmt::format("{:.4f}", p.before * factor),
               fmt::format("{:.4f}", p.after * factor),
               p.angle ? "deg" : "mm",
               fmt::format("{:+.4f}", p.change() * factor),
               p.sigma ? Quantity(*p.sigma, p.angle) : std::string("-"),
               p.at_bound      ? "at its bound"
               : !p.determined ? "not determined alone"
                               : ""});
  }
  std::string text = "\n" + table.Render();
  if (report.tool_sigma_rms_mm > 0.0) {
    text += fmt::format("  predicted deviation of the tool point: {} RMS, {} at most\n",
                        Length(report.tool_sigma_rms_mm),
                        Length(report.tool_sigma_max_mm));
  }
  for (const GroupEffect& group : report.groups) {
    text += fmt::format("  {}: its changes move the tool by {} RMS, known to {}\n",
                        group.group,
                        Length(group.change_mm),
                        Length(group.sigma_mm));
  }
  return text;
}

std::string Doubts(const CalibrationReport& report) {
  std::string text;
  if (!report.unidentifiable.empty()) text += "\nnot determined by these measurements\n";
  for (const NullDirection& direction : report.unidentifiable) {
    text += fmt::format("  {}\n    {}\n", direction.words, direction.remedy);
  }
  if (!report.correlated.empty()) text += "\nhardly told apart (correlation)\n";
  for (const CorrelatedPair& pair : report.correlated) {
    text += fmt::format("  {:+.3f}  {}, {}\n", pair.correlation, pair.first, pair.second);
  }
  return text;
}

std::string Residuals(const CalibrationReport& report) {
  TextTable table;
  table.Add({"row", "line", "kind", "before", "after", "turned after", "in deviations", ""});
  for (const RowResidual& row : report.rows) {
    table.Add({fmt::format("{}", row.row),
               fmt::format("{}", row.line),
               std::string(Name(row.kind)),
               Length(row.before_mm),
               Length(row.after_mm),
               row.after_rad > 0.0 ? Angle(row.after_rad) : std::string(),
               fmt::format("{:.2f}", row.after_sigmas),
               row.held_out   ? "held out"
               : row.rejected ? "rejected"
                              : ""});
  }
  return "\n" + table.Render();
}

}  // namespace

std::string RenderText(const CalibrationReport& report, const TextOptions& options) {
  std::string text = Summary(report) + Errors(report) + Parameters(report) + Doubts(report);
  if (options.residuals && !report.rows.empty()) text += Residuals(report);
  return text;
}

Parsed<std::string> CalibratedLayout(const kinematics::Machine& machine,
                                     const plugin::Registry& registry,
                                     const CalibrationReport& report,
                                     std::string_view source) {
  if (!report.ok()) {
    Diagnostics complaints = report.diagnostics;
    if (!HasErrors(complaints)) {
      complaints.push_back({.code = codes::kNotConverged.code,
                            .file = machine.layout().file.string(),
                            .message = "an identification that failed changes no layout"});
    }
    return tl::unexpected(std::move(complaints));
  }
  std::vector<layout::Replacement> replacements;
  for (const IdentifiedParameter& parameter : report.parameters) {
    if (machine.FindParameter(parameter.name) < 0) continue;  // of the instrument
    replacements.push_back({parameter.name, parameter.after, parameter.sigma});
  }
  return layout::ReplaceNumbers(machine.layout(), registry, replacements, source);
}

}  // namespace kompono::calibration
