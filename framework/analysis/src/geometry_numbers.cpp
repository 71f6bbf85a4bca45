// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/geometry_numbers.hpp"

#include "segments.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::analysis {
namespace {

using kinematics::Machine;
using kinematics::VectorXd;

constexpr double kSamePlaceMm = 1e-9;

const Eigen::Vector3d* Find(const Machine::SkeletonView& skeleton, const std::string& name) {
  const auto found = std::find_if(skeleton.points.begin(),
                                  skeleton.points.end(),
                                  [&name](const auto& point) { return point.name == name; });
  return found == skeleton.points.end() ? nullptr : &found->p_M;
}

StrutNumbers NumbersOf(const std::string& from,
                       const std::string& to,
                       const Eigen::Vector3d& a,
                       const Eigen::Vector3d& b) {
  StrutNumbers out{.from = from, .to = to, .length_mm = (b - a).norm()};
  if (out.length_mm > 0.0) out.direction = (b - a) / out.length_mm;
  const double across = std::hypot(out.direction.x(), out.direction.y());
  out.nutation_rad = std::atan2(across, out.direction.z());
  if (across > 0.0) out.precession_rad = std::atan2(out.direction.y(), out.direction.x());
  return out;
}

/// Of the strut that begins at a point, "struts.base1".
double RadiusOf(const Machine& machine, const std::string& point) {
  const layout::Block* block = machine.layout().FindBlock(point.substr(0, point.find('.')));
  return block == nullptr ? 0.0 : 0.5 * block->strut_diameter.value_or(0.0);
}

template <class Radius>
void AddDistances(const Machine::SkeletonView& skeleton,
                  const Radius& radius,
                  GeometryNumbers& out) {
  for (std::size_t i = 0; i < out.struts.size(); ++i) {
    const Eigen::Vector3d& a0 = *Find(skeleton, out.struts[i].from);
    const Eigen::Vector3d& a1 = *Find(skeleton, out.struts[i].to);
    for (std::size_t j = i + 1; j < out.struts.size(); ++j) {
      const Eigen::Vector3d& b0 = *Find(skeleton, out.struts[j].from);
      const Eigen::Vector3d& b1 = *Find(skeleton, out.struts[j].to);
      const auto same = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
        return (p - q).norm() < kSamePlaceMm;
      };
      if (same(a0, b0) || same(a0, b1) || same(a1, b0) || same(a1, b1)) continue;
      const SegmentMeeting meeting = MeetSegments(a0, a1, b0, b1);
      out.distances.push_back({.first = i,
                               .second = j,
                               .centre_lines_mm = meeting.distance,
                               .clearance_mm = meeting.distance - radius(out.struts[i].from) -
                                               radius(out.struts[j].from),
                               .on_first = a0 + meeting.along_a * (a1 - a0),
                               .on_second = b0 + meeting.along_b * (b1 - b0)});
    }
  }
  std::stable_sort(out.distances.begin(), out.distances.end(), [](const auto& a, const auto& b) {
    return a.centre_lines_mm < b.centre_lines_mm;
  });
}

void AddAngles(const Machine::SkeletonView& skeleton, GeometryNumbers& out) {
  for (std::size_t i = 0; i < skeleton.links.size(); ++i) {
    for (std::size_t j = i + 1; j < skeleton.links.size(); ++j) {
      for (const bool reverse_first : {false, true}) {
        for (const bool reverse_second : {false, true}) {
          const Machine::SkeletonLink& a = skeleton.links[i];
          const Machine::SkeletonLink& b = skeleton.links[j];
          const std::string& at = reverse_first ? a.to : a.from;
          if (at != (reverse_second ? b.to : b.from)) continue;
          const std::string& first = reverse_first ? a.from : a.to;
          const std::string& second = reverse_second ? b.from : b.to;
          const Eigen::Vector3d* p = Find(skeleton, at);
          const Eigen::Vector3d* q = Find(skeleton, first);
          const Eigen::Vector3d* r = Find(skeleton, second);
          if (p == nullptr || q == nullptr || r == nullptr) continue;
          const Eigen::Vector3d u = *q - *p;
          const Eigen::Vector3d v = *r - *p;
          out.angles.push_back({.at = at,
                                .first = first,
                                .second = second,
                                .angle_rad = std::atan2(u.cross(v).norm(), u.dot(v))});
        }
      }
    }
  }
}

/// "a:b:0.25" in its parts; a point alone is itself at 0.
struct Place {
  std::string from, to;
  double along = 0.0;
};

std::optional<Place> ParsePlace(const std::string& text) {
  const std::size_t first = text.find(':');
  if (first == std::string::npos) return Place{.from = text, .to = text};
  const std::size_t second = text.find(':', first + 1);
  if (second == std::string::npos) return std::nullopt;
  const std::string number = text.substr(second + 1);
  char* end = nullptr;
  const double along = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !std::isfinite(along)) return std::nullopt;
  return Place{.from = text.substr(0, first),
               .to = text.substr(first + 1, second - first - 1),
               .along = along};
}

}  // namespace

GeometryNumbers GeometryAt(const Machine& machine,
                           const VectorXd& z,
                           const VectorXd& theta,
                           const std::optional<double>& strut_radius_mm) {
  const Machine::SkeletonView skeleton = machine.Skeleton(z, theta);
  GeometryNumbers out{.points = skeleton.points};
  for (const Machine::SkeletonLink& link : skeleton.links) {
    if (link.kind != "strut") continue;
    const Eigen::Vector3d* a = Find(skeleton, link.from);
    const Eigen::Vector3d* b = Find(skeleton, link.to);
    if (a != nullptr && b != nullptr) out.struts.push_back(NumbersOf(link.from, link.to, *a, *b));
  }
  const auto radius = [&](const std::string& point) {
    return strut_radius_mm ? *strut_radius_mm : RadiusOf(machine, point);
  };
  AddDistances(skeleton, radius, out);
  AddAngles(skeleton, out);
  return out;
}

Parsed<std::vector<Eigen::Vector3d>> PathOfPoint(const Machine& machine,
                                                 const std::vector<VectorXd>& poses,
                                                 const VectorXd& theta,
                                                 const std::string& point) {
  std::vector<Eigen::Vector3d> out;
  const std::optional<Place> place = ParsePlace(point);
  const Machine::SkeletonView home = machine.Skeleton(machine.home(), theta);
  for (const std::string& name : {place ? place->from : point, place ? place->to : point}) {
    if (place && Find(home, name) != nullptr) continue;
    std::vector<std::string> names;
    for (const auto& candidate : home.points) names.push_back(candidate.name);
    return tl::unexpected(Diagnostics{
        {.code = "E0726",
         .message = fmt::format("no point of the machine is called '{}'", name),
         .help = DidYouMean(name, names) + "; a place on a link is written from:to:0.25"}});
  }
  for (const VectorXd& z : poses) {
    const Machine::SkeletonView skeleton = machine.Skeleton(z, theta);
    const Eigen::Vector3d& a = *Find(skeleton, place->from);
    const Eigen::Vector3d& b = *Find(skeleton, place->to);
    out.emplace_back(a + place->along * (b - a));
  }
  return out;
}

}  // namespace kompono::analysis
