// SPDX-License-Identifier: Apache-2.0
#include "mechanism_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <Eigen/SVD>

namespace kompono::exporting {
namespace {

using kinematics::Machine;
using kinematics::VectorXd;
using plugin::Quantity;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kStill = 1e-9;  ///< of the size: what does not move

/// The mechanism at one place.
struct Sample {
  VectorXd x, q;
  Pose<double> X_BP;
  std::vector<Vector3<double>> points;  ///< in the base
  bool reached = false;
};

class Study {
 public:
  Study(const Machine& machine, const Machine::BlockView& view, const VectorXd& theta)
      : view_(view),
        shape_(view.code->Shape()),
        theta_(theta.segment(view.first_parameter, shape_.parameters)) {
    VectorXd home(shape_.coordinates);
    for (std::size_t i = 0; i < view.coordinates.size(); ++i) {
      home[static_cast<Eigen::Index>(i)] =
          view.block->letters[i].sign * machine.home()[view.coordinates[i]];
    }
    samples_.push_back(At(home));
    for (const Vector3<double>& point : samples_[0].points) {
      size_ = std::max(size_, (point - samples_[0].points[0]).norm());
    }
    for (Eigen::Index i = 0; i < home.size(); ++i) {
      const bool turns = IsRotaryLetter(view.description->letters[static_cast<std::size_t>(i)]);
      for (const double by : {0.02, -0.02, 0.007}) {
        VectorXd x = home;
        x[i] += by * (turns ? 1.0 : size_);
        Sample sample = At(x);
        if (sample.reached) samples_.push_back(std::move(sample));
      }
    }
  }

  [[nodiscard]] Parsed<MechanismParts> Parts() const {
    if (!samples_[0].reached) return Problem("home is out of reach");
    MechanismParts out{
        .view = &view_, .X_BP = samples_[0].X_BP, .x = samples_[0].x, .q = samples_[0].q};
    RowMajor by_x(3 * shape_.points, shape_.coordinates);
    RowMajor by_q(3 * shape_.points, shape_.drives);
    Derivatives(by_x, by_q);
    for (int i = 0; i < shape_.points; ++i) {
      const Eigen::Index row = Eigen::Index{3} * i;
      const bool of_x = by_x.middleRows(row, 3).cwiseAbs().maxCoeff() > kStill * size_;
      out.points.push_back(Carried(i, of_x, by_q.middleRows(row, 3)));
    }
    for (int i = 0; i < shape_.points; ++i) {
      const bool ring =
          out.points[static_cast<std::size_t>(i)].carrier == PointPart::Carrier::kRing;
      if (ring && !FindRing(out.points, i))
        return Problem(fmt::format("nothing is known to carry its point '{}'", Name(i)));
    }
    for (const plugin::LinkDescription& link : view_.description->links) {
      if (link.kind != "strut") continue;
      if (auto problem = AddStrut(link, out)) return Problem(*problem);
    }
    if (shape_.coordinates < 6 && PlatformFollowsItsLetters()) return out;
    if (shape_.coordinates < 6 && (out.tube = FindTube(out.points))) return out;
    out.free_platform = true;
    if (shape_.coordinates < 6 && !HingesHold(out)) {
      return Problem("its platform has motions besides those of its letters");
    }
    return out;
  }

 private:
  template <class M>
  static auto Span(M& m) {
    return std::span(m.data(), static_cast<std::size_t>(m.size()));
  }

  [[nodiscard]] Sample At(const VectorXd& x) const {
    Sample out{.x = x, .q = VectorXd(shape_.drives)};
    const auto state = [&](const VectorXd& q) {
      return plugin::MechanismState{Span(x), Span(q), Span(theta_), view_.modes};
    };
    const VectorXd none;
    VectorXd platform(12);
    VectorXd points(3 * shape_.points);
    out.reached =
        view_.code->Evaluate(Quantity::kDrives, state(none), {.values = Span(out.q)}) ==
            plugin::Status::kOk &&
        view_.code->Evaluate(Quantity::kPlatform, state(none), {.values = Span(platform)}) ==
            plugin::Status::kOk &&
        view_.code->Evaluate(Quantity::kSkeleton, state(out.q), {.values = Span(points)}) ==
            plugin::Status::kOk &&
        out.q.allFinite() && points.allFinite();
    out.X_BP = Pose<double>::Read(std::span<const double>(platform.data(), 12));
    for (Eigen::Index i = 0; i < shape_.points; ++i)
      out.points.emplace_back(points.segment<3>(3 * i));
    return out;
  }

  void Derivatives(RowMajor& by_x, RowMajor& by_q) const {
    const Sample& home = samples_[0];
    VectorXd points(3 * shape_.points);
    static_cast<void>(view_.code->Evaluate(
        Quantity::kSkeleton,
        {Span(home.x), Span(home.q), Span(theta_), view_.modes},
        {.values = Span(points), .by_coordinates = Span(by_x), .by_drives = Span(by_q)}));
  }

  [[nodiscard]] bool PlatformFollowsItsLetters() const {
    return std::all_of(samples_.begin(), samples_.end(), [this](const Sample& sample) {
      Pose<double> X;
      for (Eigen::Index i = 0; i < sample.x.size(); ++i) {
        X = X * LetterMotion(view_.description->letters[static_cast<std::size_t>(i)], sample.x[i]);
      }
      return (X.p - sample.X_BP.p).norm() <= kStill * size_ &&
             (X.R - sample.X_BP.R).norm() <= kStill;
    });
  }

  /// A base point that the description links to the platform, and through which a straight line of
  /// the platform runs wherever it goes, while all its turns are about one axis of the base and one
  /// of its own.
  [[nodiscard]] std::optional<TubePart> FindTube(const std::vector<PointPart>& points) const {
    if (shape_.coordinates != 3) return std::nullopt;  // two swings and one slide
    for (const plugin::LinkDescription& link : view_.description->links) {
      const int from = Number(link.from);
      const int to = Number(link.to);
      const auto on_base = [&](int i) {
        return points[static_cast<std::size_t>(i)].carrier == PointPart::Carrier::kBase;
      };
      if (link.kind != "platform" || on_base(from) == on_base(to)) continue;
      TubePart tube{.collar = on_base(from) ? from : to};
      Eigen::MatrixX3d slides(samples_.size(), 3);
      Eigen::MatrixX3d normals_B(samples_.size(), 3);
      Eigen::MatrixX3d normals_P(samples_.size(), 3);
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        slides.row(row) =
            (InPlatform(samples_[i], tube.collar) - InPlatform(samples_[0], tube.collar)) / size_;
        const Vector3<double> normal = NeverTurnsAbout(samples_[i]);
        normals_B.row(row) = normal;
        normals_P.row(row) = samples_[i].X_BP.R.transpose() * normal;
      }
      const auto along = OnlyDirection(slides);
      const auto first = SquareToAll(normals_B);
      const auto second = SquareToAll(normals_P);
      if (!along || !first || !second) continue;
      tube.along_P = *along;
      tube.first_B = *first;
      tube.second_P = *second;
      return tube;
    }
    return std::nullopt;
  }

  /// The axis in the base about which no small motion of the platform turns it; zero if it may turn
  /// about all, or about one or none.
  [[nodiscard]] Vector3<double> NeverTurnsAbout(const Sample& sample) const {
    VectorXd platform(12);
    RowMajor by_x(12, shape_.coordinates);
    static_cast<void>(
        view_.code->Evaluate(Quantity::kPlatform,
                             {Span(sample.x), {}, Span(theta_), view_.modes},
                             {.values = Span(platform), .by_coordinates = Span(by_x)}));
    Eigen::Matrix3Xd turns(3, shape_.coordinates);
    for (Eigen::Index i = 0; i < by_x.cols(); ++i) {
      const VectorXd rate = by_x.col(i);
      const Matrix3<double> spin = Pose<double>::Read(std::span<const double>(rate.data(), 12)).R *
                                   sample.X_BP.R.transpose();
      turns.col(i) = Vector3<double>(spin(2, 1), spin(0, 2), spin(1, 0)) * size_;
    }
    const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(turns, Eigen::ComputeFullU);
    const VectorXd& gain = svd.singularValues();
    const bool about_two = gain.size() == 3 && gain[1] > 1e-3 && gain[2] <= kStill;
    return about_two ? Vector3<double>(svd.matrixU().col(2)) : Vector3<double>::Zero();
  }

  /// The one direction of the rows; none if they are nothing or differ.
  static std::optional<Vector3<double>> OnlyDirection(const Eigen::MatrixX3d& rows) {
    const Eigen::JacobiSVD<Eigen::MatrixX3d> svd(rows, Eigen::ComputeFullV);
    if (svd.singularValues()[0] <= 1e-6 || svd.singularValues()[1] > kStill) return std::nullopt;
    return Vector3<double>(svd.matrixV().col(0));
  }

  /// The one direction that is square to all rows; none if there is none or more.
  static std::optional<Vector3<double>> SquareToAll(const Eigen::MatrixX3d& rows) {
    const Eigen::JacobiSVD<Eigen::MatrixX3d> svd(rows, Eigen::ComputeFullV);
    if (svd.singularValues()[1] <= 1e-6 || svd.singularValues()[2] > kStill) return std::nullopt;
    return Vector3<double>(svd.matrixV().col(2));
  }

  /// Finds the struts that stay in a plane, as hinges on the base would make them; true if these
  /// take from the platform what its letters leave out.
  [[nodiscard]] bool HingesHold(MechanismParts& out) const {
    int freedoms = 6;
    for (StrutPart& strut : out.struts) {
      const auto span = [&strut](const Sample& sample) -> Vector3<double> {
        return (sample.points[static_cast<std::size_t>(strut.to)] -
                sample.points[static_cast<std::size_t>(strut.from)])
            .normalized();
      };
      Vector3<double> axis = Vector3<double>::Zero();
      for (const Sample& sample : samples_) {
        const Vector3<double> normal = span(samples_[0]).cross(span(sample));
        if (normal.norm() > axis.norm()) axis = normal;
      }
      axis.normalize();
      const bool planar = std::all_of(samples_.begin(), samples_.end(), [&](const Sample& sample) {
        return std::abs(axis.dot(span(sample))) <= kStill;
      });
      if (!planar) continue;
      strut.hinge = axis;
      --freedoms;
    }
    return freedoms == shape_.coordinates;
  }

  [[nodiscard]] Vector3<double> InPlatform(const Sample& sample, int point) const {
    return sample.X_BP.Inverse() * sample.points[static_cast<std::size_t>(point)];
  }

  [[nodiscard]] PointPart Carried(int point, bool of_x, const Eigen::MatrixXd& by_q) const {
    PointPart out;
    out.p_B = samples_[0].points[static_cast<std::size_t>(point)];
    int moving = 0;
    for (int k = 0; k < by_q.cols(); ++k) {
      if (by_q.col(k).norm() <= kStill) continue;
      ++moving;
      out.drive = k;
      out.by_drive = by_q.col(k);
    }
    if (!of_x && moving == 0) return out;
    if (!of_x && moving == 1) {
      out.carrier = PointPart::Carrier::kDrive;
      return out;
    }
    out.drive = -1;
    const Vector3<double> home = InPlatform(samples_[0], point);
    const bool fixed = std::all_of(samples_.begin(), samples_.end(), [&](const Sample& sample) {
      return (InPlatform(sample, point) - home).norm() <= kStill * size_;
    });
    out.carrier = fixed ? PointPart::Carrier::kPlatform : PointPart::Carrier::kRing;
    return out;
  }

  /// A point linked to one of the platform's, at a constant distance and in one plane.
  bool FindRing(std::vector<PointPart>& points, int point) const {
    for (const plugin::LinkDescription& link : view_.description->links) {
      const bool first = link.from == Name(point);
      if (link.kind != "platform" || (!first && link.to != Name(point))) continue;
      const int other = Number(first ? link.to : link.from);
      if (points[static_cast<std::size_t>(other)].carrier != PointPart::Carrier::kPlatform)
        continue;
      const Vector3<double> centre = InPlatform(samples_[0], other);
      const Vector3<double> arm = InPlatform(samples_[0], point) - centre;
      Vector3<double> axis = Vector3<double>::Zero();
      for (const Sample& sample : samples_) {
        const Vector3<double> normal = arm.cross(InPlatform(sample, point) - centre);
        if (normal.norm() > axis.norm()) axis = normal;
      }
      axis.normalize();
      const bool circles = std::all_of(samples_.begin(), samples_.end(), [&](const Sample& sample) {
        const Vector3<double> here = InPlatform(sample, point) - centre;
        return std::abs(here.norm() - arm.norm()) <= kStill * size_ &&
               std::abs(here.dot(axis)) <= kStill * size_;
      });
      if (!circles) continue;
      points[static_cast<std::size_t>(point)].ring = other;
      points[static_cast<std::size_t>(point)].ring_axis = axis;
      return true;
    }
    return false;
  }

  [[nodiscard]] std::optional<std::string> AddStrut(const plugin::LinkDescription& link,
                                                    MechanismParts& out) const {
    using Carrier = PointPart::Carrier;
    int from = Number(link.from);
    int to = Number(link.to);
    const auto carrier = [&](int i) { return out.points[static_cast<std::size_t>(i)].carrier; };
    if (carrier(from) > carrier(to)) std::swap(from, to);
    if (carrier(from) == Carrier::kBase && carrier(to) == Carrier::kDrive) {
      const int drive = out.points[static_cast<std::size_t>(to)].drive;
      if (!view_.description->drives[static_cast<std::size_t>(drive)].rotary) {
        return fmt::format("its strut '{}' - '{}' leads to a carriage", link.from, link.to);
      }
      out.cranks.push_back({.hinge = from, .end = to, .drive = drive});
      return std::nullopt;
    }
    if (carrier(from) > Carrier::kDrive || carrier(to) < Carrier::kPlatform) {
      return fmt::format("its strut '{}' - '{}' does not lead to the platform", link.from, link.to);
    }
    StrutPart strut{.from = from, .to = to};
    if (!Measures(from, to, [](const Sample&) { return 0.0; })) {
      for (int k = 0; k < shape_.drives && strut.drive < 0; ++k) {
        if (Measures(from, to, [k](const Sample& sample) { return sample.q[k]; })) strut.drive = k;
      }
      if (strut.drive < 0 || carrier(from) != Carrier::kBase) {
        return fmt::format("no drive is the length of its strut '{}' - '{}'", link.from, link.to);
      }
    }
    out.struts.push_back(strut);
    return std::nullopt;
  }

  /// Whether the distance of two points changes as `length` does.
  template <class F>
  [[nodiscard]] bool Measures(int from, int to, const F& length) const {
    const auto distance = [&](const Sample& sample) {
      return (sample.points[static_cast<std::size_t>(to)] -
              sample.points[static_cast<std::size_t>(from)])
                 .norm() -
             length(sample);
    };
    const double home = distance(samples_[0]);
    return std::all_of(samples_.begin(), samples_.end(), [&](const Sample& sample) {
      return std::abs(distance(sample) - home) <= kStill * size_;
    });
  }

  [[nodiscard]] const std::string& Name(int point) const {
    return view_.description->points[static_cast<std::size_t>(point)];
  }
  [[nodiscard]] int Number(const std::string& name) const {
    const auto& names = view_.description->points;
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  [[nodiscard]] tl::unexpected<Diagnostics> Problem(const std::string& why) const {
    return tl::unexpected(
        Diagnostics{{.severity = Severity::kError,
                     .code = "E0712",
                     .message = fmt::format("'{}' ({}) cannot be written as bodies and joints: {}",
                                            view_.block->name,
                                            view_.block->module,
                                            why),
                     .help = "other formats (formula, c, svg) do without bodies"}});
  }

  const Machine::BlockView& view_;
  plugin::MechanismShape shape_;
  VectorXd theta_;
  std::vector<Sample> samples_;
  double size_ = 1e-300;
};

}  // namespace

Parsed<MechanismParts> PartsOf(const Machine& machine,
                               const Machine::BlockView& view,
                               const VectorXd& theta) {
  return Study(machine, view, theta).Parts();
}

}  // namespace kompono::exporting
