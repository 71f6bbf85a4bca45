// SPDX-License-Identifier: Apache-2.0
#include "residuals.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace kompono::calibration {

using kinematics::MeasuredPose;
using kinematics::SolveStatus;

namespace {

int MeasuredComponents(const Measurement& measurement) {
  int count = 0;
  for (const std::optional<double>& component : measurement.position_mm) {
    if (component) ++count;
  }
  return count;
}

/// The measured components as a pose that an inverse problem can aim at.
kinematics::PoseTarget TargetOf(const Measurement& measurement, layout::RotationOrder order) {
  kinematics::PoseTarget target;
  target.order = order;
  for (std::size_t i = 0; i < 3; ++i) target.component[i] = measurement.position_mm[i];
  if (measurement.kind == MeasurementKind::kHeight) target.component[2] = measurement.value_mm;
  if (measurement.kind == MeasurementKind::kPose) {
    Pose<double> X_WT;
    X_WT.R = measurement.R_WT;
    const kinematics::PoseNumbers numbers = kinematics::NumbersFromPose(X_WT, order);
    for (std::size_t i = 3; i < 6; ++i) target.component[i] = numbers.value[i];
  }
  return target;
}

}  // namespace

Eigen::Vector3d RotationVector(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double sine = q.vec().norm();
  // For a tiny sine atan2(s, w) / s -> 1 / w, with an error of s² / 3.
  const double factor = sine < 1e-9 ? 2.0 / q.w() : 2.0 * std::atan2(sine, q.w()) / sine;
  return factor * q.vec();
}

Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  return matrix;
}

Eigen::Matrix3d LeftJacobianInverse(const Eigen::Vector3d& r) {
  const double angle = r.norm();
  // Series of (1 - (x/2) cot(x/2)) / x²; the first dropped term x⁴/30240 is below 4e-13 at 0.01.
  const double factor = angle < 1e-2
                            ? 1.0 / 12.0 + angle * angle / 720.0
                            : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  const Eigen::Matrix3d cross = CrossMatrix(r);
  return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}

bool HasRotation(MeasurementKind kind) {
  return kind == MeasurementKind::kPose || kind == MeasurementKind::kRelative;
}

int Measurement::Numbers() const {
  switch (kind) {
    case MeasurementKind::kHeight:
    case MeasurementKind::kDistance:
    case MeasurementKind::kBallBar:
    case MeasurementKind::kPlane:
      return 1;
    case MeasurementKind::kPosition:
    case MeasurementKind::kHole:
      return MeasuredComponents(*this);
    case MeasurementKind::kPose:
    case MeasurementKind::kRelative:
      break;
  }
  return MeasuredComponents(*this) + 3;
}

RowModel::RowModel(const kinematics::Machine& machine,
                   const Measurement& measurement,
                   double default_sigma_mm,
                   double default_sigma_rad)
    : machine_(&machine),
      measurement_(&measurement),
      sigma_mm_(measurement.sigma_mm.value_or(default_sigma_mm)),
      sigma_rad_(measurement.sigma_rad.value_or(default_sigma_rad)),
      size_(measurement.Numbers()),
      start_(machine.home()),
      second_start_(start_) {}

RowModel::Prediction RowModel::FindStart(const Eigen::VectorXd& theta, const RowModel* neighbour) {
  Prediction prediction = Predict(theta, false);
  if (!prediction.ok() && neighbour != nullptr) {
    start_ = second_start_ = neighbour->start_;
    prediction = Predict(theta, false);
  }
  const bool aims = measurement_->kind == MeasurementKind::kHeight ||
                    measurement_->kind == MeasurementKind::kPosition ||
                    measurement_->kind == MeasurementKind::kPose;
  if (!prediction.ok() && aims && measurement_->target < 0) {
    const kinematics::Solution aimed =
        machine_->Inverse(TargetOf(*measurement_, machine_->layout().rotation_order),
                          theta.head(static_cast<Eigen::Index>(machine_->parameters().size())),
                          machine_->home());
    if (aimed.ok()) {
      start_ = aimed.coordinates;
      prediction = Predict(theta, false);
    }
  }
  if (prediction.ok()) StartFrom(prediction);
  return prediction;
}

RowModel::Prediction RowModel::Predict(const Eigen::VectorXd& theta, bool with_derivatives) const {
  Prediction prediction;
  // Behind the machine's numbers fixtures may follow.
  const Eigen::VectorXd own = theta.head(static_cast<Eigen::Index>(machine_->parameters().size()));
  prediction.first = machine_->Measure(measurement_->readings, own, start_, with_derivatives);
  prediction.second.status = SolveStatus::kConverged;
  if (measurement_->second_readings.size() > 0 &&
      prediction.first.status == SolveStatus::kConverged) {
    prediction.second =
        machine_->Measure(measurement_->second_readings, own, second_start_, with_derivatives);
  }
  return prediction;
}

void RowModel::StartFrom(const Prediction& prediction) {
  start_ = prediction.first.coordinates;
  if (measurement_->second_readings.size() > 0) {
    second_start_ = prediction.second.coordinates;
  }
}

RowErrors RowModel::Whitened(const Prediction& prediction, const FixtureValues& fixtures) const {
  RowErrors errors = Errors(prediction, fixtures);
  for (Eigen::Index i = 0; i < errors.value.size(); ++i) errors.value[i] *= Weight(errors, i);
  return errors;
}

}  // namespace kompono::calibration
