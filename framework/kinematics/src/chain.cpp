// SPDX-License-Identifier: Apache-2.0
// X_WT as a product of factors, with the twist of every coordinate and parameter (SO 44-55: Δ_0 = Σ
// A_0k Δ_k).
#include "machine_impl.hpp"

#include <cmath>

namespace kompono::kinematics {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Spatial twist (velocity of the point at the origin, angular velocity) of dX at X, both in the
/// frame X is given in.
Vector6 SpatialTwist(const Pose<double>& X, const Matrix3<double>& dR, const Vector3<double>& dp) {
  const Matrix3<double> W = dR * X.R.transpose();
  Vector6 twist;
  const Vector3<double> omega(
      0.5 * (W(2, 1) - W(1, 2)), 0.5 * (W(0, 2) - W(2, 0)), 0.5 * (W(1, 0) - W(0, 1)));
  twist << dp - omega.cross(X.p), omega;
  return twist;
}

/// Column `column` of a 12-row derivative table.
Vector6 TwistOfColumn(const Pose<double>& X, const MatrixXd& table, Eigen::Index column) {
  const VectorXd numbers = table.col(column);
  const Pose<double> d = Pose<double>::Read({numbers.data(), 12});
  return SpatialTwist(X, d.R, d.p);
}

Vector6 Transport(const Pose<double>& X, const Vector6& twist) {
  Vector6 out;
  const Vector3<double> omega = X.R * twist.tail<3>();
  out << X.R * twist.head<3>() + X.p.cross(omega), omega;
  return out;
}

enum class Of { kCoordinate, kParameter };
struct TwistEntry {
  Of of;
  int index;
  Vector6 twist;  ///< spatial, in the factor's left frame
};

struct FactorPose {
  Pose<double> X;
  std::vector<TwistEntry> twists;
};

/// T(position) Rx(a) Ry(b) Rz(c) and its six twists.
FactorPose Placement(const VectorXd& theta, int first, bool derivatives) {
  FactorPose out{.X = PlacementPose(theta, first), .twists = {}};
  if (!derivatives) return out;
  const Matrix3<double> Ra = RotationX(theta[first + 3]);
  const Matrix3<double> Rab = Ra * RotationY(theta[first + 4]);
  for (int i = 0; i < 3; ++i) {
    Vector6 twist = Vector6::Zero();
    twist[i] = 1.0;
    out.twists.push_back({Of::kParameter, first + i, twist});
  }
  const std::array<Vector3<double>, 3> axes{Vector3<double>::UnitX(), Ra.col(1), Rab.col(2)};
  for (int i = 0; i < 3; ++i) {
    const Vector3<double>& omega = axes[static_cast<std::size_t>(i)];
    Vector6 twist;
    twist << -omega.cross(out.X.p), omega;  // the frame's origin stays
    out.twists.push_back({Of::kParameter, first + 3 + i, twist});
  }
  return out;
}

FactorPose Compose(FactorPose left, const FactorPose& right) {
  for (const TwistEntry& entry : right.twists) {
    left.twists.push_back({entry.of, entry.index, Transport(left.X, entry.twist)});
  }
  left.X = left.X * right.X;
  return left;
}

FactorPose Invert(FactorPose factor) {
  const Pose<double> inverse = factor.X.Inverse();
  for (TwistEntry& entry : factor.twists) entry.twist = -Transport(inverse, entry.twist);
  factor.X = inverse;
  return factor;
}

/// The axis moves about the frame given by its point and tilt: at 0 nothing is moved whatever the
/// frame.
FactorPose AxisFactor(const Machine::Impl& impl,
                      const AxisModel& axis,
                      const VectorXd& z,
                      const VectorXd& theta,
                      bool derivatives) {
  const layout::Axis& of = impl.layout().axes[static_cast<std::size_t>(axis.axis)];
  const FactorPose frame = Placement(theta, axis.theta_frame, derivatives);
  FactorPose motion;
  motion.X = LetterMotion(of.letter, axis.coordinate < 0 ? 0.0 : z[axis.coordinate]);
  if (derivatives && axis.coordinate >= 0) {
    Vector6 twist = Vector6::Zero();
    twist[AxisOfLetter(of.letter) + (IsRotaryLetter(of.letter) ? 3 : 0)] = 1.0;
    motion.twists.push_back({Of::kCoordinate, axis.coordinate, twist});
  }
  return Compose(Compose(frame, motion), Invert(frame));
}

FactorPose MechanismFactor(const Machine::Impl& impl,
                           const MechanismModel& mechanism,
                           const VectorXd& z,
                           const VectorXd& theta,
                           bool derivatives) {
  const layout::Block& block = BlockOf(impl, mechanism);
  const Evaluation at = Evaluate(mechanism,
                                 plugin::Quantity::kPlatform,
                                 LocalCoordinates(impl, mechanism, z),
                                 VectorXd(),
                                 theta,
                                 {.by_coordinates = derivatives, .by_parameters = derivatives});
  FactorPose platform;
  platform.X = Pose<double>::Read({at.values.data(), 12});
  for (Eigen::Index i = 0; i < at.by_coordinates.cols() && derivatives; ++i) {
    const auto k = static_cast<std::size_t>(i);
    platform.twists.push_back(
        {Of::kCoordinate,
         mechanism.coordinate[k],
         block.letters[k].sign * TwistOfColumn(platform.X, at.by_coordinates, i)});
  }
  for (Eigen::Index i = 0; i < at.by_parameters.cols() && derivatives; ++i) {
    if (at.by_parameters.col(i).isZero(0.0))
      continue;  // most platforms do not depend on the geometry
    platform.twists.push_back({Of::kParameter,
                               mechanism.theta_module + static_cast<int>(i),
                               TwistOfColumn(platform.X, at.by_parameters, i)});
  }
  return Compose(Placement(theta, mechanism.theta_mount, derivatives), platform);
}

FactorPose EndFactor(const Machine::Impl& impl,
                     const EndModel& end,
                     const VectorXd& theta,
                     bool derivatives) {
  FactorPose mount = Placement(theta, end.theta_mount, derivatives);
  if (!end.code) return mount;
  const auto count = static_cast<std::size_t>(end.parameter_count);
  std::array<double, 12> numbers{};
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> table(derivatives ? 12 : 0,
                                                                               end.parameter_count);
  const int state = impl.layout().ends[static_cast<std::size_t>(end.end)].state;
  const plugin::Status status =
      end.code->StationPose(end.station,
                            state,
                            {theta.data() + end.theta_module, count},
                            numbers,
                            {table.data(), static_cast<std::size_t>(table.size())});
  FactorPose station;
  if (status != plugin::Status::kOk) numbers.fill(std::nan(""));
  station.X = Pose<double>::Read(numbers);
  for (int i = 0; i < end.parameter_count && derivatives; ++i) {
    station.twists.push_back(
        {Of::kParameter, end.theta_module + i, TwistOfColumn(station.X, table, i)});
  }
  return Compose(std::move(mount), station);
}

FactorPose PoseOfFactor(const Machine::Impl& impl,
                        const Factor& factor,
                        const VectorXd& z,
                        const VectorXd& theta,
                        bool derivatives) {
  const auto index = static_cast<std::size_t>(factor.index);
  switch (factor.kind) {
    case Factor::Kind::kMechanism:
      return MechanismFactor(impl, impl.mechanisms[index], z, theta, derivatives);
    case Factor::Kind::kAxis:
      return AxisFactor(impl, impl.axes[index], z, theta, derivatives);
    case Factor::Kind::kEnd:
      return EndFactor(impl, impl.model->ends[index], theta, derivatives);
    case Factor::Kind::kOpenBase:
      break;
  }
  return Placement(theta, impl.model->theta_open_base, derivatives);
}

}  // namespace

Pose<double> PlacementPose(const VectorXd& theta, int first) {
  Pose<double> X;
  X.p = theta.segment<3>(first);
  X.R = RotationXYZ(theta[first + 3], theta[first + 4], theta[first + 5]);
  return X;
}

Pose<double> ChainPose(const Machine::Impl& impl,
                       const VectorXd& z,
                       const VectorXd& theta,
                       PoseDerivatives* derivatives) {
  const bool wanted = derivatives != nullptr;
  if (wanted) {
    derivatives->by_coordinates.setZero(6, static_cast<Eigen::Index>(impl.coordinates.size()));
    derivatives->by_parameters.setZero(6, static_cast<Eigen::Index>(impl.model->parameters.size()));
  }
  Pose<double> X_WK;  // W to the frame right of the factors so far
  for (const Factor& factor : impl.factors) {
    FactorPose next = PoseOfFactor(impl, factor, z, theta, wanted);
    if (factor.inverse) next = Invert(std::move(next));
    if (wanted) {
      for (const TwistEntry& entry : next.twists) {
        auto& table =
            entry.of == Of::kCoordinate ? derivatives->by_coordinates : derivatives->by_parameters;
        table.col(entry.index) += Transport(X_WK, entry.twist);
      }
    }
    X_WK = X_WK * next.X;
  }
  if (wanted) {  // from the velocity at W's origin to that of the tool point
    for (Matrix6X* table : {&derivatives->by_coordinates, &derivatives->by_parameters}) {
      for (Eigen::Index i = 0; i < table->cols(); ++i) {
        const Vector3<double> omega = table->col(i).tail<3>();
        table->col(i).head<3>() += omega.cross(X_WK.p);
      }
    }
  }
  return X_WK;
}

}  // namespace kompono::kinematics
