// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/freedoms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace kompono::analysis {
namespace {

using Eigen::Vector3d;
using Lines = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr std::size_t kMotions = 6;
constexpr const char* kLetters = "XYZABC";
constexpr double kSingular = 1e-9;  ///< smallest to largest singular value

struct StrutEnd {
  Vector3d joint_mm;  ///< seen from the tool point
  Vector3d direction;
};

/// The struts that end on the platform: one end is on a link of kind "platform" or is the tool.
std::vector<StrutEnd> StrutEnds(const kinematics::Machine::SkeletonView& skeleton,
                                const std::string& block) {
  std::map<std::string, Vector3d> place;
  for (const auto& point : skeleton.points) place[point.name] = point.p_M;
  const auto tool = place.find(block + ".tool");
  if (tool == place.end()) return {};
  std::set<std::string> platform{tool->first};
  for (const auto& link : skeleton.links) {
    if (link.kind == "platform") platform.insert({link.from, link.to});
  }
  std::vector<StrutEnd> ends;
  const std::string mine = block + ".";
  for (const auto& link : skeleton.links) {
    if (link.kind != "strut" || link.from.compare(0, mine.size(), mine) != 0) continue;
    const bool to = platform.count(link.to) > 0;
    if (to == (platform.count(link.from) > 0)) continue;
    const Vector3d joint = place.at(to ? link.to : link.from);
    const Vector3d foot = place.at(to ? link.from : link.to);
    ends.push_back({joint - tool->second, (joint - foot).normalized()});
  }
  return ends;
}

double RootMeanSquare(const std::vector<StrutEnd>& ends) {
  double sum = 0.0;
  for (const StrutEnd& end : ends) sum += end.joint_mm.squaredNorm();
  const double length = std::sqrt(sum / static_cast<double>(ends.size()));
  return length > 0.0 ? length : 1.0;  // all struts meet in the tool point: turns cannot be met
}

double Condition(const Eigen::MatrixXd& lines) {
  if (!lines.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(lines).singularValues();
  const double smallest = singular.minCoeff();
  const double largest = singular.maxCoeff();
  return smallest > kSingular * largest ? largest / smallest
                                        : std::numeric_limits<double>::infinity();
}

std::vector<FreedomChoice> Choices(const Lines& lines) {
  std::vector<FreedomChoice> choices;
  std::vector<bool> taken(kMotions, false);
  std::fill_n(taken.begin(), lines.rows(), true);
  do {
    FreedomChoice choice;
    Eigen::MatrixXd columns(lines.rows(), lines.rows());
    Eigen::Index at = 0;
    for (std::size_t k = 0; k < kMotions; ++k) {
      if (!taken[k]) continue;
      choice.letters += kLetters[k];
      columns.col(at++) = lines.col(static_cast<Eigen::Index>(k));
    }
    choice.condition = Condition(columns);
    choices.push_back(std::move(choice));
  } while (std::prev_permutation(taken.begin(), taken.end()));
  std::stable_sort(choices.begin(), choices.end(), [](const auto& a, const auto& b) {
    return a.condition < b.condition;
  });
  return choices;
}

}  // namespace

std::vector<BlockFreedoms> Freedoms(const kinematics::Machine& machine,
                                    const kinematics::VectorXd& z,
                                    std::optional<double> length_mm) {
  const kinematics::Machine::SkeletonView skeleton = machine.Skeleton(z, machine.nominal());
  std::vector<BlockFreedoms> out;
  for (const kinematics::Machine::BlockView& view : machine.blocks()) {
    const std::vector<StrutEnd> ends = StrutEnds(skeleton, view.block->name);
    BlockFreedoms block{.block = view.block->name,
                        .module = view.block->module,
                        .struts = static_cast<int>(ends.size())};
    if (!ends.empty() && ends.size() <= kMotions && block.struts == view.code->Shape().drives) {
      block.length_mm = length_mm.value_or(RootMeanSquare(ends));
      Lines lines(block.struts, 6);
      for (std::size_t i = 0; i < ends.size(); ++i) {
        lines.row(static_cast<Eigen::Index>(i)) << ends[i].direction.transpose(),
            ends[i].joint_mm.cross(ends[i].direction).transpose() / block.length_mm;
      }
      block.choices = Choices(lines);
    }
    out.push_back(std::move(block));
  }
  return out;
}

}  // namespace kompono::analysis
