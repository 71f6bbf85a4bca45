// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_MOBILITY_HPP_
#define KOMPONO_ANALYSIS_MOBILITY_HPP_

#include <optional>
#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"

/// How many motions a mechanism has, counted twice: from links and pairs, and from the rank of its
/// constraints.
namespace kompono::analysis {

/// KDD eq. 1 counts independent loops: links + loops - pairs = 1. Chebyshev-Grübler-Kutzbach gives
/// the mobility from the same counts (motion space of 3 for planar, 6 for spatial mechanisms); pods
/// and struts that can spin about themselves and parallelograms make it differ from what the
/// platform can do.
struct BlockMobility {
  std::string block;
  std::string module;
  int drives = 0;
  int coordinates = 0;
  int numeric = 0;  ///< drives + coordinates less the rank of (∂g/∂x ∂g/∂q) at home: what the
                    ///< drives must hold
  bool counted = false;  ///< whether the sidecar gives links and pairs; else the next members are 0
  int links = 0;
  int pairs = 0;
  int loops = 0;
  int gruebler = 0;
  int spatial = 0;  ///< the same count in space, if the mechanism is planar; else equal to gruebler
  int idle = 0;     ///< counted motions that move no platform: struts spinning about themselves
  int passive = 0;  ///< counted constraints that repeat others
  std::string explanation;  ///< empty when both agree, else what the difference means
};

/// One entry for every mechanism, on whichever branch of the formula it is.
[[nodiscard]] std::vector<BlockMobility> Mobility(const kinematics::Machine& machine);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_MOBILITY_HPP_
