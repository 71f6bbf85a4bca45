// SPDX-License-Identifier: Apache-2.0
#include "kompono/kinematics/machine.hpp"

#include "machine_impl.hpp"

#include <algorithm>

namespace kompono::kinematics {
namespace {

template <class Named>
int IndexOf(const std::vector<Named>& list, std::string_view name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [name](const Named& n) { return n.name == name; });
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

}  // namespace

Machine::Machine(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

const layout::Layout& Machine::layout() const {
  return impl_->model->layout;
}
const std::vector<Coordinate>& Machine::coordinates() const {
  return impl_->coordinates;
}
const std::vector<Drive>& Machine::drives() const {
  return impl_->drives;
}
const std::vector<Parameter>& Machine::parameters() const {
  return impl_->model->parameters;
}

VectorXd Machine::nominal() const {
  const std::vector<Parameter>& list = parameters();
  VectorXd theta(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i)
    theta[static_cast<Eigen::Index>(i)] = list[i].nominal;
  return theta;
}

VectorXd Machine::home() const {
  VectorXd z(static_cast<Eigen::Index>(impl_->coordinates.size()));
  for (std::size_t i = 0; i < impl_->coordinates.size(); ++i) {
    z[static_cast<Eigen::Index>(i)] = impl_->coordinates[i].home;
  }
  return z;
}

int Machine::FindCoordinate(std::string_view name) const {
  return IndexOf(impl_->coordinates, name);
}
int Machine::FindDrive(std::string_view name) const {
  return IndexOf(impl_->drives, name);
}
int Machine::FindParameter(std::string_view name) const {
  return IndexOf(parameters(), name);
}

Pose<double> Machine::ToolPose(const VectorXd& z,
                               const VectorXd& theta,
                               PoseDerivatives* derivatives) const {
  return ChainPose(*impl_, z, theta, derivatives);
}

std::vector<Machine::BlockView> Machine::blocks() const {
  std::vector<BlockView> views;
  for (const MechanismModel& mechanism : impl_->mechanisms) {
    if (mechanism.first_drive < 0) continue;
    views.push_back({.block = &BlockOf(*impl_, mechanism),
                     .description = mechanism.description,
                     .code = mechanism.code.get(),
                     .coordinates = mechanism.coordinate,
                     .first_drive = mechanism.first_drive,
                     .first_parameter = mechanism.theta_module,
                     .modes = mechanism.modes});
  }
  return views;
}

Machine::SkeletonView Machine::Skeleton(const VectorXd& z, const VectorXd& theta) const {
  SkeletonView view;
  // Frames of the mechanisms in the workpiece-side base M: X_MK = X_MW X_WK.
  Pose<double> X_WK;
  std::vector<Pose<double>> before(impl_->factors.size());
  Pose<double> X_WM;
  for (std::size_t i = 0; i < impl_->factors.size(); ++i) {
    before[i] = X_WK;
    Machine::Impl single = *impl_;
    single.factors = {impl_->factors[i]};
    X_WK = X_WK * ChainPose(single, z, theta, nullptr);
    if (impl_->factors[i].inverse) X_WM = X_WK;
    if (!impl_->factors[i].inverse) continue;
    before[i] = X_WK;  // the mechanism's carrier is to the right of an inverse factor
  }
  for (std::size_t i = 0; i < impl_->factors.size(); ++i) {
    const Factor& factor = impl_->factors[i];
    if (factor.kind != Factor::Kind::kMechanism) continue;
    const MechanismModel& mechanism = impl_->mechanisms[static_cast<std::size_t>(factor.index)];
    const std::string& block = BlockOf(*impl_, mechanism).name;
    const VectorXd x = LocalCoordinates(*impl_, mechanism, z);
    const VectorXd q =
        Evaluate(mechanism, plugin::Quantity::kDrives, x, VectorXd(), theta, {}).values;
    const Evaluation points = Evaluate(mechanism, plugin::Quantity::kSkeleton, x, q, theta, {});
    const Pose<double> X_MB =
        X_WM.Inverse() * before[i] * PlacementPose(theta, mechanism.theta_mount);
    for (std::size_t k = 0; k < mechanism.description->points.size(); ++k) {
      const Vector3<double> p_BQ = points.values.segment<3>(3 * static_cast<Eigen::Index>(k));
      view.points.push_back({block + "." + mechanism.description->points[k], X_MB * p_BQ});
    }
    for (const plugin::LinkDescription& link : mechanism.description->links) {
      view.links.push_back({block + "." + link.from, block + "." + link.to, link.kind});
    }
  }
  return view;
}

}  // namespace kompono::kinematics
