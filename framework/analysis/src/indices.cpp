// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/indices.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace kompono::analysis {
namespace {

/// The rotary coordinates that the zone holds.
std::vector<int> HeldAngles(const Machine& machine, const Region& region) {
  std::vector<int> out;
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const int index = static_cast<int>(i);
    const bool varied =
        std::find(region.varied.begin(), region.varied.end(), index) != region.varied.end();
    if (machine.coordinates()[i].rotary && !varied) out.push_back(index);
  }
  return out;
}

double ContentOf(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, std::size_t n) {
  // A planar zone is compared with the two larger sides, a linear one with the longest.
  std::array<double, 3> sides{upper.x() - lower.x(), upper.y() - lower.y(), upper.z() - lower.z()};
  std::sort(sides.begin(), sides.end(), std::greater<>());
  double content = 1.0;
  for (std::size_t i = 0; i < n; ++i) content *= sides[i];
  return content;
}

/// Box around the machine's points with its zone's corners taken.
double MachineContent(const PoseJudge& judge, const WorkZone& zone) {
  const Machine& machine = judge.machine();
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector3d upper = -lower;
  const auto take = [&](const VectorXd& z) {
    for (const auto& point : machine.Skeleton(z, judge.theta()).points) {
      if (!point.p_M.allFinite()) continue;
      lower = lower.cwiseMin(point.p_M);
      upper = upper.cwiseMax(point.p_M);
    }
    const Eigen::Vector3d tool = machine.ToolPose(z, judge.theta()).p;
    if (!tool.allFinite()) return;
    lower = lower.cwiseMin(tool);
    upper = upper.cwiseMax(tool);
  };
  take(machine.home());
  // The zone's own cells, thinned: where the box's corners lie outside, the machine does not go.
  const std::size_t stride = 1 + zone.cells.size() / 2000;
  for (std::size_t k = 0; k < zone.cells.size(); k += stride) {
    std::vector<double> at;
    for (std::size_t i = 0; i < zone.box.dimension(); ++i) {
      const std::array<double, 2> edge = zone.Edge(zone.cells[k], i);
      at.push_back(0.5 * (edge[0] + edge[1]));
    }
    take(zone.box.At(at));
  }
  return ContentOf(lower, upper, zone.box.dimension());
}

/// Grid poses that are inside at home's angles, and those that are with every combination of tilts.
double TiltableShare(const PoseJudge& judge,
                     const Region& box,
                     const std::vector<int>& angles,
                     double tilt,
                     std::uint64_t steps,
                     const RunControl& control) {
  double longest = 0.0;
  for (std::size_t i = 0; i < box.dimension(); ++i) longest = std::max(longest, box.Extent(i));
  std::vector<std::uint64_t> grid;
  std::uint64_t poses = 1;
  for (std::size_t i = 0; i < box.dimension(); ++i) {
    grid.push_back(std::max<std::uint64_t>(
        4, static_cast<std::uint64_t>(static_cast<double>(steps) * box.Extent(i) / longest)));
    poses *= grid.back();
  }
  constexpr std::uint64_t kCapacity = PoseBlock::kCapacity;
  std::vector<PoseBlock> blocks;
  for (unsigned i = 0; i < control.Threads(); ++i) blocks.emplace_back(judge);
  std::vector<std::uint64_t> inside(blocks.size(), 0);
  std::vector<std::uint64_t> tilted(blocks.size(), 0);
  const auto work = [&](std::uint64_t task, unsigned worker) {
    PoseBlock& block = blocks[worker];
    const std::uint64_t first = task * kCapacity;
    const auto count = static_cast<std::size_t>(std::min(kCapacity, poses - first));
    std::vector<char> kept(count, 1);
    Region region = box;
    const std::uint32_t combinations = 1U << angles.size();
    for (std::uint32_t c = 0; c <= combinations; ++c) {  // the last: home's own angles
      for (std::size_t i = 0; i < angles.size(); ++i) {
        const double sign = ((c >> i) & 1U) != 0 ? 1.0 : -1.0;
        region.z[angles[i]] = box.z[angles[i]] + (c == combinations ? 0.0 : sign * tilt);
      }
      FillHeld(region, block);
      FillGrid(region, grid, first, count, block);
      block.Judge(count);
      for (std::size_t k = 0; k < count && c < combinations; ++k)
        kept[k] = kept[k] != 0 && block.Inside(k) ? 1 : 0;
    }
    inside[worker] += block.InsideCount();
    for (std::size_t k = 0; k < count; ++k)
      tilted[worker] += kept[k] != 0 && block.Inside(k) ? 1 : 0;
  };
  static_cast<void>(ForEachTask((poses + kCapacity - 1) / kCapacity, control, work));
  double all = 0.0;
  double some = 0.0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    all += static_cast<double>(inside[i]);
    some += static_cast<double>(tilted[i]);
  }
  return all > 0.0 ? some / all : 0.0;
}

/// How far one angle can be turned from home, the rest held: bisected steps outwards.
LayoutIndices::Range RangeOf(const PoseJudge& judge, const Region& box, int angle) {
  const kinematics::Coordinate& c = judge.machine().coordinates()[static_cast<std::size_t>(angle)];
  LayoutIndices::Range out{.coordinate = c.name};
  const Region region{.z = judge.machine().home(),
                      .varied = {angle},
                      .lower = {std::max(c.home - std::numbers::pi, c.lower.value_or(-1e9))},
                      .upper = {std::min(c.home + std::numbers::pi, c.upper.value_or(1e9))}};
  out.lower_rad = out.upper_rad = c.home;
  const auto function = ZoneFunction::Make(judge, region, true);
  if (!function || box.dimension() == 0) return out;
  ZoneFunction::Scratch scratch(*function);
  const auto inside = [&](double at) { return function->Inside({&at, 1}, scratch); };
  if (!inside(c.home)) return out;
  const auto far = [&](double end) {
    constexpr int kSteps = 720;
    double good = c.home;
    for (int i = 1; i <= kSteps; ++i) {
      const double next = c.home + (end - c.home) * i / kSteps;
      if (!inside(next)) {
        double bad = next;
        for (int k = 0; k < 40; ++k) {
          const double middle = 0.5 * (good + bad);
          (inside(middle) ? good : bad) = middle;
        }
        break;
      }
      good = next;
    }
    return good;
  };
  out.lower_rad = far(region.lower[0]);
  out.upper_rad = far(region.upper[0]);
  return out;
}

}  // namespace

LayoutIndices IndicesOf(const PoseJudge& judge,
                        const ZoneFunction& function,
                        const WorkZone& zone,
                        double tilt_rad,
                        std::uint64_t steps,
                        const RunControl& control) {
  LayoutIndices out{.tilt_rad = tilt_rad};
  if (zone.lower.empty()) return out;
  Region box = function.region();
  box.lower = zone.lower;
  box.upper = zone.upper;
  out.utilisation = zone.content / box.Content();
  const double machine = MachineContent(judge, zone);
  out.space_efficiency = machine > 0.0 ? zone.content / machine : 0.0;
  const std::vector<int> angles = HeldAngles(judge.machine(), box);
  if (angles.empty()) return out;
  out.orientation_space = TiltableShare(judge, box, angles, tilt_rad, steps, control);
  double product = 1.0;
  for (const int angle : angles) {
    out.ranges.push_back(RangeOf(judge, box, angle));
    product *=
        (out.ranges.back().upper_rad - out.ranges.back().lower_rad) / (2.0 * std::numbers::pi);
  }
  out.orientation_angle = product;
  return out;
}

}  // namespace kompono::analysis
