// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_FRONT_HPP_
#define KOMPONO_SYNTHESIS_FRONT_HPP_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// The Pareto front of points that come one by one. Exact: the front depends on the points only and
/// neither on their order nor on how they were shared out, so that fronts of shards merge to the
/// front of the whole.
namespace kompono::synthesis {

enum class Direction { kMinimise, kMaximise };

struct FrontPoint {
  std::uint64_t id = 0;        ///< the candidate's index
  std::vector<double> values;  ///< as they were given, one for each objective
  bool operator==(const FrontPoint&) const = default;
};

/// Why a point is not on the front.
struct Domination {
  FrontPoint by;               ///< of all that dominate it the one that is best where it is worst
  std::size_t dominators = 0;  ///< points of the front that dominate it
  /// For each objective by how much `by` is better: never negative, 0 where both are equal.
  std::vector<double> better_by = {};
  /// The objective where it is most better, measured by the front's extent.
  std::size_t most = 0;
};

class Front {
 public:
  /// At least one objective.
  explicit Front(std::vector<Direction> directions);

  /// False: the point is dominated, or one of its values is not finite. Points with equal values
  /// are all kept. Ids are the caller's: one that comes twice with the same values is kept once.
  bool Insert(std::uint64_t id, std::span<const double> values);
  /// Puts the other's points in. @throws std::logic_error for other objectives.
  void Merge(const Front& other);

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::size_t objectives() const { return directions_.size(); }
  [[nodiscard]] const std::vector<Direction>& directions() const { return directions_; }
  /// By ascending id.
  [[nodiscard]] std::vector<FrontPoint> Points() const;

  /// For each objective the point that is best in it; among equals the one that is best in the
  /// next objectives, then the one with the lowest id. Empty front: empty.
  [[nodiscard]] std::vector<FrontPoint> Extremes() const;
  /// The point that lies farthest below the plane through the extremes, all objectives scaled to
  /// the front's extent: where giving up a little of one gains much of another no longer.
  [[nodiscard]] std::optional<FrontPoint> Knee() const;

  /// A thinner front: space is divided into boxes with these sides (in the objectives' units,
  /// greater than 0); of each box that no other box dominates one point stays, the best by the sum
  /// of its scaled values, then the lowest id.
  [[nodiscard]] std::vector<FrontPoint> Thinned(std::span<const double> epsilon) const;

  /// Why a point with these values is not on the front; nothing if no point dominates it.
  [[nodiscard]] std::optional<Domination> WhyDominated(std::span<const double> values) const;

 private:
  [[nodiscard]] FrontPoint At(std::size_t row) const;
  [[nodiscard]] std::span<const double> Row(std::size_t row) const;
  [[nodiscard]] std::vector<double> Turned(std::span<const double> values) const;
  /// For each objective 1 / (greatest - least value), 0 where all are equal.
  [[nodiscard]] std::vector<double> Scales() const;
  void Swap(std::size_t a, std::size_t b);
  void DropLast();

  std::vector<Direction> directions_;
  std::vector<double> rows_;  ///< row by row, signs turned so that less is better
  std::vector<std::uint64_t> ids_;
};

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_FRONT_HPP_
