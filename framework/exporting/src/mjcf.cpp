// SPDX-License-Identifier: Apache-2.0
#include "kompono/exporting/mjcf.hpp"

#include "mechanism_parts.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include <Eigen/Geometry>

namespace kompono::exporting {
namespace {

using kinematics::Machine;
using kinematics::VectorXd;
using Carrier = PointPart::Carrier;

constexpr std::string_view kUnitMass = R"(<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>)";

std::string Numbers(const Vector3<double>& v) {
  return fmt::format("{} {} {}", v[0], v[1], v[2]);
}

/// Attribute values: the five characters that XML keeps for itself.
std::string Escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Writes one mechanism.
class Writer {
 public:
  explicit Writer(const MechanismParts& parts)
      : parts_(parts), block_(parts.view->block->name), thick_(Thickness()) {}

  void Bodies(std::string& out) const {
    out += fmt::format("    <!-- {}: {} -->\n", block_, parts_.view->block->module);
    for (const CrankPart& crank : parts_.cranks) Crank(crank, out);
    for (std::size_t i = 0; i < parts_.points.size(); ++i) {
      const bool crank =
          std::any_of(parts_.cranks.begin(), parts_.cranks.end(), [i](const CrankPart& c) {
            return c.end == static_cast<int>(i);
          });
      if (parts_.points[i].carrier == Carrier::kDrive && !crank) Carriage(i, out);
    }
    for (const StrutPart& strut : parts_.struts) {
      if (Point(strut.from).carrier == Carrier::kBase) Strut(strut, Point(strut.from).p_B, 4, out);
    }
    Platform(out);
  }

  void Connections(std::string& out) const {
    for (const StrutPart& strut : parts_.struts) {
      const PointPart& end = Point(strut.to);
      const bool pod = strut.drive >= 0;
      const Vector3<double> anchor =
          pod ? Vector3<double>::Zero().eval() : Vector3<double>(end.p_B - Point(strut.from).p_B);
      Connection(strut, anchor, out);
      if (end.carrier != Carrier::kRing) continue;
      // A pin along the ring holds the strut in the plane of the ring's axis: a second point of it.
      const Vector3<double> arm = end.p_B - Point(end.ring).p_B;
      const Vector3<double> along = (parts_.X_BP.R * end.ring_axis).cross(arm).normalized();
      Connection(strut, anchor + 10.0 * thick_ * along, out);
    }
  }

 private:
  void Connection(const StrutPart& strut, const Vector3<double>& anchor, std::string& out) const {
    out += fmt::format("    <connect body1=\"{}{}\" body2=\"{}\" anchor=\"{}\"/>\n",
                       StrutName(strut),
                       strut.drive >= 0 ? ".end" : "",
                       Point(strut.to).carrier == Carrier::kRing ? block_ + "." + Name(strut.to)
                                                                 : block_ + ".platform",
                       Numbers(anchor));
  }

  [[nodiscard]] const PointPart& Point(int i) const {
    return parts_.points[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const std::string& Name(int point) const {
    return parts_.view->description->points[static_cast<std::size_t>(point)];
  }
  [[nodiscard]] std::string DriveName(int drive) const {
    return block_ + "." + parts_.view->description->drives[static_cast<std::size_t>(drive)].name;
  }
  [[nodiscard]] std::string StrutName(const StrutPart& strut) const {
    return fmt::format("{}.{}-{}", block_, Name(strut.from), Name(strut.to));
  }
  [[nodiscard]] double Thickness() const {
    double size = 0.0;
    for (const PointPart& point : parts_.points) {
      size = std::max(size, (point.p_B - parts_.points[0].p_B).norm());
    }
    return 0.008 * size;
  }
  [[nodiscard]] std::string Capsule(const Vector3<double>& to) const {
    return fmt::format(
        R"(<geom type="capsule" fromto="0 0 0 {}" size="{}" contype="0" conaffinity="0"/>)",
        Numbers(to),
        thick_);
  }

  void Carriage(std::size_t point, std::string& out) const {
    const PointPart& part = parts_.points[point];
    out += fmt::format(
        "    <body name=\"{}.{}\" pos=\"{}\">\n"
        "      <joint name=\"{}\" type=\"slide\" axis=\"{}\" ref=\"{}\"/>\n      {}\n"
        "      <geom type=\"box\" size=\"{} {} {}\" contype=\"0\" conaffinity=\"0\"/>\n",
        block_,
        Name(static_cast<int>(point)),
        Numbers(part.p_B),
        DriveName(part.drive),
        Numbers(part.by_drive),
        parts_.q[part.drive],
        kUnitMass,
        2.0 * thick_,
        2.0 * thick_,
        2.0 * thick_);
    StrutsFrom(static_cast<int>(point), Vector3<double>::Zero(), out);
    out += "    </body>\n";
  }

  /// Turns about the axis that is square to the arm and to its velocity.
  void Crank(const CrankPart& crank, std::string& out) const {
    const Vector3<double> arm = Point(crank.end).p_B - Point(crank.hinge).p_B;
    const Vector3<double> axis = arm.cross(Point(crank.end).by_drive);
    out += fmt::format(
        "    <body name=\"{}.{}\" pos=\"{}\">\n"
        "      <joint name=\"{}\" type=\"hinge\" axis=\"{}\" ref=\"{}\"/>\n      {}\n      {}\n",
        block_,
        Name(crank.end),
        Numbers(Point(crank.hinge).p_B),
        DriveName(crank.drive),
        Numbers(axis),
        parts_.q[crank.drive],
        kUnitMass,
        Capsule(arm));
    StrutsFrom(crank.end, arm, out);
    out += "    </body>\n";
  }

  void StrutsFrom(int point, const Vector3<double>& place, std::string& out) const {
    for (const StrutPart& strut : parts_.struts) {
      if (strut.from == point) Strut(strut, place, 6, out);
    }
  }

  void Strut(const StrutPart& strut,
             const Vector3<double>& place,
             std::size_t indent,
             std::string& out) const {
    const Vector3<double> span = Point(strut.to).p_B - Point(strut.from).p_B;
    const std::string margin(indent, ' ');
    const std::string name = StrutName(strut);
    out +=
        fmt::format("{}<body name=\"{}\" pos=\"{}\">\n{}  {}\n",
                    margin,
                    name,
                    Numbers(place),
                    margin,
                    strut.hinge ? fmt::format(R"(<joint name="{}.hinge" type="hinge" axis="{}"/>)",
                                              name,
                                              Numbers(*strut.hinge))
                                : fmt::format(R"(<joint name="{}.ball" type="ball"/>)", name));
    if (strut.drive < 0) {
      out += fmt::format("{}  {}\n{}  {}\n", margin, kUnitMass, margin, Capsule(span));
    } else {
      const Vector3<double> half = 0.5 * span;
      out += fmt::format(
          "{0}  {1}\n{0}  {2}\n"
          "{0}  <body name=\"{3}.end\" pos=\"{4}\">\n"
          "{0}    <joint name=\"{5}\" type=\"slide\" axis=\"{4}\" ref=\"{6}\"/>\n"
          "{0}    {1}\n{0}    {7}\n{0}  </body>\n",
          margin,
          kUnitMass,
          Capsule(half),
          name,
          Numbers(span),
          DriveName(strut.drive),
          parts_.q[strut.drive],
          Capsule(-half));
    }
    out += margin + "</body>\n";
  }

  void Platform(std::string& out) const {
    const Eigen::Quaterniond turn(parts_.X_BP.R);
    out += fmt::format("    <body name=\"{}.platform\" pos=\"{}\" quat=\"{} {} {} {}\">\n",
                       block_,
                       Numbers(parts_.X_BP.p),
                       turn.w(),
                       turn.x(),
                       turn.y(),
                       turn.z());
    Freedoms(out);
    out += fmt::format("      {}\n", kUnitMass);
    for (std::size_t i = 0; i < parts_.points.size(); ++i) {
      const PointPart& part = parts_.points[i];
      const Vector3<double> at = parts_.X_BP.Inverse() * part.p_B;
      if (part.carrier == Carrier::kPlatform && at.norm() > thick_) {
        out += fmt::format("      {}\n", Capsule(at));
      }
      if (part.carrier != Carrier::kRing) continue;
      const Vector3<double> centre = parts_.X_BP.Inverse() * Point(part.ring).p_B;
      out += fmt::format(
          "      <body name=\"{}.{}\" pos=\"{}\">\n"
          "        <joint name=\"{}.{}.turn\" type=\"hinge\" axis=\"{}\"/>\n        {}\n        "
          "{}\n"
          "      </body>\n",
          block_,
          Name(static_cast<int>(i)),
          Numbers(centre),
          block_,
          Name(static_cast<int>(i)),
          Numbers(part.ring_axis),
          kUnitMass,
          Capsule(at - centre));
    }
    out += "    </body>\n";
  }

  /// A joint's axis is fixed to what the joints before it have moved, and is given in the platform
  /// as it stands at home.
  void Freedoms(std::string& out) const {
    const std::string& letters = parts_.view->description->letters;
    if (parts_.free_platform) {
      out += fmt::format("      <joint name=\"{}.platform\" type=\"free\"/>\n", block_);
      return;
    }
    if (parts_.tube) {
      Swings(*parts_.tube, out);
      return;
    }
    Matrix3<double> R_so_far = Matrix3<double>::Identity();
    for (std::size_t i = 0; i < letters.size(); ++i) {
      const double at = parts_.x[static_cast<Eigen::Index>(i)];
      const Vector3<double> axis =
          parts_.X_BP.R.transpose() * R_so_far * Vector3<double>::Unit(AxisOfLetter(letters[i]));
      const bool turns = IsRotaryLetter(letters[i]);
      out += fmt::format("      <joint name=\"{}.{}\" type=\"{}\" axis=\"{}\" ref=\"{}\"/>\n",
                         block_,
                         letters[i],
                         turns ? "hinge" : "slide",
                         Numbers(axis),
                         at);
      if (turns) R_so_far = R_so_far * LetterMotion(letters[i], at).R;
    }
  }

  /// The tube of the platform swings in its collar and slides through it.
  void Swings(const TubePart& tube, std::string& out) const {
    const Vector3<double> collar = parts_.X_BP.Inverse() * Point(tube.collar).p_B;
    const auto joint = [&](std::string_view name, const char* type, const Vector3<double>& axis) {
      out += fmt::format("      <joint name=\"{}.{}.{}\" type=\"{}\" pos=\"{}\" axis=\"{}\"/>\n",
                         block_,
                         Name(tube.collar),
                         name,
                         type,
                         Numbers(collar),
                         Numbers(axis));
    };
    joint("first", "hinge", parts_.X_BP.R.transpose() * tube.first_B);
    joint("second", "hinge", tube.second_P);
    joint("slide", "slide", tube.along_P);
    out += fmt::format("      {}\n", Capsule(collar));
  }

  const MechanismParts& parts_;
  const std::string& block_;
  double thick_;
};

}  // namespace

Parsed<std::string> Mjcf(const Machine& machine, const VectorXd& theta) {
  const std::vector<Machine::BlockView> views = machine.blocks();
  Diagnostics problems;
  std::string bodies;
  std::string connections;
  for (const Machine::BlockView& view : views) {
    const Parsed<MechanismParts> parts = PartsOf(machine, view, theta);
    if (!parts) {
      problems.insert(problems.end(), parts.error().begin(), parts.error().end());
      continue;
    }
    const Writer writer(*parts);
    writer.Bodies(bodies);
    writer.Connections(connections);
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return fmt::format(
      "<!-- The mechanisms of a kompono layout at home, each in its own base. Millimetres, "
      "radians;\n"
      "     drives count from the mechanism's own zero. -->\n"
      "<mujoco model=\"{}\">\n"
      "  <compiler angle=\"radian\" coordinate=\"local\" inertiafromgeom=\"false\"/>\n"
      "  <option gravity=\"0 0 0\"><flag contact=\"disable\"/></option>\n"
      "  <worldbody>\n{}  </worldbody>\n  <equality>\n{}  </equality>\n</mujoco>\n",
      Escaped(machine.layout().name),
      bodies,
      connections);
}

}  // namespace kompono::exporting
