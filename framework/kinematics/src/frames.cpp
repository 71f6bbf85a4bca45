// SPDX-License-Identifier: Apache-2.0
// Where the blocks of a chain stand, seen from the workpiece-side base.
#include "machine_impl.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace kompono::kinematics {
namespace {

/// The pose of one factor as it carries: not inverted, whichever side it is on.
Pose<double> CarriedPose(const Machine::Impl& impl,
                         Factor factor,
                         const VectorXd& z,
                         const VectorXd& theta) {
  Machine::Impl single = impl;
  factor.inverse = false;
  single.factors = {factor};
  return ChainPose(single, z, theta, nullptr);
}

/// 7 of "front7"; 0 if the name ends in no digits.
int NumberOf(const std::string& station) {
  const std::size_t end = station.find_last_not_of("0123456789");
  return end + 1 < station.size() ? std::stoi(station.substr(end + 1)) : 0;
}

/// Every station while the one in use is in its place; those that the unit's numbers do not have
/// are left out.
void AddStations(const EndModel& end,
                 const layout::End& of,
                 const VectorXd& theta,
                 Machine::FrameView& view) {
  if (!end.code) return;
  const plugin::UnitShape shape = end.code->Shape();
  const std::span<const double> parameters(theta.data() + end.theta_module,
                                           static_cast<std::size_t>(end.parameter_count));
  const int in_place = of.state > 0 ? of.state : NumberOf(of.station);
  for (int station = 0; station < shape.stations; ++station) {
    std::array<double, 12> numbers{};
    const plugin::Status status = end.code->StationPose(
        station, std::min(in_place, shape.states - 1), parameters, numbers, {});
    const Pose<double> X_MF = view.X_MC * Pose<double>::Read(numbers);
    if (status == plugin::Status::kOk && X_MF.p.allFinite()) view.stations.push_back(X_MF);
  }
}

}  // namespace

std::vector<Machine::FrameView> Machine::Frames(const VectorXd& z, const VectorXd& theta) const {
  const Impl& impl = *impl_;
  std::vector<FrameView> views;
  Pose<double> X_MK;
  const auto add = [&](const Factor& factor) {
    const auto index = static_cast<std::size_t>(factor.index);
    FrameView view{.workpiece_side = factor.inverse};
    const Pose<double> X_KF = CarriedPose(impl, factor, z, theta);
    view.X_MC = X_MK;
    X_MK = X_MK * X_KF;
    view.X_MF = X_MK;
    if (factor.kind == Factor::Kind::kAxis) {
      const AxisModel& axis = impl.axes[index];
      view.kind = FrameView::Kind::kAxis;
      view.name = layout().axes[static_cast<std::size_t>(axis.axis)].name;
      view.X_MC = view.X_MC * PlacementPose(theta, axis.theta_frame);
    } else if (factor.kind == Factor::Kind::kMechanism) {
      const MechanismModel& mechanism = impl.mechanisms[index];
      view.kind = FrameView::Kind::kMechanism;
      view.name = BlockOf(impl, mechanism).name;
      view.X_MC = view.X_MC * PlacementPose(theta, mechanism.theta_mount);
    } else if (factor.kind == Factor::Kind::kEnd) {
      const EndModel& end = impl.model->ends[index];
      const layout::End& of = layout().ends[static_cast<std::size_t>(end.end)];
      view.kind = FrameView::Kind::kEnd;
      view.name = of.name;
      view.X_MC = view.X_MC * PlacementPose(theta, end.theta_mount);
      AddStations(end, of, theta, view);
    } else {
      return;  // the open base carries on from another foundation
    }
    views.push_back(std::move(view));
  };
  for (const Factor& factor : impl.factors) {
    if (!factor.inverse) add(factor);
  }
  X_MK = {};
  for (auto factor = impl.factors.rbegin(); factor != impl.factors.rend(); ++factor) {
    if (factor->inverse) add(*factor);
  }
  return views;
}

}  // namespace kompono::kinematics
