// SPDX-License-Identifier: Apache-2.0
// Runs what `kompono analyze` was asked for.
#include "analyzing.hpp"

#include <algorithm>
#include <cmath>

namespace kompono::cli {
namespace {

using analysis::PoseJudge;
using analysis::Region;
using analysis::WorkZone;
using analysis::ZoneFunction;
using kinematics::Machine;

constexpr double kPosesOfAField = 200000.0;

/// Whether the zone can have bodies: two or three lengths.
bool HasBodies(const Machine& machine, const Region& region) {
  if (region.dimension() < 2) return false;
  for (std::size_t i = 0; i < region.dimension(); ++i) {
    if (VariedCoordinate(machine, region, i).rotary) return false;
  }
  return true;
}

FittedBody Fit(const ZoneFunction& function,
               const WorkZone& zone,
               analysis::BodyShape shape,
               const std::vector<double>& proportions,
               bool wanted,
               const analysis::RunControl& control) {
  FittedBody out{.body = analysis::LargestInside(function, zone, shape, proportions, control)};
  if (wanted) out.wanted = proportions;
  return out;
}

/// For a cylinder of diameter and height: per varied coordinate.
std::vector<double> CylinderExtents(const std::vector<double>& given, std::size_t dimension) {
  std::vector<double> out{given[0], given[0]};
  if (dimension == 3) out.push_back(given.size() > 1 ? given[1] : given[0]);
  return out;
}

void FindBodies(const AnalysisTask& task, AnalysisResult& out) {
  const Region& region = out.function->region();
  if (!HasBodies(*out.machine, region) || out.zone->lower.empty() || out.stopped) return;
  std::vector<double> box(region.dimension(), 1.0);
  if (task.box) {
    box = *task.box;
    box.resize(region.dimension(), box.back());
  }
  const std::vector<double> cylinder =
      CylinderExtents(task.cylinder.value_or(std::vector<double>{1.0, 1.0}), region.dimension());
  out.bodies.push_back(Fit(*out.function,
                           *out.zone,
                           analysis::BodyShape::kBox,
                           box,
                           task.box.has_value(),
                           task.control));
  out.bodies.push_back(Fit(*out.function,
                           *out.zone,
                           analysis::BodyShape::kCylinder,
                           cylinder,
                           task.cylinder.has_value(),
                           task.control));
}

/// As many steps along each side as make the wanted number of poses in all.
std::vector<std::uint64_t> StepsOf(const Region& region, double poses) {
  const double side = std::pow(poses, 1.0 / static_cast<double>(region.dimension()));
  return std::vector<std::uint64_t>(region.dimension(),
                                    static_cast<std::uint64_t>(std::max(2.0, side)));
}

void FindDexterity(const AnalysisTask& task, const Region& region, AnalysisResult& out) {
  const std::vector<std::uint64_t> steps = StepsOf(region, kPosesOfAField);
  for (std::size_t m = 0; m < out.judge->mechanisms().size(); ++m) {
    MechanismDexterity one{.block = out.judge->mechanisms()[m].block};
    one.length_mm =
        task.length_mm ? *task.length_mm : analysis::CharacteristicLength(*out.judge, m);
    one.home = analysis::DexterityAt(*out.judge, m, out.machine->home(), one.length_mm);
    one.field = analysis::DexterityOver(
        *out.judge, m, one.length_mm, region, steps, task.control, task.regular);
    out.stopped = out.stopped || one.field.stopped;
    out.dexterity.push_back(std::move(one));
  }
}

Diagnostics FindSlices(const AnalysisTask& task, AnalysisResult& out) {
  const Region& region = out.function->region();
  Diagnostics problems;
  for (const auto& [name, value] : task.slices) {
    for (std::size_t i = 0; i < region.dimension(); ++i) {
      const kinematics::Coordinate& c = VariedCoordinate(*out.machine, region, i);
      if (c.name != name || region.dimension() < 2) continue;
      const auto function =
          ZoneFunction::Make(*out.judge, analysis::SliceOf(region, i, value), task.regular);
      if (!function) return function.error();
      SliceResult slice{.coordinate = name,
                        .value = value,
                        .rotary = c.rotary,
                        .function = std::make_shared<const ZoneFunction>(*function)};
      slice.zone = analysis::ComputeZone(*slice.function,
                                         {.tolerance = task.tolerance, .control = task.control});
      out.stopped = out.stopped || slice.zone.stopped;
      if (task.singularities)
        slice.singular =
            analysis::SingularitiesIn(*out.judge, *slice.function, 20000, task.control);
      out.slices.push_back(std::move(slice));
    }
  }
  return problems;
}

Diagnostics FindZone(const AnalysisTask& task, AnalysisResult& out) {
  if (task.zone || task.dexterity || task.indices) {
    out.zone = analysis::ComputeZone(*out.function,
                                     {.tolerance = task.tolerance, .control = task.control});
    out.stopped = out.zone->stopped;
  }
  if (task.zone && out.zone) FindBodies(task, out);
  if (task.dexterity && !out.zone->lower.empty()) {
    Region region = out.function->region();
    region.lower = out.zone->lower;
    region.upper = out.zone->upper;
    FindDexterity(task, region, out);
  }
  if (task.indices && HasBodies(*out.machine, out.function->region()))
    out.indices =
        analysis::IndicesOf(*out.judge, *out.function, *out.zone, task.tilt_rad, 40, task.control);
  if (task.singularities) {
    // Within reach and ranges: with the box that was searched, not with home's side only.
    const auto function = ZoneFunction::Make(*out.judge, out.function->region(), true);
    if (!function) return function.error();
    out.singular = analysis::SingularitiesIn(*out.judge, *function, 20000, task.control);
    out.home_distance = analysis::DistanceToSingularity(*out.judge, out.machine->home());
  }
  return FindSlices(task, out);
}

}  // namespace

bool FittedBody::Fits() const {
  if (!body.found) return false;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (body.size[i] < wanted[i]) return false;
  }
  return true;
}

bool AnalysisResult::Negative() const {
  return stopped || (zone && zone->empty()) ||
         std::any_of(bodies.begin(),
                     bodies.end(),
                     [](const FittedBody& b) { return !b.wanted.empty() && !b.Fits(); }) ||
         (path && (!path->singularities.empty() || !path->out_of_reach.empty()));
}

const kinematics::Coordinate& VariedCoordinate(const Machine& machine,
                                               const Region& region,
                                               std::size_t i) {
  return machine.coordinates()[static_cast<std::size_t>(region.varied[i])];
}

Parsed<AnalysisResult> Analyze(const Machine& machine, const AnalysisTask& task) {
  AnalysisResult out{.machine = &machine};
  auto judge = PoseJudge::Make(machine, machine.nominal(), task.limits);
  if (!judge) return tl::unexpected(judge.error());
  out.judge = std::make_shared<const PoseJudge>(std::move(*judge));
  if (task.zone || task.dexterity || task.indices || task.singularities || !task.slices.empty()) {
    const auto region = analysis::RegionOf(machine, task.over, task.at);
    if (!region) return tl::unexpected(region.error());
    auto function = ZoneFunction::Make(*out.judge, *region, task.regular);
    if (!function) return tl::unexpected(function.error());
    out.function = std::make_shared<const ZoneFunction>(std::move(*function));
    Diagnostics problems = FindZone(task, out);
    if (!problems.empty()) return tl::unexpected(std::move(problems));
  }
  if (!task.path.empty()) {
    auto report = analysis::SingularitiesOnPath(*out.judge, task.path, task.control);
    if (!report) return tl::unexpected(report.error());
    out.path = std::move(*report);
    out.stopped = out.stopped || out.path->stopped;
  }
  if (!task.point.empty()) {
    const std::vector<Eigen::VectorXd> poses =
        task.path.empty() ? std::vector<Eigen::VectorXd>{task.at} : task.path;
    auto path = analysis::PathOfPoint(machine, poses, machine.nominal(), task.point);
    if (!path) return tl::unexpected(path.error());
    out.point_path = std::move(*path);
  }
  if (task.geometry) {
    out.geometry =
        analysis::GeometryAt(machine, task.at, machine.nominal(), task.limits.strut_radius_mm);
  }
  return out;
}

}  // namespace kompono::cli
