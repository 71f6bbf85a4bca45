// SPDX-License-Identifier: Apache-2.0
// The engineer's one screen.
#include "analyzing.hpp"
#include "machine_sheet.hpp"
#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kompono::cli {
namespace {

using analysis::Region;
using analysis::WorkZone;
using kinematics::Machine;

/// Four significant digits, without an exponent for what a machine measures.
std::string Short(double value) {
  if (!std::isfinite(value)) return value > 0.0 ? "inf" : "-";
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  if (size >= 1e6 || size < 1e-3) return fmt::format("{:.4g}", value);
  const int digits = std::max(0, 3 - static_cast<int>(std::floor(std::log10(size))));
  return fmt::format("{:.{}f}", value, digits);
}

/// Millimetres to one decimal: "12.0" and never "-0.0".
std::string Tenths(double value) {
  const double rounded = std::round(value * 10.0) / 10.0;
  return fmt::format("{:.1f}", rounded == 0.0 ? 0.0 : rounded);
}

struct ContentUnit {
  const char* what;
  const char* unit;
  double factor;
};

/// How a zone's content is told: m³, cm³ … by its size; degrees where angles vary.
ContentUnit UnitOfZone(const Machine& machine, const Region& region, double content) {
  std::size_t angles = 0;
  for (std::size_t i = 0; i < region.dimension(); ++i)
    angles += VariedCoordinate(machine, region, i).rotary ? 1 : 0;
  const double factor = std::pow(kDegPerRad, static_cast<double>(angles));
  if (angles == 1 && region.dimension() == 1) return {"range", "deg", factor};
  if (angles == region.dimension()) return {"content", angles == 2 ? "deg²" : "deg³", factor};
  if (angles > 0) return {"content", "mm and deg multiplied", factor};
  switch (region.dimension()) {
    case 1:
      return {"range", "mm", 1.0};
    case 2:
      return content >= 1e5 ? ContentUnit{"area", "m²", 1e-6} : ContentUnit{"area", "mm²", 1.0};
    default:
      return content >= 1e8 ? ContentUnit{"volume", "m³", 1e-9}
                            : ContentUnit{"volume", "cm³", 1e-3};
  }
}

std::string PlaceText(const Machine& machine, const Region& region, const Eigen::VectorXd& z) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < region.dimension(); ++i) {
    const kinematics::Coordinate& c = VariedCoordinate(machine, region, i);
    words.push_back(fmt::format("{} {}", c.name, Tenths(Outward(z[region.varied[i]], c.rotary))));
  }
  return Joined(words);
}

std::string HeldText(const Machine& machine, const Region& region) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const int index = static_cast<int>(i);
    if (std::find(region.varied.begin(), region.varied.end(), index) != region.varied.end())
      continue;
    const kinematics::Coordinate& c = machine.coordinates()[i];
    words.push_back(fmt::format(
        "{} {} {}", c.name, Brief(Outward(region.z[index], c.rotary)), UnitOf(c.rotary)));
  }
  return words.empty() ? "" : "; held: " + Joined(words);
}

std::string ContentText(const Machine& machine, const WorkZone& zone) {
  const ContentUnit unit = UnitOfZone(machine, zone.box, zone.content);
  return fmt::format("{} {} ± {} {}",
                     unit.what,
                     Short(zone.content * unit.factor),
                     fmt::format("{:.2g}", zone.bound * unit.factor),
                     unit.unit);
}

std::string SharesText(const WorkZone& zone) {
  std::vector<std::size_t> order(zone.shares.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&zone](std::size_t a, std::size_t b) {
    return zone.shares[a] > zone.shares[b];
  });
  std::string out;
  for (std::size_t k = 0; k < std::min<std::size_t>(6, order.size()); ++k) {
    const double share = zone.shares[order[k]];
    if (share < 0.005) break;
    out += fmt::format("    {:>3.0f} %  {}\n", share * 100.0, zone.constraints[order[k]]);
  }
  return out;
}

std::string ExtentsText(const Machine& machine, const Region& searched, const WorkZone& zone) {
  std::string out;
  for (std::size_t i = 0; i < zone.box.dimension(); ++i) {
    const kinematics::Coordinate& c = VariedCoordinate(machine, zone.box, i);
    out += fmt::format("  {} {} .. {} {}",
                       c.name,
                       Tenths(Outward(zone.lower[i], c.rotary)),
                       Tenths(Outward(zone.upper[i], c.rotary)),
                       UnitOf(c.rotary));
    const bool open_below = zone.touches[i][0] && !(c.lower && *c.lower >= searched.lower[i]);
    const bool open_above = zone.touches[i][1] && !(c.upper && *c.upper <= searched.upper[i]);
    if (open_below || open_above) out += "  (cut by the search: the machine sets no limit there)";
    out += "\n";
  }
  return out;
}

std::string BodyText(const Machine& machine, const Region& region, const FittedBody& fitted) {
  const bool box = fitted.body.shape == analysis::BodyShape::kBox;
  const bool planar = region.dimension() == 2;
  const char* name = box ? (planar ? "rectangle" : "box") : (planar ? "disc" : "cylinder");
  if (!fitted.body.found) return fmt::format("  no {} of these proportions was found\n", name);
  std::string size;
  if (box) {
    for (const double s : fitted.body.size) size += (size.empty() ? "" : " x ") + Tenths(s);
  } else {
    size = "diameter " + Tenths(fitted.body.size[0]);
    if (!planar) size += ", height " + Tenths(fitted.body.size[2]);
  }
  Eigen::VectorXd z = region.z;
  for (std::size_t i = 0; i < fitted.body.centre.size(); ++i)
    z[region.varied[i]] = fitted.body.centre[i];
  std::string out =
      fmt::format("  largest {} {} mm around {}\n", name, size, PlaceText(machine, region, z));
  if (fitted.wanted.empty()) return out;
  std::string wanted;
  for (std::size_t i = 0; i < fitted.wanted.size(); ++i) {
    if (!box && i == 1) continue;
    wanted += (wanted.empty() ? "" : " x ") + Brief(fitted.wanted[i]);
  }
  return out + fmt::format("    {} {}\n", wanted, fitted.Fits() ? "fits" : "does not fit");
}

std::string ZoneText(const Console& console, const AnalysisResult& result) {
  const Machine& machine = *result.machine;
  const WorkZone& zone = *result.zone;
  const Region& region = result.function->region();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < region.dimension(); ++i)
    names.push_back(VariedCoordinate(machine, region, i).name);
  std::string out = fmt::format("work zone over {}{}\n", Joined(names), HeldText(machine, region));
  if (zone.lower.empty()) {
    return out + console.Paint(zone.empty() ? "  empty: no place is within reach and ranges\n"
                                            : "  no place is certainly within reach and ranges\n",
                               Hue::kRed);
  }
  out += "  " + ContentText(machine, zone) + "\n" + ExtentsText(machine, region, zone);
  for (const FittedBody& body : result.bodies) out += BodyText(machine, region, body);
  return out + "  its boundary is made of\n" + SharesText(zone);
}

std::string DexterityText(const AnalysisResult& result) {
  std::string out;
  const Machine& machine = *result.machine;
  const Region& region = result.function->region();
  for (const MechanismDexterity& one : result.dexterity) {
    const analysis::DexterityField& field = one.field;
    out += fmt::format("\ndexterity of {}", one.block);
    if (one.length_mm != 1.0) out += fmt::format(", 1 rad counted as {} mm", Short(one.length_mm));
    out += "\n";
    if (field.poses == 0) {
      out += "  no pose of the grid is inside the zone\n";
      continue;
    }
    out += fmt::format(
        "  condition {} best at {}\n            {} worst at {}\n            {} at home, {} mean; "
        "mean of 1/condition {}\n",
        Short(field.best),
        PlaceText(machine, region, field.best_at),
        Short(field.worst),
        PlaceText(machine, region, field.worst_at),
        Short(one.home.dexterity.condition),
        Short(field.mean),
        Short(field.global));
    out += fmt::format(
        "  weakest   {} N held per N of the drives; slowest {} mm/s per mm/s of the drives\n",
        Short(field.weakest_force),
        Short(field.slowest_velocity));
  }
  return out;
}

std::string IndicesText(const analysis::LayoutIndices& indices) {
  std::string out = fmt::format("\nindices\n  workspace utilisation {}, space efficiency {}\n",
                                Short(indices.utilisation),
                                Short(indices.space_efficiency));
  if (!indices.orientation_space) return out;
  out += fmt::format("  orientation space {} with ±{} deg, orientation angle {}\n",
                     Short(*indices.orientation_space),
                     Brief(indices.tilt_rad * kDegPerRad),
                     Short(indices.orientation_angle.value_or(0.0)));
  for (const analysis::LayoutIndices::Range& range : indices.ranges) {
    out += fmt::format("    {} {} .. {} deg at home\n",
                       range.coordinate,
                       Tenths(range.lower_rad * kDegPerRad),
                       Tenths(range.upper_rad * kDegPerRad));
  }
  return out;
}

std::string DistanceText(const AnalysisResult& result) {
  const analysis::SingularityDistance& home = *result.home_distance;
  if (home.type == 0) return "  nothing singular near home\n";
  return fmt::format("  home is {} mm from type {} of {}{}\n",
                     Tenths(home.distance_mm),
                     home.type,
                     home.block,
                     home.drive.empty() ? "" : ", where " + home.drive + " ends");
}

std::string SingularText(const Console& console, const AnalysisResult& result) {
  if (result.judge->mechanisms().empty()) return "\nno mechanism, so nothing is singular\n";
  std::string out = "\nsingularities\n";
  const analysis::SingularSet& set = *result.singular;
  const Machine& machine = *result.machine;
  if (set.cells.empty()) {
    out += console.Paint("  none of type 2 within reach and ranges: proven\n", Hue::kGreen);
    return out + DistanceText(result);
  }
  out += console.Paint(set.crossed ? "  type 2 within reach and ranges: det A changes its sign\n"
                                   : "  type 2 within reach and ranges cannot be excluded\n",
                       Hue::kRed);
  for (std::size_t i = 0; i < set.lower.size(); ++i) {
    const kinematics::Coordinate& c = VariedCoordinate(machine, set.box, i);
    out += fmt::format("    {} {} .. {} {}\n",
                       c.name,
                       Tenths(Outward(set.lower[i], c.rotary)),
                       Tenths(Outward(set.upper[i], c.rotary)),
                       UnitOf(c.rotary));
  }
  if (set.nearest) {
    out += fmt::format("    nearest to home at {}, {} mm away\n",
                       PlaceText(machine, set.box, *set.nearest),
                       Tenths(set.nearest_distance));
  }
  return out + DistanceText(result);
}

std::string SlicesText(const AnalysisResult& result) {
  if (result.slices.empty()) return "";
  std::string out = "\nslices\n";
  for (const SliceResult& slice : result.slices) {
    out += fmt::format("  {} {} {}: {}{}\n",
                       slice.coordinate,
                       Brief(Outward(slice.value, slice.rotary)),
                       UnitOf(slice.rotary),
                       slice.zone.empty() ? "empty" : ContentText(*result.machine, slice.zone),
                       slice.singular.cells.empty() ? "" : ", type 2 singularities inside");
  }
  return out;
}

std::string PathText(const Console& console, const AnalysisResult& result) {
  const analysis::PathReport& path = *result.path;
  std::string out = "\npath\n";
  if (path.singularities.empty() && path.out_of_reach.empty())
    return out + console.Paint("  regular from end to end, between the samples too: proven\n",
                               Hue::kGreen);
  for (const std::array<double, 2>& piece : path.out_of_reach)
    out += fmt::format("  out of reach from sample {:.6g} to {:.6g}\n", piece[0] + 1, piece[1] + 1);
  for (const analysis::PathSingularity& one : path.singularities) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < result.machine->coordinates().size(); ++i) {
      const kinematics::Coordinate& c = result.machine->coordinates()[i];
      words.push_back(
          fmt::format("{} {:.6g}", c.name, Outward(one.z[static_cast<Eigen::Index>(i)], c.rotary)));
    }
    const char* how = one.type != 2 ? "" : one.crossed ? ", crossed" : ", touched";
    out += fmt::format("  type {} of {}{}{} at sample {:.9g}: {}\n",
                       one.type,
                       one.block,
                       one.drive.empty() ? "" : " (" + one.drive + ")",
                       how,
                       0.5 * (one.from + one.to) + 1.0,
                       Joined(words));
  }
  return out;
}

std::string GeometryText(const analysis::GeometryNumbers& numbers) {
  TextTable points({{"point"}, {"x mm", true}, {"y mm", true}, {"z mm", true}});
  for (const auto& point : numbers.points) {
    points.Row({point.name, Fixed(point.p_M.x()), Fixed(point.p_M.y()), Fixed(point.p_M.z())});
  }
  TextTable struts(
      {{"strut"}, {"length mm", true}, {"precession deg", true}, {"nutation deg", true}});
  for (const analysis::StrutNumbers& strut : numbers.struts) {
    struts.Row({strut.from + " - " + strut.to,
                Fixed(strut.length_mm),
                Fixed(strut.precession_rad * kDegPerRad),
                Fixed(strut.nutation_rad * kDegPerRad)});
  }
  TextTable distances({{"nearest struts"}, {"centre lines mm", true}, {"clearance mm", true}});
  for (const analysis::StrutDistance& pair : numbers.distances) {
    const auto name = [&numbers](std::size_t i) {
      return numbers.struts[i].from + " - " + numbers.struts[i].to;
    };
    distances.Row({name(pair.first) + " and " + name(pair.second),
                   Fixed(pair.centre_lines_mm),
                   Fixed(pair.clearance_mm)});
  }
  TextTable angles({{"angle at"}, {"between"}, {"deg", true}});
  for (const analysis::LinkAngle& angle : numbers.angles)
    angles.Row(
        {angle.at, angle.first + " and " + angle.second, Fixed(angle.angle_rad * kDegPerRad)});
  std::string out = "\n" + points.Render();
  if (!struts.empty()) out += "\n" + struts.Render();
  if (!distances.empty()) out += "\n" + distances.Render();
  if (!angles.empty()) out += "\n" + angles.Render();
  return out;
}

}  // namespace

std::string AnalysisText(const Console& console, const AnalysisResult& result) {
  std::string out = result.machine->layout().name + "\n\n";
  if (result.zone) out += ZoneText(console, result);
  if (result.zone) out += DexterityText(result);
  if (result.indices) out += IndicesText(*result.indices);
  if (result.singular) out += SingularText(console, result);
  out += SlicesText(result);
  if (result.path) out += PathText(console, result);
  if (!result.point_path.empty()) {
    TextTable table({{"sample", true}, {"x mm", true}, {"y mm", true}, {"z mm", true}});
    for (std::size_t i = 0; i < result.point_path.size(); ++i) {
      const Eigen::Vector3d& p = result.point_path[i];
      table.Row({std::to_string(i + 1), Fixed(p.x()), Fixed(p.y()), Fixed(p.z())});
    }
    out += "\n" + table.Render();
  }
  if (result.geometry) out += GeometryText(*result.geometry);
  if (result.stopped) out += "\nstopped: the bounds hold for what was looked at until then\n";
  return out;
}

}  // namespace kompono::cli
