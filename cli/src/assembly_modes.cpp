// SPDX-License-Identifier: Apache-2.0
#include "assembly_modes.hpp"

#include "assignments.hpp"
#include "machine_sheet.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kompono::cli {
namespace {

using kinematics::AssemblyMode;
using kinematics::AssemblyModes;
using kinematics::Machine;
using nlohmann::ordered_json;

constexpr const char* kLetters = "XYZABC";

std::string Provenance(const AssemblyModes& modes) {
  return modes.complete ? "complete: every mechanism has closed forms"
                        : fmt::format("found from {} starts; there may be more", modes.starts);
}

std::string Signs(const std::vector<std::vector<double>>& modes) {
  std::string out;
  for (const std::vector<double>& mechanism : modes) {
    if (!out.empty() && !mechanism.empty()) out += ' ';
    for (const double mode : mechanism) out += mode > 0.0 ? '+' : '-';
  }
  return out.empty() ? "-" : out;
}

ordered_json ModesJson(const Machine& machine,
                       const AssemblyModes& modes,
                       layout::RotationOrder order) {
  ordered_json out{{"complete", modes.complete},
                   {"starts", modes.starts},
                   {"assembly_modes", ordered_json::array()}};
  for (const AssemblyMode& mode : modes.found) {
    const kinematics::PoseNumbers pose = kinematics::NumbersFromPose(mode.X_WT, order);
    ordered_json entry{{"as_laid_out", mode.as_laid_out},
                       {"pose", ordered_json::object()},
                       {"coordinates", ordered_json::object()},
                       {"modes", mode.modes},
                       {"det_a", mode.det_a}};
    for (std::size_t k = 0; k < 6; ++k) {
      entry["pose"][std::string(1, kLetters[k])] = Outward(pose.value[k], k > 2);
    }
    for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
      const kinematics::Coordinate& coordinate = machine.coordinates()[i];
      entry["coordinates"][coordinate.name] =
          Outward(mode.coordinates[static_cast<Eigen::Index>(i)], coordinate.rotary);
    }
    out["assembly_modes"].push_back(std::move(entry));
  }
  return out;
}

std::string ModesText(const AssemblyModes& modes, layout::RotationOrder order) {
  TextTable table({{"", true},
                   {"X mm", true},
                   {"Y mm", true},
                   {"Z mm", true},
                   {"A deg", true},
                   {"B deg", true},
                   {"C deg", true},
                   {"modes"},
                   {"det A"},
                   {""}});
  std::size_t number = 0;
  for (const AssemblyMode& mode : modes.found) {
    std::vector<std::string> row{std::to_string(++number)};
    const kinematics::PoseNumbers pose = kinematics::NumbersFromPose(mode.X_WT, order);
    for (std::size_t k = 0; k < 6; ++k) row.push_back(Fixed(Outward(pose.value[k], k > 2)));
    row.push_back(Signs(mode.modes));
    std::string sides;
    for (const double det : mode.det_a) sides += det > 0.0 ? '+' : '-';
    row.push_back(sides.empty() ? "-" : sides);
    row.push_back(mode.as_laid_out ? "as laid out" : "");
    table.Row(std::move(row));
  }
  return fmt::format("{} for these drive readings; {}\n",
                     Counted(modes.found.size(), "assembly mode"),
                     Provenance(modes)) +
         table.Render();
}

}  // namespace

ExitCode ShowAssemblyModes(Session& session,
                           const Machine& machine,
                           const Eigen::VectorXd& readings,
                           layout::RotationOrder order) {
  const AssemblyModes modes = machine.AllForward(readings, machine.nominal());
  if (session.json) {
    session.console.Json(ModesJson(machine, modes, order));
  } else {
    session.console.Out(ModesText(modes, order));
  }
  return modes.found.empty() ? ExitCode::kNoSolution : ExitCode::kOk;
}

}  // namespace kompono::cli
