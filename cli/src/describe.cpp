// SPDX-License-Identifier: Apache-2.0
// kompono describe: what a layout is made of and what it can move.
#include "freedoms.hpp"
#include "machine_sheet.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <memory>

#include "kompono/analysis/abilities.hpp"
#include "kompono/analysis/mobility.hpp"
#include "kompono/formula/equivalence.hpp"
#include "kompono/formula/formula.hpp"
#include "kompono/kinematics/branches.hpp"

namespace kompono::cli {
namespace {

using kinematics::Machine;
using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono describe machine.toml            coordinates, drives, mobility, abilities, home\n"
    "  kompono describe machine.toml --json     the same for programs\n"
    "  kompono describe machine.toml --freedoms which motions its struts can meet";

/// What is computed once and printed in two ways.
struct Sheet {
  const Machine& machine;
  std::vector<kinematics::Coordinate> coordinates;  ///< of all branches of the formula
  std::vector<kinematics::Drive> drives;
  std::vector<analysis::BlockMobility> mobility;
  std::vector<kinematics::Singularity> singularities;  ///< at home
  struct Home {
    std::string part, tool;
    kinematics::PoseNumbers pose;
  };
  std::vector<Home> homes;                                       ///< one per branch
  std::map<std::string, std::vector<std::string>> capabilities;  ///< and what gives them
  std::vector<analysis::Ability> abilities;
};

std::map<std::string, std::vector<std::string>> CapabilitiesOf(const layout::Layout& layout,
                                                               const plugin::Registry& registry) {
  std::map<std::string, std::vector<std::string>> out;
  const auto add = [&](const std::string& name, const std::string& module) {
    const plugin::ModuleDescription* description = registry.Find(module);
    if (description == nullptr) return;
    for (const std::string& capability : description->capabilities) out[capability].push_back(name);
  };
  for (const layout::Block& block : layout.blocks) add(block.name, block.module);
  for (const layout::End& end : layout.ends) add(end.name, end.module);
  return out;
}

/// Appends what has a name that is not there yet.
template <class T>
void Merge(const std::vector<T>& from, std::vector<T>& into, std::string T::*name) {
  for (const T& item : from) {
    const bool known = std::any_of(into.begin(), into.end(), [&item, name](const T& other) {
      return other.*name == item.*name;
    });
    if (!known) into.push_back(item);
  }
}

Sheet Describe(const Machine& machine, const plugin::Registry& registry) {
  const Eigen::VectorXd theta = machine.nominal();
  Sheet sheet{.machine = machine,
              .coordinates = {},
              .drives = {},
              .mobility = analysis::Mobility(machine),
              .singularities = {},
              .homes = {},
              .capabilities = CapabilitiesOf(machine.layout(), registry),
              .abilities = analysis::Abilities(machine, registry)};
  for (const kinematics::Branch& branch : kinematics::Branches(machine)) {
    const Machine& chain = branch.chain;
    Merge(chain.coordinates(), sheet.coordinates, &kinematics::Coordinate::name);
    Merge(chain.drives(), sheet.drives, &kinematics::Drive::name);
    Merge(chain.Singularities(chain.home(), theta),
          sheet.singularities,
          &kinematics::Singularity::block);
    sheet.homes.push_back({branch.part,
                           branch.tool,
                           kinematics::NumbersFromPose(chain.ToolPose(chain.home(), theta),
                                                       machine.layout().rotation_order)});
  }
  return sheet;
}

std::size_t Identifiable(const Machine& machine) {
  const auto& parameters = machine.parameters();
  return static_cast<std::size_t>(std::count_if(
      parameters.begin(), parameters.end(), [](const auto& p) { return p.identifiable; }));
}

ordered_json PlacementJson(const layout::Placement& placement) {
  const auto& r = placement.rotation_rad;
  return {{"position_mm", placement.position_mm},
          {"rotation_deg", {r[0] * kDegPerRad, r[1] * kDegPerRad, r[2] * kDegPerRad}}};
}

std::string PlacementText(const layout::Placement& placement) {
  const auto& p = placement.position_mm;
  const auto& r = placement.rotation_rad;
  return fmt::format("position {} {} {} mm, rotation {} {} {} deg",
                     Brief(p[0]),
                     Brief(p[1]),
                     Brief(p[2]),
                     Brief(r[0] * kDegPerRad),
                     Brief(r[1] * kDegPerRad),
                     Brief(r[2] * kDegPerRad));
}

void AddMotionsJson(const Sheet& sheet, ordered_json& out) {
  out["coordinates"] = ordered_json::array();
  for (const kinematics::Coordinate& coordinate : sheet.coordinates) {
    out["coordinates"].push_back(
        {{"name", coordinate.name},
         {"letter", std::string(1, coordinate.letter)},
         {"unit", UnitOf(coordinate.rotary)},
         {"range", RangeJson(coordinate.lower, coordinate.upper, coordinate.rotary)},
         {"home", Outward(coordinate.home, coordinate.rotary)}});
  }
  out["drives"] = ordered_json::array();
  for (const kinematics::Drive& drive : sheet.drives) {
    ordered_json entry{{"name", drive.name},
                       {"unit", UnitOf(drive.rotary)},
                       {"range", RangeJson(drive.lower, drive.upper, drive.rotary)}};
    if (drive.speed) entry["speed_per_s"] = Outward(*drive.speed, drive.rotary);
    if (drive.acceleration)
      entry["acceleration_per_s2"] = Outward(*drive.acceleration, drive.rotary);
    if (drive.stiffness)
      entry[drive.rotary ? "stiffness_N_mm_per_rad" : "stiffness_N_per_mm"] = *drive.stiffness;
    out["drives"].push_back(std::move(entry));
  }
}

ordered_json AbilitiesJson(const std::vector<analysis::Ability>& abilities) {
  ordered_json out = ordered_json::array();
  for (const analysis::Ability& ability : abilities) {
    out.push_back({{"name", ability.name()},
                   {"title", ability.title()},
                   {"possible", ability.possible},
                   {"reason", ability.reason},
                   {"by", ability.by}});
  }
  return out;
}

ordered_json SheetJson(const Sheet& sheet) {
  const layout::Layout& layout = sheet.machine.layout();
  ordered_json out{{"name", layout.name},
                   {"description", layout.description},
                   {"formula", formula::Canonical(layout.formula)},
                   {"explanation", ordered_json::array()},
                   {"keys",
                    {{"string", formula::StringKey(layout.formula)},
                     {"distribution", formula::DistributionKey(layout.formula)},
                     {"relative_motion", formula::RelativeMotionKey(layout.formula)}}}};
  for (const formula::Explanation& line : formula::Explain(layout.formula)) {
    out["explanation"].push_back(
        {{"text", line.text}, {"meaning", line.meaning}, {"depth", line.depth}});
  }
  AddMotionsJson(sheet, out);
  out["mechanisms"] = ordered_json::array();
  for (const analysis::BlockMobility& block : sheet.mobility) {
    ordered_json entry{{"block", block.block},
                       {"module", block.module},
                       {"drives", block.drives},
                       {"coordinates", block.coordinates},
                       {"mobility", block.numeric}};
    if (block.counted) {
      entry["links"] = block.links;
      entry["pairs"] = block.pairs;
      entry["loops"] = block.loops;
      entry["gruebler"] = block.gruebler;
      entry["gruebler_in_space"] = block.spatial;
      entry["idle_motions"] = block.idle;
      entry["passive_constraints"] = block.passive;
    }
    entry["explanation"] = block.explanation;
    out["mechanisms"].push_back(std::move(entry));
  }
  out["parameters"] = {{"count", sheet.machine.parameters().size()},
                       {"identifiable", Identifiable(sheet.machine)}};
  out["ends"] = ordered_json::array();
  for (const layout::End& end : layout.ends) {
    ordered_json entry{{"name", end.name}, {"module", end.module}, {"station", end.station}};
    entry.update(PlacementJson(end.mount));
    out["ends"].push_back(std::move(entry));
  }
  if (layout.formula.open_base) out["open_base"] = PlacementJson(layout.open_base);
  out["capabilities"] = sheet.capabilities;
  out["abilities"] = AbilitiesJson(sheet.abilities);
  const SingularitySummary summary = Summary(sheet.singularities);
  out["home"] = {{"pose", PoseJson(sheet.homes.front().pose)},
                 {"singularity", {{"type", summary.type}, {"margin", summary.margin}}}};
  out["branches"] = ordered_json::array();
  for (const Sheet::Home& home : sheet.homes)
    out["branches"].push_back(
        {{"part", home.part}, {"tool", home.tool}, {"pose", PoseJson(home.pose)}});
  return out;
}

std::string MotionsText(const Sheet& sheet) {
  TextTable coordinates({{"coordinate"}, {"range"}, {"home", true}, {""}});
  for (const kinematics::Coordinate& c : sheet.coordinates) {
    coordinates.Row({c.name,
                     RangeText(c.lower, c.upper, c.rotary),
                     Fixed(Outward(c.home, c.rotary)),
                     std::string(UnitOf(c.rotary))});
  }
  TextTable drives({{"drive"}, {"range"}, {"speed", true}, {"acceleration", true}});
  for (const kinematics::Drive& d : sheet.drives) {
    const auto rate = [&d](const std::optional<double>& value, std::string_view per) {
      return value
                 ? fmt::format("{} {}/{}", Brief(Outward(*value, d.rotary)), UnitOf(d.rotary), per)
                 : std::string("-");
    };
    drives.Row({d.name,
                RangeText(d.lower, d.upper, d.rotary),
                rate(d.speed, "s"),
                rate(d.acceleration, "s²")});
  }
  return "\n" + coordinates.Render() + "\n" + drives.Render();
}

std::string MobilityText(const Sheet& sheet) {
  if (sheet.mobility.empty()) return "";
  TextTable table({{"mechanism"},
                   {"module"},
                   {"links", true},
                   {"pairs", true},
                   {"loops", true},
                   {"Grübler", true},
                   {"mobility", true}});
  for (const analysis::BlockMobility& block : sheet.mobility) {
    const auto counted = [&block](int number) {
      return block.counted ? std::to_string(number) : std::string("-");
    };
    table.Row({block.block,
               block.module,
               counted(block.links),
               counted(block.pairs),
               counted(block.loops),
               counted(block.gruebler),
               std::to_string(block.numeric)});
    if (!block.explanation.empty()) table.Line("      " + block.explanation);
  }
  return "\n" + table.Render();
}

/// What the layout makes possible, each with its reason; what it does not is told by --json.
std::string AbilitiesText(const Sheet& sheet) {
  TextTable table({{"can do"}, {""}});
  for (const analysis::Ability& ability : sheet.abilities) {
    if (!ability.possible) continue;
    table.Row({std::string(ability.title()), ability.reason});
  }
  return table.empty() ? "" : "\n" + table.Render();
}

void Print(Console& console, const Sheet& sheet) {
  const layout::Layout& layout = sheet.machine.layout();
  console.Out(console.Paint(layout.name.empty() ? layout.file.string() : layout.name, Hue::kBold) +
              "\n");
  if (!layout.description.empty()) console.Out(layout.description + "\n");
  console.Out(fmt::format("\n{}\n", formula::Canonical(layout.formula)));
  TextTable lines({{""}, {""}});
  for (const formula::Explanation& line : formula::Explain(layout.formula)) {
    lines.Row(
        {std::string(static_cast<std::size_t>(2 * line.depth), ' ') + line.text, line.meaning});
  }
  console.Out(lines.Render() + MotionsText(sheet) + MobilityText(sheet) + AbilitiesText(sheet));
  TextTable facts({{""}, {""}});
  for (const layout::End& end : layout.ends) {
    facts.Row(
        {end.name,
         fmt::format("{}{}{}",
                     end.module.empty() ? "bare frame" : end.module,
                     end.station.empty() ? "" : ", station " + end.station,
                     end.mount == layout::Placement{} ? "" : ", " + PlacementText(end.mount))});
  }
  if (layout.formula.open_base) facts.Row({"open base", PlacementText(layout.open_base)});
  for (const auto& [name, given_by] : sheet.capabilities)
    facts.Row({"capability", fmt::format("{} ({})", name, Joined(given_by))});
  facts.Row({"geometry",
             fmt::format("{}, {} identifiable",
                         Counted(sheet.machine.parameters().size(), "number"),
                         Identifiable(sheet.machine))});
  const SingularitySummary summary = Summary(sheet.singularities);
  facts.Row(
      {"at home",
       fmt::format(
           "{}, singularity margin {}", SingularityName(summary.type), Fixed(summary.margin))});
  console.Out("\n" + facts.Render());
  for (const Sheet::Home& home : sheet.homes) {
    const std::string ends =
        sheet.homes.size() > 1 ? fmt::format(" of {} on {}", home.tool, home.part) : "";
    console.Out(fmt::format("\ntool pose at home{}, {}\n", ends, OrderName(layout.rotation_order)) +
                PoseText(home.pose));
  }
}

struct Options {
  std::string file;
  bool freedoms = false;
  std::optional<double> length_mm;
};

ExitCode Run(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> machine = session.ReadMachine(options.file, code);
  if (!machine) return code;
  if (options.freedoms || options.length_mm) {
    PrintFreedoms(session, *machine, options.length_mm);
    return ExitCode::kOk;
  }
  const Sheet sheet = Describe(*machine, session.registry());
  if (session.json) {
    session.console.Json(SheetJson(sheet));
  } else {
    Print(session.console, sheet);
  }
  return ExitCode::kOk;
}

}  // namespace

void AddDescribe(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "describe", "Motions, drives, mobility and home of a layout", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(command->add_option("FILE", options->file, "Layout")->required(),
               ValueHint::Kind::kFile);
  command->add_flag(
      "--freedoms",
      options->freedoms,
      "Instead: every choice of as many motions as struts, with its condition number at home");
  command
      ->add_option("--radian", options->length_mm, "With --freedoms: what a radian counts, in mm")
      ->check(CLI::PositiveNumber);
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
