// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPORTING_DRAWING_HPP_
#define KOMPONO_EXPORTING_DRAWING_HPP_

#include <array>
#include <string>

#include "kompono/kinematics/machine.hpp"

/// Line drawings of machines as SVG, from the mechanisms' own skeletons: nothing is drawn that is
/// not computed with.
namespace kompono::exporting {

struct DrawingOptions {
  double width_px = 640.0;
  double height_px = 480.0;
  /// View direction: azimuth from x to y and elevation above the base plane, degrees; a planar
  /// machine (all points in one plane) is drawn square on.
  double azimuth_deg = -75.0;
  double elevation_deg = 24.0;
  bool point_names = false;
};

/// The machine at coordinates z. Struts, rails and platforms have classes of their own for style
/// sheets; colours adapt to dark pages.
[[nodiscard]] std::string DrawSvg(const kinematics::Machine& machine,
                                  const kinematics::VectorXd& z,
                                  const kinematics::VectorXd& theta,
                                  const DrawingOptions& options = {});

}  // namespace kompono::exporting

#endif  // KOMPONO_EXPORTING_DRAWING_HPP_
