// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_ZONE_FILES_HPP_
#define KOMPONO_ANALYSIS_ZONE_FILES_HPP_

#include <string>
#include <vector>

#include "kompono/analysis/singularities.hpp"
#include "kompono/analysis/work_zone.hpp"

/// Zones for other programs. Lengths are millimetres, angles degrees in every file.
namespace kompono::analysis {

/// The zone's surface (three varied coordinates) as triangles, each vertex on the boundary to
/// `precision` of a grid step: marching tetrahedra over a grid of `steps` along the longest side,
/// edges bisected with the zone's own function. Normals point outwards.
struct ZoneSurface {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Sums over the triangles: what the mesh encloses and its extent.
  [[nodiscard]] double Volume() const;
  [[nodiscard]] double Area() const;
};
[[nodiscard]] ZoneSurface SurfaceOfZone(const ZoneFunction& function,
                                        const WorkZone& zone,
                                        int steps = 64,
                                        const RunControl& control = {});

/// The outline of a planar zone as closed lines, likewise by marching triangles.
using Outline = std::vector<std::vector<std::array<double, 2>>>;
[[nodiscard]] Outline OutlineOfZone(const ZoneFunction& function,
                                    const WorkZone& zone,
                                    int steps = 200,
                                    const RunControl& control = {});

/// Stanford PLY, ASCII.
[[nodiscard]] std::string SurfacePly(const ZoneSurface& surface, const std::string& comment);

/// One line per cell: edges of the cell, share that is inside at least and at most.
[[nodiscard]] std::string ZoneCsv(const Machine& machine, const WorkZone& zone);

/// One planar picture: zone, singular places, bodies; several are put side by side.
struct ZonePicture {
  std::string title;
  std::string horizontal, vertical;  ///< names of the coordinates
  Outline outline;
  std::vector<std::array<double, 4>> singular;  ///< rectangles: x, y, width, height
  std::vector<std::array<double, 4>> boxes;     ///< likewise
  std::vector<std::array<double, 3>> discs;     ///< x, y, diameter
  std::array<double, 2> lower{}, upper{};       ///< what is drawn
  /// Cells of a map: x, y, width, height, value; painted from `worst` (dark) to `best` (light).
  std::vector<std::array<double, 5>> map;
  double best = 0.0, worst = 1.0;
  std::string map_name;
};
[[nodiscard]] std::string PicturesSvg(const std::vector<ZonePicture>& pictures);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_ZONE_FILES_HPP_
