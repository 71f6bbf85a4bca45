// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/pose_judge.hpp"

#include "mechanism_points.hpp"
#include "segments.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/layout/numbers.hpp"

namespace kompono::analysis {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::max();

void SetRanges(const Machine& machine,
               const Machine::BlockView& view,
               const VectorXd& theta,
               bool keep_ranges,
               PoseJudge::Mechanism& out) {
  for (std::size_t i = 0; i < view.description->drives.size(); ++i) {
    double lower = -kNoLimit;
    double upper = kNoLimit;
    const kinematics::Drive& drive =
        machine.drives()[static_cast<std::size_t>(view.first_drive) + i];
    if (keep_ranges) {
      const double zero = theta[machine.FindParameter(drive.name + ".zero")];
      const bool reversed = view.block->drives[i].sign < 0;
      const auto& from = reversed ? drive.upper : drive.lower;
      const auto& to = reversed ? drive.lower : drive.upper;
      if (from) lower = zero + (reversed ? -*from : *from);
      if (to) upper = zero + (reversed ? -*to : *to);
    }
    out.reversed.push_back(view.block->drives[i].sign < 0);
    out.lower.push_back(lower);
    out.upper.push_back(upper);
  }
}

/// The ends of the struts whose joints have a limit.
std::vector<PoseJudge::Joint> LimitedJoints(const MechanismPoints& at_home,
                                            const PoseJudge::Mechanism& mechanism,
                                            const std::vector<SwingLimit>& limits,
                                            std::vector<bool>& used) {
  std::vector<PoseJudge::Joint> out;
  for (const StrutEnds& strut : at_home.struts) {
    for (const auto& [at, other] : {std::pair(strut.from, strut.to), {strut.to, strut.from}}) {
      const auto point = static_cast<std::size_t>(at);
      const std::string name = mechanism.block + "." + mechanism.description->points[point];
      for (std::size_t i = 0; i < limits.size(); ++i) {
        if (!layout::MatchesPattern(limits[i].joint, name) ||
            at_home.body[point] == PointBody::kOther)
          continue;
        used[i] = true;
        PoseJudge::Joint joint{.at = at,
                               .other = other,
                               .on_platform = at_home.body[point] == PointBody::kPlatform,
                               .cosine = std::cos(limits[i].swing_rad),
                               .swing_rad = limits[i].swing_rad};
        joint.axis =
            (at_home.point[static_cast<std::size_t>(other)] - at_home.point[point]).normalized();
        if (joint.on_platform) joint.axis = at_home.platform.R.transpose() * joint.axis;
        out.push_back(joint);
      }
    }
  }
  return out;
}

/// Smallest distance between the struts' centre lines; none if it is not looked at.
std::optional<double> SmallestDistance(const layout::Block& block, const Limits& limits) {
  std::optional<double> radius = limits.strut_radius_mm;
  std::optional<double> clearance = limits.clearance_mm;
  if (limits.of_layout) {
    if (!radius && block.strut_diameter) radius = 0.5 * *block.strut_diameter;
    if (!clearance) clearance = block.clearance;
  }
  if (!radius && !clearance) return std::nullopt;
  return 2.0 * radius.value_or(0.0) + clearance.value_or(0.0);
}

/// Pairs of struts that do not share a joint.
std::vector<PoseJudge::StrutPair> Pairs(const MechanismPoints& at_home,
                                        const std::optional<double>& distance_mm) {
  std::vector<PoseJudge::StrutPair> out;
  if (!distance_mm) return out;
  const std::vector<StrutEnds>& struts = at_home.struts;
  for (std::size_t i = 0; i < struts.size(); ++i) {
    for (std::size_t j = i + 1; j < struts.size(); ++j) {
      if (at_home.ShareAJoint(struts[i], struts[j])) continue;
      out.push_back({.first = {struts[i].from, struts[i].to},
                     .second = {struts[j].from, struts[j].to},
                     .distance_mm = *distance_mm});
    }
  }
  return out;
}

void AddConstraints(const PoseJudge::Mechanism& mechanism,
                    const Machine& machine,
                    int first_drive,
                    int index,
                    std::vector<Constraint>& out) {
  using Kind = Constraint::Kind;
  const auto point = [&mechanism](int i) {
    return mechanism.block + "." + mechanism.description->points[static_cast<std::size_t>(i)];
  };
  for (std::size_t i = 0; i < mechanism.lower.size(); ++i) {
    const kinematics::Drive& drive = machine.drives()[static_cast<std::size_t>(first_drive) + i];
    const int row = static_cast<int>(i);
    out.push_back({Kind::kReach, drive.name + " out of reach", index, row});
    const bool swap = mechanism.reversed[i];  // its upper reading is its lower coordinate
    if (mechanism.lower[i] > -kNoLimit)
      out.push_back({Kind::kDriveLower,
                     drive.name + (swap ? " at its upper limit" : " at its lower limit"),
                     index,
                     row});
    if (mechanism.upper[i] < kNoLimit)
      out.push_back({Kind::kDriveUpper,
                     drive.name + (swap ? " at its lower limit" : " at its upper limit"),
                     index,
                     row});
  }
  for (std::size_t i = 0; i < mechanism.joints.size(); ++i) {
    out.push_back(
        {Kind::kSwing, "swing of " + point(mechanism.joints[i].at), index, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < mechanism.pairs.size(); ++i) {
    const PoseJudge::StrutPair& pair = mechanism.pairs[i];
    out.push_back({Kind::kClearance,
                   fmt::format("clearance of {} - {} and {} - {}",
                               point(pair.first[0]),
                               point(pair.first[1]),
                               point(pair.second[0]),
                               point(pair.second[1])),
                   index,
                   static_cast<int>(i)});
  }
}

Diagnostics UnknownJoints(const std::vector<SwingLimit>& limits,
                          const std::vector<bool>& used,
                          const std::vector<std::string>& names) {
  Diagnostics out;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    if (used[i]) continue;
    out.push_back({.code = "E0721",
                   .message = fmt::format("no strut has a joint '{}' on base, carriage or platform",
                                          limits[i].joint),
                   .help = DidYouMean(limits[i].joint, names, 12)});
  }
  return out;
}

}  // namespace

Parsed<PoseJudge> PoseJudge::Make(const Machine& machine,
                                  const VectorXd& theta,
                                  const Limits& limits) {
  PoseJudge judge;
  judge.machine_ = &machine;
  judge.theta_ = theta;
  judge.coordinate_count_ = machine.coordinates().size();
  std::vector<SwingLimit> swings = limits.swings;
  for (const layout::Block& block : machine.layout().blocks) {
    for (const layout::JointLimit& joint : block.joints) {
      if (limits.of_layout) swings.push_back({block.name + "." + joint.points, joint.swing});
    }
  }
  std::vector<bool> used(swings.size(), false);
  std::vector<std::string> names;
  for (const Machine::BlockView& view : machine.blocks()) {
    Mechanism mechanism = DescribeMechanism(view, theta);
    SetRanges(machine, view, theta, limits.of_layout, mechanism);
    const MechanismPoints at_home = PointsAt(mechanism, machine.home());
    for (const StrutEnds& strut : at_home.struts) {
      for (const int end : {strut.from, strut.to}) {
        if (at_home.body[static_cast<std::size_t>(end)] == PointBody::kOther) continue;
        names.push_back(mechanism.block + "." +
                        mechanism.description->points[static_cast<std::size_t>(end)]);
      }
    }
    mechanism.joints = LimitedJoints(at_home, mechanism, swings, used);
    mechanism.pairs = Pairs(at_home, SmallestDistance(*view.block, limits));
    AddConstraints(mechanism,
                   machine,
                   view.first_drive,
                   static_cast<int>(judge.mechanisms_.size()),
                   judge.constraints_);
    judge.mechanisms_.push_back(std::move(mechanism));
  }
  Diagnostics problems = UnknownJoints(swings, used, names);
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return judge;
}

std::vector<BrokenStrutLimit> BrokenStrutLimits(const PoseJudge& judge, const VectorXd& z) {
  using Kind = Constraint::Kind;
  std::vector<MechanismPoints> at;
  at.reserve(judge.mechanisms().size());
  for (const PoseJudge::Mechanism& mechanism : judge.mechanisms())
    at.push_back(PointsAt(mechanism, z));
  std::vector<BrokenStrutLimit> out;
  for (const Constraint& constraint : judge.constraints()) {
    const auto m = static_cast<std::size_t>(constraint.mechanism);
    const auto row = static_cast<std::size_t>(constraint.row);
    const auto point = [&here = at[m]](int i) -> const Eigen::Vector3d& {
      return here.point[static_cast<std::size_t>(i)];
    };
    if (constraint.kind == Kind::kSwing) {
      const PoseJudge::Joint& joint = judge.mechanisms()[m].joints[row];
      const Eigen::Vector3d axis =
          joint.on_platform ? Eigen::Vector3d(at[m].platform.R * joint.axis) : joint.axis;
      const Eigen::Vector3d strut = point(joint.other) - point(joint.at);
      const double swing = std::atan2(axis.cross(strut).norm(), axis.dot(strut));
      if (swing > joint.swing_rad) out.push_back({&constraint, swing, joint.swing_rad});
    } else if (constraint.kind == Kind::kClearance) {
      const PoseJudge::StrutPair& pair = judge.mechanisms()[m].pairs[row];
      const double distance = SegmentDistance(
          point(pair.first[0]), point(pair.first[1]), point(pair.second[0]), point(pair.second[1]));
      if (distance < pair.distance_mm) out.push_back({&constraint, distance, pair.distance_mm});
    }
  }
  return out;
}

}  // namespace kompono::analysis
