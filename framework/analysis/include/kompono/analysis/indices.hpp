// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_INDICES_HPP_
#define KOMPONO_ANALYSIS_INDICES_HPP_

#include <optional>
#include <string>
#include <vector>

#include "kompono/analysis/work_zone.hpp"

/// Four pure numbers that compare layouts of any size, after the indices that E. L. J. Bohez gave
/// for five-axis machines; what exactly is divided by what is said here and in docs/analysis.md.
namespace kompono::analysis {

struct LayoutIndices {
  double utilisation = 0.0;       ///< zone / box around it: how much of the travels is of use
  double space_efficiency = 0.0;  ///< zone / box around the machine in all corners of its zone
  /// Zone in which all rotary coordinates can be tilted by ± `tilt_rad` at once / zone; none for a
  /// machine that does not turn.
  std::optional<double> orientation_space;
  double tilt_rad = 0.0;
  /// Product over the rotary coordinates of range / 360°, each alone at home; none likewise.
  std::optional<double> orientation_angle;
  struct Range {
    std::string coordinate;
    double lower_rad = 0.0, upper_rad = 0.0;
  };
  std::vector<Range> ranges;
};

/// `zone` must be that of `function`, over lengths. By a grid of `steps` along the longest side.
[[nodiscard]] LayoutIndices IndicesOf(const PoseJudge& judge,
                                      const ZoneFunction& function,
                                      const WorkZone& zone,
                                      double tilt_rad,
                                      std::uint64_t steps = 40,
                                      const RunControl& control = {});

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_INDICES_HPP_
