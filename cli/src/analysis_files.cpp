// SPDX-License-Identifier: Apache-2.0
// Pictures and tables of `kompono analyze`.
#include "analyzing.hpp"
#include "csv.hpp"
#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kompono/analysis/zone_files.hpp"

namespace kompono::cli {
namespace {

using analysis::Region;
using analysis::WorkZone;
using analysis::ZonePicture;
using kinematics::Machine;

constexpr std::size_t kMapSteps = 60;

std::array<double, 4> CellRectangle(const Region& box, const analysis::ZoneCell& cell) {
  const double width = std::ldexp(box.Extent(0), -cell.level);
  const double height = std::ldexp(box.Extent(1), -cell.level);
  return {
      box.lower[0] + cell.index[0] * width, box.lower[1] + cell.index[1] * height, width, height};
}

/// 1/condition of the worst mechanism on a grid over the picture.
void PaintCondition(const AnalysisResult& result,
                    const AnalysisTask& task,
                    const analysis::ZoneFunction& function,
                    ZonePicture& picture) {
  const Region& region = function.region();
  analysis::ZoneFunction::Scratch scratch(function);
  std::vector<double> lengths;
  for (std::size_t m = 0; m < result.judge->mechanisms().size(); ++m) {
    lengths.push_back(task.length_mm ? *task.length_mm
                                     : analysis::CharacteristicLength(*result.judge, m));
  }
  const double width = (picture.upper[0] - picture.lower[0]) / kMapSteps;
  const double height = (picture.upper[1] - picture.lower[1]) / kMapSteps;
  for (std::size_t k = 0; k < kMapSteps * kMapSteps; ++k) {
    const std::size_t column = k % kMapSteps;
    const std::size_t row = k / kMapSteps;
    const double x = picture.lower[0] + (static_cast<double>(column) + 0.5) * width;
    const double y = picture.lower[1] + (static_cast<double>(row) + 0.5) * height;
    const std::array<double, 2> at{x, y};
    if (!function.Inside(at, scratch)) continue;
    double least = 1.0;
    for (std::size_t m = 0; m < lengths.size(); ++m) {
      const double condition =
          analysis::DexterityAt(*result.judge, m, region.At(at), lengths[m]).dexterity.condition;
      least = std::min(least, std::isfinite(condition) ? 1.0 / condition : 0.0);
    }
    picture.map.push_back({x - 0.5 * width, y - 0.5 * height, width, height, least});
  }
  picture.worst = 0.0;
  picture.best = 1.0;
  picture.title += ", colour 1/condition";
}

ZonePicture PictureOf(const AnalysisResult& result,
                      const AnalysisTask& task,
                      const analysis::ZoneFunction& function,
                      const WorkZone& zone,
                      const analysis::SingularSet* singular,
                      std::string title) {
  const Region& region = function.region();
  const auto name = [&](std::size_t i) {
    const kinematics::Coordinate& c = VariedCoordinate(*result.machine, region, i);
    return c.name + (c.rotary ? " rad" : " mm");
  };
  ZonePicture picture{.title = std::move(title), .horizontal = name(0), .vertical = name(1)};
  const bool empty = zone.lower.empty();
  for (std::size_t i = 0; i < 2; ++i) {
    const double from = empty ? region.lower[i] : zone.lower[i];
    const double to = empty ? region.upper[i] : zone.upper[i];
    picture.lower[i] = from - 0.05 * (to - from);
    picture.upper[i] = to + 0.05 * (to - from);
  }
  if (!empty) picture.outline = analysis::OutlineOfZone(function, zone, 200, task.control);
  if (task.map) PaintCondition(result, task, function, picture);
  if (singular != nullptr) {
    for (const analysis::ZoneCell& cell : singular->cells) {
      const std::array<double, 4> r = CellRectangle(singular->box, cell);
      if (r[0] + r[2] >= picture.lower[0] && r[0] <= picture.upper[0] &&
          r[1] + r[3] >= picture.lower[1] && r[1] <= picture.upper[1])
        picture.singular.push_back(r);
    }
  }
  return picture;
}

void AddBodies(const AnalysisResult& result, ZonePicture& picture) {
  for (const FittedBody& fitted : result.bodies) {
    const analysis::InscribedBody& body = fitted.body;
    if (!body.found) continue;
    if (body.shape == analysis::BodyShape::kBox) {
      picture.boxes.push_back({body.centre[0] - 0.5 * body.size[0],
                               body.centre[1] - 0.5 * body.size[1],
                               body.size[0],
                               body.size[1]});
    } else {
      picture.discs.push_back({body.centre[0], body.centre[1], body.size[0]});
    }
  }
}

/// Three cuts through the middle of a spatial zone.
std::vector<ZonePicture> Cuts(const AnalysisResult& result, const AnalysisTask& task) {
  std::vector<ZonePicture> out;
  const Region& region = result.function->region();
  if (result.zone->lower.empty()) return out;
  for (std::size_t i = region.dimension(); i-- > 0;) {
    const double value = result.bodies.empty() || !result.bodies[0].body.found
                             ? 0.5 * (result.zone->lower[i] + result.zone->upper[i])
                             : result.bodies[0].body.centre[i];
    const auto function = analysis::ZoneFunction::Make(
        *result.judge, analysis::SliceOf(region, i, value), task.regular);
    if (!function) continue;
    const WorkZone zone = analysis::ComputeZone(
        *function, {.tolerance = std::max(0.01, task.tolerance), .control = task.control});
    const analysis::SingularSet singular =
        analysis::SingularitiesIn(*result.judge, *function, 20000, task.control);
    const kinematics::Coordinate& c = VariedCoordinate(*result.machine, region, i);
    out.push_back(
        PictureOf(result,
                  task,
                  *function,
                  zone,
                  &singular,
                  fmt::format("{} {:.1f} {}", c.name, Outward(value, c.rotary), UnitOf(c.rotary))));
  }
  return out;
}

}  // namespace

std::string AnalysisSvg(const AnalysisResult& result, const AnalysisTask& task) {
  std::vector<ZonePicture> pictures;
  for (const SliceResult& slice : result.slices) {
    if (slice.function->region().dimension() != 2) continue;
    pictures.push_back(PictureOf(result,
                                 task,
                                 *slice.function,
                                 slice.zone,
                                 &slice.singular,
                                 fmt::format("{} {} {}",
                                             slice.coordinate,
                                             Brief(Outward(slice.value, slice.rotary)),
                                             UnitOf(slice.rotary))));
  }
  if (pictures.empty() && result.zone) {
    if (result.function->region().dimension() == 2) {
      pictures.push_back(PictureOf(result,
                                   task,
                                   *result.function,
                                   *result.zone,
                                   result.singular ? &*result.singular : nullptr,
                                   result.machine->layout().name));
      AddBodies(result, pictures.back());
    } else if (result.function->region().dimension() == 3) {
      pictures = Cuts(result, task);
    }
  }
  return analysis::PicturesSvg(pictures);
}

std::string AnalysisCsv(const AnalysisResult& result, const AnalysisTask& task) {
  if (!result.point_path.empty()) {
    std::string out = "sample,x_mm,y_mm,z_mm\n";
    for (std::size_t i = 0; i < result.point_path.size(); ++i) {
      const Eigen::Vector3d& p = result.point_path[i];
      out += fmt::format("{},{},{},{}\n", i + 1, Exact(p.x()), Exact(p.y()), Exact(p.z()));
    }
    return out;
  }
  if (task.map && result.zone && !result.zone->lower.empty()) {
    // Poses of a grid with everything a map may show.
    const Region& region = result.function->region();
    analysis::ZoneFunction::Scratch scratch(*result.function);
    std::string out;
    for (std::size_t i = 0; i < region.dimension(); ++i) {
      const kinematics::Coordinate& c = VariedCoordinate(*result.machine, region, i);
      out += fmt::format("{}_{},", CsvField(c.name), UnitOf(c.rotary));
    }
    for (const MechanismDexterity& one : result.dexterity)
      out += fmt::format("{0}.condition,{0}.weakest_force,{0}.slowest_velocity,", one.block);
    out += "singularity_mm\n";
    const auto steps = static_cast<std::size_t>(region.dimension() == 3 ? 16 : 60);
    const auto count = static_cast<std::size_t>(
        std::pow(static_cast<double>(steps), static_cast<double>(region.dimension())));
    for (std::size_t k = 0; k < count && !task.control.Stopped(); ++k) {
      std::vector<double> at;
      std::size_t rest = k;
      for (std::size_t i = 0; i < region.dimension(); ++i, rest /= steps) {
        const double share = (static_cast<double>(rest % steps) + 0.5) / static_cast<double>(steps);
        at.push_back(result.zone->lower[i] +
                     share * (result.zone->upper[i] - result.zone->lower[i]));
      }
      if (!result.function->Inside(at, scratch)) continue;
      const Eigen::VectorXd z = region.At(at);
      for (std::size_t i = 0; i < at.size(); ++i) {
        const kinematics::Coordinate& c = VariedCoordinate(*result.machine, region, i);
        out += Exact(Outward(at[i], c.rotary)) + ",";
      }
      for (std::size_t m = 0; m < result.dexterity.size(); ++m) {
        const analysis::Dexterity d =
            analysis::DexterityAt(*result.judge, m, z, result.dexterity[m].length_mm).dexterity;
        out +=
            fmt::format("{:.9g},{:.9g},{:.9g},", d.condition, d.weakest_force, d.slowest_velocity);
      }
      out += fmt::format("{:.6g}\n", analysis::DistanceToSingularity(*result.judge, z).distance_mm);
    }
    return out;
  }
  return result.zone ? analysis::ZoneCsv(*result.machine, *result.zone) : std::string();
}

}  // namespace kompono::cli
