// SPDX-License-Identifier: Apache-2.0
#include "catalog_record.hpp"

#include "calibration_files.hpp"
#include "machine_sheet.hpp"
#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "kompono/analysis/abilities.hpp"
#include "kompono/analysis/mobility.hpp"
#include "kompono/catalog/hash.hpp"
#include "kompono/formula/equivalence.hpp"
#include "kompono/kinematics/branches.hpp"

namespace kompono::cli {
namespace {

using catalog::LayoutRecord;
using kinematics::Machine;

constexpr const char* kAtHome = "at home";

catalog::Motion MotionOf(const formula::Axis& axis, catalog::Side side, const std::string& block) {
  formula::Axis bare = axis;
  bare.block.clear();
  return {.axis = formula::ItemText(bare), .side = side, .working = axis.working, .block = block};
}

void AddMotions(const formula::Chain& chain, catalog::Side side, LayoutRecord& record) {
  for (const formula::Item& item : chain) {
    if (const auto* axis = std::get_if<formula::Axis>(&item)) {
      record.motions.push_back(MotionOf(*axis, side, axis->block));
    } else if (const auto* group = std::get_if<formula::Group>(&item)) {
      for (const formula::Axis& member : group->axes)
        record.motions.push_back(MotionOf(member, side, group->block));
    } else if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) AddMotions(branch, side, record);
    }
  }
}

/// Blocks and ends with their modules, the plugins these came from, and what they can do.
void AddModules(const layout::Layout& layout,
                const plugin::Registry& registry,
                LayoutRecord& record) {
  std::map<std::string, std::string> plugins;
  std::map<std::string, std::string> capabilities;
  const auto add = [&](const std::string& name, const std::string& module) {
    const plugin::ModuleDescription* description = registry.Find(module);
    if (description == nullptr) return;
    record.blocks.push_back({.name = name, .module = module, .plugin = description->plugin_id});
    for (const plugin::ModuleDescription* used :
         {description, registry.Find(description->implementation)}) {
      if (used != nullptr) plugins[used->plugin_id] = used->plugin_version;
    }
    for (const std::string& capability : description->capabilities) {
      std::string& detail = capabilities[capability];
      detail += (detail.empty() ? "" : ", ") + name;
    }
  };
  for (const layout::Block& block : layout.blocks) add(block.name, block.module);
  for (const layout::End& end : layout.ends) {
    if (!end.module.empty()) add(end.name, end.module);
  }
  for (const auto& [id, version] : plugins)
    record.provenance.plugins.push_back({.id = id, .version = version});
  for (const auto& [name, detail] : capabilities)
    record.capabilities.push_back({.name = name, .detail = detail});
}

/// What the whole layout makes possible, beside the words of its modules.
void AddAbilities(const Machine& machine, const plugin::Registry& registry, LayoutRecord& record) {
  for (const analysis::Ability& ability : analysis::Abilities(machine, registry)) {
    if (ability.possible)
      record.capabilities.push_back(
          {.name = std::string(ability.name()), .detail = ability.reason});
  }
}

catalog::Metric MetricOf(std::string name, double value, std::string unit = "1") {
  catalog::Metric metric{
      .name = std::move(name), .value = value, .unit = std::move(unit), .method = kAtHome};
  if (!std::isfinite(value)) {
    metric.value.reset();
    metric.failure = "not a number at home";
  }
  return metric;
}

void AddMetrics(const Machine& machine, LayoutRecord& record) {
  const Eigen::VectorXd z = machine.home();
  const Eigen::VectorXd theta = machine.nominal();
  const SingularitySummary summary = Summary(machine.Singularities(z, theta));
  record.metrics.push_back(MetricOf("singularity_margin", summary.margin));
  record.metrics.push_back(MetricOf("singularity_type", summary.type));
  for (const analysis::BlockMobility& block : analysis::Mobility(machine)) {
    record.metrics.push_back(MetricOf("mobility." + block.block, block.numeric));
    if (!block.counted) continue;
    record.metrics.push_back(MetricOf("gruebler." + block.block, block.gruebler));
    record.metrics.push_back(MetricOf("loops." + block.block, block.loops));
  }
}

}  // namespace

LayoutRecord RecordOf(const Machine& machine,
                      const plugin::Registry& registry,
                      const std::string& source) {
  const layout::Layout& layout = machine.layout();
  LayoutRecord record;
  record.name = layout.name.empty() ? std::filesystem::path(source).stem().string() : layout.name;
  record.formula = formula::Canonical(layout.formula);
  record.distribution = formula::DistributionKey(layout.formula);
  record.relative_motion = formula::RelativeMotionKey(layout.formula);
  record.open_base = layout.formula.open_base;
  std::set<std::string> coordinates;
  std::set<std::string> drives;
  for (const kinematics::Branch& branch : kinematics::Branches(machine)) {
    for (const kinematics::Coordinate& coordinate : branch.chain.coordinates())
      coordinates.insert(coordinate.name);
    for (const kinematics::Drive& drive : branch.chain.drives()) drives.insert(drive.name);
  }
  record.coordinates = static_cast<int>(coordinates.size());
  record.drives = static_cast<int>(drives.size());
  AddMotions(layout.formula.left, catalog::Side::kWorkpiece, record);
  AddMotions(layout.formula.right, catalog::Side::kTool, record);
  AddModules(layout, registry, record);
  AddAbilities(machine, registry, record);
  for (const kinematics::Parameter& parameter : machine.parameters()) {
    record.parameters.push_back({.name = parameter.name,
                                 .value = Outward(parameter.nominal, parameter.angle),
                                 .unit = std::string(UnitOf(parameter.angle))});
  }
  record.toml = layout.text;
  AddMetrics(machine, record);
  if (const auto calibration = CalibrationOfLayout(layout.text))
    record.calibrations.push_back(*calibration);
  record.provenance.source_path = source;
  record.provenance.source_sha256 = catalog::Hex(catalog::Sha256Of(layout.text));
  return record;
}

}  // namespace kompono::cli
