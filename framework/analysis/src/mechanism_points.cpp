// SPDX-License-Identifier: Apache-2.0
#include "mechanism_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kompono::analysis {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kSamePlace = 1e-9;  ///< of the mechanism's size

std::span<double> View(RowMajor& matrix) {
  return {matrix.data(), static_cast<std::size_t>(matrix.size())};
}

std::vector<Eigen::Vector3d> PointsOf(const VectorXd& numbers) {
  std::vector<Eigen::Vector3d> out;
  for (Eigen::Index i = 0; i + 2 < numbers.size(); i += 3) out.emplace_back(numbers.segment<3>(i));
  return out;
}

int IndexOf(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// Which points move with the platform, seen by moving it a little in all coordinates at once.
std::vector<PointBody> Bodies(const PoseJudge::Mechanism& mechanism,
                              const VectorXd& x,
                              const std::vector<Eigen::Vector3d>& here,
                              const Pose<double>& platform) {
  double size = 1.0;
  for (const Eigen::Vector3d& point : here) size = std::max(size, point.norm());
  VectorXd moved = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const bool rotary = IsRotaryLetter(mechanism.description->letters[static_cast<std::size_t>(i)]);
    moved[i] += (rotary ? 1e-3 : 1e-3 * size) * (1.0 + 0.37 * static_cast<double>(i));
  }
  const VectorXd q = ValuesAt(mechanism, plugin::Quantity::kDrives, moved, VectorXd(), false).value;
  const std::vector<Eigen::Vector3d> there =
      PointsOf(ValuesAt(mechanism, plugin::Quantity::kSkeleton, moved, q, false).value);
  const Pose<double> X = Pose<double>::Read(
      {ValuesAt(mechanism, plugin::Quantity::kPlatform, moved, VectorXd(), false).value.data(),
       12});
  // Struts end on a carriage or the base at one end and on the platform at the other; a point on
  // neither is on another link.
  std::vector<PointBody> out(here.size(), PointBody::kOther);
  for (std::size_t i = 0; i < here.size(); ++i) {
    const Eigen::Vector3d on_platform = X * (platform.Inverse() * here[i]);
    if ((on_platform - there[i]).norm() < kSamePlace * size) {
      out[i] = PointBody::kPlatform;
    } else if ((here[i] - there[i]).norm() < kSamePlace * size) {
      out[i] = PointBody::kBase;
    }
  }
  for (const plugin::LinkDescription& link : mechanism.description->links) {
    if (link.kind != "rail") continue;
    for (const std::string& end : {link.from, link.to}) {
      const int i = IndexOf(mechanism.description->points, end);
      if (i >= 0 && out[static_cast<std::size_t>(i)] == PointBody::kOther)
        out[static_cast<std::size_t>(i)] = PointBody::kBase;
    }
  }
  return out;
}

}  // namespace

bool MechanismPoints::ShareAJoint(const StrutEnds& a, const StrutEnds& b) const {
  double size = 1.0;
  for (const Eigen::Vector3d& p : point) size = std::max(size, p.norm());
  for (const int i : {a.from, a.to}) {
    for (const int j : {b.from, b.to}) {
      const double apart =
          (point[static_cast<std::size_t>(i)] - point[static_cast<std::size_t>(j)]).norm();
      if (i == j || apart < kSamePlace * size) return true;
    }
  }
  return false;
}

PoseJudge::Mechanism DescribeMechanism(const Machine::BlockView& view, const VectorXd& theta) {
  PoseJudge::Mechanism out{.code = view.code,
                           .description = view.description,
                           .block = view.block->name,
                           .shape = view.code->Shape(),
                           .modes = view.modes,
                           .coordinate = view.coordinates};
  const double* first = theta.data() + view.first_parameter;
  out.parameters.assign(first, first + out.shape.parameters);
  for (const layout::Block::LetterMap& letter : view.block->letters)
    out.sign.push_back(letter.sign < 0 ? -1.0 : 1.0);
  return out;
}

VectorXd LocalAt(const PoseJudge::Mechanism& mechanism, const VectorXd& z) {
  VectorXd x(static_cast<Eigen::Index>(mechanism.coordinate.size()));
  for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i)
    x[static_cast<Eigen::Index>(i)] = mechanism.sign[i] * z[mechanism.coordinate[i]];
  return x;
}

Values ValuesAt(const PoseJudge::Mechanism& mechanism,
                plugin::Quantity quantity,
                const VectorXd& x,
                const VectorXd& q,
                bool derivatives) {
  const auto rows = static_cast<Eigen::Index>(plugin::RowsOf(mechanism.shape, quantity));
  const bool by_q = derivatives && q.size() > 0;
  RowMajor x_table(derivatives ? rows : 0, mechanism.shape.coordinates);
  RowMajor q_table(by_q ? rows : 0, mechanism.shape.drives);
  Values out{.value = VectorXd(rows)};
  const plugin::Status status =
      mechanism.code->Evaluate(quantity,
                               {.coordinates = {x.data(), static_cast<std::size_t>(x.size())},
                                .drives = {q.data(), static_cast<std::size_t>(q.size())},
                                .parameters = mechanism.parameters,
                                .modes = mechanism.modes},
                               {.values = {out.value.data(), static_cast<std::size_t>(rows)},
                                .by_coordinates = View(x_table),
                                .by_drives = View(q_table),
                                .by_parameters = {}});
  if (status != plugin::Status::kOk) {
    out.value.setConstant(std::numeric_limits<double>::quiet_NaN());
    x_table.setConstant(std::numeric_limits<double>::quiet_NaN());
    q_table.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  out.by_coordinates = x_table;
  out.by_drives = q_table;
  return out;
}

MechanismPoints PointsAt(const PoseJudge::Mechanism& mechanism, const VectorXd& z) {
  const VectorXd x = LocalAt(mechanism, z);
  const VectorXd q = ValuesAt(mechanism, plugin::Quantity::kDrives, x, VectorXd(), false).value;
  MechanismPoints out;
  out.point = PointsOf(ValuesAt(mechanism, plugin::Quantity::kSkeleton, x, q, false).value);
  const VectorXd platform =
      ValuesAt(mechanism, plugin::Quantity::kPlatform, x, VectorXd(), false).value;
  out.platform = Pose<double>::Read({platform.data(), 12});
  out.body = Bodies(mechanism, x, out.point, out.platform);
  for (const plugin::LinkDescription& link : mechanism.description->links) {
    if (link.kind != "strut") continue;
    const StrutEnds strut{.from = IndexOf(mechanism.description->points, link.from),
                          .to = IndexOf(mechanism.description->points, link.to)};
    if (strut.from >= 0 && strut.to >= 0) out.struts.push_back(strut);
  }
  return out;
}

}  // namespace kompono::analysis
