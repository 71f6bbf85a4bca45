// SPDX-License-Identifier: Apache-2.0
// Where det A vanishes in a region, and how far a pose is from there.
#include "mechanism_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "kompono/analysis/dexterity.hpp"
#include "kompono/analysis/singularities.hpp"

namespace kompono::analysis {
namespace {

constexpr std::uint8_t kFirstLevel = 2;
constexpr std::uint8_t kLastLevel = 20;

struct Edges {
  std::array<double, 3> lower{}, upper{};
};

Edges EdgesOf(const Region& box, const ZoneCell& cell) {
  Edges out;
  for (std::size_t i = 0; i < box.dimension(); ++i) {
    const double step = std::ldexp(box.Extent(i), -cell.level);
    out.lower[i] = box.lower[i] + cell.index[i] * step;
    out.upper[i] = box.lower[i] + (cell.index[i] + 1.0) * step;
  }
  return out;
}

std::vector<ZoneCell> ChildrenOf(const std::vector<ZoneCell>& cells, std::size_t dimension) {
  std::vector<ZoneCell> out;
  for (const ZoneCell& cell : cells) {
    for (std::uint32_t child = 0; child < (1U << dimension); ++child) {
      ZoneCell part{.level = static_cast<std::uint8_t>(cell.level + 1)};
      for (std::size_t i = 0; i < dimension; ++i)
        part.index[i] = 2 * cell.index[i] + ((child >> i) & 1U);
      out.push_back(part);
    }
  }
  return out;
}

/// Product of the signs of det A over the mechanisms; 0 where one vanishes or is out of reach.
double SignAt(const PoseJudge& judge, const VectorXd& z) {
  double sign = 1.0;
  for (const auto& mechanism : judge.machine().Singularities(z, judge.theta())) {
    if (mechanism.det_a == 0.0) return 0.0;
    sign *= mechanism.det_a > 0.0 ? 1.0 : -1.0;
  }
  return sign;
}

/// The signs of det A met at the corners of cells.
struct Signs {
  bool up = false, down = false;

  void Add(const PoseJudge& judge, const Region& box, const ZoneCell& cell) {
    const Edges edges = EdgesOf(box, cell);
    for (std::uint32_t corner = 0; corner < (1U << box.dimension()); ++corner) {
      std::vector<double> at;
      for (std::size_t i = 0; i < box.dimension(); ++i)
        at.push_back(((corner >> i) & 1U) != 0 ? edges.upper[i] : edges.lower[i]);
      const double sign = SignAt(judge, box.At(at));
      up = up || sign > 0.0;
      down = down || sign < 0.0;
    }
  }
};

/// The cell nearest to home, and the crossing on the straight way there.
void FindNearest(const PoseJudge& judge, SingularSet& set) {
  const VectorXd home = set.box.At([&] {
    std::vector<double> at;
    for (const int i : set.box.varied) at.push_back(judge.machine().home()[i]);
    return at;
  }());
  double least = std::numeric_limits<double>::infinity();
  VectorXd nearest;
  for (const ZoneCell& cell : set.cells) {
    const Edges edges = EdgesOf(set.box, cell);
    std::vector<double> at;
    for (std::size_t i = 0; i < set.box.dimension(); ++i)
      at.push_back(std::clamp(home[set.box.varied[i]], edges.lower[i], edges.upper[i]));
    const VectorXd z = set.box.At(at);
    if ((z - home).norm() >= least) continue;
    least = (z - home).norm();
    nearest = z;
  }
  if (nearest.size() == 0) return;
  // A little beyond the cell, so that the way crosses what the cell holds.
  const std::vector<VectorXd> way{home, home + 1.2 * (nearest - home)};
  const auto report = SingularitiesOnPath(judge, way);
  set.nearest = nearest;
  if (report) {
    for (const PathSingularity& found : report->singularities) {
      if (found.type < 2) continue;
      set.nearest = found.z;
      break;
    }
  }
  set.nearest_distance = (*set.nearest - home).norm();
}

}  // namespace

SingularSet SingularitiesIn(const PoseJudge& judge,
                            const ZoneFunction& function,
                            std::size_t most_cells,
                            const RunControl& control) {
  SingularSet set{.box = function.region()};
  const std::size_t n = set.box.dimension();
  std::vector<ZoneFunction::Scratch> scratch;
  for (unsigned i = 0; i < control.Threads(); ++i) scratch.emplace_back(function);
  std::vector<ZoneCell> current{ZoneCell{}};
  for (std::uint8_t level = 0; level < kFirstLevel; ++level) current = ChildrenOf(current, n);
  for (std::uint8_t level = kFirstLevel; level <= kLastLevel; ++level) {
    std::vector<char> singular(current.size(), 0);
    const std::uint64_t done =
        ForEachTask((current.size() + 63) / 64, control, [&](std::uint64_t task, unsigned worker) {
          const std::size_t begin = static_cast<std::size_t>(task) * 64;
          for (std::size_t k = begin; k < std::min(current.size(), begin + 64); ++k) {
            const Edges edges = EdgesOf(set.box, current[k]);
            singular[k] =
                function.Judge({edges.lower.data(), n}, {edges.upper.data(), n}, scratch[worker])
                        .singular
                    ? 1
                    : 0;
          }
        });
    std::vector<ZoneCell> kept;
    for (std::size_t k = 0; k < current.size(); ++k) {
      if (singular[k] != 0) kept.push_back(current[k]);
    }
    set.cells = std::move(kept);
    if (set.cells.empty() || control.Stopped() || done * 64 < current.size()) break;
    if ((set.cells.size() << n) > most_cells || level >= 10 + (n == 1 ? 10 : 0)) break;
    current = ChildrenOf(set.cells, n);
  }
  if (set.cells.empty()) return set;
  set.lower = set.box.upper;
  set.upper = set.box.lower;
  Signs signs;
  const std::size_t stride = 1 + set.cells.size() / 2000;
  for (std::size_t k = 0; k < set.cells.size(); ++k) {
    const Edges edges = EdgesOf(set.box, set.cells[k]);
    for (std::size_t i = 0; i < n; ++i) {
      set.lower[i] = std::min(set.lower[i], edges.lower[i]);
      set.upper[i] = std::max(set.upper[i], edges.upper[i]);
    }
    if (k % stride == 0 && !(signs.up && signs.down)) signs.Add(judge, set.box, set.cells[k]);
  }
  set.crossed = signs.up && signs.down;
  FindNearest(judge, set);
  return set;
}

namespace {

/// What vanishes at a singularity of one mechanism, in local coordinates with angles as lengths.
struct Indicator {
  int type = 2;
  int drive = -1;  ///< of type 1
};

class SteepestWay {
 public:
  SteepestWay(const PoseJudge& judge, std::size_t mechanism, const VectorXd& z)
      : mechanism_(judge.mechanisms()[mechanism]), z_(z), x_(LocalAt(mechanism_, z)) {
    const double length = CharacteristicLength(judge, mechanism);
    scale_ = VectorXd::Ones(x_.size());
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (IsRotaryLetter(mechanism_.description->letters[static_cast<std::size_t>(i)]))
        scale_[i] = 1.0 / length;
    }
    for (const Eigen::Vector3d& point : PointsAt(mechanism_, z).point)
      size_ = std::max(size_, point.norm());
  }

  /// Infinite if the way leads nowhere within ten times the size.
  [[nodiscard]] double Distance(const Indicator& indicator, VectorXd& found) const {
    const double none = std::numeric_limits<double>::infinity();
    const double here = Value(indicator, x_);
    if (!std::isfinite(here)) return 0.0;
    if (here == 0.0) return 0.0;
    VectorXd gradient(x_.size());
    const double step = 1e-5 * size_;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      VectorXd moved = x_;
      moved[i] += step * scale_[i];
      const double up = Value(indicator, moved);
      moved[i] -= 2.0 * step * scale_[i];
      gradient[i] = (up - Value(indicator, moved)) / (2.0 * step);
    }
    const double slope = gradient.norm();
    if (!std::isfinite(slope) || !(slope > 0.0)) return none;
    const VectorXd way = (here > 0.0 ? -1.0 : 1.0) * gradient.cwiseProduct(scale_) / slope;
    double before = 0.0;
    double stride = std::min(0.25 * std::abs(here) / slope, 0.02 * size_);
    while (before < 10.0 * size_) {
      const double next = before + stride;
      const double there = Value(indicator, x_ + next * way);
      if (!std::isfinite(there) || there * here <= 0.0) {
        const double at = Bisect(indicator, way, here, before, next);
        found = z_;
        const VectorXd x = x_ + at * way;
        for (std::size_t i = 0; i < mechanism_.coordinate.size(); ++i)
          found[mechanism_.coordinate[i]] = mechanism_.sign[i] * x[static_cast<Eigen::Index>(i)];
        return at;
      }
      before = next;
      stride = std::min(1.5 * stride, 0.02 * size_);
    }
    return none;
  }

 private:
  [[nodiscard]] double Value(const Indicator& indicator, const VectorXd& x) const {
    if (indicator.type == 1) {
      return ValuesAt(mechanism_, plugin::Quantity::kReach, x, VectorXd(), false)
          .value[indicator.drive];
    }
    const VectorXd q = ValuesAt(mechanism_, plugin::Quantity::kDrives, x, VectorXd(), false).value;
    if (!q.allFinite()) return std::numeric_limits<double>::quiet_NaN();
    MatrixXd A = ValuesAt(mechanism_, plugin::Quantity::kClosure, x, q, true).by_coordinates;
    if (A.rows() != A.cols()) return std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index i = 0; i < A.rows(); ++i) A.row(i) /= size_;
    return (A * scale_.asDiagonal()).determinant();
  }

  [[nodiscard]] double Bisect(
      const Indicator& indicator, const VectorXd& way, double here, double from, double to) const {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (from + to);
      const double there = Value(indicator, x_ + middle * way);
      (std::isfinite(there) && there * here > 0.0 ? from : to) = middle;
    }
    return 0.5 * (from + to);
  }

  const PoseJudge::Mechanism& mechanism_;
  VectorXd z_, x_, scale_;
  double size_ = 1.0;
};

}  // namespace

SingularityDistance DistanceToSingularity(const PoseJudge& judge, const VectorXd& z) {
  SingularityDistance out{.distance_mm = std::numeric_limits<double>::infinity()};
  for (std::size_t m = 0; m < judge.mechanisms().size(); ++m) {
    const PoseJudge::Mechanism& mechanism = judge.mechanisms()[m];
    const SteepestWay way(judge, m, z);
    const auto take = [&](const Indicator& indicator) {
      VectorXd found = z;
      const double distance = way.Distance(indicator, found);
      if (!(distance < out.distance_mm)) return;
      out = {.block = mechanism.block,
             .type = indicator.type,
             .drive =
                 indicator.drive < 0
                     ? std::string()
                     : mechanism.block + "." +
                           mechanism.description->drives[static_cast<std::size_t>(indicator.drive)]
                               .name,
             .distance_mm = distance,
             .z = found};
    };
    take({.type = 2});
    for (int drive = 0; drive < mechanism.shape.drives; ++drive) {
      // A pod's reach is its length squared and ends nowhere else.
      take({.type = 1, .drive = drive});
    }
  }
  return out;
}

}  // namespace kompono::analysis
