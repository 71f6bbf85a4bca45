// SPDX-License-Identifier: Apache-2.0
// The boundary of a zone as triangles or lines: tetrahedra (triangles) of a grid that have corners
// on both sides, their crossed edges bisected.
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "kompono/analysis/zone_files.hpp"

namespace kompono::analysis {
namespace {

constexpr int kBisections = 14;

using Point = std::array<double, 3>;

/// Corners of a grid around the zone, each known to be inside or not.
class Grid {
 public:
  Grid(const ZoneFunction& function, const WorkZone& zone, int steps, const RunControl& control)
      : function_(function), region_(function.region()), n_(region_.dimension()) {
    double extent = 0.0;
    for (std::size_t i = 0; i < n_; ++i) extent = std::max(extent, zone.upper[i] - zone.lower[i]);
    const double step = extent / steps;
    for (std::size_t i = 0; i < n_; ++i) {
      const double own = zone.upper[i] - zone.lower[i];
      const int cells = std::max(2, static_cast<int>(std::ceil(own / step)));
      step_[i] = own / cells;
      // One cell of margin, so that the surface closes; off by a little, so that no corner lies
      // exactly on a plane boundary.
      lower_[i] = zone.lower[i] - 1.0137 * step_[i];
      count_[i] = cells + 4;
    }
    for (unsigned i = 0; i < control.Threads(); ++i) scratch_.emplace_back(function);
    inside_.assign(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                       static_cast<std::size_t>(count_[2]),
                   0);
    const auto rows = static_cast<std::uint64_t>(count_[1]) * static_cast<std::uint64_t>(count_[2]);
    static_cast<void>(ForEachTask(rows, control, [&](std::uint64_t row, unsigned worker) {
      const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(count_[0]);
      for (std::size_t x = 0; x < static_cast<std::size_t>(count_[0]); ++x)
        inside_[first + x] = In(At(first + x), worker) ? 1 : 0;
    }));
  }

  [[nodiscard]] int Count(std::size_t i) const { return count_[i]; }
  [[nodiscard]] std::uint32_t Index(int x, int y, int z) const {
    return static_cast<std::uint32_t>((z * count_[1] + y) * count_[0] + x);
  }
  [[nodiscard]] bool Inside(std::uint32_t corner) const { return inside_[corner] != 0; }

  [[nodiscard]] Point At(std::size_t corner) const {
    Point out{};
    std::size_t rest = corner;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto count = static_cast<std::size_t>(count_[i]);
      out[i] = lower_[i] + static_cast<double>(rest % count) * step_[i];
      rest /= count;
    }
    return out;
  }

  /// The boundary between two corners on different sides.
  [[nodiscard]] Point Crossing(std::uint32_t a, std::uint32_t b, unsigned worker) {
    Point in = At(Inside(a) ? a : b);
    Point out = At(Inside(a) ? b : a);
    for (int k = 0; k < kBisections; ++k) {
      Point middle{};
      for (std::size_t i = 0; i < 3; ++i) middle[i] = 0.5 * (in[i] + out[i]);
      (In(middle, worker) ? in : out) = middle;
    }
    return in;
  }

 private:
  [[nodiscard]] bool In(const Point& at, unsigned worker) {
    for (std::size_t i = 0; i < n_; ++i) {
      if (at[i] < region_.lower[i] || at[i] > region_.upper[i]) return false;
    }
    return function_.Inside({at.data(), n_}, scratch_[worker]);
  }

  const ZoneFunction& function_;
  const Region& region_;
  std::size_t n_;
  std::vector<ZoneFunction::Scratch> scratch_;
  Point lower_{}, step_{};
  std::array<int, 3> count_{1, 1, 1};
  std::vector<char> inside_;
};

/// The vertices on crossed edges, each once.
class EdgeVertices {
 public:
  [[nodiscard]] std::uint32_t Of(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32U) | std::max(a, b);
    const auto [found, added] = known_.try_emplace(key, static_cast<std::uint32_t>(edges_.size()));
    if (added) edges_.push_back({a, b});
    return found->second;
  }
  [[nodiscard]] std::vector<Point> Positions(Grid& grid, const RunControl& control) const {
    std::vector<Point> out(edges_.size());
    constexpr std::size_t kOfATask = 256;
    static_cast<void>(ForEachTask(
        (edges_.size() + kOfATask - 1) / kOfATask,
        control,
        [&](std::uint64_t task, unsigned worker) {
          const std::size_t first = static_cast<std::size_t>(task) * kOfATask;
          for (std::size_t k = first; k < std::min(edges_.size(), first + kOfATask); ++k)
            out[k] = grid.Crossing(edges_[k][0], edges_[k][1], worker);
        }));
    return out;
  }

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> known_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// The six tetrahedra of a cube around its diagonal: corner numbers as bits x, y, z.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// All six run round the diagonal the same way, so an even permutation of a tetrahedron's corners
/// keeps its hand, and the triangles can be written down with their insides on one side.
void MarchTetrahedron(const Grid& grid,
                      const std::array<std::uint32_t, 4>& corner,
                      EdgeVertices& vertices,
                      Triangles& out) {
  std::array<std::uint32_t, 4> in{};
  std::array<std::uint32_t, 4> outside{};
  std::size_t ins = 0;
  std::size_t outs = 0;
  bool even = true;  // of the permutation that brings the inner corners to the front
  for (std::size_t k = 0; k < 4; ++k) {
    if (grid.Inside(corner[k])) {
      if (outs % 2 == 1) even = !even;
      in[ins++] = corner[k];
    } else {
      outside[outs++] = corner[k];
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (even) {
      out.push_back({a, b, c});
    } else {
      out.push_back({a, c, b});
    }
  };
  if (ins == 1) {
    add(vertices.Of(in[0], outside[0]),
        vertices.Of(in[0], outside[1]),
        vertices.Of(in[0], outside[2]));
  } else if (ins == 3) {
    add(vertices.Of(in[0], outside[0]),
        vertices.Of(in[1], outside[0]),
        vertices.Of(in[2], outside[0]));
  } else if (ins == 2) {
    const std::uint32_t a = vertices.Of(in[0], outside[0]);
    const std::uint32_t b = vertices.Of(in[0], outside[1]);
    const std::uint32_t c = vertices.Of(in[1], outside[0]);
    const std::uint32_t d = vertices.Of(in[1], outside[1]);
    add(a, b, d);
    add(a, d, c);
  }
}

Eigen::Vector3d At(const ZoneSurface& surface, std::uint32_t vertex) {
  const Point& p = surface.vertices[vertex];
  return {p[0], p[1], p[2]};
}

/// The lines between crossed edges, joined to loops: every vertex has two neighbours.
std::vector<std::vector<std::uint32_t>> Loops(
    const std::vector<std::array<std::uint32_t, 2>>& segments) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> neighbours;
  for (const auto& [a, b] : segments) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::vector<std::vector<std::uint32_t>> out;
  while (!neighbours.empty()) {
    std::vector<std::uint32_t> loop{neighbours.begin()->first};
    while (true) {
      const auto here = neighbours.find(loop.back());
      if (here == neighbours.end() || here->second.empty()) break;
      const std::uint32_t next = here->second.back();
      here->second.pop_back();
      if (here->second.empty()) neighbours.erase(here);
      const auto there = neighbours.find(next);
      if (there != neighbours.end()) {
        const auto back = std::find(there->second.begin(), there->second.end(), loop.back());
        if (back != there->second.end()) there->second.erase(back);
        if (there->second.empty()) neighbours.erase(there);
      }
      if (next == loop.front()) break;
      loop.push_back(next);
    }
    if (loop.size() > 2) out.push_back(std::move(loop));
  }
  return out;
}

}  // namespace

double ZoneSurface::Volume() const {
  double sum = 0.0;
  for (const auto& t : triangles)
    sum += At(*this, t[0]).cross(At(*this, t[1])).dot(At(*this, t[2]));
  return sum / 6.0;
}

double ZoneSurface::Area() const {
  double sum = 0.0;
  for (const auto& t : triangles) {
    const Eigen::Vector3d a = At(*this, t[0]);
    sum += 0.5 * (At(*this, t[1]) - a).cross(At(*this, t[2]) - a).norm();
  }
  return sum;
}

ZoneSurface SurfaceOfZone(const ZoneFunction& function,
                          const WorkZone& zone,
                          int steps,
                          const RunControl& control) {
  ZoneSurface out;
  if (zone.lower.empty() || function.region().dimension() != 3) return out;
  Grid grid(function, zone, steps, control);
  EdgeVertices vertices;
  for (int z = 0; z + 1 < grid.Count(2); ++z) {
    for (int y = 0; y + 1 < grid.Count(1); ++y) {
      for (int x = 0; x + 1 < grid.Count(0); ++x) {
        for (const std::array<int, 4>& tetrahedron : kTetrahedra) {
          std::array<std::uint32_t, 4> corner{};
          for (std::size_t k = 0; k < 4; ++k) {
            const int bits = tetrahedron[k];
            corner[k] = grid.Index(x + (bits & 1), y + ((bits >> 1) & 1), z + ((bits >> 2) & 1));
          }
          MarchTetrahedron(grid, corner, vertices, out.triangles);
        }
      }
    }
  }
  out.vertices = vertices.Positions(grid, control);
  if (out.Volume() < 0.0) {
    for (auto& triangle : out.triangles) std::swap(triangle[1], triangle[2]);
  }
  return out;
}

Outline OutlineOfZone(const ZoneFunction& function,
                      const WorkZone& zone,
                      int steps,
                      const RunControl& control) {
  Outline out;
  if (zone.lower.empty() || function.region().dimension() != 2) return out;
  Grid grid(function, zone, steps, control);
  EdgeVertices vertices;
  std::vector<std::array<std::uint32_t, 2>> segments;
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::vector<std::uint32_t> crossed;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      if (grid.Inside(from) != grid.Inside(to)) crossed.push_back(vertices.Of(from, to));
    }
    if (crossed.size() == 2) segments.push_back({crossed[0], crossed[1]});
  };
  for (int y = 0; y + 1 < grid.Count(1); ++y) {
    for (int x = 0; x + 1 < grid.Count(0); ++x) {
      triangle(grid.Index(x, y, 0), grid.Index(x + 1, y, 0), grid.Index(x + 1, y + 1, 0));
      triangle(grid.Index(x, y, 0), grid.Index(x + 1, y + 1, 0), grid.Index(x, y + 1, 0));
    }
  }
  const std::vector<Point> positions = vertices.Positions(grid, control);
  for (const std::vector<std::uint32_t>& loop : Loops(segments)) {
    std::vector<std::array<double, 2>> line;
    line.reserve(loop.size());
    for (const std::uint32_t vertex : loop)
      line.push_back({positions[vertex][0], positions[vertex][1]});
    out.push_back(std::move(line));
  }
  return out;
}

}  // namespace kompono::analysis
