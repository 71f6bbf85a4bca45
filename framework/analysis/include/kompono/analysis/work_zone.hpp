// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_WORK_ZONE_HPP_
#define KOMPONO_ANALYSIS_WORK_ZONE_HPP_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kompono/analysis/pose_judge.hpp"
#include "kompono/analysis/region.hpp"

/// The work zone: all places that a machine can take with the rest of its coordinates held.
///
/// The varied coordinates' box is split into cells (quadtree, octree) and each cell is judged as a
/// whole with interval arithmetic on the formulas that the plugins recorded: certainly inside,
/// certainly outside, or neither. Cells of the last kind are split further; what remains of them
/// holds the boundary, and there the formulas' slopes bound how much of the cell can be inside. So
/// the content is known between two numbers, not estimated: nothing the size of a cell is
/// overlooked (after L. Jaulin's pavings, which J.-P. Merlet used for parallel robots).
namespace kompono::analysis {

/// What ends a zone besides the judge's constraints.
struct ZoneOptions {
  double tolerance = 0.005;          ///< wanted bound of the content, relative to it
  std::size_t most_cells = 2000000;  ///< cells that are judged; the bound is then what it is
  bool regular = true;  ///< only the home's side of type 2 singularities (det A keeps its sign)
  RunControl control;
};

/// A cell of the paving. Edges are box extent / 2^level.
struct ZoneCell {
  std::array<std::uint32_t, 3> index{};
  std::uint8_t level = 0;
  bool certain = false;             ///< completely inside; else the boundary may run through it
  std::int16_t cause = -1;          ///< constraint that bounds it; index into WorkZone::constraints
  float least = 1.0F, most = 1.0F;  ///< share of the cell that is inside
};

struct WorkZone {
  Region box;                   ///< what was searched
  double content = 0.0;         ///< mm, mm² or mm³
  double bound = 0.0;           ///< |content - true content| <= bound, rounding included
  std::vector<ZoneCell> cells;  ///< inside or on the boundary; outside are all others
  std::vector<std::string> constraints;
  std::vector<double> shares;  ///< per constraint: part of the boundary's extent it makes up, sum 1
  /// Box around the zone, a cell wider at most; empty if nothing is certainly inside.
  std::vector<double> lower, upper;
  /// Per varied coordinate: whether the zone touches the searched box's lower and upper end.
  std::vector<std::array<bool, 2>> touches;
  std::uint64_t judged = 0;  ///< cells in all
  bool stopped = false;

  [[nodiscard]] bool empty() const { return cells.empty(); }
  /// Lower and upper end of a cell in direction i.
  [[nodiscard]] std::array<double, 2> Edge(const ZoneCell& cell, std::size_t i) const;
};

/// A zone's judge over boxes and points; what ComputeZone, inscribed bodies and surfaces share.
class ZoneFunction {
 public:
  /// `region` may vary up to three coordinates. E0722: a module that records no formulas; E0723:
  /// more than three varied coordinates or none.
  [[nodiscard]] static Parsed<ZoneFunction> Make(const PoseJudge& judge,
                                                 const Region& region,
                                                 bool regular);

  enum class Verdict { kOutside, kBoundary, kInside };
  struct Judged {
    Verdict verdict = Verdict::kBoundary;
    double least = 0.0, most = 1.0;  ///< share of the box that is inside
    int cause = -1;                  ///< the constraint that matters most; -1 if inside
    bool singular = false;           ///< det A may vanish in the box, as far as it is reached
  };
  /// One thread's memory.
  class Scratch {
   public:
    explicit Scratch(const ZoneFunction& function);
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    Scratch(Scratch&&) noexcept;
    Scratch& operator=(Scratch&&) noexcept;
    ~Scratch();

   private:
    friend class ZoneFunction;
    struct Values;
    std::unique_ptr<Values> values_;
  };

  [[nodiscard]] Judged Judge(std::span<const double> lower,
                             std::span<const double> upper,
                             Scratch& scratch) const;
  /// A single point; on the boundary to rounding counts as outside.
  [[nodiscard]] bool Inside(std::span<const double> at, Scratch& scratch) const;

  [[nodiscard]] const std::vector<Constraint>& constraints() const;
  [[nodiscard]] const Region& region() const;
  /// "delta.X at its lower limit", or "… at the edge of the search" where the machine sets no
  /// limit; two for each varied coordinate.
  [[nodiscard]] std::vector<std::string> EndNames() const;

 private:
  struct State;
  explicit ZoneFunction(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// The varied coordinates of a machine unless told otherwise: its translations, at most three, and
/// how far they go by their ranges; where there is no range, a multiple of the machine's size.
struct Span {
  std::string coordinate;  ///< full name
  std::optional<double> lower, upper;
};
/// E0724: unknown coordinate. Coordinates not varied are held at home or where `held` puts them.
[[nodiscard]] Parsed<Region> RegionOf(const Machine& machine,
                                      const std::vector<Span>& varied,
                                      const VectorXd& held);

/// Shrinks the box to the zone first, so that the cells are spent where it is. The region's own
/// limits stay what `touches` refers to.
[[nodiscard]] WorkZone ComputeZone(const ZoneFunction& function, const ZoneOptions& options);

/// The plane cut of a region of three coordinates at one value of one of them.
[[nodiscard]] Region SliceOf(const Region& region, std::size_t direction, double value);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_WORK_ZONE_HPP_
