// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/evaluation.hpp"

#include <algorithm>

namespace kompono::synthesis {
namespace {

constexpr std::array<StageDescription, kStages> kStageTable{{
    {Stage::kStructure,
     "structure",
     "the candidate and the modules' sidecars",
     "counts of drives, parts, joints, stacked motions"},
    {Stage::kMobility,
     "mobility",
     "a machine of the same relative motion",
     "freedoms of the tool in the part, passive constraints"},
    {Stage::kSizing,
     "sizing",
     "the machine and the required zone",
     "values of the continuous parameters"},
    {Stage::kZone, "zone", "the sized machine", "share of the zone, travels, dexterity, abilities"},
    {Stage::kBudget,
     "budget",
     "the sized machine, stiffnesses, tolerances, masses",
     "stiffness, errors, margins of singularities, moving mass, space"},
}};

// The order is that of MetricId. Methods are texts in the catalog: a change of method changes them.
constexpr std::array<MetricDescription, kMetrics> kMetricTable{{
    {MetricId::kDriveCount,
     "drive_count",
     "1",
     false,
     Stage::kStructure,
     "sidecars",
     "drives of all required motions"},
    {MetricId::kPartCount,
     "part_count",
     "1",
     false,
     Stage::kStructure,
     "sidecars",
     "moving parts: one for a plain axis, links less base for a mechanism"},
    {MetricId::kPassiveJoints,
     "passive_joints",
     "1",
     false,
     Stage::kStructure,
     "sidecars",
     "joints of mechanisms that no drive moves"},
    {MetricId::kStack,
     "stack",
     "1",
     false,
     Stage::kStructure,
     "formula",
     "motions carried one by another on the longer side"},
    {MetricId::kPartMotions,
     "part_motions",
     "1",
     false,
     Stage::kStructure,
     "formula",
     "motions that the part makes"},
    {MetricId::kFoundations,
     "foundations",
     "1",
     false,
     Stage::kStructure,
     "formula",
     "1, or 2 for an open base"},
    {MetricId::kMobility,
     "mobility",
     "1",
     true,
     Stage::kMobility,
     "rank of twists beside home",
     "independent motions of the tool in the part"},
    {MetricId::kPassiveConstraints,
     "passive_constraints",
     "1",
     false,
     Stage::kMobility,
     "Grübler against rank",
     "constraints of mechanisms that repeat others"},
    {MetricId::kAbilities,
     "abilities",
     "1",
     true,
     Stage::kZone,
     "KDD table 1",
     "how many of the nine abilities of KDD table 1 the layout has"},
    {MetricId::kTravel,
     "travel",
     "mm",
     false,
     Stage::kZone,
     "required zone, grid",
     "travels of the linear drives that the zone needs, summed"},
    {MetricId::kZoneShare,
     "zone_share",
     "1",
     true,
     Stage::kZone,
     "grid",
     "share of the required zone that is reached"},
    {MetricId::kDexterityMean,
     "dexterity_mean",
     "1",
     true,
     Stage::kZone,
     "1/condition, grid",
     "mean of 1/condition of the mechanisms over the zone (Gosselin)"},
    {MetricId::kDexterityWorst,
     "dexterity_worst",
     "1",
     true,
     Stage::kZone,
     "1/condition, grid",
     "smallest 1/condition of the mechanisms in the zone"},
    {MetricId::kSingularityMargin,
     "singularity_margin",
     "1",
     true,
     Stage::kBudget,
     "scaled A and B, required poses",
     "smallest singular value of A and B of the mechanisms"},
    {MetricId::kOrientationMargin,
     "orientation_margin",
     "1",
     true,
     Stage::kBudget,
     "tool axis, required poses",
     "smallest singular value of the tool axis' directions by the turns"},
    {MetricId::kStiffness,
     "stiffness",
     "N/um",
     true,
     Stage::kBudget,
     "drives, required poses",
     "smallest stiffness of the tool in the part, at the worst pose and in the worst direction"},
    {MetricId::kErrorBudget,
     "error_budget",
     "um",
     false,
     Stage::kBudget,
     "first order, required poses",
     "standard deviation of the tool's position from tolerances, at the worst pose"},
    {MetricId::kDynamicError,
     "dynamic_error",
     "um",
     false,
     Stage::kBudget,
     "inertia on drives, required poses",
     "deflection of the drives under the moved masses' inertia, at the worst pose (SO 6)"},
    {MetricId::kMovingMass,
     "moving_mass",
     "kg",
     false,
     Stage::kBudget,
     "mass model",
     "masses that the motions carry, summed over the motions"},
    {MetricId::kFootprint,
     "footprint",
     "m2",
     false,
     Stage::kBudget,
     "box, required poses",
     "floor under part, tool and mechanisms in all corners of the zone"},
    {MetricId::kFrame,
     "frame",
     "m",
     false,
     Stage::kBudget,
     "box, required poses",
     "stiff frame that joins the two sides over the machine: twice its height and its longer side; "
     "none for an open base"},
    {MetricId::kSpaceEfficiency,
     "space_efficiency",
     "1",
     true,
     Stage::kBudget,
     "box, required poses",
     "required zone over the box around the machine (after Bohez)"},
}};

}  // namespace

const std::array<StageDescription, kStages>& Stages() {
  return kStageTable;
}

std::string_view NameOf(Stage stage) {
  return kStageTable[static_cast<std::size_t>(stage)].name;
}

const std::array<MetricDescription, kMetrics>& Metrics() {
  return kMetricTable;
}

const MetricDescription& DescriptionOf(MetricId id) {
  return kMetricTable[static_cast<std::size_t>(id)];
}

const MetricDescription* FindMetric(std::string_view name) {
  const auto* const found =
      std::find_if(kMetricTable.begin(), kMetricTable.end(), [name](const auto& metric) {
        return metric.name == name;
      });
  return found == kMetricTable.end() ? nullptr : found;
}

const std::vector<std::string>& MetricNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    out.reserve(kMetrics);
    for (const MetricDescription& metric : kMetricTable) out.emplace_back(metric.name);
    return out;
  }();
  return names;
}

std::string_view NameOf(EvaluationStatus status) {
  switch (status) {
    case EvaluationStatus::kOk:
      return "ok";
    case EvaluationStatus::kRejected:
      return "rejected";
    case EvaluationStatus::kFailed:
      return "failed";
  }
  return "";
}

}  // namespace kompono::synthesis
