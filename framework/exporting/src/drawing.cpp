// SPDX-License-Identifier: Apache-2.0
#include "kompono/exporting/drawing.hpp"

#include "canvas.hpp"
#include "scene.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace kompono::exporting {
namespace {

using Form = Shape::Form;

/// The normal of the plane that all points lie in, if there is one.
bool Planar(const std::vector<Eigen::Vector3d>& points, Eigen::Vector3d* normal) {
  if (points.size() < 3) return false;
  Eigen::MatrixXd spread(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    spread.col(static_cast<Eigen::Index>(i)) = points[i] - points.front();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(spread, Eigen::ComputeFullU);
  if (svd.singularValues()[2] > 1e-9 * svd.singularValues()[0]) return false;
  *normal = svd.matrixU().col(2);
  return true;
}

/// A planar machine square on, from its own upper side; any other as the options say.
View Chosen(const Scene& scene, const DrawingOptions& options) {
  Eigen::Vector3d normal;
  // A lathe is seen more from the end, so that its discs are not seen edge on.
  const double turned_deg = scene.axes.isIdentity() ? 0.0 : 13.0;
  if (!Planar(scene.joints, &normal))
    return ViewFrom(scene.axes, options.azimuth_deg + turned_deg, options.elevation_deg);
  const Eigen::Vector3d in_axes = scene.axes.transpose() * normal;
  if (std::abs(in_axes.z()) > 0.5) return ViewFrom(scene.axes, -90.0, 90.0);
  const double azimuth_deg = std::atan2(in_axes.y(), in_axes.x()) * 180.0 / std::numbers::pi;
  return ViewFrom(scene.axes, azimuth_deg > 0.0 ? azimuth_deg - 180.0 : azimuth_deg, 0.0);
}

constexpr const char* kStyle = R"(<style>
  line, path, polyline { stroke-linecap: round; stroke-linejoin: round; fill: none }
  .rail { stroke: #bfc6d0; stroke-width: 8 }
  .strut { stroke: #2f6fb2; stroke-width: 4.5 }
  .cylinder { stroke: #5b8fc4; stroke-width: 9 }
  .foundation { fill: #8a93a3; fill-opacity: .18; stroke: #8a93a3; stroke-width: 1.2 }
  .platform { stroke: #c8642b; stroke-width: 4.5 }
  .base { stroke: #8a93a3; stroke-width: 4 }
  .arm { stroke: #c8642b; stroke-width: 3; stroke-dasharray: 1 6 }
  .plate { fill: #c8642b; fill-opacity: .22 }
  .joint { fill: #f5f7fa; stroke: #2f4a66; stroke-width: 1.6 }
  .carriage { fill: #5c6675; stroke: #2f3744; stroke-width: 1.2 }
  .tool, .tip { fill: #b3261e }
  .cutter { fill: #7a8696; stroke: #4a5462; stroke-width: 1 }
  .disc { fill: #7a8696; fill-opacity: .75; stroke: #4a5462; stroke-width: 1.2 }
  .disc-face { fill: #9aa5b3; stroke: #4a5462; stroke-width: 1 }
  .pocket { stroke: #4a5462; stroke-width: 3 }
  .holder { fill: #a7b0bd; stroke: #5c6675; stroke-width: 1.2; fill-opacity: .8 }
  .part { fill: #4c9a63; stroke: #2f6b43; stroke-width: 1.2; fill-opacity: .55 }
  .part-face { fill: #4c9a63; stroke: #2f6b43; stroke-width: 1.2; fill-opacity: .8 }
  .axis { stroke: #55606e; stroke-width: 1.4 }
  text { font: 13px sans-serif; fill: #3d4753 }
  @media (prefers-color-scheme: dark) {
    text { fill: #c3ccd6 } .axis { stroke: #c3ccd6 } .joint { fill: #1d232b; stroke: #9cc3ea }
  }
</style>
)";

class Pen {
 public:
  Pen(const Canvas& canvas, bool point_names) : canvas_(canvas), point_names_(point_names) {}

  [[nodiscard]] std::string Draw(const Shape& shape) {
    switch (shape.form) {
      case Form::kLine:
        return Line(shape);
      case Form::kBody:
        return Body(shape);
      case Form::kDot:
        return Dot(shape);
      case Form::kArrow:
        return Arrow(shape);
      case Form::kArc:
        return Arc(shape);
      case Form::kName:
        break;
    }
    Eigen::Vector2d at = canvas_.Place(shape.points[0]) + Eigen::Vector2d(10, 17);
    // A name does not lie on another one.
    while (std::any_of(names_.begin(), names_.end(), [&at](const Eigen::Vector2d& other) {
      return std::abs(other.x() - at.x()) < 48.0 && std::abs(other.y() - at.y()) < 14.0;
    })) {
      at.y() += 15.0;
    }
    names_.push_back(at);
    return Text(at, shape.text);
  }

 private:
  static std::string Text(const Eigen::Vector2d& at, const std::string& text) {
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", at.x(), at.y(), Escaped(text));
  }

  [[nodiscard]] std::string Line(const Shape& shape) const {
    const Eigen::Vector2d a = canvas_.Place(shape.points[0]);
    const Eigen::Vector2d b = canvas_.Place(shape.points[1]);
    return fmt::format(
        "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
        shape.kind,
        a.x(),
        a.y(),
        b.x(),
        b.y());
  }

  [[nodiscard]] std::string Body(const Shape& shape) const {
    std::vector<Eigen::Vector2d> corners;
    for (const Eigen::Vector3d& p : shape.points) corners.push_back(canvas_.Place(p));
    std::string points;
    for (const Eigen::Vector2d& p : Hull(std::move(corners)))
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", p.x(), p.y());
    return fmt::format("<polygon class=\"{}\" points=\"{}\"/>\n", shape.kind, points);
  }

  [[nodiscard]] std::string Dot(const Shape& shape) const {
    const Eigen::Vector2d at = canvas_.Place(shape.points[0]);
    const bool main = shape.kind == "tool" || shape.kind == "tip";
    std::string out;
    if (shape.kind == "carriage") {
      out = fmt::format(
          "<rect class=\"carriage\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"13\" height=\"13\" "
          "rx=\"2\"/>\n",
          at.x() - 6.5,
          at.y() - 6.5);
    } else {
      out = fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n",
                        shape.kind,
                        at.x(),
                        at.y(),
                        main ? 4.5 : 4.0);
    }
    if (point_names_ && !shape.text.empty()) out += Text(at + Eigen::Vector2d(7, -7), shape.text);
    return out;
  }

  /// Seen end on, an arrow is a ring with a dot.
  [[nodiscard]] std::string Arrow(const Shape& shape) const {
    const Eigen::Vector2d foot = canvas_.Place(shape.points[0]);
    const Eigen::Vector2d head = canvas_.Place(shape.points[1]);
    const Eigen::Vector2d along = head - foot;
    if (along.norm() < 10.0) {
      return fmt::format(
                 "<circle class=\"axis\" fill=\"none\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\"/>\n",
                 foot.x(),
                 foot.y()) +
             Text(foot + Eigen::Vector2d(-4, -13), shape.text);
    }
    const Eigen::Vector2d e = along.normalized();
    const Eigen::Vector2d side(-e.y(), e.x());
    const Eigen::Vector2d left = head - 8.0 * e + 3.5 * side;
    const Eigen::Vector2d right = head - 8.0 * e - 3.5 * side;
    return fmt::format(
               "<path class=\"axis\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} "
               "{:.1f}L{:.1f} {:.1f}\"/>\n",
               foot.x(),
               foot.y(),
               head.x(),
               head.y(),
               left.x(),
               left.y(),
               head.x(),
               head.y(),
               right.x(),
               right.y()) +
           Text(head + 11.0 * e + Eigen::Vector2d(-4, 4), shape.text);
  }

  /// Three quarters of a circle about the axis, a little way up it.
  [[nodiscard]] std::string Arc(const Shape& shape) const {
    const Eigen::Vector3d along = shape.points[1] - shape.points[0];
    const Eigen::Vector3d middle = shape.points[0] + 0.5 * along;
    const Eigen::Vector3d across = 0.35 * along.norm() * along.unitOrthogonal();
    std::string points;
    Eigen::Vector2d last;
    for (int i = 0; i <= 18; ++i) {
      const double angle = 1.5 * std::numbers::pi * i / 18.0;
      const Eigen::AngleAxisd turn(angle, along.normalized());
      const Eigen::Vector3d p = middle + turn * across;
      last = canvas_.Place(p);
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", last.x(), last.y());
    }
    return fmt::format("<polyline class=\"axis\" points=\"{}\"/>\n", points) +
           Text(last + Eigen::Vector2d(5, 4), shape.text);
  }

  const Canvas& canvas_;
  bool point_names_;
  std::vector<Eigen::Vector2d> names_;
};

double DepthOf(const Shape& shape, const Canvas& canvas) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : shape.points)
    middle += p / static_cast<double>(shape.points.size());
  return canvas.Depth(middle);
}

}  // namespace

std::string DrawSvg(const kinematics::Machine& machine,
                    const kinematics::VectorXd& z,
                    const kinematics::VectorXd& theta,
                    const DrawingOptions& options) {
  Scene scene = SceneOf(machine, z, theta);
  Canvas canvas(Chosen(scene, options), options.width_px, options.height_px);
  for (const Shape& shape : scene.shapes) {
    for (const Eigen::Vector3d& p : shape.points) canvas.Include(p);
  }
  std::stable_sort(
      scene.shapes.begin(), scene.shapes.end(), [&canvas](const Shape& a, const Shape& b) {
        if (a.layer != b.layer) return a.layer < b.layer;
        return DepthOf(a, canvas) < DepthOf(b, canvas);
      });
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
      "height=\"{1:g}\" "
      "role=\"img\">\n<title>{2}</title>\n{3}",
      options.width_px,
      options.height_px,
      Escaped(machine.layout().name),
      kStyle);
  Pen pen(canvas, options.point_names);
  for (const Shape& shape : scene.shapes) svg += pen.Draw(shape);
  return svg + "</svg>\n";
}

}  // namespace kompono::exporting
