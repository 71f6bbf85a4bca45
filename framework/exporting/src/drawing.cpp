// SPDX-License-Identifier: Apache-2.0
#include "kompono/exporting/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <Eigen/Geometry>

namespace kompono::exporting {
namespace {

constexpr double kRadPerDeg = 0.017453292519943295769;
constexpr double kMargin_px = 36.0;

struct View {
  Eigen::Vector3d right, up, toward;
};

View ViewFrom(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kRadPerDeg;
  const double e = elevation_deg * kRadPerDeg;
  return {.right = {-std::sin(a), std::cos(a), 0.0},
          .up = {-std::sin(e) * std::cos(a), -std::sin(e) * std::sin(a), std::cos(e)},
          .toward = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}};
}

struct Line {
  Eigen::Vector3d from, to;
  std::string kind;
};

/// Rails go on past their carriages; the tool is a short arrow at the platform's point.
std::vector<Line> LinesOf(const kinematics::Machine::SkeletonView& skeleton) {
  std::map<std::string, Eigen::Vector3d> places;
  for (const auto& point : skeleton.points) places[point.name] = point.p_M;
  std::vector<Line> lines;
  for (const auto& link : skeleton.links) {
    const auto from = places.find(link.from);
    const auto to = places.find(link.to);
    if (from == places.end() || to == places.end()) continue;
    Line line{from->second, to->second, link.kind};
    if (link.kind == "rail") {
      const Eigen::Vector3d reach = 0.25 * (line.to - line.from);
      line.to += reach;
      line.from -= reach;
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

bool IsPlanar(const kinematics::Machine::SkeletonView& skeleton) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const auto& point : skeleton.points) {
    lowest = std::min(lowest, point.p_M.z());
    highest = std::max(highest, point.p_M.z());
  }
  return highest - lowest < 1e-9;
}

class Canvas {
 public:
  Canvas(const View& view, const DrawingOptions& options) : view_(view), options_(options) {}

  void Include(const Eigen::Vector3d& p) {
    const Eigen::Vector2d at = Flat(p);
    lower_ = lower_.cwiseMin(at);
    upper_ = upper_.cwiseMax(at);
  }
  [[nodiscard]] Eigen::Vector2d Place(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d size = (upper_ - lower_).cwiseMax(1e-9);
    const double scale = std::min((options_.width_px - 2 * kMargin_px) / size.x(),
                                  (options_.height_px - 2 * kMargin_px) / size.y());
    const Eigen::Vector2d centred = (Flat(p) - 0.5 * (lower_ + upper_)) * scale;
    return {0.5 * options_.width_px + centred.x(), 0.5 * options_.height_px - centred.y()};
  }
  [[nodiscard]] double Depth(const Eigen::Vector3d& p) const { return view_.toward.dot(p); }

 private:
  [[nodiscard]] Eigen::Vector2d Flat(const Eigen::Vector3d& p) const {
    return {view_.right.dot(p), view_.up.dot(p)};
  }

  View view_;
  DrawingOptions options_;
  Eigen::Vector2d lower_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d upper_ = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
};

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return out;
}

constexpr const char* kStyle = R"(<style>
  line { stroke-linecap: round }
  .rail { stroke: #8a93a3; stroke-width: 7; opacity: .55 }
  .strut { stroke: #2f6fb2; stroke-width: 4 }
  .platform { stroke: #c8642b; stroke-width: 5 }
  .base { stroke: #8a93a3; stroke-width: 4 }
  .joint { fill: #f5f7fa; stroke: #2f4a66; stroke-width: 1.6 }
  .tool { fill: #c8642b }
  text { font: 12px sans-serif; fill: #55606e }
  @media (prefers-color-scheme: dark) { text { fill: #aab4c0 } .joint { fill: #1d232b; stroke: #9cc3ea } }
</style>
)";

}  // namespace

std::string DrawSvg(const kinematics::Machine& machine,
                    const kinematics::VectorXd& z,
                    const kinematics::VectorXd& theta,
                    const DrawingOptions& options) {
  const kinematics::Machine::SkeletonView skeleton = machine.Skeleton(z, theta);
  const View view = IsPlanar(skeleton) ? ViewFrom(-90.0, 90.0)
                                       : ViewFrom(options.azimuth_deg, options.elevation_deg);
  Canvas canvas(view, options);
  std::vector<Line> lines = LinesOf(skeleton);
  for (const auto& point : skeleton.points) canvas.Include(point.p_M);
  for (const Line& line : lines) {
    canvas.Include(line.from);
    canvas.Include(line.to);
  }
  std::stable_sort(lines.begin(), lines.end(), [&canvas](const Line& a, const Line& b) {
    return canvas.Depth(a.from + a.to) < canvas.Depth(b.from + b.to);
  });
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
      "height=\"{1:g}\" "
      "role=\"img\">\n<title>{2}</title>\n{3}",
      options.width_px,
      options.height_px,
      Escaped(machine.layout().name),
      kStyle);
  for (const Line& line : lines) {
    const Eigen::Vector2d a = canvas.Place(line.from);
    const Eigen::Vector2d b = canvas.Place(line.to);
    svg += fmt::format(
        "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
        line.kind,
        a.x(),
        a.y(),
        b.x(),
        b.y());
  }
  for (const auto& point : skeleton.points) {
    const Eigen::Vector2d at = canvas.Place(point.p_M);
    const bool tool = point.name.ends_with(".tool");
    svg += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n",
                       tool ? "tool" : "joint",
                       at.x(),
                       at.y(),
                       tool ? 6 : 4);
    if (options.point_names) {
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                         at.x() + 7,
                         at.y() - 7,
                         Escaped(point.name.substr(point.name.rfind('.') + 1)));
    }
  }
  return svg + "</svg>\n";
}

}  // namespace kompono::exporting
