// SPDX-License-Identifier: Apache-2.0
#include "residuals.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace kompono::calibration {

using kinematics::MeasuredPose;
using kinematics::SolveStatus;

namespace {

Eigen::Matrix3d Cross(const Eigen::Vector3d& r) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  return matrix;
}

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

Eigen::Matrix3d LeftJacobianInverse(const Eigen::Vector3d& r) {
  const double angle = r.norm();
  // Series of (1 - (x/2) cot(x/2)) / x²; the first dropped term x⁴/30240 is below 4e-13 at 0.01.
  const double factor = angle < 1e-2
                            ? 1.0 / 12.0 + angle * angle / 720.0
                            : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  const Eigen::Matrix3d cross = Cross(r);
  return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}

RowErrors ErrorsOf(const Measurement& measurement,
                   const Pose<double>& X_WT,
                   const Pose<double>& X_WT_second) {
  RowErrors errors;
  errors.value.resize(measurement.Numbers());
  errors.lengths = static_cast<int>(errors.value.size());
  switch (measurement.kind) {
    case MeasurementKind::kHeight:
      errors.value[0] = X_WT.p.z() - measurement.value_mm;
      break;
    case MeasurementKind::kDistance:
      errors.value[0] = (X_WT.p - X_WT_second.p).norm() - measurement.value_mm;
      break;
    case MeasurementKind::kPose:
    case MeasurementKind::kPosition: {
      int at = 0;
      for (int i = 0; i < 3; ++i) {
        const std::optional<double>& measured =
            measurement.position_mm[static_cast<std::size_t>(i)];
        if (measured) errors.value[at++] = X_WT.p[i] - *measured;
      }
      errors.lengths = at;
      if (measurement.kind == MeasurementKind::kPose) {
        errors.value.tail<3>() = RotationVector(X_WT.R * measurement.R_WT.transpose());
      }
      break;
    }
  }
  return errors;
}

RowMaps MapsOf(const Measurement& measurement,
               const Pose<double>& X_WT,
               const Pose<double>& X_WT_second) {
  RowMaps maps;
  maps.first.setZero(measurement.Numbers(), 6);
  switch (measurement.kind) {
    case MeasurementKind::kHeight:
      maps.first(0, 2) = 1.0;
      break;
    case MeasurementKind::kDistance: {
      const Eigen::Vector3d between = X_WT.p - X_WT_second.p;
      const double distance = between.norm();
      if (distance > 0.0) maps.first.block<1, 3>(0, 0) = between.transpose() / distance;
      maps.second = -maps.first;
      break;
    }
    case MeasurementKind::kPose:
    case MeasurementKind::kPosition: {
      int at = 0;
      for (int i = 0; i < 3; ++i) {
        if (measurement.position_mm[static_cast<std::size_t>(i)]) maps.first(at++, i) = 1.0;
      }
      if (measurement.kind == MeasurementKind::kPose) {
        maps.first.bottomRightCorner<3, 3>() =
            LeftJacobianInverse(RotationVector(X_WT.R * measurement.R_WT.transpose()));
      }
      break;
    }
  }
  return maps;
}

int Measurement::Numbers() const {
  switch (kind) {
    case MeasurementKind::kHeight:
    case MeasurementKind::kDistance:
      return 1;
    case MeasurementKind::kPosition:
      return MeasuredComponents(*this);
    case MeasurementKind::kPose:
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
  if (!prediction.ok() && measurement_->kind != MeasurementKind::kDistance) {
    const kinematics::Solution aimed = machine_->Inverse(
        TargetOf(*measurement_, machine_->layout().rotation_order), theta, machine_->home());
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
  prediction.first = machine_->Measure(measurement_->readings, theta, start_, with_derivatives);
  prediction.second.status = SolveStatus::kConverged;
  if (measurement_->kind == MeasurementKind::kDistance &&
      prediction.first.status == SolveStatus::kConverged) {
    prediction.second =
        machine_->Measure(measurement_->second_readings, theta, second_start_, with_derivatives);
  }
  return prediction;
}

void RowModel::StartFrom(const Prediction& prediction) {
  start_ = prediction.first.coordinates;
  if (measurement_->kind == MeasurementKind::kDistance) {
    second_start_ = prediction.second.coordinates;
  }
}

RowErrors RowModel::Whitened(const Prediction& prediction) const {
  RowErrors errors = Errors(prediction);
  for (Eigen::Index i = 0; i < errors.value.size(); ++i) errors.value[i] *= Weight(errors, i);
  return errors;
}

void RowModel::Jacobian(
    const Prediction& prediction,
    const std::vector<int>& free,
    const Eigen::VectorXd& scale,
    Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian)
    const {
  RowMaps maps = MapsOf(*measurement_, prediction.first.X_WT, prediction.second.X_WT);
  const bool distance = measurement_->kind == MeasurementKind::kDistance;
  const int lengths = measurement_->kind == MeasurementKind::kPose ? size_ - 3 : size_;
  for (int i = 0; i < size_; ++i) {
    const double weight = 1.0 / (i < lengths ? sigma_mm_ : sigma_rad_);
    maps.first.row(i) *= weight;
    if (distance) maps.second.row(i) *= weight;
  }
  for (std::size_t j = 0; j < free.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const Eigen::Matrix<double, 6, 1> twist =
        prediction.first.by_parameters.col(free[j]) * scale[column];
    jacobian.col(column) = maps.first * twist;
    if (distance) {
      const Eigen::Matrix<double, 6, 1> second =
          prediction.second.by_parameters.col(free[j]) * scale[column];
      jacobian.col(column) += maps.second * second;
    }
  }
}

}  // namespace kompono::calibration
