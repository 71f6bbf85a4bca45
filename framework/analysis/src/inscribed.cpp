// SPDX-License-Identifier: Apache-2.0
// Largest bodies: a first guess on voxels, a climb with samples, a proof with intervals.
#include "kompono/analysis/inscribed.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace kompono::analysis {
namespace {

constexpr int kVoxels = 48;  ///< along the longest side, counted in the body's proportions
constexpr std::size_t kProofCells = 400000;
constexpr int kSamplesOfASide = 9;

using Point = std::array<double, 3>;

/// The zone as voxels of the body's own proportions, so that the body is a cube or an upright
/// cylinder of equal diameter and height in them.
class Voxels {
 public:
  Voxels(const WorkZone& zone, const std::vector<double>& proportions)
      : n_(zone.box.dimension()), lower_(zone.lower) {
    double edge = 0.0;
    for (std::size_t i = 0; i < n_; ++i)
      edge = std::max(edge, (zone.upper[i] - zone.lower[i]) / proportions[i] / kVoxels);
    for (std::size_t i = 0; i < n_; ++i) {
      step_.push_back(edge * proportions[i]);
      const double extent = zone.upper[i] - zone.lower[i];
      count_[i] = std::max(1, static_cast<int>(std::ceil(extent / step_[i] - 1e-9)));
      // Many more voxels than along the longest side would be of no use.
      count_[i] = std::min(count_[i], 4 * kVoxels);
    }
    full_.assign(Index(0, 0, count_[2]), 0);
    Fill(zone);
  }

  [[nodiscard]] int Count(std::size_t i) const { return count_[i]; }
  [[nodiscard]] bool Full(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < count_[0] && y < count_[1] && z < count_[2] &&
           full_[Index(x, y, z)] != 0;
  }

  /// Edge of the largest cube (square) that ends at each voxel: the rule of three neighbours.
  void LargestCube(std::array<double, 3>& centre, double& scale) const {
    std::vector<std::uint16_t> edge(full_.size(), 0);
    const auto at = [&](int x, int y, int z) -> int {
      return x < 0 || y < 0 || z < 0 ? 0 : edge[Index(x, y, z)];
    };
    int best = 0;
    std::array<int, 3> end{};
    for (int z = 0; z < count_[2]; ++z) {
      for (int y = 0; y < count_[1]; ++y) {
        for (int x = 0; x < count_[0]; ++x) {
          if (full_[Index(x, y, z)] == 0) continue;
          int least = std::numeric_limits<int>::max();
          for (int before = 1; before < (1 << n_); ++before) {
            least = std::min(
                least, at(x - (before & 1), y - ((before >> 1) & 1), z - ((before >> 2) & 1)));
          }
          edge[Index(x, y, z)] = static_cast<std::uint16_t>(least + 1);
          if (least + 1 <= best) continue;
          best = least + 1;
          end = {x, y, z};
        }
      }
    }
    scale = best * step_[0];
    for (std::size_t i = 0; i < n_; ++i)
      centre[i] = lower_[i] + (end[i] + 1 - 0.5 * best) * step_[i];
  }

 private:
  [[nodiscard]] std::size_t Index(int x, int y, int z) const {
    const int row = z * count_[1] + y;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(x);
  }

  /// A voxel is full if its middle lies in a cell that is mostly inside.
  void Fill(const WorkZone& zone) {
    for (const ZoneCell& cell : zone.cells) {
      if (cell.least + cell.most < 1.0F) continue;
      std::array<int, 3> from{0, 0, 0};
      std::array<int, 3> to{1, 1, 1};
      for (std::size_t i = 0; i < n_; ++i) {
        const std::array<double, 2> edge = zone.Edge(cell, i);
        from[i] = std::max(0, static_cast<int>(std::ceil((edge[0] - lower_[i]) / step_[i] - 0.5)));
        to[i] = std::min(count_[i],
                         static_cast<int>(std::ceil((edge[1] - lower_[i]) / step_[i] - 0.5)));
      }
      for (int z = from[2]; z < to[2]; ++z) {
        for (int y = from[1]; y < to[1]; ++y) {
          for (int x = from[0]; x < to[0]; ++x) full_[Index(x, y, z)] = 1;
        }
      }
    }
  }

  std::size_t n_;
  std::vector<double> lower_, step_;
  std::array<int, 3> count_{1, 1, 1};
  std::vector<char> full_;
};

/// Points of the unit body (extents 1 around 0), dense on its surface.
std::vector<Point> SurfaceOf(BodyShape shape, std::size_t n) {
  std::vector<Point> out;
  const auto coordinate = [](int i) {
    return static_cast<double>(i) / (kSamplesOfASide - 1) - 0.5;
  };
  const int layers = n == 3 ? kSamplesOfASide : 1;
  for (int k = 0; k < layers; ++k) {
    const double z = n == 3 ? coordinate(k) : 0.0;
    if (shape == BodyShape::kCylinder) {
      for (int a = 0; a < 48; ++a) {
        const double angle = 2.0 * std::numbers::pi * a / 48.0;
        for (const double radius : {0.5, 0.25}) {
          out.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
        }
      }
      out.push_back({0.0, 0.0, z});
      continue;
    }
    for (int j = 0; j < (n >= 2 ? kSamplesOfASide : 1); ++j) {
      for (int i = 0; i < kSamplesOfASide; ++i)
        out.push_back({coordinate(i), n >= 2 ? coordinate(j) : 0.0, z});
    }
  }
  return out;
}

/// Tries bodies by their samples.
class Climb {
 public:
  Climb(const ZoneFunction& function, BodyShape shape, const std::vector<double>& proportions)
      : function_(function),
        scratch_(function),
        samples_(SurfaceOf(shape, proportions.size())),
        proportions_(proportions) {}

  [[nodiscard]] bool Fits(const Point& centre, double scale) {
    const std::size_t n = proportions_.size();
    Point at{};
    for (std::size_t i = 0; i < n; ++i) {
      const double half = 0.5 * scale * proportions_[i];
      if (centre[i] - half < function_.region().lower[i] ||
          centre[i] + half > function_.region().upper[i])
        return false;
    }
    // The sample that failed last fails most likely again.
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const Point& sample = samples_[(k + last_) % samples_.size()];
      for (std::size_t i = 0; i < n; ++i) at[i] = centre[i] + scale * proportions_[i] * sample[i];
      if (function_.Inside({at.data(), n}, scratch_)) continue;
      last_ = (k + last_) % samples_.size();
      return false;
    }
    return true;
  }

  /// The largest scale at a place, knowing that `known` fits or is 0.
  [[nodiscard]] double Largest(const Point& centre, double known, double limit) {
    double inside = known;
    double outside = limit;
    for (int i = 0; i < 24 && outside - inside > 1e-5 * outside; ++i) {
      const double middle = 0.5 * (inside + outside);
      (Fits(centre, middle) ? inside : outside) = middle;
    }
    return inside;
  }

  void Improve(Point& centre, double& scale, double step, double limit) {
    const std::size_t n = proportions_.size();
    const double last = 1e-4 * step;
    while (step > last) {
      bool better = false;
      for (std::size_t direction = 0; direction < 2 * n; ++direction) {
        Point moved = centre;
        moved[direction / 2] += (direction % 2 == 0 ? step : -step) * proportions_[direction / 2];
        if (!Fits(moved, scale * (1.0 + 1e-4))) continue;
        centre = moved;
        scale = Largest(moved, scale * (1.0 + 1e-4), limit);
        better = true;
      }
      if (!better) step *= 0.5;
    }
  }

 private:
  const ZoneFunction& function_;
  ZoneFunction::Scratch scratch_;
  std::vector<Point> samples_;
  std::vector<double> proportions_;
  std::size_t last_ = 0;
};

/// Whether the cell has a point of the cylinder (disc) around `centre`.
bool MeetsCylinder(const Point& lower,
                   const Point& upper,
                   const std::vector<double>& centre,
                   double radius) {
  double square = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double nearest = std::clamp(centre[i], lower[i], upper[i]);
    square += (nearest - centre[i]) * (nearest - centre[i]);
  }
  return square <= radius * radius;
}

/// Where the body lies within the region's ends, as near to `centre` as it can.
std::vector<double> WithinEnds(const Region& region,
                               const std::vector<double>& centre,
                               const std::vector<double>& size) {
  std::vector<double> out = centre;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double lowest = region.lower[i] + 0.5 * size[i];
    const double highest = region.upper[i] - 0.5 * size[i];
    out[i] = lowest < highest ? std::clamp(out[i], lowest, highest) : 0.5 * (lowest + highest);
  }
  return out;
}

}  // namespace

bool ProvenInside(const ZoneFunction& function,
                  BodyShape shape,
                  const std::vector<double>& centre,
                  const std::vector<double>& size,
                  const RunControl& control) {
  struct Piece {
    Point lower{}, upper{};
  };
  const std::size_t n = centre.size();
  Piece whole;
  for (std::size_t i = 0; i < n; ++i) {
    whole.lower[i] = centre[i] - 0.5 * size[i];
    whole.upper[i] = centre[i] + 0.5 * size[i];
    if (whole.lower[i] < function.region().lower[i] || whole.upper[i] > function.region().upper[i])
      return false;
  }
  ZoneFunction::Scratch scratch(function);
  std::vector<Piece> open{whole};
  std::size_t judged = 0;
  while (!open.empty()) {
    if (++judged > kProofCells || control.Stopped()) return false;
    const Piece piece = open.back();
    open.pop_back();
    if (shape == BodyShape::kCylinder && n >= 2 &&
        !MeetsCylinder(piece.lower, piece.upper, centre, 0.5 * size[0]))
      continue;
    const ZoneFunction::Judged verdict =
        function.Judge({piece.lower.data(), n}, {piece.upper.data(), n}, scratch);
    if (verdict.verdict == ZoneFunction::Verdict::kInside) continue;
    // Outside cells at a cylinder's edge may have no point of it yet.
    if (verdict.verdict == ZoneFunction::Verdict::kOutside && shape == BodyShape::kBox)
      return false;
    double largest = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      largest = std::max(largest, (piece.upper[i] - piece.lower[i]) / size[i]);
    if (largest < 1e-4) return false;
    for (std::uint32_t child = 0; child < (1U << n); ++child) {
      Piece part = piece;
      for (std::size_t i = 0; i < n; ++i) {
        const double middle = 0.5 * (piece.lower[i] + piece.upper[i]);
        (((child >> i) & 1U) != 0 ? part.lower[i] : part.upper[i]) = middle;
      }
      open.push_back(part);
    }
  }
  return true;
}

InscribedBody LargestInside(const ZoneFunction& function,
                            const WorkZone& zone,
                            BodyShape shape,
                            const std::vector<double>& proportions,
                            const RunControl& control) {
  const std::size_t n = zone.box.dimension();
  if (proportions.size() != n ||
      std::any_of(proportions.begin(), proportions.end(), [](double p) { return !(p > 0.0); }))
    throw std::logic_error("LargestInside: expects a positive proportion per varied coordinate");
  InscribedBody out{.shape = shape};
  if (zone.lower.empty()) return out;
  Point centre{};
  double scale = 0.0;
  Voxels(zone, proportions).LargestCube(centre, scale);
  scale /= proportions[0];
  if (scale <= 0.0) return out;
  double limit = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    limit = std::max(limit, 1.01 * (zone.upper[i] - zone.lower[i]) / proportions[i]);
  Climb climb(function, shape, proportions);
  const double step = 0.1 * scale;
  if (!climb.Fits(centre, scale)) scale = climb.Largest(centre, 0.0, scale);
  scale = climb.Largest(centre, scale, limit);
  climb.Improve(centre, scale, step, limit);
  out.centre.assign(centre.begin(), centre.begin() + static_cast<std::ptrdiff_t>(n));
  // The search ends just below what touches a limit: the very extents asked for come first.
  double shrink = 2e-4;
  if (scale > 0.99 && scale * (1.0 - shrink) < 1.0) {
    out.size = proportions;
    const std::vector<double> touching = WithinEnds(function.region(), out.centre, out.size);
    out.found = ProvenInside(function, shape, touching, out.size, control);
    if (out.found) out.centre = touching;
  }
  // Samples can miss a dent; the proof does not. A little smaller until it is given.
  for (; !out.found && shrink < 0.9 && !control.Stopped(); shrink *= 2.0) {
    out.size.clear();
    for (const double p : proportions) out.size.push_back(p * scale * (1.0 - shrink));
    out.found = ProvenInside(function, shape, out.centre, out.size, control);
  }
  out.content = shape == BodyShape::kCylinder && n >= 2 ? std::numbers::pi / 4.0 : 1.0;
  for (const double extent : out.size) out.content *= extent;
  return out;
}

}  // namespace kompono::analysis
