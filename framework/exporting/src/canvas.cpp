// SPDX-License-Identifier: Apache-2.0
#include "canvas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kompono::exporting {
namespace {

constexpr double kMargin_px = 40.0;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

double Turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

}  // namespace

View ViewFrom(const Eigen::Matrix3d& axes, double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kRadPerDeg;
  const double e = elevation_deg * kRadPerDeg;
  return {.right = axes * Eigen::Vector3d(-std::sin(a), std::cos(a), 0.0),
          .up = axes * Eigen::Vector3d(
                           -std::sin(e) * std::cos(a), -std::sin(e) * std::sin(a), std::cos(e)),
          .toward = axes * Eigen::Vector3d(
                               std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e))};
}

void Canvas::Include(const Eigen::Vector3d& p) {
  const Eigen::Vector2d at = Flat(p);
  lower_ = lower_.cwiseMin(at);
  upper_ = upper_.cwiseMax(at);
}

double Canvas::PixelsPerMm() const {
  const Eigen::Vector2d size = (upper_ - lower_).cwiseMax(1e-9);
  return std::min((width_px_ - 2 * kMargin_px) / size.x(),
                  (height_px_ - 2 * kMargin_px) / size.y());
}

Eigen::Vector2d Canvas::Place(const Eigen::Vector3d& p) const {
  const Eigen::Vector2d centred = (Flat(p) - 0.5 * (lower_ + upper_)) * PixelsPerMm();
  return {0.5 * width_px_ + centred.x(), 0.5 * height_px_ - centred.y()};
}

double Canvas::Depth(const Eigen::Vector3d& p) const {
  return std::round(view_.toward.dot(p) * 1e4) / 1e4;
}

std::vector<Eigen::Vector2d> Hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  for (const bool back : {false, true}) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() >= first + 2 && Turn(hull[hull.size() - 2], hull.back(), p) <= 1e-9)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the other half begins with it
    if (!back) std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return out;
}

}  // namespace kompono::exporting
