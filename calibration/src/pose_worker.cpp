// SPDX-License-Identifier: Apache-2.0
#include "pose_worker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

namespace kompono::calibration {
namespace {

using kinematics::SolveStatus;

constexpr double kRadianLengthMm = 100.0;  ///< what a radian counts beside millimetres
/// Drives met so well leave an error of their square over the machine's size: below a nanometre.
constexpr double kSettledMm = 1e-3;
constexpr int kMostSteps = 40;
constexpr double kLongestStepRad = 0.5;

int Sign(double value) {
  return (value > 0.0 ? 1 : 0) - (value < 0.0 ? 1 : 0);
}

/// The free numbers below `count`.
std::vector<int> Below(const std::vector<int>& free, int count) {
  return {free.begin(), std::lower_bound(free.begin(), free.end(), count)};
}

}  // namespace

PoseWorker::PoseWorker(const kinematics::Machine& machine,
                       const MeasurementSet& set,
                       const std::vector<int>& free,
                       const Eigen::VectorXd& drive_variance)
    : machine_(machine),
      set_(set),
      linear_(machine, Below(free, static_cast<int>(machine.parameters().size()))),
      drive_variance_(drive_variance),
      drive_length_(drive_variance.size()),
      drives_are_exact_(drive_variance.isZero(0.0)) {
  for (Eigen::Index i = 0; i < drive_length_.size(); ++i) {
    const bool rotary = machine.drives()[static_cast<std::size_t>(i)].rotary;
    drive_length_[i] = rotary ? kRadianLengthMm : 1.0;
  }
  const auto own = static_cast<int>(machine.parameters().size());
  for (const int index : free) {
    if (index >= own) of_fixtures_.push_back(index - own);
  }
  if (linear_.At(machine.home(), Depth::kByCoordinates) &&
      linear_.readings_by_coordinates().rows() == linear_.readings_by_coordinates().cols()) {
    home_sign_ = Sign(linear_.readings_by_coordinates().partialPivLu().determinant());
  }
}

void PoseWorker::SetGeometry(const Eigen::VectorXd& theta) {
  const auto own = static_cast<Eigen::Index>(machine_.parameters().size());
  linear_.SetGeometry(theta.head(own));
  fixture_values_ = theta.tail(theta.size() - own);
}

double PoseWorker::DriveNorm(const Eigen::VectorXd& c) const {
  return c.cwiseProduct(drive_length_).cwiseAbs().maxCoeff();
}

bool PoseWorker::OnTheBranchOfHome() const {
  const Eigen::MatrixXd& Q = linear_.readings_by_coordinates();
  if (home_sign_ == 0 || Q.rows() != Q.cols()) return true;
  return Sign(Q.partialPivLu().determinant()) == home_sign_;
}

bool PoseWorker::Settle(const Eigen::VectorXd& readings, Depth first, Eigen::VectorXd* z) {
  double norm = std::numeric_limits<double>::infinity();
  trial_ = *z;
  Depth depth = first;
  for (int i = 0; i < kMostSteps; ++i) {
    const bool finite = linear_.At(trial_, depth);
    depth = Depth::kByCoordinates;
    if (finite) c_ = linear_.readings() - readings;
    const double next = finite ? DriveNorm(c_) : std::numeric_limits<double>::infinity();
    if (!(next < norm)) {  // too far, or out of reach
      if (!std::isfinite(norm) && i == 0) return false;
      step_ *= 0.5;
      trial_ = *z + step_;
      continue;
    }
    *z = trial_;
    norm = next;
    const Eigen::MatrixXd& Q = linear_.readings_by_coordinates();
    if (Q.rows() == Q.cols()) {
      q_by_z_inverse_.noalias() = Q.inverse();
    } else {
      q_by_z_inverse_ = Q.completeOrthogonalDecomposition().pseudoInverse();
    }
    if (norm < kSettledMm) return q_by_z_inverse_.allFinite();
    step_.noalias() = -(q_by_z_inverse_ * c_);
    if (!step_.allFinite()) return false;
    for (std::size_t k = 0; k < machine_.coordinates().size(); ++k) {
      if (!machine_.coordinates()[k].rotary) continue;
      const double turn = std::abs(step_[static_cast<Eigen::Index>(k)]);
      if (turn > kLongestStepRad) step_ *= kLongestStepRad / turn;
    }
    trial_ = *z + step_;
  }
  return false;
}

bool PoseWorker::Evaluate(const Eigen::VectorXd& readings,
                          bool with_derivatives,
                          bool moved,
                          Eigen::VectorXd* z,
                          Side* side) {
  const Depth first = with_derivatives && !moved ? Depth::kByParameters : Depth::kByCoordinates;
  trial_ = *z;
  Eigen::VectorXd at = *z;
  if (!Settle(readings, first, &at)) return false;
  // Only a first pass that was already close has derivatives by the geometry.
  const bool deep = first == Depth::kByParameters && at == *z;
  if (with_derivatives && !deep && !linear_.At(at, Depth::kByParameters)) return false;
  side->by_readings.noalias() = linear_.pose_by_coordinates() * q_by_z_inverse_;
  if (with_derivatives) {
    side->by_parameters = linear_.pose_by_parameters();
    side->by_parameters.noalias() -=
        side->by_readings.lazyProduct(linear_.readings_by_parameters());
  }
  // The rest of c by its first order.
  const Twist rest = -(side->by_readings * c_);
  side->X_linear = linear_.X_WT();
  side->X_WT = side->X_linear;
  side->X_WT.p += rest.head<3>();
  side->X_WT.R = RotationFromVector(rest.tail<3>()) * side->X_WT.R;
  *z = at;
  z->noalias() -= q_by_z_inverse_ * c_;
  return true;
}

void PoseWorker::Whiten(const PoseRow& row, const RowMaps& maps, bool with_derivatives) {
  const Eigen::Index m = rho_.size();
  if (drives_are_exact_) {
    for (Eigen::Index i = 0; i < m; ++i) {
      const double weight = 1.0 / (i < errors_.lengths ? row.sigma_mm : row.sigma_rad);
      rho_[i] *= weight;
      if (with_derivatives) jacobian_.row(i) *= weight;
    }
    return;
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const double sigma = i < errors_.lengths ? row.sigma_mm : row.sigma_rad;
    covariance(i, i) = sigma * sigma;
  }
  const auto add = [&](const RowMaps::Map& map, const Side& side) {
    const Eigen::MatrixXd G = map * side.by_readings;
    covariance += G * drive_variance_.asDiagonal() * G.transpose();
  };
  add(maps.first, first_);
  if (maps.second.rows() > 0) add(maps.second, second_);
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  root.matrixL().solveInPlace(rho_);
  if (!with_derivatives) return;
  jacobian_.topRows(m) = root.matrixL().solve(Eigen::MatrixXd(jacobian_.topRows(m)));
}

void PoseWorker::Differentiate(const Measurement& measurement, const RowMaps& maps) {
  const Eigen::Index m = rho_.size();
  const Eigen::Index own = first_.by_parameters.cols();
  const auto others = static_cast<Eigen::Index>(of_fixtures_.size());
  jacobian_.resize(std::max<Eigen::Index>(m, 6), own + others);
  auto of_machine = jacobian_.topLeftCorner(m, own);
  of_machine.noalias() = maps.first.lazyProduct(first_.by_parameters);
  if (maps.second.rows() > 0) {
    of_machine.noalias() += maps.second.lazyProduct(second_.by_parameters);
  }
  for (Eigen::Index j = 0; j < others; ++j) {
    const int fixture = of_fixtures_[static_cast<std::size_t>(j)] / 3;
    const int component = of_fixtures_[static_cast<std::size_t>(j)] % 3;
    auto column = jacobian_.col(own + j).head(m);
    column.setZero();
    if (measurement.target == fixture) column += maps.target.col(component);
    if (measurement.fixture == fixture) column += maps.fixture.col(component);
  }
}

bool PoseWorker::Linearise(PoseRow* row, bool with_derivatives, bool moved) {
  const Measurement& measurement = *row->measurement;
  const bool two = measurement.second_readings.size() > 0;
  if (!Evaluate(measurement.readings, with_derivatives, moved, &row->z, &first_)) return false;
  if (two &&
      !Evaluate(measurement.second_readings, with_derivatives, moved, &row->z_second, &second_)) {
    return false;
  }
  const FixtureValues fixtures{.fixtures = &set_.fixtures, .value = fixture_values_.data()};
  errors_ = ErrorsOf(measurement, first_.X_WT, second_.X_WT, fixtures);
  rho_ = errors_.value;
  RowMaps maps;
  if (with_derivatives || !drives_are_exact_) {
    maps = MapsOf(measurement, first_.X_linear, second_.X_linear, fixtures);
  }
  if (with_derivatives) Differentiate(measurement, maps);
  Whiten(*row, maps, with_derivatives);
  return rho_.allFinite();
}

bool PoseWorker::ToolByParameters(PoseRow* row, Eigen::Matrix<double, 6, Eigen::Dynamic>* twists) {
  if (!Evaluate(row->measurement->readings, true, false, &row->z, &first_)) return false;
  *twists = first_.by_parameters;
  return true;
}

bool PoseWorker::AimAt(const Measurement& measurement, Eigen::VectorXd* z) {
  Eigen::Vector3d p_WT;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double>& component = measurement.position_mm[static_cast<std::size_t>(i)];
    if (!component) return false;
    p_WT[i] = *component;
  }
  trial_ = machine_.home();
  for (int i = 0; i < 12; ++i) {
    if (!linear_.PoseAt(trial_)) return false;
    Twist error;
    error << p_WT - linear_.X_WT().p,
        RotationVector(measurement.R_WT * linear_.X_WT().R.transpose());
    if (error.head<3>().norm() < 1.0 && error.tail<3>().norm() < 1e-2) {
      *z = trial_;
      return true;
    }
    const Eigen::Matrix<double, 6, 6> V = linear_.pose_by_coordinates();
    trial_ += V.partialPivLu().solve(error);
    if (!trial_.allFinite()) return false;
  }
  return false;
}

SolveStatus PoseWorker::FindStart(const Eigen::VectorXd& theta,
                                  const Eigen::VectorXd* neighbour,
                                  PoseRow* row) {
  const Measurement& measurement = *row->measurement;
  const bool two = measurement.second_readings.size() > 0;
  const auto try_from = [&](const Eigen::VectorXd& start) {
    Eigen::VectorXd z = start;
    if (!Settle(measurement.readings, Depth::kByCoordinates, &z) || !OnTheBranchOfHome()) {
      return false;
    }
    row->z = z;
    if (!two) return true;
    if (!Settle(measurement.second_readings, Depth::kByCoordinates, &z) || !OnTheBranchOfHome()) {
      return false;
    }
    row->z_second = z;
    return true;
  };
  Eigen::VectorXd aim;
  const bool full =
      measurement.kind == MeasurementKind::kPose && machine_.coordinates().size() == 6;
  if (full && AimAt(measurement, &aim) && try_from(aim)) return SolveStatus::kConverged;
  if (try_from(machine_.home())) return SolveStatus::kConverged;
  if (neighbour != nullptr && try_from(*neighbour)) return SolveStatus::kConverged;
  // The long way, which follows the branch and tells why it failed.
  RowModel model(machine_, measurement, row->sigma_mm, row->sigma_rad);
  const RowModel::Prediction prediction = model.FindStart(theta, nullptr);
  if (!prediction.ok()) return prediction.status();
  row->z = prediction.first.coordinates;
  if (two) row->z_second = prediction.second.coordinates;
  return SolveStatus::kConverged;
}

}  // namespace kompono::calibration
