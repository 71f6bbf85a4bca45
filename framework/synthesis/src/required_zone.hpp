// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_REQUIRED_ZONE_HPP_
#define KOMPONO_SYNTHESIS_REQUIRED_ZONE_HPP_

#include <string>
#include <string_view>
#include <vector>

#include "kompono/analysis/dexterity.hpp"
#include "kompono/kinematics/machine.hpp"
#include "kompono/synthesis/study.hpp"

/// What a study's work zone, seen from the part, asks of a machine's own coordinates.
namespace kompono::synthesis {

/// "X" of "drive.X".
[[nodiscard]] std::string_view AxisOf(const kinematics::Coordinate& coordinate);

struct RequiredZone {
  analysis::Region region;  ///< home and the box of coordinates that covers every required pose
  bool found = false;
  /// Content of the required zone in the part: product of the extents of its lengths, and how many
  /// there are.
  double content = 1.0;
  std::size_t lengths = 0;
  /// Required poses: ends and middles of all motions. Where something turns, the box has corners
  /// that no required pose needs.
  std::vector<Eigen::VectorXd> poses;
};

/// Angles are ranges of the rotary coordinates; for each grid of them the translations follow from
/// the places of the zone's corners in the part: tables that turn the part and heads that swing
/// need longer ways than the zone is long.
[[nodiscard]] RequiredZone FindRequiredZone(const kinematics::Machine& machine,
                                            const std::vector<Motion>& motions);

/// Poses of an even grid over a region, its ends included.
class PoseGrid {
 public:
  /// As many steps in each direction as make about `poses` in all, at least two.
  PoseGrid(const analysis::Region& region, std::uint64_t poses);
  /// The same number of steps in each direction, fewer if that made more than `most` poses.
  [[nodiscard]] static PoseGrid Of(const analysis::Region& region,
                                   std::uint64_t steps,
                                   std::uint64_t most);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] Eigen::VectorXd At(std::uint64_t index) const;
  /// Columns of the poses first … first + count - 1.
  void Fill(std::uint64_t first, std::size_t count, analysis::PoseBlock& block) const;

 private:
  PoseGrid(const analysis::Region& region, std::uint64_t steps, int tag);
  const analysis::Region* region_;
  std::uint64_t steps_ = 2, size_ = 1;
};

/// What a map of poses says of a machine's mechanisms.
struct ZoneMap {
  std::uint64_t poses = 0, inside = 0;
  std::uint64_t beyond =
      0;  ///< within all limits, but across a type 2 singularity as seen from home
  double dexterity_mean = 1.0, dexterity_worst = 1.0;  ///< 1/condition; of several the least
  std::vector<Interval> drives;  ///< of each machine drive, what the zone needs of it
  [[nodiscard]] double Share() const {
    return poses == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(poses);
  }
};
/// `lengths_mm`: characteristic length of each mechanism of the judge.
[[nodiscard]] ZoneMap MapZone(const analysis::PoseJudge& judge,
                              const std::vector<double>& lengths_mm,
                              const analysis::Region& region,
                              const PoseGrid& grid);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_REQUIRED_ZONE_HPP_
