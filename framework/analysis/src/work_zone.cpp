// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/work_zone.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kompono::analysis {
namespace {

constexpr std::uint8_t kFirstLevel = 3;
constexpr std::uint8_t kLastLevel = 24;
constexpr std::size_t kCellsOfATask = 256;
constexpr std::size_t kCellsOfTheFirstLook = 60000;
constexpr double kTouch = 1e-9;  ///< of the box's extent

using Judged = ZoneFunction::Judged;
using Verdict = ZoneFunction::Verdict;

std::array<double, 2> EdgeOf(const Region& box, const ZoneCell& cell, std::size_t i) {
  const double step = std::ldexp(box.Extent(i), -cell.level);
  const double from = static_cast<double>(cell.index[i]);
  const bool last = cell.index[i] + 1U == (1U << cell.level);
  return {box.lower[i] + from * step, last ? box.upper[i] : box.lower[i] + (from + 1.0) * step};
}

double VolumeOf(const Region& box, const ZoneCell& cell) {
  return std::ldexp(box.Content(), -static_cast<int>(cell.level * box.dimension()));
}

std::vector<ZoneCell> FirstCells(std::size_t dimension) {
  std::vector<ZoneCell> out;
  const std::uint32_t side = 1U << kFirstLevel;
  const std::uint32_t count = 1U << (kFirstLevel * dimension);
  for (std::uint32_t k = 0; k < count; ++k) {
    ZoneCell cell{.level = kFirstLevel};
    std::uint32_t rest = k;
    for (std::size_t i = 0; i < dimension; ++i, rest /= side) cell.index[i] = rest % side;
    out.push_back(cell);
  }
  return out;
}

void Split(const ZoneCell& cell, std::size_t dimension, std::vector<ZoneCell>& out) {
  for (std::uint32_t child = 0; child < (1U << dimension); ++child) {
    ZoneCell part{.level = static_cast<std::uint8_t>(cell.level + 1)};
    for (std::size_t i = 0; i < dimension; ++i)
      part.index[i] = 2 * cell.index[i] + ((child >> i) & 1U);
    out.push_back(part);
  }
}

/// Judges all cells on all cores; how many were judged before a stop.
std::size_t JudgeAll(const ZoneFunction& function,
                     const Region& box,
                     std::vector<ZoneFunction::Scratch>& scratch,
                     const RunControl& control,
                     std::vector<ZoneCell>& cells,
                     std::vector<Verdict>& verdicts) {
  verdicts.resize(cells.size());
  const std::uint64_t tasks = (cells.size() + kCellsOfATask - 1) / kCellsOfATask;
  const auto work = [&](std::uint64_t task, unsigned worker) {
    const std::size_t begin = static_cast<std::size_t>(task) * kCellsOfATask;
    const std::size_t end = std::min(cells.size(), begin + kCellsOfATask);
    std::array<double, 3> lower{};
    std::array<double, 3> upper{};
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t i = 0; i < box.dimension(); ++i) {
        const std::array<double, 2> edge = EdgeOf(box, cells[k], i);
        lower[i] = edge[0];
        upper[i] = edge[1];
      }
      const Judged judged = function.Judge(
          {lower.data(), box.dimension()}, {upper.data(), box.dimension()}, scratch[worker]);
      verdicts[k] = judged.verdict;
      cells[k].certain = judged.verdict == Verdict::kInside;
      cells[k].cause = static_cast<std::int16_t>(judged.cause);
      // Rounded to float outwards: the bounds stay bounds.
      cells[k].least = std::max(0.0F, std::nextafter(static_cast<float>(judged.least), -1.0F));
      cells[k].most = std::min(1.0F, std::nextafter(static_cast<float>(judged.most), 2.0F));
      if (cells[k].certain) cells[k].least = cells[k].most = 1.0F;
    }
  };
  const std::uint64_t done = ForEachTask(tasks, control, work);
  return std::min(cells.size(), static_cast<std::size_t>(done) * kCellsOfATask);
}

/// The sums over the cells that are kept.
struct Sums {
  double least = 0.0, most = 0.0;
  void Add(const ZoneCell& cell, double volume) {
    least += cell.least * volume;
    most += cell.most * volume;
  }
};

/// Splits the cells whose share is known worst until the whole is known well enough.
WorkZone Pave(const ZoneFunction& function,
              const Region& box,
              double tolerance,
              std::size_t most_cells,
              const RunControl& control) {
  WorkZone zone{.box = box};
  std::vector<ZoneFunction::Scratch> scratch;
  for (unsigned i = 0; i < control.Threads(); ++i) scratch.emplace_back(function);
  std::vector<ZoneCell> current = FirstCells(box.dimension());
  std::vector<Verdict> verdicts;
  Sums settled;
  for (std::uint8_t level = kFirstLevel; !current.empty(); ++level) {
    const std::size_t done = JudgeAll(function, box, scratch, control, current, verdicts);
    zone.judged += done;
    zone.stopped = done < current.size();
    std::vector<ZoneCell> open;
    const double volume = VolumeOf(box, current.front());
    Sums sums = settled;
    for (std::size_t k = 0; k < current.size(); ++k) {
      if (k >= done) {  // not looked at any more: nothing is known of it
        current[k].least = 0.0F;
        current[k].most = 1.0F;
        verdicts[k] = Verdict::kBoundary;
      }
      if (verdicts[k] == Verdict::kOutside) continue;
      sums.Add(current[k], volume);
      if (verdicts[k] == Verdict::kInside) {
        zone.cells.push_back(current[k]);
        settled.Add(current[k], volume);
      } else {
        open.push_back(current[k]);
      }
    }
    const double wanted = tolerance * (sums.least + sums.most);
    const std::size_t children = std::size_t{1} << box.dimension();
    const bool enough = sums.most - sums.least <= wanted || zone.stopped || level == kLastLevel ||
                        zone.judged + open.size() * children > most_cells;
    current.clear();
    const double threshold =
        0.3 * wanted / static_cast<double>(std::max<std::size_t>(1, open.size()));
    for (const ZoneCell& cell : open) {
      if (enough || (cell.most - cell.least) * volume <= threshold) {
        settled.Add(cell, volume);
        if (cell.most > 0.0F) zone.cells.push_back(cell);
      } else {
        Split(cell, box.dimension(), current);
      }
    }
  }
  zone.content = 0.5 * (settled.least + settled.most);
  zone.bound = 0.5 * (settled.most - settled.least) + 1e-12 * settled.most;
  return zone;
}

/// Widens zone.lower and zone.upper to the cells that `counts` takes.
template <class Counts>
void Widen(WorkZone& zone, const Counts& counts) {
  for (const ZoneCell& cell : zone.cells) {
    if (!counts(cell)) continue;
    for (std::size_t i = 0; i < zone.box.dimension(); ++i) {
      const std::array<double, 2> edge = zone.Edge(cell, i);
      zone.lower[i] = std::min(zone.lower[i], edge[0]);
      zone.upper[i] = std::max(zone.upper[i], edge[1]);
    }
  }
}

/// The box around all cells that have a part inside, or may have. With `certain` those that only
/// may do not count if they lie far from all that have: where reach ends in a corner, a few cells
/// can stay open for ever.
void FindBounds(WorkZone& zone, bool certain) {
  zone.lower.clear();
  zone.upper.clear();
  const auto known = [](const ZoneCell& cell) { return cell.least > 0.0F; };
  const bool any = std::any_of(zone.cells.begin(), zone.cells.end(), known);
  if (zone.cells.empty() || (certain && !any)) return;
  zone.lower = zone.box.upper;
  zone.upper = zone.box.lower;
  if (!certain || !any) {
    Widen(zone, [](const ZoneCell&) { return true; });
    return;
  }
  Widen(zone, known);
  const std::vector<double> lower = zone.lower;
  const std::vector<double> upper = zone.upper;
  Widen(zone, [&](const ZoneCell& cell) {
    for (std::size_t i = 0; i < zone.box.dimension(); ++i) {
      const std::array<double, 2> edge = zone.Edge(cell, i);
      const double far = 0.25 * (upper[i] - lower[i]);
      if (edge[0] < lower[i] - far || edge[1] > upper[i] + far) return false;
    }
    return true;
  });
}

/// What the boundary is made of: each boundary cell counts with the extent of its face, and so do
/// cells that end at the searched box.
void FindShares(WorkZone& zone, const Region& region, const std::vector<std::string>& ends) {
  const std::size_t n = region.dimension();
  const std::size_t own = zone.constraints.size();
  zone.constraints.insert(zone.constraints.end(), ends.begin(), ends.end());
  zone.shares.assign(zone.constraints.size(), 0.0);
  zone.touches.assign(n, {false, false});
  for (const ZoneCell& cell : zone.cells) {
    const double volume = VolumeOf(zone.box, cell);
    if (cell.cause >= 0 && static_cast<std::size_t>(cell.cause) < own && !cell.certain) {
      const double size = std::pow(volume, 1.0 / static_cast<double>(n));
      zone.shares[static_cast<std::size_t>(cell.cause)] += volume / size;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::array<double, 2> edge = zone.Edge(cell, i);
      const double slack = kTouch * region.Extent(i);
      const std::array<bool, 2> touches{edge[0] <= region.lower[i] + slack,
                                        edge[1] >= region.upper[i] - slack};
      for (std::size_t end = 0; end < 2; ++end) {
        if (!touches[end] || cell.most <= 0.0F) continue;
        zone.touches[i][end] = true;
        zone.shares[own + 2 * i + end] += cell.most * volume / (edge[1] - edge[0]);
      }
    }
  }
  const double sum = std::accumulate(zone.shares.begin(), zone.shares.end(), 0.0);
  if (sum <= 0.0) return;
  for (double& share : zone.shares) share /= sum;
}

}  // namespace

std::array<double, 2> WorkZone::Edge(const ZoneCell& cell, std::size_t i) const {
  return EdgeOf(box, cell, i);
}

WorkZone ComputeZone(const ZoneFunction& function, const ZoneOptions& options) {
  const Region& region = function.region();
  Region box = region;
  // Where the zone is: a coarse paving of everything, then of what is left.
  for (int look = 0; look < 3; ++look) {
    WorkZone coarse = Pave(function, box, 0.3, kCellsOfTheFirstLook, options.control);
    FindBounds(coarse, false);
    if (coarse.stopped || coarse.empty()) break;
    double shrunk = 1.0;
    for (std::size_t i = 0; i < box.dimension(); ++i)
      shrunk *= (coarse.upper[i] - coarse.lower[i]) / box.Extent(i);
    box.lower = coarse.lower;
    box.upper = coarse.upper;
    if (shrunk > 0.5) break;
  }
  WorkZone zone = Pave(function, box, options.tolerance, options.most_cells, options.control);
  for (const Constraint& constraint : function.constraints())
    zone.constraints.push_back(constraint.name);
  FindBounds(zone, true);
  FindShares(zone, region, function.EndNames());
  return zone;
}

Region SliceOf(const Region& region, std::size_t direction, double value) {
  Region out = region;
  out.z[region.varied[direction]] = value;
  const auto at = static_cast<std::ptrdiff_t>(direction);
  out.varied.erase(out.varied.begin() + at);
  out.lower.erase(out.lower.begin() + at);
  out.upper.erase(out.upper.begin() + at);
  return out;
}

}  // namespace kompono::analysis
