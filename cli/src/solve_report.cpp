// SPDX-License-Identifier: Apache-2.0
// What `kompono solve` prints for one pose.
#include "solving.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kompono::cli {
namespace {

using kinematics::Machine;
using nlohmann::ordered_json;

ordered_json SingularityJson(const SolvedPose& solved) {
  if (!solved.complete) {
    return {{"type", nullptr}, {"margin", nullptr}, {"mechanisms", ordered_json::array()}};
  }
  const SingularitySummary summary = Summary(solved.singularities);
  ordered_json out{
      {"type", summary.type}, {"margin", summary.margin}, {"mechanisms", ordered_json::array()}};
  for (const kinematics::Singularity& mechanism : solved.singularities) {
    out["mechanisms"].push_back({{"block", mechanism.block},
                                 {"type", mechanism.type},
                                 {"margin", mechanism.margin},
                                 {"margin_a", mechanism.margin_a},
                                 {"margin_b", mechanism.margin_b},
                                 {"det_a", mechanism.det_a}});
  }
  return out;
}

std::string CoordinatesText(const Machine& machine, const SolvedPose& solved) {
  TextTable table({{"coordinate"}, {"", true}, {""}, {"range"}});
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const kinematics::Coordinate& coordinate = machine.coordinates()[i];
    const double value = solved.solution.coordinates[static_cast<Eigen::Index>(i)];
    table.Row({coordinate.name,
               Fixed(Outward(value, coordinate.rotary)),
               std::string(UnitOf(coordinate.rotary)),
               RangeText(coordinate.lower, coordinate.upper, coordinate.rotary)});
  }
  return table.Render();
}

std::string DrivesText(const Console& console, const Machine& machine, const SolvedPose& solved) {
  TextTable table({{"drive"}, {"", true}, {""}, {"range"}, {""}});
  for (std::size_t i = 0; i < machine.drives().size(); ++i) {
    const kinematics::Drive& drive = machine.drives()[i];
    const auto k = static_cast<Eigen::Index>(i);
    const double value = solved.solution.drives[k];
    const bool reached = std::isfinite(value);
    const bool outside =
        (drive.lower && value < *drive.lower) || (drive.upper && value > *drive.upper);
    table.Row({drive.name,
               Fixed(Outward(value, drive.rotary)),
               std::string(UnitOf(drive.rotary)),
               RangeText(drive.lower, drive.upper, drive.rotary),
               !reached  ? console.Paint("out of reach", Hue::kRed)
               : outside ? console.Paint("outside", Hue::kRed)
                         : ""});
  }
  return table.Render();
}

std::string JacobianText(const Machine& machine, const DriveJacobian& jacobian) {
  std::vector<TextTable::Column> columns{{"Jacobian"}};
  for (const std::size_t k : jacobian.components)
    columns.push_back({fmt::format("d/d{}", kPoseLetters[k]), true});
  TextTable table(std::move(columns));
  for (std::size_t i = 0; i < machine.drives().size(); ++i) {
    std::vector<std::string> cells{machine.drives()[i].name};
    for (Eigen::Index j = 0; j < jacobian.matrix.cols(); ++j)
      cells.push_back(Fixed(jacobian.matrix(static_cast<Eigen::Index>(i), j)));
    table.Row(std::move(cells));
  }
  return table.Render() + "  mm or rad of a drive per mm or rad of the pose\n";
}

std::string SingularityText(const SolvedPose& solved) {
  if (solved.singularities.empty()) return "";
  TextTable table({{"mechanism"}, {"margin", true}, {"margin A", true}, {"margin B", true}, {""}});
  for (const kinematics::Singularity& mechanism : solved.singularities) {
    table.Row({mechanism.block,
               Fixed(mechanism.margin),
               Fixed(mechanism.margin_a),
               Fixed(mechanism.margin_b),
               std::string(SingularityName(mechanism.type))});
  }
  return "\n" + table.Render();
}

std::string StrutsText(const std::vector<Strut>& struts) {
  if (struts.empty()) return "";
  TextTable table({{"strut"}, {"length mm", true}, {"ux", true}, {"uy", true}, {"uz", true}});
  for (const Strut& strut : struts) {
    table.Row({strut.from + " - " + strut.to,
               Fixed(strut.length_mm),
               Fixed(strut.direction.x()),
               Fixed(strut.direction.y()),
               Fixed(strut.direction.z())});
  }
  return "\n" + table.Render();
}

}  // namespace

ordered_json SolvedJson(const Machine& machine, const SolvedPose& solved) {
  ordered_json out{{"pose", PoseJson(solved.pose)},
                   {"coordinates", ordered_json::object()},
                   {"drives", ordered_json::object()},
                   {"jacobian", ordered_json::array()},
                   {"jacobian_rows", ordered_json::array()},
                   {"jacobian_columns", ordered_json::array()}};
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const kinematics::Coordinate& coordinate = machine.coordinates()[i];
    out["coordinates"][coordinate.name] =
        Outward(solved.solution.coordinates[static_cast<Eigen::Index>(i)], coordinate.rotary);
  }
  for (std::size_t i = 0; i < machine.drives().size(); ++i) {
    const kinematics::Drive& drive = machine.drives()[i];
    out["drives"][drive.name] =
        Outward(solved.solution.drives[static_cast<Eigen::Index>(i)], drive.rotary);
    out["jacobian_rows"].push_back(drive.name);
  }
  for (Eigen::Index i = 0; i < solved.jacobian.matrix.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < solved.jacobian.matrix.cols(); ++j)
      row.push_back(solved.jacobian.matrix(i, j));
    out["jacobian"].push_back(std::move(row));
  }
  for (const std::size_t k : solved.jacobian.components)
    out["jacobian_columns"].push_back(std::string(1, kPoseLetters[k]));
  out["singularity"] = SingularityJson(solved);
  out["status"] = solved.Status();
  out["message"] = solved.Message();
  out["iterations"] = solved.solution.iterations;
  out["residual_mm"] = solved.solution.residual;
  out["limits"] = solved.limits;
  out["struts"] = ordered_json::array();
  for (const Strut& strut : solved.struts) {
    out["struts"].push_back(
        {{"from", strut.from},
         {"to", strut.to},
         {"length_mm", strut.length_mm},
         {"direction", {strut.direction.x(), strut.direction.y(), strut.direction.z()}}});
  }
  return out;
}

std::string SolvedText(const Console& console,
                       const Machine& machine,
                       const SolvedPose& solved,
                       layout::RotationOrder order) {
  std::string out = fmt::format("tool pose in the workpiece, {}\n", OrderName(order));
  out += PoseText(solved.pose);
  out += "\n" + CoordinatesText(machine, solved);
  out += "\n" + DrivesText(console, machine, solved);
  if (solved.complete) {
    out += "\n" + JacobianText(machine, solved.jacobian);
    out += SingularityText(solved) + StrutsText(solved.struts);
  }
  return out +
         fmt::format("\n{}, {}, residual {:.3g} mm or rad\n",
                     console.Paint(solved.Status(),
                                   solved.Exit() == ExitCode::kOk ? Hue::kGreen : Hue::kRed),
                     Counted(static_cast<std::size_t>(solved.solution.iterations), "iteration"),
                     solved.solution.residual);
}

}  // namespace kompono::cli
