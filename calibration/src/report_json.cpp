// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include <numbers>
#include <string>

#include "kompono/calibration/report.hpp"

namespace kompono::calibration {
namespace {

using nlohmann::json;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

std::string Unit(bool angle) {
  return angle ? "deg" : "mm";
}
double Shown(double value, bool angle) {
  return angle ? value * kDegPerRad : value;
}

json Parameter(const IdentifiedParameter& p) {
  const std::string unit = Unit(p.angle);
  json out{{"name", p.name},
           {"unit", unit},
           {"before_" + unit, Shown(p.before, p.angle)},
           {"after_" + unit, Shown(p.after, p.angle)},
           {"change_" + unit, Shown(p.change(), p.angle)},
           {"at_bound", p.at_bound},
           {"determined", p.determined}};
  out["sigma_" + unit] = p.sigma ? json(Shown(*p.sigma, p.angle)) : json(nullptr);
  return out;
}

json Statistics(const ErrorStatistics& s) {
  const std::string unit = Unit(s.angle);
  return {{"quantity", s.quantity},
          {"held_out", s.held_out},
          {"count", s.count},
          {"rms_before_" + unit, Shown(s.rms_before, s.angle)},
          {"rms_after_" + unit, Shown(s.rms_after, s.angle)},
          {"max_before_" + unit, Shown(s.max_before, s.angle)},
          {"max_after_" + unit, Shown(s.max_after, s.angle)}};
}

json Direction(const NullDirection& direction, const CalibrationReport& report) {
  json parts = json::array();
  for (const auto& [name, change] : direction.parts) {
    bool angle = false;
    for (const IdentifiedParameter& p : report.parameters) angle |= p.name == name && p.angle;
    parts.push_back({{"name", name}, {"change_" + Unit(angle), Shown(change, angle)}});
  }
  return {{"parameters", parts}, {"words", direction.words}, {"remedy", direction.remedy}};
}

json Row(const RowResidual& row) {
  json out{{"row", row.row},
           {"line", row.line},
           {"kind", Name(row.kind)},
           {"held_out", row.held_out},
           {"rejected", row.rejected},
           {"before_mm", row.before_mm},
           {"after_mm", row.after_mm},
           {"after_sigmas", row.after_sigmas}};
  if (row.kind == MeasurementKind::kPose || row.kind == MeasurementKind::kRelative) {
    out["before_deg"] = row.before_rad * kDegPerRad;
    out["after_deg"] = row.after_rad * kDegPerRad;
  }
  return out;
}

}  // namespace

json ToJson(const CalibrationReport& report) {
  json out{{"status", Name(report.status)},
           {"ok", report.ok()},
           {"iterations", report.iterations},
           {"rows_fitted", report.rows_fitted},
           {"rows_held_out", report.rows_held_out},
           {"rows_rejected", report.rejected},
           {"numbers", report.numbers},
           {"free_parameters", report.free.size()},
           {"rank", report.rank},
           {"dof", report.dof},
           {"cost_before", report.cost_before},
           {"cost_after", report.cost_after},
           {"chi_squared", report.chi_squared},
           {"sigma0", report.sigma0},
           {"sigma_assumed", report.sigma_assumed},
           {"scaled_condition", report.scaled_condition},
           {"tool_sigma_rms_mm", report.tool_sigma_rms_mm},
           {"tool_sigma_max_mm", report.tool_sigma_max_mm},
           {"solver_ms", report.solver_ms},
           {"total_ms", report.total_ms},
           {"solver_message", report.solver_message}};
  out["parameters"] = json::array();
  for (const IdentifiedParameter& p : report.parameters) out["parameters"].push_back(Parameter(p));
  out["errors"] = json::array();
  for (const ErrorStatistics& s : report.statistics) out["errors"].push_back(Statistics(s));
  out["unidentifiable"] = json::array();
  for (const NullDirection& direction : report.unidentifiable) {
    out["unidentifiable"].push_back(Direction(direction, report));
  }
  out["correlated"] = json::array();
  for (const CorrelatedPair& pair : report.correlated) {
    out["correlated"].push_back(
        {{"first", pair.first}, {"second", pair.second}, {"correlation", pair.correlation}});
  }
  out["verdict"] = report.verdict;
  if (!report.suspects.names.empty()) {
    out["locked_suspects"] = {{"names", report.suspects.names},
                              {"share", report.suspects.share},
                              {"share_of_all", report.suspects.share_of_all}};
  }
  out["observability"] = report.observability;
  out["frozen"] = report.frozen;
  out["groups"] = json::array();
  for (const GroupEffect& group : report.groups) {
    out["groups"].push_back(
        {{"group", group.group}, {"change_mm", group.change_mm}, {"sigma_mm", group.sigma_mm}});
  }
  out["rows"] = json::array();
  for (const RowResidual& row : report.rows) out["rows"].push_back(Row(row));
  out["diagnostics"] = kompono::ToJson(report.diagnostics);
  return out;
}

}  // namespace kompono::calibration
