// SPDX-License-Identifier: Apache-2.0
#include "null_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace kompono::calibration {

using kinematics::MeasuredPose;
using kinematics::Parameter;

namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kMoves = 1e-6;   ///< of what the parts alone would move
constexpr double kSlight = 0.01;  ///< parts below this share of the largest are not worth words
constexpr double kRadianLengthMm = 100.0;  ///< what a turn by a radian counts beside a motion
constexpr std::size_t kMostNamed = 6;
constexpr std::size_t kMostRows = 12;  ///< where further measurements are tried

/// "struts.base[3].x" -> "struts.base[*].x"
std::string WithoutIndex(const std::string& name) {
  const std::size_t open = name.find('[');
  const std::size_t close = name.find(']', open == std::string::npos ? 0 : open);
  if (open == std::string::npos || close == std::string::npos) return name;
  return name.substr(0, open + 1) + "*" + name.substr(close);
}

struct Part {
  std::string name;
  double value = 0.0;  ///< mm or deg
  bool angle = false;
  int count = 1;
};

/// Parts with equal changes whose names differ in the index only become one, if they are all that
/// the machine has.
std::vector<Part> Grouped(const std::vector<Parameter>& parameters, const Eigen::VectorXd& change) {
  std::map<std::string, int> of_pattern;
  for (const Parameter& parameter : parameters) ++of_pattern[WithoutIndex(parameter.name)];
  std::map<std::string, std::vector<Part>> groups;
  std::vector<std::string> order;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = change[static_cast<Eigen::Index>(i)];
    if (value == 0.0) continue;
    const std::string pattern = WithoutIndex(parameters[i].name);
    std::vector<Part>& group = groups[pattern];
    if (group.empty()) order.push_back(pattern);
    group.push_back({parameters[i].name,
                     parameters[i].angle ? value * kDegPerRad : value,
                     parameters[i].angle});
  }
  std::vector<Part> parts;
  for (const std::string& pattern : order) {
    const std::vector<Part>& group = groups[pattern];
    const bool all = group.size() > 1 && static_cast<int>(group.size()) == of_pattern[pattern];
    const bool equal = std::all_of(group.begin(), group.end(), [&group](const Part& part) {
      return std::abs(part.value - group.front().value) <= 1e-5 * std::abs(group.front().value);
    });
    if (all && equal) {
      parts.push_back(
          {pattern, group.front().value, group.front().angle, static_cast<int>(group.size())});
    } else {
      parts.insert(parts.end(), group.begin(), group.end());
    }
  }
  const auto indexed = [](const Part& part) { return part.name.find('[') != std::string::npos; };
  std::stable_partition(parts.begin(), parts.end(), std::not_fn(indexed));
  const double first = parts.empty() ? 1.0 : parts.front().value;
  for (Part& part : parts) part.value /= first;  // the first changes by 1 mm or 1 deg
  return parts;
}

/// "struts.base" of "struts.base[3].x"; frames and single numbers are their own family.
std::string Family(const std::string& name) {
  return name.substr(0, name.find('['));
}

std::string Families(const std::vector<Part>& parts) {
  std::vector<std::string> families;
  for (const Part& part : parts) {
    const std::string family = Family(part.name);
    if (std::find(families.begin(), families.end(), family) == families.end()) {
      families.push_back(family);
    }
  }
  if (families.size() > kMostNamed) {
    const std::size_t more = families.size() - kMostNamed;
    families.resize(kMostNamed);
    families.push_back(fmt::format("{} more", more));
  }
  const std::string last = families.back();
  families.pop_back();
  return families.empty() ? last : fmt::format("{} and {}", fmt::join(families, ", "), last);
}

std::string Changes(const std::vector<Part>& parts) {
  std::vector<std::string> changes;
  for (const Part& part : parts) {
    if (changes.size() == kMostNamed) {
      changes.push_back(fmt::format("and {} more numbers", parts.size() - kMostNamed));
      break;
    }
    changes.push_back(
        fmt::format("{} {:+.3g} {}", part.name, part.value, part.angle ? "deg" : "mm"));
  }
  return fmt::format("{}", fmt::join(changes, ", "));
}

std::string Words(const std::vector<Part>& parts) {
  if (parts.size() == 1 && parts[0].count == 1) {
    return fmt::format("{} has no effect on these measurements", parts[0].name);
  }
  if (parts.size() == 2 && parts[0].angle == parts[1].angle && parts[0].count == 1 &&
      parts[1].count == 1) {
    const double ratio = parts[1].value / parts[0].value;
    const double most = kSlight;
    if (std::abs(ratio + 1.0) < most || std::abs(ratio - 1.0) < most) {
      return fmt::format("{} and {} can only be told apart up to their {}",
                         parts[0].name,
                         parts[1].name,
                         ratio < 0.0 ? "sum" : "difference");
    }
  }
  return fmt::format("{} cannot be told apart: they may change together without any effect ({})",
                     Families(parts),
                     Changes(parts));
}

}  // namespace

void NullWords::Motion::Add(const MeasuredPose& pose, const Eigen::VectorXd& change) {
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  for (Eigen::Index i = 0; i < pose.by_parameters.cols(); ++i) {
    if (change[i] == 0.0) continue;
    const Eigen::Matrix<double, 6, 1> part = pose.by_parameters.col(i) * change[i];
    twist += part;
    v_parts = std::max(v_parts, part.head<3>().norm());
    w_parts = std::max(w_parts, part.tail<3>().norm());
  }
  v = v.cwiseMax(twist.head<3>().cwiseAbs());
  w = w.cwiseMax(twist.tail<3>().cwiseAbs());
}

bool NullWords::Motion::Moves(int axis) const {
  return v_parts > 1e-12 && v[axis] > kMoves * v_parts;
}

bool NullWords::Motion::Turns() const {
  return w_parts > 1e-15 && w.maxCoeff() > kMoves * w_parts;
}

NullWords::NullWords(const kinematics::Machine& machine,
                     const std::vector<Parameter>& parameters,
                     const std::vector<RowModel*>& rows,
                     const Eigen::VectorXd& theta)
    : machine_(machine), parameters_(parameters), rows_(rows), theta_(theta) {
  for (const RowModel* row : rows) {
    RowModel::Prediction prediction = row->Predict(theta, true);
    if (!prediction.ok()) continue;
    poses_.push_back(std::move(prediction.first));
    if (row->measurement().second_readings.size() > 0) {
      poses_.push_back(std::move(prediction.second));
    }
  }
  FindStillDrives();
  elsewhere_ = Shifted(std::vector<bool>(machine.drives().size(), true));
}

void NullWords::FindStillDrives() {
  const std::size_t count = machine_.drives().size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const bool still = std::all_of(rows_.begin(), rows_.end(), [this, k](const RowModel* row) {
      return std::abs(row->measurement().readings[k] - rows_.front()->measurement().readings[k]) <
             1e-9;
    });
    if (!still) continue;
    std::vector<bool> one(count, false);
    one[i] = true;
    still_.push_back({machine_.drives()[i].name, Shifted(one)});
  }
}

NullDirection NullWords::Describe(const Eigen::VectorXd& change) const {
  NullDirection direction;
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (change[i] == 0.0) continue;
    direction.parts.emplace_back(parameters_[static_cast<std::size_t>(i)].name, change[i]);
  }
  const Eigen::VectorXd essential = Essential(change);
  const std::vector<Part> parts = Grouped(parameters_, essential);
  direction.words = Words(parts);
  const bool single = (essential.array() != 0.0).count() == 1;
  const std::string measure = Remedy(change);
  if (!measure.empty()) {
    direction.remedy = (single ? "lock it, or " : "lock one of them, or ") + measure;
  } else if (single) {
    direction.remedy = "lock it; no measurement of this tool can see it";
  } else {
    direction.remedy = "lock one of them; no measurement of this tool can tell them apart";
  }
  return direction;
}

Eigen::VectorXd NullWords::Essential(const Eigen::VectorXd& change) const {
  Eigen::VectorXd effect = Eigen::VectorXd::Zero(change.size());
  for (const MeasuredPose& pose : poses_) {
    for (Eigen::Index i = 0; i < pose.by_parameters.cols(); ++i) {
      if (change[i] == 0.0) continue;
      const Eigen::Matrix<double, 6, 1> part = pose.by_parameters.col(i) * change[i];
      effect[i] =
          std::max(effect[i], part.head<3>().norm() + kRadianLengthMm * part.tail<3>().norm());
    }
  }
  const double largest = effect.maxCoeff();
  if (largest == 0.0) return change;
  // Fixtures do not move the tool; theirs count as they are.
  for (auto i = static_cast<Eigen::Index>(machine_.parameters().size()); i < change.size(); ++i) {
    const bool angle = parameters_[static_cast<std::size_t>(i)].angle;
    effect[i] = std::abs(change[i]) * (angle ? kRadianLengthMm : 1.0);
  }
  return (effect.array() < kSlight * largest).select(0.0, change);
}

std::string NullWords::Remedy(const Eigen::VectorXd& change) const {
  const Motion here = MotionAt(poses_, change);
  constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
  std::vector<std::string_view> moved;
  for (int i = 0; i < 3; ++i) {
    if (here.Moves(i)) moved.push_back(kAxes[static_cast<std::size_t>(i)]);
  }
  if (!moved.empty()) {
    return fmt::format("measure the tool point's {} as well", fmt::join(moved, ", "));
  }
  if (here.Turns()) return "measure the tool's orientation as well (poses)";
  // Moving a drive that stood still in all rows is the usual way out.
  for (const StillDrive& drive : still_) {
    if (MotionAt(drive.moved, change).Any()) {
      return fmt::format("measure at other positions of {} too", drive.name);
    }
  }
  if (MotionAt(elsewhere_, change).Any()) {
    return "measure at more and more different places and orientations";
  }
  return {};
}

NullWords::Motion NullWords::MotionAt(const std::vector<MeasuredPose>& poses,
                                      const Eigen::VectorXd& change) const {
  Motion motion;
  for (const MeasuredPose& pose : poses) motion.Add(pose, change);
  return motion;
}

std::vector<MeasuredPose> NullWords::Shifted(const std::vector<bool>& drives) const {
  constexpr std::array<double, 6> kPattern{1.0, -0.6, 0.35, -0.85, 0.5, -0.2};
  std::vector<MeasuredPose> poses;
  const std::size_t stride = rows_.size() / kMostRows + 1;
  for (std::size_t i = 0; i < rows_.size(); i += stride) {
    Eigen::VectorXd readings = rows_[i]->measurement().readings;
    for (std::size_t k = 0; k < drives.size(); ++k) {
      const double step = machine_.drives()[k].rotary ? 0.1 : 10.0;
      if (drives[k]) {
        readings[static_cast<Eigen::Index>(k)] += step * kPattern[(k + i) % kPattern.size()];
      }
    }
    MeasuredPose pose =
        machine_.Measure(readings,
                         theta_.head(static_cast<Eigen::Index>(machine_.parameters().size())),
                         rows_[i]->start(),
                         true);
    if (pose.status == kinematics::SolveStatus::kConverged) poses.push_back(std::move(pose));
  }
  return poses;
}

}  // namespace kompono::calibration
