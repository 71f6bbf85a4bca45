// SPDX-License-Identifier: Apache-2.0
#include "workshop.hpp"

#include "ways.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "kompono/plugin/capability_words.hpp"

namespace kompono::analysis {
namespace {

using kinematics::Machine;
using kinematics::PoseDerivatives;
using kinematics::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Two chucks that hold one bar: axes within 0.1° and 0.05 mm, a calibrated offset and no more.
constexpr double kFacing_rad = 0.0018;
constexpr double kFacing_mm = 0.05;
/// Where on the part's axis a tool is tried, from the stop in the chuck.
constexpr std::array<double, 4> kTried_mm{5.0, 20.0, 50.0, 200.0};

std::set<std::string> Without(const std::set<std::string>& these,
                              const std::set<std::string>& those) {
  std::set<std::string> out;
  std::set_difference(
      these.begin(), these.end(), those.begin(), those.end(), std::inserter(out, out.end()));
  return out;
}

/// Columns of the named coordinates in W at home: velocity of the tool's point over its turning.
Eigen::Matrix<double, 6, Eigen::Dynamic> Columns(const Machine& chain,
                                                 const std::set<std::string>& names,
                                                 bool rotary) {
  PoseDerivatives at;
  static_cast<void>(chain.ToolPose(chain.home(), chain.nominal(), &at));
  Eigen::Matrix<double, 6, Eigen::Dynamic> out(6, 0);
  for (std::size_t i = 0; i < chain.coordinates().size(); ++i) {
    const kinematics::Coordinate& coordinate = chain.coordinates()[i];
    if (coordinate.rotary != rotary || !names.contains(coordinate.name)) continue;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.rightCols<1>() = at.by_coordinates.col(static_cast<Eigen::Index>(i));
  }
  return out;
}

Eigen::Index RankOf(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return 0;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns);
  svd.setThreshold(1e-6);
  return svd.rank();
}

/// Moves the translating coordinates, within their ranges, until the tool's tip stands at `target`
/// (W); true if it does and no drive is beyond its range.
bool Stands(const Machine& chain, const Eigen::Vector3d& target) {
  const std::vector<kinematics::Coordinate>& coordinates = chain.coordinates();
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (!coordinates[i].rotary) free.push_back(static_cast<Eigen::Index>(i));
  }
  const VectorXd theta = chain.nominal();
  VectorXd z = chain.home();
  for (int round = 0; round < 60; ++round) {
    PoseDerivatives at;
    const Eigen::Vector3d error = target - chain.ToolPose(z, theta, &at).p;
    if (!error.allFinite()) return false;
    if (error.norm() < 1e-6) break;
    if (free.empty() || round == 59) return false;
    Eigen::MatrixXd J(3, static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k)
      J.col(static_cast<Eigen::Index>(k)) = at.by_coordinates.col(free[k]).head<3>();
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-9);
    const VectorXd step = solver.compute(J).solve(error);
    std::vector<Eigen::Index> still_free;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const kinematics::Coordinate& of = coordinates[static_cast<std::size_t>(free[k])];
      const double wanted = z[free[k]] + step[static_cast<Eigen::Index>(k)];
      z[free[k]] = std::clamp(wanted, of.lower.value_or(-kInfinity), of.upper.value_or(kInfinity));
      if (z[free[k]] == wanted) still_free.push_back(free[k]);
    }
    free = std::move(still_free);
  }
  VectorXd readings;
  VectorXd reach;
  chain.DrivesOf(z, theta, &readings, &reach);
  for (std::size_t i = 0; i < chain.drives().size(); ++i) {
    const kinematics::Drive& drive = chain.drives()[i];
    const double reading = readings[static_cast<Eigen::Index>(i)];
    if (!(reach[static_cast<Eigen::Index>(i)] >= 0.0) || !std::isfinite(reading)) return false;
    if (reading < drive.lower.value_or(-kInfinity) - 1e-9 ||
        reading > drive.upper.value_or(kInfinity) + 1e-9)
      return false;
  }
  return true;
}

/// 7 of "front7".
std::string StemOf(const std::string& station) {
  return station.substr(0, station.find_last_not_of("0123456789") + 1);
}

}  // namespace

bool Facing::Faces() const {
  return angle_rad < kFacing_rad;
}
bool Facing::Coaxial() const {
  return Faces() && offset_mm < kFacing_mm;
}

Workshop::Workshop(const Machine& machine, const plugin::Registry& registry)
    : machine_(machine), registry_(registry) {
  const layout::Layout& layout = machine.layout();
  for (Way& way : WaysOf(layout.formula.left, layout, registry)) {
    (way.Is(plugin::words::kSupportsPart) ? supports_ : parts_).push_back(std::move(way));
  }
  GroupTools(WaysOf(layout.formula.right, layout, registry));
}

const Machine& Workshop::Chain(const Way& part, const Way& tool) const {
  const auto key = std::pair(part.leaf, tool.leaf);
  const auto known = chains_.find(key);
  if (known != chains_.end()) return known->second;
  Parsed<Machine> chain = machine_.Between(part.leaf, tool.leaf);
  if (!chain) throw std::logic_error("a leaf of the formula is on no chain: " + part.leaf);
  return chains_.emplace(key, std::move(*chain)).first->second;
}

/// Each has two translations of its own against the part, one for the feed and one for the depth.
bool Workshop::MoveApart(const Way& one, const Way& other) const {
  const Way& part = parts_.empty() ? supports_.front() : parts_.front();
  const auto own = [&](const Way& tool, const Way& than) {
    const auto columns = Columns(Chain(part, tool), Without(tool.moves, than.moves), false);
    return RankOf(columns.topRows<3>());
  };
  return own(one, other) >= 2 && own(other, one) >= 2;
}

void Workshop::GroupTools(std::vector<Way> tools) {
  for (Way& tool : tools) {
    const auto home =
        std::find_if(carriers_.begin(), carriers_.end(), [&](const std::vector<Way>& carrier) {
          return std::any_of(carrier.begin(), carrier.end(), [&](const Way& other) {
            return !MoveApart(tool, other);
          });
        });
    if (home == carriers_.end()) {
      carriers_.push_back({std::move(tool)});
    } else {
      home->push_back(std::move(tool));
    }
  }
}

Facing Workshop::FacingOf(const Way& first, const Way& second) const {
  const Way& tool = carriers_.front().front();
  const Machine& to_first = Chain(first, tool);
  const Machine& to_second = Chain(second, tool);
  const auto seen = [&](const std::string& moved) {  // X_P1P2 with one coordinate 1 mm on
    const auto pose = [&](const Machine& chain) {
      VectorXd z = chain.home();
      if (const int at = chain.FindCoordinate(moved); at >= 0) z[at] += 1.0;
      return chain.ToolPose(z, chain.nominal());
    };
    return pose(to_first) * pose(to_second).Inverse();
  };
  const Pose<double> home = seen("");
  Facing out;
  out.angle_rad = std::acos(std::clamp(-home.R(2, 2), -1.0, 1.0));
  out.offset_mm = std::hypot(home.p.x(), home.p.y());
  out.nearest_mm = out.furthest_mm = home.p.z();
  for (const auto& [chain, way, other] :
       {std::tuple(&to_first, &first, &second), std::tuple(&to_second, &second, &first)}) {
    for (const std::string& name : Without(way->moves, other->moves)) {
      const int at = chain->FindCoordinate(name);
      if (at < 0 || chain->coordinates()[static_cast<std::size_t>(at)].rotary) continue;
      const Eigen::Vector3d moved = seen(name).p - home.p;
      if (std::abs(moved.z()) < 0.5 || std::hypot(moved.x(), moved.y()) > 1e-3) continue;
      const kinematics::Coordinate& of = chain->coordinates()[static_cast<std::size_t>(at)];
      const double down = moved.z() * (of.lower.value_or(-kInfinity) - of.home);
      const double up = moved.z() * (of.upper.value_or(kInfinity) - of.home);
      out.nearest_mm += std::min(down, up);
      out.furthest_mm += std::max(down, up);
      out.closing.push_back(name);
    }
  }
  return out;
}

std::optional<double> Workshop::Reaches(const Way& part, const Way& tool) const {
  const Machine& chain = Chain(part, tool);
  for (const double distance : kTried_mm) {
    if (Stands(chain, {0.0, 0.0, distance})) return distance;
  }
  return std::nullopt;
}

const Way* Workshop::Reaches(const Way& part, const std::vector<Way>& carrier) const {
  const auto found = std::find_if(carrier.begin(), carrier.end(), [&](const Way& tool) {
    return Reaches(part, tool).has_value();
  });
  return found == carrier.end() ? nullptr : &*found;
}

std::vector<std::string> Workshop::Swings(const Way& part, const Way& tool) const {
  std::vector<std::string> out;
  for (const std::string& name : tool.moves) {
    const auto column = Columns(Chain(part, tool), {name}, true);
    if (column.cols() == 1 && std::hypot(column(3, 0), column(4, 0)) > 0.9) out.push_back(name);
  }
  return out;
}

std::vector<std::string> Workshop::SharedTravel(const Way& part, const Way& tool) const {
  const Machine& chain = Chain(part, tool);
  const Eigen::MatrixXd tools = Columns(chain, tool.moves, false).topRows<3>();
  std::vector<std::string> out;
  for (const std::string& name : part.moves) {
    const Eigen::MatrixXd one = Columns(chain, {name}, false).topRows<3>();
    if (one.cols() == 0) continue;
    Eigen::MatrixXd both(3, tools.cols() + 1);
    both << tools, one;
    if (RankOf(both) == RankOf(tools)) out.push_back(name);
  }
  return out;
}

int Workshop::ToolsOf(const Way& tool) const {
  const layout::End* end = machine_.layout().FindEnd(tool.end);
  const plugin::ModuleDescription* module = end == nullptr ? nullptr : registry_.Find(end->module);
  if (module == nullptr || !tool.Is(plugin::words::kManyTools)) return 1;
  // Stations of one kind count one set of tools: "front1", "front2", …
  std::set<std::string> stems;
  for (const std::string& station : module->stations) stems.insert(StemOf(station));
  const plugin::ParameterDescription* counter = module->FindParameter(module->counted_by);
  if (counter != nullptr)
    return static_cast<int>(end->parameters[static_cast<std::size_t>(counter->offset)]);
  return static_cast<int>(module->stations.size() / std::max<std::size_t>(1, stems.size()));
}

}  // namespace kompono::analysis
