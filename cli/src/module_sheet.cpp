// SPDX-License-Identifier: Apache-2.0
#include "module_sheet.hpp"

#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string_view>
#include <vector>

namespace kompono::cli {
namespace {

using nlohmann::ordered_json;

std::string ShapeText(const plugin::ParameterDescription& parameter) {
  switch (parameter.shape) {
    case plugin::ParameterShape::kNumber:
      return "number";
    case plugin::ParameterShape::kNumbers:
      return fmt::format("numbers[{}]", parameter.count);
    case plugin::ParameterShape::kPoint:
      return "point";
    case plugin::ParameterShape::kPoints:
      return fmt::format("points[{}]", parameter.count);
  }
  return "";
}

/// Descriptions are in their own unit, not in the internal one.
std::string LimitsText(const plugin::ParameterDescription& parameter) {
  if (!parameter.lower && !parameter.upper) return "";
  return fmt::format("{} .. {}",
                     parameter.lower ? Brief(*parameter.lower) : "",
                     parameter.upper ? Brief(*parameter.upper) : "");
}

std::string DefaultText(const plugin::ParameterDescription& parameter) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < parameter.default_value.size(); ++i) {
    if (i == kMost) return text + fmt::format(" ... ({})", parameter.default_value.size());
    text += (i == 0 ? "" : " ") + Brief(parameter.default_value[i]);
  }
  if (text.empty()) return "needed";
  return parameter.fixed ? text + " (fixed)" : text;
}

std::string Parameters(const plugin::ModuleDescription& module) {
  TextTable table({{"parameter"},
                   {"shape"},
                   {"unit"},
                   {"default"},
                   {"range"},
                   {"tolerance", true},
                   {"identifiable"},
                   {"meaning"}});
  for (const plugin::ParameterDescription& parameter : module.parameters) {
    table.Row({parameter.name,
               ShapeText(parameter),
               parameter.unit,
               DefaultText(parameter),
               LimitsText(parameter),
               parameter.tolerance ? Brief(*parameter.tolerance) : "-",
               parameter.identifiable ? "yes" : "no",
               parameter.meaning});
  }
  return table.empty() ? "" : "\n" + table.Render();
}

std::string Modes(const plugin::ModuleDescription& module) {
  TextTable table({{"assembly mode"}, {"default"}, {"meaning"}});
  for (const plugin::ModeDescription& mode : module.modes)
    table.Row({mode.name, mode.default_sign > 0 ? "+" : "-", mode.meaning});
  return table.empty() ? "" : "\n" + table.Render();
}

std::string StructureText(const plugin::StructureDescription& structure) {
  std::string text = Counted(static_cast<std::size_t>(structure.links), "link");
  text += ", pairs";
  for (const auto& [letter, count] : structure.pairs) text += fmt::format(" {}{}", count, letter);
  return text + (structure.planar ? ", planar" : ", spatial");
}

}  // namespace

std::string ModuleText(const plugin::ModuleDescription& module) {
  std::string out =
      fmt::format("{}: {} ({} of {} {})\n",
                  module.id,
                  module.title,
                  module.kind == plugin::ModuleKind::kMechanism ? "mechanism" : "unit",
                  module.plugin_id,
                  module.plugin_version);
  TextTable facts({{""}, {""}});
  const auto fact = [&facts](std::string_view name, const std::string& value) {
    if (!value.empty()) facts.Row({std::string(name), value});
  };
  fact("summary", module.summary);
  if (module.implementation != module.id) fact("preset of", module.implementation);
  std::vector<std::string> letters;
  for (const char letter : module.letters) letters.emplace_back(1, letter);
  fact("coordinates", Joined(letters, " "));
  std::vector<std::string> drives;
  for (const plugin::DriveDescription& drive : module.drives)
    drives.push_back(drive.name + (drive.rotary ? " (rotary)" : " (linear)"));
  fact("drives", Joined(drives));
  fact("points", Joined(module.points));
  fact("stations", Joined(module.stations));
  if (module.structure) fact("structure", StructureText(*module.structure));
  fact("capabilities", Joined(module.capabilities));
  fact("sources", Joined(module.sources));
  return out + facts.Render() + Parameters(module) + Modes(module);
}

ordered_json ModuleJson(const plugin::ModuleDescription& module) {
  ordered_json out{{"id", module.id},
                   {"kind", module.kind == plugin::ModuleKind::kMechanism ? "mechanism" : "unit"},
                   {"title", module.title},
                   {"summary", module.summary},
                   {"plugin", module.plugin_id},
                   {"version", module.plugin_version},
                   {"implementation", module.implementation},
                   {"letters", module.letters}};
  out["drives"] = ordered_json::array();
  for (const plugin::DriveDescription& drive : module.drives)
    out["drives"].push_back({{"name", drive.name}, {"kind", drive.rotary ? "rotary" : "linear"}});
  out["parameters"] = ordered_json::array();
  for (const plugin::ParameterDescription& parameter : module.parameters) {
    ordered_json entry{{"name", parameter.name},
                       {"shape", ShapeText(parameter)},
                       {"unit", parameter.unit},
                       {"meaning", parameter.meaning},
                       {"identifiable", parameter.identifiable},
                       {"fixed", parameter.fixed},
                       {"default", nullptr},
                       {"range", {nullptr, nullptr}},
                       {"tolerance", nullptr}};
    if (!parameter.default_value.empty()) entry["default"] = parameter.default_value;
    if (parameter.lower) entry["range"][0] = *parameter.lower;
    if (parameter.upper) entry["range"][1] = *parameter.upper;
    if (parameter.tolerance) entry["tolerance"] = *parameter.tolerance;
    out["parameters"].push_back(std::move(entry));
  }
  out["modes"] = ordered_json::array();
  for (const plugin::ModeDescription& mode : module.modes) {
    out["modes"].push_back({{"name", mode.name},
                            {"default", mode.default_sign > 0 ? "+" : "-"},
                            {"meaning", mode.meaning}});
  }
  out["points"] = module.points;
  out["links"] = ordered_json::array();
  for (const plugin::LinkDescription& link : module.links)
    out["links"].push_back({{"from", link.from}, {"to", link.to}, {"kind", link.kind}});
  if (module.structure) {
    out["structure"] = {{"links", module.structure->links},
                        {"pairs", module.structure->pairs},
                        {"planar", module.structure->planar}};
  }
  out["stations"] = module.stations;
  out["capabilities"] = module.capabilities;
  out["sources"] = module.sources;
  return out;
}

}  // namespace kompono::cli
