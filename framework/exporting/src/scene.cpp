// SPDX-License-Identifier: Apache-2.0
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "kompono/geometry/pose.hpp"
#include "kompono/kinematics/branches.hpp"

namespace kompono::exporting {
namespace {

using kinematics::Machine;
using kinematics::VectorXd;
using Form = Shape::Form;
using Frame = Machine::FrameView;

/// Points on a circle about z of the frame.
std::vector<Eigen::Vector3d> Ring(const Pose<double>& X, double radius, double height) {
  constexpr int kCorners = 32;
  std::vector<Eigen::Vector3d> ring;
  for (int i = 0; i < kCorners; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kCorners;
    ring.push_back(X * Eigen::Vector3d(radius * std::cos(a), radius * std::sin(a), height));
  }
  return ring;
}

std::vector<Eigen::Vector3d> Box(const Pose<double>& X, double half, double low, double high) {
  std::vector<Eigen::Vector3d> corners;
  for (const double h : {low, high}) {
    for (const auto& [sx, sy] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
      corners.push_back(X * Eigen::Vector3d(sx * half, sy * half, h));
  }
  return corners;
}

class SceneBuilder {
 public:
  SceneBuilder(const Machine& machine, const VectorXd& z, const VectorXd& theta)
      : machine_(machine), z_(z), theta_(theta) {}

  Scene Build() {
    for (const kinematics::Branch& branch : kinematics::Branches(machine_))
      CollectChain(branch.chain);
    Measure();
    AddMechanisms();
    for (const auto& [name, chain] : ends_) AddEnd(chain);
    return std::move(scene_);
  }

 private:
  /// One end with the frames of its own side, from the base outward; the end is the last.
  using Outward = std::vector<Frame>;

  void CollectChain(const Machine& chain) {
    const VectorXd z = kinematics::CoordinatesOn(chain, machine_, z_);
    Machine::SkeletonView skeleton = chain.Skeleton(z, theta_);
    for (auto& point : skeleton.points) points_.emplace(point.name, point.p_M);
    for (auto& link : skeleton.links) {
      if (seen_.insert(link.from + " " + link.to + " " + link.kind).second) links_.push_back(link);
    }
    Sample(chain, z);
    std::map<bool, Outward> sides;
    for (Frame& frame : chain.Frames(z, theta_)) {
      const bool side = frame.workpiece_side;
      sides[side].push_back(std::move(frame));
    }
    for (auto& [side, outward] : sides) {
      if (!outward.empty() && outward.back().kind == Frame::Kind::kEnd)
        ends_.emplace(outward.back().name, std::move(outward));
    }
  }

  /// Points of the skeletons at poses a little to all sides: they tell how rails run and which
  /// struts change their length.
  void Sample(const Machine& chain, const VectorXd& z) {
    Eigen::AlignedBox3d box;
    for (const auto& [name, p] : points_) box.extend(p);
    const double length = points_.empty() ? 0.0 : 0.08 * box.diagonal().norm();
    for (std::size_t i = 0; i < chain.coordinates().size(); ++i) {
      for (const double sign : {-1.0, 1.0}) {
        VectorXd moved = z;
        moved[static_cast<Eigen::Index>(i)] +=
            sign * (chain.coordinates()[i].rotary ? 0.1 : length);
        const std::vector<Machine::SkeletonPoint> points = chain.Skeleton(moved, theta_).points;
        if (!std::all_of(points.begin(), points.end(), [](const auto& point) {
              return point.p_M.allFinite();
            })) {
          continue;  // out of reach
        }
        for (const auto& point : points) samples_[point.name].push_back(point.p_M);
      }
    }
  }

  [[nodiscard]] bool ChangesLength(const Machine::SkeletonLink& link) const {
    const auto from = samples_.find(link.from);
    const auto to = samples_.find(link.to);
    if (from == samples_.end() || to == samples_.end()) return false;
    const double now = (points_.at(link.from) - points_.at(link.to)).norm();
    for (std::size_t i = 0; i < std::min(from->second.size(), to->second.size()); ++i) {
      if (std::abs((from->second[i] - to->second[i]).norm() - now) > 1e-6 * now) return true;
    }
    return false;
  }

  /// From end to end of what the carriage passes in the samples, and a little more.
  [[nodiscard]] std::vector<Eigen::Vector3d> Rail(const Machine::SkeletonLink& link) const {
    std::vector<Eigen::Vector3d> passed{points_.at(link.from), points_.at(link.to)};
    for (const std::string& end : {link.from, link.to}) {
      const auto found = samples_.find(end);
      if (found != samples_.end())
        passed.insert(passed.end(), found->second.begin(), found->second.end());
    }
    // The pair of points furthest apart, from one end to the other.
    const auto furthest = [&passed](const Eigen::Vector3d& from) {
      return *std::max_element(passed.begin(), passed.end(), [&from](const auto& a, const auto& b) {
        return (a - from).norm() < (b - from).norm();
      });
    };
    const Eigen::Vector3d one = furthest(passed.front());
    const Eigen::Vector3d other = furthest(one);
    const Eigen::Vector3d beyond = 0.12 * (other - one);
    return {one - beyond, other + beyond};
  }

  void Measure() {
    Eigen::AlignedBox3d box;
    for (const auto& [name, p] : points_) {
      scene_.joints.push_back(p);
      box.extend(p);
    }
    for (const auto& [name, outward] : ends_) {
      box.extend(outward.back().X_MC.p);
      if (outward.back().X_MF.p.allFinite()) box.extend(outward.back().X_MF.p);
      for (const Pose<double>& station : outward.back().stations) box.extend(station.p);
    }
    scene_.size_mm = std::max(1e-3, box.diagonal().norm());
    // A horizontal spindle along z of the base lays the machine down: y is then up.
    for (const auto& [name, outward] : ends_) {
      for (const Frame& frame : outward) {
        if (frame.kind == Frame::Kind::kAxis && LiesAlongZ(frame))
          scene_.axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
      }
    }
  }

  [[nodiscard]] bool LiesAlongZ(const Frame& frame) const {
    const std::vector<formula::Axis> axes = formula::AxesOf(machine_.layout().formula);
    return std::any_of(axes.begin(), axes.end(), [&frame](const formula::Axis& axis) {
      return axis.Name() == frame.name && axis.orientation == formula::Orientation::kHorizontal &&
             std::abs(frame.X_MC.R.col(AxisOfLetter(axis.letter)).z()) > 0.9;
    });
  }

  void Add(Form form,
           std::string kind,
           std::vector<Eigen::Vector3d> points,
           int layer = 0,
           std::string text = "") {
    scene_.shapes.push_back({.form = form,
                             .kind = std::move(kind),
                             .points = std::move(points),
                             .text = std::move(text),
                             .layer = layer});
  }

  void AddMechanisms() {
    std::map<std::string, std::set<std::string>> plates;  // block -> points of its platform
    std::map<std::string, std::set<std::string>> struts;
    std::map<std::string, int> touched;  ///< how many lines of the platform meet in a point
    std::set<std::string> on_rail;
    for (const Machine::SkeletonLink& link : links_) {
      const auto from = points_.find(link.from);
      const auto to = points_.find(link.to);
      if (from == points_.end() || to == points_.end()) continue;
      const std::string block = link.from.substr(0, link.from.find('.'));
      std::vector<Eigen::Vector3d> line{from->second, to->second};
      if (link.kind == "rail") {
        line = Rail(link);
        on_rail.insert({link.from, link.to});
      } else if (link.kind == "strut") {
        struts[block].insert({link.from, link.to});
        if (ChangesLength(link))
          Add(Form::kLine, "cylinder", {line[0], line[0] + 0.55 * (line[1] - line[0])});
      } else if (link.kind == "platform") {
        ++touched[link.from];
        ++touched[link.to];
        plates[block].insert({link.from, link.to});
      }
      Add(Form::kLine, link.kind, std::move(line));
    }
    for (const auto& [block, names] : plates) {
      std::set<std::string> corners;  // a single line stands on the plate
      std::copy_if(names.begin(),
                   names.end(),
                   std::inserter(corners, corners.end()),
                   [&touched](const std::string& name) { return touched[name] > 1; });
      AddPlate("plate", corners, 0);
    }
    for (const auto& [block, names] : struts) {
      std::set<std::string> feet;
      for (const std::string& name : names) {
        if (!on_rail.contains(name) && !plates[block].contains(name) && Stands(name))
          feet.insert(name);
      }
      AddPlate("foundation", feet, -2);
    }
    std::set<std::string> all_struts;
    for (const auto& [block, names] : struts) all_struts.insert(names.begin(), names.end());
    for (const auto& [name, p] : points_) {
      if (on_rail.contains(name) && !all_struts.contains(name)) continue;  // a rail's mark
      const char* kind = on_rail.contains(name) ? "carriage" : "joint";
      Add(Form::kDot,
          name.ends_with(".tool") ? "tool" : kind,
          {p},
          1,
          name.substr(name.rfind('.') + 1));
    }
  }

  /// Whether a point is the same in all samples: a foot on the base.
  [[nodiscard]] bool Stands(const std::string& name) const {
    const auto found = samples_.find(name);
    return found == samples_.end() ||
           std::all_of(found->second.begin(), found->second.end(), [&](const auto& p) {
             return (p - points_.at(name)).norm() < 1e-9 * scene_.size_mm;
           });
  }

  void AddPlate(const std::string& kind, const std::set<std::string>& names, int layer) {
    std::vector<Eigen::Vector3d> corners;
    corners.reserve(names.size());
    for (const std::string& name : names) corners.push_back(points_.at(name));
    if (corners.size() > 2) Add(Form::kBody, kind, std::move(corners), layer);
  }

  [[nodiscard]] bool TurnsPart(const Outward& outward) const {
    return std::any_of(outward.begin(), outward.end(), [this](const Frame& frame) {
      if (frame.kind != Frame::Kind::kAxis) return false;
      const layout::Axis* axis = machine_.layout().FindAxis(frame.name);
      return axis != nullptr && axis->main_motion;
    });
  }

  void AddEnd(const Outward& outward) {
    const Frame& end = outward.back();
    if (!end.X_MC.p.allFinite() || !end.X_MF.p.allFinite()) return;
    AddArm(outward);
    if (!end.workpiece_side) {
      if (end.stations.size() > 1) {
        AddTurret(end);
      } else {
        AddTool(end);
      }
    } else if (TurnsPart(outward)) {
      AddChuck(end);
    } else if (end.X_MC.R.col(2).dot(end.X_MF.R.col(2)) < -0.5) {
      AddTool(end);  // a centre that looks back
    } else {
      AddTable(end);
    }
    AddAxes(outward);
    Add(Form::kName, "name", {end.X_MF.p}, 3, end.name);
  }

  /// What holds the end: a line from the platform it stands on.
  void AddArm(const Outward& outward) {
    for (auto frame = outward.rbegin(); frame != outward.rend(); ++frame) {
      if (frame->kind != Frame::Kind::kMechanism) continue;
      if ((frame->X_MF.p - outward.back().X_MC.p).norm() > 1e-6)
        Add(Form::kLine, "arm", {frame->X_MF.p, outward.back().X_MC.p});
      return;
    }
  }

  /// Thick at the base, pointed at the tip.
  void AddTool(const Frame& end) {
    const Eigen::Vector3d along = end.X_MF.p - end.X_MC.p;
    if (along.norm() < 1e-9) {
      Add(Form::kDot, "tip", {end.X_MF.p}, 2);
      return;
    }
    Pose<double> X = end.X_MC;
    X.R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
    const double thick = std::min(0.022 * scene_.size_mm, 0.25 * along.norm());
    std::vector<Eigen::Vector3d> body = Ring(X, thick, 0.0);
    const std::vector<Eigen::Vector3d> waist = Ring(X, thick, 0.6 * along.norm());
    body.insert(body.end(), waist.begin(), waist.end());
    body.push_back(end.X_MF.p);
    Add(Form::kBody, "cutter", std::move(body), 1);
    Add(Form::kDot, "tip", {end.X_MF.p}, 2);
  }

  /// A body round the disc, a spoke to every tip; stations of two discs lie at two heights.
  void AddTurret(const Frame& end) {
    std::map<long, std::vector<Eigen::Vector3d>> discs;
    for (const Pose<double>& station : end.stations) {
      const double height = (end.X_MC.Inverse() * station.p).z();
      discs[std::lround(height * 1e3)].push_back(station.p);
    }
    const Eigen::Vector3d thick = 0.012 * scene_.size_mm * end.X_MC.R.col(2);
    for (const auto& [height, tips] : discs) {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& tip : tips) centre += tip / static_cast<double>(tips.size());
      std::vector<Eigen::Vector3d> body;
      std::vector<Eigen::Vector3d> face;
      for (const Eigen::Vector3d& tip : tips) {
        const Eigen::Vector3d rim = centre + 0.7 * (tip - centre);
        body.insert(body.end(), {rim - thick, rim + thick});
        face.push_back(rim - thick);
        Add(Form::kLine, "pocket", {centre + 0.6 * (tip - centre), tip}, 1);
      }
      Add(Form::kBody, "disc", std::move(body), 1);
      Add(Form::kBody, "disc-face", std::move(face), 1);
    }
    Add(Form::kDot, "tip", {end.X_MF.p}, 2);
  }

  /// The chuck behind the stop and a bar before it.
  void AddChuck(const Frame& end) {
    const double radius = 0.035 * scene_.size_mm;
    std::vector<Eigen::Vector3d> chuck = Ring(end.X_MF, 1.8 * radius, 0.0);
    const double depth = -std::max(2.0 * radius, (end.X_MF.p - end.X_MC.p).norm());
    const std::vector<Eigen::Vector3d> back = Ring(end.X_MF, 1.8 * radius, depth);
    chuck.insert(chuck.end(), back.begin(), back.end());
    Add(Form::kBody, "holder", std::move(chuck));
    std::vector<Eigen::Vector3d> bar = Ring(end.X_MF, 0.8 * radius, 0.0);
    const std::vector<Eigen::Vector3d> face = Ring(end.X_MF, 0.8 * radius, 4.0 * radius);
    bar.insert(bar.end(), face.begin(), face.end());
    Add(Form::kBody, "part", std::move(bar), 1);
  }

  /// A plate under the datum.
  void AddTable(const Frame& end) {
    const double half = 0.09 * scene_.size_mm;
    Add(Form::kBody, "part", Box(end.X_MF, half, -0.25 * half, 0.0), -1);
    Add(Form::kBody, "part-face", Box(end.X_MF, half, 0.0, 0.0), -1);
  }

  /// Plain axes as arrows at the end they carry, turns as arcs about their own axes.
  void AddAxes(const Outward& outward) {
    for (const Frame& frame : outward) {
      if (frame.kind != Frame::Kind::kAxis || !drawn_.insert(frame.name).second) continue;
      const layout::Axis* axis = machine_.layout().FindAxis(frame.name);
      if (axis == nullptr) continue;
      const Eigen::Vector3d along = frame.X_MC.R.col(AxisOfLetter(axis->letter));
      // A main motion turns the end itself; other turns have an axis of their own.
      const bool own =
          IsRotaryLetter(axis->letter) ? !axis->main_motion : frame.X_MC.p.norm() > 1e-9;
      const Eigen::Vector3d& foot = own ? frame.X_MC.p : outward.back().X_MC.p;
      const double length = 0.12 * scene_.size_mm;
      Add(IsRotaryLetter(axis->letter) ? Form::kArc : Form::kArrow,
          "axis",
          {foot, foot + length * along},
          2,
          frame.name);
    }
  }

  const Machine& machine_;
  const VectorXd& z_;
  const VectorXd& theta_;
  Scene scene_;
  std::map<std::string, Eigen::Vector3d> points_;
  std::map<std::string, std::vector<Eigen::Vector3d>> samples_;
  std::vector<Machine::SkeletonLink> links_;
  std::set<std::string> seen_, drawn_;
  std::map<std::string, Outward> ends_;
};

}  // namespace

Scene SceneOf(const Machine& machine, const VectorXd& z, const VectorXd& theta) {
  return SceneBuilder(machine, z, theta).Build();
}

}  // namespace kompono::exporting
