// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "kompono/calibration/html_report.hpp"
#include "kompono/calibration/report.hpp"

namespace kompono::calibration {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr int kBins = 24;
constexpr double kWidth = 640.0, kHeight = 180.0, kMargin = 36.0;
constexpr std::size_t kMostBars = 400;
constexpr const char* kBefore = "#b8b8b8";
constexpr const char* kAfter = "#2a6fb0";
constexpr const char* kRejected = "#c0392b";

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>{0}</title>\n"
    "<style>\nbody{{font:15px/1.45 sans-serif;margin:2em auto;max-width:60em;padding:0 1em;"
    "color:#222}}\ntable{{border-collapse:collapse;margin:1em 0}}\n"
    "td,th{{padding:.15em .7em;border-bottom:1px solid #ddd;text-align:right}}\n"
    "td:first-child,th:first-child{{text-align:left}}\n"
    "svg{{max-width:100%;height:auto}}\npre{{background:#f5f5f5;padding:.8em;overflow:auto}}\n"
    "</style></head><body>\n<h1>{0}</h1>\n";

std::string Escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string Cells(const std::vector<std::string>& cells, std::string_view tag = "td") {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, Escaped(cell));
  return row + "</tr>\n";
}

std::string Micrometres(double mm) {
  return fmt::format("{:.4g}", 1e3 * mm);
}

std::string ErrorTable(const CalibrationReport& report) {
  std::string out =
      "<h2>Errors</h2>\n<table>" +
      Cells({"error", "rows", "RMS before", "RMS after", "max before", "max after"}, "th");
  for (const ErrorStatistics& s : report.statistics) {
    const auto shown = [&s](double value) {
      return s.angle ? fmt::format("{:.4g} deg", value * kDegPerRad) : Micrometres(value) + " µm";
    };
    out += Cells({fmt::format("{} ({})", s.quantity, s.held_out ? "held out" : "fitted"),
                  fmt::format("{}", s.count),
                  shown(s.rms_before),
                  shown(s.rms_after),
                  shown(s.max_before),
                  shown(s.max_after)});
  }
  return out + "</table>\n";
}

/// Errors of lengths fall over decades from before to after: bins of their logarithm.
std::string Histogram(const CalibrationReport& report) {
  std::vector<std::array<double, 2>> logs;
  double low = 1e300;
  double high = -1e300;
  for (const RowResidual& row : report.rows) {
    const std::array<double, 2> pair{std::log10(std::max(row.before_mm, 1e-7)),
                                     std::log10(std::max(row.after_mm, 1e-7))};
    logs.push_back(pair);
    low = std::min({low, pair[0], pair[1]});
    high = std::max({high, pair[0], pair[1]});
  }
  if (logs.empty()) return {};
  high = std::max(high, low + 1e-6);
  std::array<std::array<int, kBins>, 2> count{};
  int most = 1;
  for (const auto& pair : logs) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double at = (pair[k] - low) / (high - low) * kBins;
      const auto bin = static_cast<std::size_t>(std::clamp(static_cast<int>(at), 0, kBins - 1));
      most = std::max(most, ++count[k][bin]);
    }
  }
  std::string out = fmt::format(
      "<h2>Histogram</h2>\n<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"errors before and "
      "after\">\n",
      kWidth,
      kHeight + kMargin);
  const double step = (kWidth - 2.0 * kMargin) / kBins;
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      if (count[k][bin] == 0) continue;
      const double height = kHeight * count[k][bin] / most;
      out += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
          kMargin + step * (static_cast<double>(bin) + 0.5 * static_cast<double>(k)),
          kHeight - height,
          0.46 * step,
          height,
          k == 0 ? kBefore : kAfter);
    }
  }
  out += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"12\">{} µm</text>\n",
                     kMargin,
                     kHeight + 16.0,
                     Micrometres(std::pow(10.0, low)));
  out += fmt::format(
      "<text x=\"{}\" y=\"{}\" font-size=\"12\" text-anchor=\"end\">{} µm</text>\n</svg>\n"
      "<p>Grey: before, blue: after; the axis is logarithmic.</p>\n",
      kWidth - kMargin,
      kHeight + 16.0,
      Micrometres(std::pow(10.0, high)));
  return out;
}

/// A stroke per row from its error before to that after.
std::string RowChart(const CalibrationReport& report) {
  if (report.rows.empty()) return {};
  const std::size_t stride = report.rows.size() / kMostBars + 1;
  double low = 1e300;
  double high = 1e-7;
  for (const RowResidual& row : report.rows) {
    low = std::min({low, std::max(row.after_mm, 1e-7), std::max(row.before_mm, 1e-7)});
    high = std::max({high, row.after_mm, row.before_mm});
  }
  const double decades = std::max(1e-6, std::log10(high / low));
  const auto y = [&](double mm) {
    return kHeight - (kHeight - 10.0) * std::log10(std::max(mm, 1e-7) / low) / decades;
  };
  std::string out = fmt::format(
      "<h2>Rows</h2>\n<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"error of every row\">\n"
      "<defs><marker id=\"tip\" viewBox=\"0 0 6 6\" refX=\"5\" refY=\"3\" markerWidth=\"5\" "
      "markerHeight=\"5\" orient=\"auto\"><path d=\"M0 0L6 3L0 6z\" "
      "fill=\"{}\"/></marker></defs>\n",
      kWidth,
      kHeight + kMargin,
      kAfter);
  const double step = (kWidth - 2.0 * kMargin) / static_cast<double>(report.rows.size());
  for (std::size_t i = 0; i < report.rows.size(); i += stride) {
    const RowResidual& row = report.rows[i];
    const double x = kMargin + step * (static_cast<double>(i) + 0.5);
    out += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\" "
        "marker-end=\"url(#tip)\"><title>row {4}: {5} to {6} µm{7}</title></line>\n",
        x,
        y(row.before_mm),
        y(row.after_mm),
        row.rejected ? kRejected : kAfter,
        row.row,
        Micrometres(row.before_mm),
        Micrometres(row.after_mm),
        row.rejected   ? ", left out"
        : row.held_out ? ", held out"
                       : "");
  }
  out += fmt::format("<text x=\"2\" y=\"{:.1f}\" font-size=\"11\">{} µm</text>\n",
                     y(high) + 4.0,
                     Micrometres(high));
  out += fmt::format("<text x=\"2\" y=\"{:.1f}\" font-size=\"11\">{} µm</text>\n</svg>\n",
                     y(low),
                     Micrometres(low));
  return out +
         "<p>Each arrow leads from a row's error before to that after; red rows were left "
         "out.</p>\n";
}

std::string ParameterTable(const CalibrationReport& report) {
  if (report.parameters.empty()) return {};
  std::string out = "<h2>Numbers</h2>\n<table>" +
                    Cells({"number", "before", "after", "unit", "change", "deviation", ""}, "th");
  for (const IdentifiedParameter& p : report.parameters) {
    const double factor = p.angle ? kDegPerRad : 1.0;
    out += Cells({p.name,
                  fmt::format("{:.5f}", p.before * factor),
                  fmt::format("{:.5f}", p.after * factor),
                  p.angle ? "deg" : "mm",
                  fmt::format("{:+.5f}", p.change() * factor),
                  p.sigma ? fmt::format("{:.2g}", *p.sigma * factor) : "-",
                  p.at_bound      ? "at its bound"
                  : !p.determined ? "not determined alone"
                                  : ""});
  }
  return out + "</table>\n";
}

std::string Doubts(const CalibrationReport& report) {
  std::string out;
  if (!report.unidentifiable.empty()) {
    out += "<h2>Not determined</h2>\n<ul>\n";
    for (const NullDirection& direction : report.unidentifiable) {
      out += fmt::format("<li>{}: {}</li>\n", Escaped(direction.words), Escaped(direction.remedy));
    }
    out += "</ul>\n";
  }
  if (report.diagnostics.empty()) return out;
  out += "<h2>Remarks</h2>\n<ul>\n";
  for (const Diagnostic& diagnostic : report.diagnostics) {
    out += fmt::format("<li>{} [{}]{}{}</li>\n",
                       Escaped(diagnostic.message),
                       diagnostic.code,
                       diagnostic.help.empty() ? "" : "; ",
                       Escaped(diagnostic.help));
  }
  return out + "</ul>\n";
}

}  // namespace

std::string RenderHtml(const CalibrationReport& report,
                       std::string_view title,
                       const std::vector<PageSection>& more) {
  CalibrationReport summary = report;
  summary.parameters.clear();
  summary.statistics.clear();
  summary.unidentifiable.clear();
  summary.correlated.clear();
  std::string sections;
  for (const PageSection& section : more) {
    sections +=
        fmt::format("<h2>{}</h2>\n<pre>{}</pre>\n", Escaped(section.title), Escaped(section.text));
  }
  return fmt::format(fmt::runtime(kHead), Escaped(title)) + "<pre>" + Escaped(RenderText(summary)) +
         "</pre>\n" + ErrorTable(report) + Histogram(report) + RowChart(report) +
         ParameterTable(report) + sections + Doubts(report) + "</body></html>\n";
}

}  // namespace kompono::calibration
