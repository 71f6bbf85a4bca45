// SPDX-License-Identifier: Apache-2.0
// What `kompono analyze --json` prints: the same numbers, mm and deg.
#include "analyzing.hpp"
#include "text.hpp"
#include <nlohmann/json.hpp>

#include <cmath>

namespace kompono::cli {
namespace {

using analysis::Region;
using analysis::WorkZone;
using kinematics::Machine;
using nlohmann::ordered_json;

ordered_json Number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json CoordinatesJson(const Machine& machine, const Eigen::VectorXd& z) {
  ordered_json out = ordered_json::object();
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const kinematics::Coordinate& c = machine.coordinates()[i];
    out[c.name] = Number(Outward(z[static_cast<Eigen::Index>(i)], c.rotary));
  }
  return out;
}

ordered_json VectorJson(const Eigen::Vector3d& v) {
  return {Number(v.x()), Number(v.y()), Number(v.z())};
}

/// From mm and rad to mm and deg.
double ContentFactor(const Machine& machine, const Region& region) {
  double factor = 1.0;
  for (std::size_t i = 0; i < region.dimension(); ++i)
    factor *= VariedCoordinate(machine, region, i).rotary ? kDegPerRad : 1.0;
  return factor;
}

ordered_json ZoneJson(const Machine& machine, const WorkZone& zone) {
  const double factor = ContentFactor(machine, zone.box);
  ordered_json out{{"content", zone.content * factor},
                   {"bound", zone.bound * factor},
                   {"coordinates", ordered_json::object()},
                   {"boundary", ordered_json::object()},
                   {"cells", zone.cells.size()},
                   {"cells_judged", zone.judged},
                   {"stopped", zone.stopped}};
  for (std::size_t i = 0; i < zone.box.dimension() && !zone.lower.empty(); ++i) {
    const kinematics::Coordinate& c = VariedCoordinate(machine, zone.box, i);
    out["coordinates"][c.name] = {{"from", Outward(zone.lower[i], c.rotary)},
                                  {"to", Outward(zone.upper[i], c.rotary)},
                                  {"unit", UnitOf(c.rotary)},
                                  {"at_edge_of_search", zone.touches[i]}};
  }
  for (std::size_t i = 0; i < zone.shares.size(); ++i) {
    if (zone.shares[i] > 0.0) out["boundary"][zone.constraints[i]] = zone.shares[i];
  }
  return out;
}

ordered_json BodyJson(const FittedBody& fitted) {
  ordered_json out{{"shape", fitted.body.shape == analysis::BodyShape::kBox ? "box" : "cylinder"},
                   {"found", fitted.body.found}};
  if (fitted.body.found) {
    out["size_mm"] = fitted.body.size;
    out["centre"] = fitted.body.centre;
    out["content"] = fitted.body.content;
  }
  if (!fitted.wanted.empty()) {
    out["wanted_mm"] = fitted.wanted;
    out["fits"] = fitted.Fits();
  }
  return out;
}

ordered_json DexterityValues(const analysis::Dexterity& at) {
  return {{"condition", Number(at.condition)},
          {"weakest_force", Number(at.weakest_force)},
          {"slowest_velocity", Number(at.slowest_velocity)}};
}

ordered_json DexterityJson(const Machine& machine, const MechanismDexterity& one) {
  ordered_json out{{"block", one.block},
                   {"characteristic_length_mm", one.length_mm},
                   {"poses", one.field.poses}};
  if (one.field.poses > 0) {
    out["best"] = {{"condition", one.field.best},
                   {"at", CoordinatesJson(machine, one.field.best_at)}};
    out["worst"] = {{"condition", one.field.worst},
                    {"at", CoordinatesJson(machine, one.field.worst_at)}};
    out["mean"] = one.field.mean;
    out["mean_inverse"] = one.field.global;
    out["weakest_force"] = one.field.weakest_force;
    out["slowest_velocity"] = one.field.slowest_velocity;
  }
  out["home"] = DexterityValues(one.home.dexterity);
  out["home"]["ellipsoid"] = ordered_json::array();
  for (const analysis::EllipsoidAxis& axis : one.home.axes) {
    const Eigen::Vector3d v = axis.twist.head<3>();
    const Eigen::Vector3d omega = axis.twist.tail<3>() / one.length_mm;
    out["home"]["ellipsoid"].push_back({{"v", VectorJson(v)},
                                        {"omega_per_mm", VectorJson(omega)},
                                        {"velocity", Number(axis.velocity)},
                                        {"force", Number(axis.force)}});
  }
  return out;
}

ordered_json IndicesJson(const analysis::LayoutIndices& indices) {
  ordered_json out{{"workspace_utilisation", indices.utilisation},
                   {"space_efficiency", indices.space_efficiency},
                   {"orientation_space", nullptr},
                   {"orientation_angle", nullptr}};
  if (!indices.orientation_space) return out;
  out["orientation_space"] = *indices.orientation_space;
  out["orientation_angle"] = indices.orientation_angle.value_or(0.0);
  out["tilt_deg"] = indices.tilt_rad * kDegPerRad;
  for (const analysis::LayoutIndices::Range& range : indices.ranges) {
    out["ranges_deg"][range.coordinate] = {range.lower_rad * kDegPerRad,
                                           range.upper_rad * kDegPerRad};
  }
  return out;
}

ordered_json SingularJson(const AnalysisResult& result) {
  const analysis::SingularSet& set = *result.singular;
  const Machine& machine = *result.machine;
  ordered_json out{{"type_2", {{"possible", !set.cells.empty()}, {"crossed", set.crossed}}}};
  if (!set.cells.empty()) {
    for (std::size_t i = 0; i < set.lower.size(); ++i) {
      const kinematics::Coordinate& c = VariedCoordinate(machine, set.box, i);
      out["type_2"]["coordinates"][c.name] = {{"from", Outward(set.lower[i], c.rotary)},
                                              {"to", Outward(set.upper[i], c.rotary)}};
    }
    if (set.nearest) {
      out["type_2"]["nearest_to_home"] = CoordinatesJson(machine, *set.nearest);
      out["type_2"]["distance"] = set.nearest_distance;
    }
  }
  const analysis::SingularityDistance& home = *result.home_distance;
  out["home"] = {{"type", home.type},
                 {"block", home.block},
                 {"drive", home.drive},
                 {"distance_mm", Number(home.distance_mm)}};
  if (home.type != 0) out["home"]["at"] = CoordinatesJson(machine, home.z);
  return out;
}

ordered_json PathJson(const AnalysisResult& result) {
  ordered_json out{{"singularities", ordered_json::array()},
                   {"out_of_reach", ordered_json::array()}};
  for (const analysis::PathSingularity& one : result.path->singularities) {
    out["singularities"].push_back({{"type", one.type},
                                    {"block", one.block},
                                    {"drive", one.drive},
                                    {"crossed", one.crossed},
                                    {"from_sample", one.from + 1.0},
                                    {"to_sample", one.to + 1.0},
                                    {"coordinates", CoordinatesJson(*result.machine, one.z)}});
  }
  for (const std::array<double, 2>& piece : result.path->out_of_reach)
    out["out_of_reach"].push_back({piece[0] + 1.0, piece[1] + 1.0});
  return out;
}

ordered_json GeometryJson(const analysis::GeometryNumbers& numbers) {
  ordered_json out{{"points_mm", ordered_json::object()},
                   {"struts", ordered_json::array()},
                   {"distances", ordered_json::array()},
                   {"angles", ordered_json::array()}};
  for (const auto& point : numbers.points) out["points_mm"][point.name] = VectorJson(point.p_M);
  for (const analysis::StrutNumbers& strut : numbers.struts) {
    out["struts"].push_back({{"from", strut.from},
                             {"to", strut.to},
                             {"length_mm", strut.length_mm},
                             {"direction", VectorJson(strut.direction)},
                             {"precession_deg", strut.precession_rad * kDegPerRad},
                             {"nutation_deg", strut.nutation_rad * kDegPerRad}});
  }
  for (const analysis::StrutDistance& pair : numbers.distances) {
    out["distances"].push_back({{"first", pair.first},
                                {"second", pair.second},
                                {"centre_lines_mm", pair.centre_lines_mm},
                                {"clearance_mm", pair.clearance_mm},
                                {"on_first_mm", VectorJson(pair.on_first)},
                                {"on_second_mm", VectorJson(pair.on_second)}});
  }
  for (const analysis::LinkAngle& angle : numbers.angles) {
    out["angles"].push_back({{"at", angle.at},
                             {"first", angle.first},
                             {"second", angle.second},
                             {"deg", angle.angle_rad * kDegPerRad}});
  }
  return out;
}

}  // namespace

ordered_json AnalysisJson(const AnalysisResult& result) {
  const Machine& machine = *result.machine;
  ordered_json out{{"name", machine.layout().name}};
  if (result.zone) {
    out["zone"] = ZoneJson(machine, *result.zone);
    out["zone"]["held"] = CoordinatesJson(machine, result.function->region().z);
    out["bodies"] = ordered_json::array();
    for (const FittedBody& body : result.bodies) out["bodies"].push_back(BodyJson(body));
  }
  if (!result.slices.empty()) {
    out["slices"] = ordered_json::array();
    for (const SliceResult& slice : result.slices) {
      ordered_json one = ZoneJson(machine, slice.zone);
      one["at"] = {{slice.coordinate, Outward(slice.value, slice.rotary)}};
      one["singular_cells"] = slice.singular.cells.size();
      out["slices"].push_back(std::move(one));
    }
  }
  if (!result.dexterity.empty()) {
    out["dexterity"] = ordered_json::array();
    for (const MechanismDexterity& one : result.dexterity)
      out["dexterity"].push_back(DexterityJson(machine, one));
  }
  if (result.indices) out["indices"] = IndicesJson(*result.indices);
  if (result.singular) out["singularities"] = SingularJson(result);
  if (result.path) out["path"] = PathJson(result);
  if (!result.point_path.empty()) {
    out["point_mm"] = ordered_json::array();
    for (const Eigen::Vector3d& p : result.point_path) out["point_mm"].push_back(VectorJson(p));
  }
  if (result.geometry) out["geometry"] = GeometryJson(*result.geometry);
  out["stopped"] = result.stopped;
  return out;
}

}  // namespace kompono::cli
