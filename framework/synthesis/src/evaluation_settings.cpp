// SPDX-License-Identifier: Apache-2.0
// The table [evaluation] of a study.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <toml++/toml.h>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/synthesis/evaluation.hpp"

namespace kompono::synthesis {
namespace {

using Settings = EvaluationSettings;

/// One key: where its number goes and what it is multiplied with on the way.
struct Key {
  SettingDescription description;
  double Settings::*number = nullptr;
  std::uint64_t Settings::*whole = nullptr;
  double factor = 1.0;
};

constexpr double kArcsecond_rad = 4.84813681109536e-6;
constexpr double kNPerUm = 1000.0;  // N/mm
constexpr double kNmPerArcsec = 1000.0 / kArcsecond_rad;

const std::vector<Key>& Keys() {
  static const std::vector<Key> keys{
      {{"poses", "1", "poses of the work-zone map", 8, 1e8}, nullptr, &Settings::poses},
      {{"zone_share", "1", "least share of the required zone", 0, 1}, &Settings::zone_share},
      {{"dexterity_goal", "1", "worst 1/condition that sizing asks for", 0, 1},
       &Settings::dexterity_goal},
      {{"sizing_steps", "1", "poses per coordinate while sizing", 2, 21},
       nullptr,
       &Settings::sizing_steps},
      {{"sizing_rounds", "1", "most evaluations of the optimiser", 1, 1e6},
       nullptr,
       &Settings::sizing_rounds},
      {{"drive_tolerance", "um", "position of a linear drive, standard deviation", 0, 1e6},
       &Settings::drive_tolerance_mm,
       nullptr,
       1e-3},
      {{"rotary_tolerance", "arcsec", "angle of a rotary drive, standard deviation", 0, 1e6},
       &Settings::drive_tolerance_rad,
       nullptr,
       kArcsecond_rad},
      {{"guide_straightness", "um", "of a plain axis, across its motion", 0, 1e6},
       &Settings::guide_straightness_mm,
       nullptr,
       1e-3},
      {{"guide_angle", "arcsec", "roll, pitch and yaw of a plain axis", 0, 1e6},
       &Settings::guide_angle_rad,
       nullptr,
       kArcsecond_rad},
      {{"squareness", "arcsec", "direction of a plain axis", 0, 1e6},
       &Settings::squareness_rad,
       nullptr,
       kArcsecond_rad},
      {{"guide_lever", "mm", "distance of guides from the work zone", 0, 1e6},
       &Settings::guide_lever_mm},
      {{"foundation_tolerance", "um", "mutual position of an open base, each way", 0, 1e6},
       &Settings::foundation_mm,
       nullptr,
       1e-3},
      {{"drive_stiffness", "N/um", "of a linear drive that the study gives none", 1e-9, 1e9},
       &Settings::drive_stiffness_n_per_mm,
       nullptr,
       kNPerUm},
      {{"rotary_stiffness", "N m/arcsec", "of a rotary drive that the study gives none", 1e-9, 1e9},
       &Settings::rotary_stiffness_nmm_per_rad,
       nullptr,
       kNmPerArcsec},
      {{"slide_mass", "kg", "of a plain axis", 0, 1e9}, &Settings::slide_kg},
      {{"slide_share", "1", "and of it for each kg that it carries", 0, 100},
       &Settings::slide_share},
      {{"platform_mass", "kg", "of a mechanism's platform", 0, 1e9}, &Settings::platform_kg},
      {{"carriage_mass", "kg", "of each of its drives", 0, 1e9}, &Settings::carriage_kg},
      {{"strut_mass", "kg/m", "of its struts", 0, 1e9}, &Settings::strut_kg_per_m},
      {{"tool_mass", "kg", "of tool and spindle", 0, 1e9}, &Settings::tool_kg},
      {{"acceleration", "mm/s2", "of the tool in the part", 0, 1e9}, &Settings::acceleration_mm_s2},
  };
  return keys;
}

Diagnostic Problem(std::string_view code,
                   std::string_view text,
                   std::string_view file,
                   const toml::source_region& place,
                   std::string message,
                   std::string help) {
  return {.code = std::string(code),
          .file = std::string(file),
          .span = SpanAt(
              text,
              static_cast<int>(place.begin.line),
              static_cast<int>(place.begin.column),
              std::max(1,
                       place.end.line == place.begin.line ? static_cast<int>(place.end.column) -
                                                                static_cast<int>(place.begin.column)
                                                          : 1)),
          .message = std::move(message),
          .help = std::move(help)};
}

std::string RangeText(const Key& key) {
  const SettingDescription& of = key.description;
  return fmt::format("{} from {:g} to {:g}{}: {}",
                     key.whole != nullptr ? "give a whole number" : "give a number",
                     of.lower,
                     of.upper,
                     of.unit == "1" ? "" : fmt::format(" {}", of.unit),
                     of.meaning);
}

/// Empty if the value is good.
std::string Take(const Key& key, const toml::node& node, Settings& out) {
  const std::optional<double> number = node.is_number() ? node.value<double>() : std::nullopt;
  if (!number) return fmt::format("'{}' is no number", key.description.key);
  if (!(*number >= key.description.lower) || !(*number <= key.description.upper))
    return fmt::format("'{}' is out of range", key.description.key);
  if (key.whole != nullptr) {
    if (std::floor(*number) != *number)
      return fmt::format("'{}' is no whole number", key.description.key);
    out.*key.whole = static_cast<std::uint64_t>(*number);
  } else {
    out.*key.number = *number * key.factor;
  }
  return "";
}

}  // namespace

std::vector<SettingDescription> EvaluationKeys() {
  std::vector<SettingDescription> out;
  for (const Key& key : Keys()) out.push_back(key.description);
  return out;
}

Parsed<EvaluationSettings> ReadEvaluationSettings(std::string_view study_text,
                                                  std::string_view file) {
  EvaluationSettings out;
  toml::table root;
  try {
    root = toml::parse(study_text, file);
  } catch (const toml::parse_error& error) {
    return tl::unexpected(Diagnostics{
        Problem("E0841", study_text, file, error.source(), std::string(error.description()), "")});
  }
  const toml::node* node = root.get("evaluation");
  if (node == nullptr) return out;
  const toml::table* table = node->as_table();
  Diagnostics problems;
  if (table == nullptr) {
    problems.push_back(Problem("E0841",
                               study_text,
                               file,
                               node->source(),
                               "'evaluation' is no table",
                               "write [evaluation] and below it, say, poses = 10000"));
    return tl::unexpected(std::move(problems));
  }
  std::vector<std::string> names;
  for (const Key& key : Keys()) names.emplace_back(key.description.key);
  for (const auto& [name, value] : *table) {
    const auto found = std::find(names.begin(), names.end(), name.str());
    if (found == names.end()) {
      problems.push_back(Problem("E0840",
                                 study_text,
                                 file,
                                 name.source(),
                                 fmt::format("unknown key '{}' in [evaluation]", name.str()),
                                 DidYouMean(name.str(), names, names.size())));
      continue;
    }
    const Key& key = Keys()[static_cast<std::size_t>(found - names.begin())];
    std::string complaint = Take(key, value, out);
    if (!complaint.empty())
      problems.push_back(
          Problem("E0841", study_text, file, value.source(), std::move(complaint), RangeText(key)));
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return out;
}

}  // namespace kompono::synthesis
