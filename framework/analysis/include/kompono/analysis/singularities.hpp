// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_SINGULARITIES_HPP_
#define KOMPONO_ANALYSIS_SINGULARITIES_HPP_

#include <optional>
#include <string>
#include <vector>

#include "kompono/analysis/work_zone.hpp"

/// Where a machine's mechanisms are singular (Gosselin and Angeles: with A ẋ = B q̇, type 1 det B =
/// 0, type 2 det A = 0, type 3 both), how far a pose is from there, and whether a path meets such a
/// place between its samples.
namespace kompono::analysis {

/// A singular place on a path, proven to lie between `from` and `to`; everything else on the path
/// is proven regular.
struct PathSingularity {
  int type = 2;
  std::string block;
  std::string drive;     ///< type 1 and 3: the drive at the end of its reach
  bool crossed = false;  ///< type 2: det A changes its sign; else it is only touched, to rounding
  double from = 0.0, to = 0.0;  ///< sample index and fraction: 2.5 is half-way between 2 and 3
  VectorXd z;                   ///< in the middle of that
};

struct PathReport {
  std::vector<PathSingularity> singularities;  ///< along the path
  /// Pieces that a mechanism cannot reach, from and to as above.
  std::vector<std::array<double, 2>> out_of_reach;
  bool stopped = false;
};

/// The path leads straight, in virtual coordinates, from sample to sample. By bisection with
/// interval arithmetic: a piece is regular when det A cannot vanish on it, so that nothing between
/// the samples is missed. E0722: a module that records no formulas.
[[nodiscard]] Parsed<PathReport> SingularitiesOnPath(const PoseJudge& judge,
                                                     const std::vector<VectorXd>& samples,
                                                     const RunControl& control = {});

/// How far the nearest singularity lies that the steepest way leads to. A radian counts as the
/// mechanism's characteristic length.
struct SingularityDistance {
  std::string block;
  int type = 0;              ///< 0: none within ten times the machine's size
  std::string drive;         ///< type 1
  double distance_mm = 0.0;  ///< infinite if type is 0
  VectorXd z;                ///< the singular place
};
/// The nearest of all mechanisms and types; type 0 for a machine without mechanisms.
[[nodiscard]] SingularityDistance DistanceToSingularity(const PoseJudge& judge, const VectorXd& z);

/// The places of a region that can be reached and where det A vanishes, as cells that cover all of
/// them.
struct SingularSet {
  Region box;
  std::vector<ZoneCell> cells;
  bool crossed = false;  ///< det A has both signs in the region; else it may vanish without change
  std::vector<double> lower, upper;  ///< box around the cells; empty if there is none
  std::optional<VectorXd> nearest;   ///< to home, on the straight way from there
  double nearest_distance = 0.0;     ///< from home in the varied coordinates, mm (and rad)
};
/// `function` must have been made with `regular`.
[[nodiscard]] SingularSet SingularitiesIn(const PoseJudge& judge,
                                          const ZoneFunction& function,
                                          std::size_t most_cells = 20000,
                                          const RunControl& control = {});

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_SINGULARITIES_HPP_
