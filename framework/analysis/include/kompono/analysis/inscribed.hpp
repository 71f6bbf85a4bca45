// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_INSCRIBED_HPP_
#define KOMPONO_ANALYSIS_INSCRIBED_HPP_

#include <array>
#include <vector>

#include "kompono/analysis/work_zone.hpp"

/// The largest body of given proportions that fits into a work zone, its place free, its edges
/// along the coordinates. What is returned is proven to lie inside; that nothing larger fits is
/// found by search, not proven.
namespace kompono::analysis {

enum class BodyShape {
  kBox,       ///< in a planar zone a rectangle
  kCylinder,  ///< axis along the last varied coordinate; in a planar zone a disc
};

struct InscribedBody {
  BodyShape shape = BodyShape::kBox;
  bool found = false;
  std::vector<double> centre;  ///< in the varied coordinates
  std::vector<double> size;    ///< extents; for a cylinder diameter, diameter, height
  double content = 0.0;
};

/// `proportions`: extents per varied coordinate; for a cylinder {diameter, diameter, height}, or
/// {diameter, diameter} for a disc. If a body of exactly these extents is the largest, touching the
/// zone's limits, it is found as such. @throws std::logic_error for another number of them, or one
/// that is not above 0.
[[nodiscard]] InscribedBody LargestInside(const ZoneFunction& function,
                                          const WorkZone& zone,
                                          BodyShape shape,
                                          const std::vector<double>& proportions,
                                          const RunControl& control = {});

/// Whether a body lies completely inside the zone: proven, or not proven.
[[nodiscard]] bool ProvenInside(const ZoneFunction& function,
                                BodyShape shape,
                                const std::vector<double>& centre,
                                const std::vector<double>& size,
                                const RunControl& control = {});

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_INSCRIBED_HPP_
