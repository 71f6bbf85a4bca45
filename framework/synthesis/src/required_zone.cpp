// SPDX-License-Identifier: Apache-2.0
#include "required_zone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

namespace kompono::synthesis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using kinematics::Machine;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kAngleSteps = 7;    ///< poses of each turn from end to end
constexpr int kNewtonRounds = 8;  ///< a platform of pure letters needs one
constexpr double kPlaced_mm = 1e-6;

/// A required motion and the coordinate that makes it.
struct Pairing {
  const Motion* motion = nullptr;
  int coordinate = -1;
  int row = -1;       ///< of the tool's position; -1: a turn, or a second axis
  double sign = 1.0;  ///< of a turn: coordinate against the tool's turn in the part
};

std::vector<Pairing> PairMotions(const Machine& machine, const std::vector<Motion>& motions) {
  kinematics::PoseDerivatives derivatives;
  (void)machine.ToolPose(machine.home(), machine.nominal(), &derivatives);
  std::vector<Pairing> out;
  for (const Motion& motion : motions) {
    Pairing pairing{.motion = &motion};
    for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
      if (AxisOf(machine.coordinates()[i]) == motion.name) pairing.coordinate = static_cast<int>(i);
    }
    const std::size_t direction = std::string_view("XYZABC").find(motion.axis.letter);
    if (pairing.coordinate >= 0 && direction != std::string_view::npos) {
      const auto row = static_cast<Eigen::Index>(direction);
      if (row < 3 && motion.axis.number == 0) pairing.row = static_cast<int>(row);
      if (derivatives.by_coordinates(row, pairing.coordinate) < 0.0) pairing.sign = -1.0;
    }
    out.push_back(pairing);
  }
  return out;
}

/// Moves the translations until the tool is at the corner; false if they cannot.
bool Place(const Machine& machine,
           const std::vector<Pairing>& lengths,
           const std::vector<double>& corner,
           VectorXd& z) {
  const auto n = static_cast<Eigen::Index>(lengths.size());
  MatrixXd D(n, n);
  VectorXd missing(n);
  kinematics::PoseDerivatives derivatives;
  const VectorXd theta = machine.nominal();
  for (int round = 0; round < kNewtonRounds; ++round) {
    const Pose<double> X_WT = machine.ToolPose(z, theta, &derivatives);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Pairing& row = lengths[static_cast<std::size_t>(i)];
      missing[i] = corner[static_cast<std::size_t>(i)] - X_WT.p[row.row];
      for (Eigen::Index j = 0; j < n; ++j) {
        D(i, j) =
            derivatives.by_coordinates(row.row, lengths[static_cast<std::size_t>(j)].coordinate);
      }
    }
    if (!missing.allFinite()) return false;
    if (missing.cwiseAbs().maxCoeff() < kPlaced_mm) return true;
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(D);
    if (qr.rank() < n) return false;
    const VectorXd step = qr.solve(missing);
    for (Eigen::Index i = 0; i < n; ++i)
      z[lengths[static_cast<std::size_t>(i)].coordinate] += step[i];
  }
  return false;
}

/// Ends and middle of every length at the angles that z has.
void AddPoses(const Machine& machine,
              const std::vector<Pairing>& lengths,
              VectorXd z,
              std::vector<VectorXd>& poses) {
  std::size_t count = 1;
  for (std::size_t i = 0; i < lengths.size(); ++i) count *= 3;
  for (std::size_t index = 0; index < count; ++index) {
    std::vector<double> place;
    std::size_t rest = index;
    for (const Pairing& pairing : lengths) {
      const Interval& range = pairing.motion->range;
      place.push_back(range.lower + 0.5 * static_cast<double>(rest % 3) * range.width());
      rest /= 3;
    }
    if (Place(machine, lengths, place, z)) poses.push_back(z);
  }
}

struct Bounds {
  VectorXd lower, upper;
  void Take(const VectorXd& z) {
    lower = lower.cwiseMin(z);
    upper = upper.cwiseMax(z);
  }
};

/// Every corner of the lengths at the angles that z has.
bool TakeCorners(const Machine& machine,
                 const std::vector<Pairing>& lengths,
                 VectorXd z,
                 Bounds& bounds) {
  if (lengths.empty()) {
    bounds.Take(z);
    return true;
  }
  for (std::size_t c = 0; c < std::size_t{1} << lengths.size(); ++c) {
    std::vector<double> corner;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const Interval& range = lengths[i].motion->range;
      corner.push_back(((c >> i) & 1U) != 0 ? range.upper : range.lower);
    }
    if (!Place(machine, lengths, corner, z)) return false;
    bounds.Take(z);
  }
  return true;
}

}  // namespace

std::string_view AxisOf(const kinematics::Coordinate& coordinate) {
  const std::string_view name = coordinate.name;
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

RequiredZone FindRequiredZone(const Machine& machine, const std::vector<Motion>& motions) {
  RequiredZone out;
  std::vector<Pairing> lengths;
  std::vector<Pairing> others;  // turns and second axes: their ranges are the coordinates' own
  for (const Pairing& pairing : PairMotions(machine, motions)) {
    if (pairing.coordinate < 0) return out;
    (pairing.row >= 0 ? lengths : others).push_back(pairing);
    if (pairing.row < 0 || pairing.motion->range.width() <= 0.0) continue;
    out.content *= pairing.motion->range.width();
    ++out.lengths;
  }
  const VectorXd home = machine.home();
  Bounds bounds{home, home};
  std::uint64_t grids = 1;
  for (std::size_t i = 0; i < others.size(); ++i) grids *= kAngleSteps;
  bool first = true;
  for (std::uint64_t grid = 0; grid < grids; ++grid) {
    VectorXd z = home;
    std::uint64_t rest = grid;
    bool told = true;  // ends and middles of the angles
    for (const Pairing& other : others) {
      told = told && rest % kAngleSteps % (kAngleSteps / 2) == 0;
      const double along = static_cast<double>(rest % kAngleSteps) / (kAngleSteps - 1);
      rest /= kAngleSteps;
      const Interval& range = other.motion->range;
      z[other.coordinate] = other.sign * (range.lower + along * range.width());
    }
    if (first) {
      // Home itself need not lie in the zone.
      bounds.lower = VectorXd::Constant(home.size(), kInfinity);
      bounds.upper = -bounds.lower;
      first = false;
    }
    if (!TakeCorners(machine, lengths, z, bounds)) return out;
    if (told) AddPoses(machine, lengths, z, out.poses);
  }
  out.found = true;
  out.region.z = 0.5 * (bounds.lower + bounds.upper);
  for (Eigen::Index i = 0; i < home.size(); ++i) {
    if (!(bounds.upper[i] - bounds.lower[i] > 1e-9)) continue;
    out.region.varied.push_back(static_cast<int>(i));
    out.region.lower.push_back(bounds.lower[i]);
    out.region.upper.push_back(bounds.upper[i]);
  }
  return out;
}

PoseGrid::PoseGrid(const analysis::Region& region, std::uint64_t steps, int /*tag*/)
    : region_(&region), steps_(steps) {
  for (std::size_t i = 0; i < region.dimension(); ++i) size_ *= steps_;
}

PoseGrid::PoseGrid(const analysis::Region& region, std::uint64_t poses)
    : PoseGrid(region,
               region.dimension() == 0
                   ? std::uint64_t{2}
                   : std::max<std::uint64_t>(
                         2,
                         static_cast<std::uint64_t>(std::lround(
                             std::ceil(std::pow(static_cast<double>(poses),
                                                1.0 / static_cast<double>(region.dimension())) -
                                       1e-9)))),
               0) {}

PoseGrid PoseGrid::Of(const analysis::Region& region, std::uint64_t steps, std::uint64_t most) {
  PoseGrid out(region, steps, 0);
  while (steps > 2 && out.size() > most) out = PoseGrid(region, --steps, 0);
  return out;
}

VectorXd PoseGrid::At(std::uint64_t index) const {
  VectorXd z = region_->z;
  for (std::size_t i = region_->dimension(); i-- > 0;) {
    const double along = static_cast<double>(index % steps_) / static_cast<double>(steps_ - 1);
    index /= steps_;
    z[region_->varied[i]] = region_->lower[i] + along * region_->Extent(i);
  }
  return z;
}

void PoseGrid::Fill(std::uint64_t first, std::size_t count, analysis::PoseBlock& block) const {
  for (Eigen::Index i = 0; i < region_->z.size(); ++i) {
    const auto column = block.column(static_cast<std::size_t>(i));
    std::fill_n(column.begin(), count, region_->z[i]);
  }
  std::uint64_t stride = 1;
  for (std::size_t i = region_->dimension(); i-- > 0;) {
    const auto column = block.column(static_cast<std::size_t>(region_->varied[i]));
    const double step = region_->Extent(i) / static_cast<double>(steps_ - 1);
    for (std::size_t k = 0; k < count; ++k) {
      column[k] = region_->lower[i] + step * static_cast<double>((first + k) / stride % steps_);
    }
    stride *= steps_;
  }
}

namespace {

/// What the drives of the mechanisms must reach, in drive coordinates.
struct DriveExtents {
  std::vector<std::vector<Interval>> of;  ///< per mechanism and drive

  explicit DriveExtents(const analysis::PoseJudge& judge) {
    for (const auto& mechanism : judge.mechanisms())
      of.emplace_back(static_cast<std::size_t>(mechanism.shape.drives),
                      Interval{kInfinity, -kInfinity});
  }
  void Take(const analysis::PoseBlock& block, std::size_t pose) {
    for (std::size_t m = 0; m < of.size(); ++m) {
      for (std::size_t i = 0; i < of[m].size(); ++i) {
        const double q = block.DriveCoordinate(m, i, pose);
        of[m][i].lower = std::min(of[m][i].lower, q);
        of[m][i].upper = std::max(of[m][i].upper, q);
      }
    }
  }
};

/// Of every drive of the machine: mechanisms as they were judged, plain axes as far as their
/// coordinates are varied.
std::vector<Interval> DrivesOf(const analysis::PoseJudge& judge,
                               const DriveExtents& extents,
                               const analysis::Region& region) {
  const Machine& machine = judge.machine();
  std::vector<Interval> out(machine.drives().size());
  const std::vector<Machine::BlockView> blocks = machine.blocks();
  for (std::size_t m = 0; m < blocks.size(); ++m) {
    for (std::size_t i = 0; i < extents.of[m].size(); ++i)
      out[static_cast<std::size_t>(blocks[m].first_drive) + i] = extents.of[m][i];
  }
  for (std::size_t i = 0; i < region.dimension(); ++i) {
    const int drive =
        machine.FindDrive(machine.coordinates()[static_cast<std::size_t>(region.varied[i])].name);
    if (drive >= 0) out[static_cast<std::size_t>(drive)] = {region.lower[i], region.upper[i]};
  }
  return out;
}

}  // namespace

ZoneMap MapZone(const analysis::PoseJudge& judge,
                const std::vector<double>& lengths_mm,
                const analysis::Region& region,
                const PoseGrid& grid) {
  ZoneMap out{.poses = grid.size()};
  DriveExtents extents(judge);
  if (judge.mechanisms().empty()) {
    out.inside = out.poses;
    out.drives = DrivesOf(judge, extents, region);
    return out;
  }
  analysis::PoseBlock block(judge);
  std::vector<analysis::DexterityBlock> dexterity;
  for (std::size_t m = 0; m < judge.mechanisms().size(); ++m)
    dexterity.emplace_back(judge, m, lengths_mm[m], true);
  std::vector<double> sum(dexterity.size(), 0.0);
  for (std::uint64_t first = 0; first < grid.size(); first += analysis::PoseBlock::kCapacity) {
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(analysis::PoseBlock::kCapacity, grid.size() - first));
    grid.Fill(first, count, block);
    block.Judge(count);
    for (std::size_t m = 0; m < dexterity.size(); ++m) dexterity[m].Evaluate(block, count);
    for (std::size_t k = 0; k < count; ++k) {
      if (!block.Inside(k)) continue;
      const bool at_home = std::all_of(
          dexterity.begin(), dexterity.end(), [k](const auto& d) { return d.OnHomeSide(k); });
      if (!at_home) {
        ++out.beyond;
        continue;
      }
      ++out.inside;
      extents.Take(block, k);
      for (std::size_t m = 0; m < dexterity.size(); ++m) {
        const double condition = dexterity[m].At(k).condition;
        const double inverse = condition >= 1.0 ? 1.0 / condition : 0.0;
        sum[m] += inverse;
        out.dexterity_worst = std::min(out.dexterity_worst, inverse);
      }
    }
  }
  if (out.inside == 0) out.dexterity_worst = 0.0;
  for (const double total : sum) {
    out.dexterity_mean = std::min(out.dexterity_mean,
                                  out.inside == 0 ? 0.0 : total / static_cast<double>(out.inside));
  }
  out.drives = DrivesOf(judge, extents, region);
  return out;
}

}  // namespace kompono::synthesis
