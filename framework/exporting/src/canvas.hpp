// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPORTING_CANVAS_HPP_
#define KOMPONO_EXPORTING_CANVAS_HPP_

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace kompono::exporting {

/// Directions of the picture in the machine's base frame.
struct View {
  Eigen::Vector3d right, up, toward;
};

/// From azimuth (about the third of `axes`, from the first to the second) and elevation, degrees.
[[nodiscard]] View ViewFrom(const Eigen::Matrix3d& axes, double azimuth_deg, double elevation_deg);

/// Parallel projection onto a sheet of pixels, scaled so that everything included has room.
class Canvas {
 public:
  Canvas(const View& view, double width_px, double height_px)
      : view_(view), width_px_(width_px), height_px_(height_px) {}

  void Include(const Eigen::Vector3d& p);
  [[nodiscard]] Eigen::Vector2d Place(const Eigen::Vector3d& p) const;
  [[nodiscard]] double PixelsPerMm() const;
  /// Nearer is more; rounded, so that equal depths stay equal whatever the last bits are.
  [[nodiscard]] double Depth(const Eigen::Vector3d& p) const;
  [[nodiscard]] const View& view() const { return view_; }

 private:
  [[nodiscard]] Eigen::Vector2d Flat(const Eigen::Vector3d& p) const {
    return {view_.right.dot(p), view_.up.dot(p)};
  }

  View view_;
  double width_px_, height_px_;
  Eigen::Vector2d lower_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d upper_ = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
};

/// Corners of the smallest convex polygon round the points, in order.
[[nodiscard]] std::vector<Eigen::Vector2d> Hull(std::vector<Eigen::Vector2d> points);

/// Text with <, > and & spelled out.
[[nodiscard]] std::string Escaped(const std::string& text);

}  // namespace kompono::exporting

#endif  // KOMPONO_EXPORTING_CANVAS_HPP_
