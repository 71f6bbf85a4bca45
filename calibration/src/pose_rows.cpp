// SPDX-License-Identifier: Apache-2.0
#include "pose_rows.hpp"

#include "pose_worker.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include <Eigen/QR>

namespace kompono::calibration {
namespace {

using kinematics::SolveStatus;

/// Fewer rows are not worth a second thread.
constexpr std::size_t kRowsOfAThread = 1500;
constexpr double kMoved = 2e-4;  ///< change of θ after which rows are expected to be off; mm, rad
constexpr Eigen::Index kBlockRows = 192;

}  // namespace

PoseRows::PoseRows(const kinematics::Machine& machine,
                   const MeasurementSet& set,
                   std::vector<int> free,
                   const RowNoise& noise)
    : machine_(machine), set_(set), free_(std::move(free)), noise_(noise) {
  const auto drives = static_cast<Eigen::Index>(machine.drives().size());
  drive_variance_.resize(drives);
  for (Eigen::Index i = 0; i < drives; ++i) {
    const bool rotary = machine.drives()[static_cast<std::size_t>(i)].rotary;
    const double sigma = rotary ? noise.drive_sigma_rad : noise.drive_sigma_mm;
    drive_variance_[i] = sigma * sigma;
  }
  rows_.reserve(set.measurements.size());
  for (const Measurement& m : set.measurements) {
    rows_.push_back(
        {.measurement = &m,
         .sigma_mm = m.sigma_mm.value_or(noise.default_sigma_mm),
         .sigma_rad = m.sigma_rad.value_or(noise.default_sigma_rad),
         .z = machine.home(),
         .z_second = m.second_readings.size() > 0 ? machine.home() : Eigen::VectorXd()});
  }
}

PoseRows::~PoseRows() = default;

void PoseRows::ForEachChunk(
    const Eigen::VectorXd& theta,
    std::size_t count,
    const std::function<void(PoseWorker&, std::size_t, std::size_t)>& work) {
  const std::size_t most = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t threads = std::clamp<std::size_t>(count / kRowsOfAThread, 1, most);
  while (workers_.size() < threads) {
    workers_.push_back(std::make_unique<PoseWorker>(machine_, set_, free_, drive_variance_));
    workers_.back()->set_number(workers_.size() - 1);
  }
  for (std::size_t i = 0; i < threads; ++i) workers_[i]->SetGeometry(theta);
  const auto begin_of = [&](std::size_t i) { return count * i / threads; };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < threads; ++i) {
    others.emplace_back([&, i] { work(*workers_[i], begin_of(i), begin_of(i + 1)); });
  }
  work(*workers_[0], 0, begin_of(1));
  for (std::thread& other : others) other.join();
}

std::vector<SolveStatus> PoseRows::Start(const Eigen::VectorXd& theta) {
  std::vector<SolveStatus> status(rows_.size(), SolveStatus::kConverged);
  ForEachChunk(theta, rows_.size(), [&](PoseWorker& worker, std::size_t begin, std::size_t end) {
    const Eigen::VectorXd* neighbour = nullptr;
    for (std::size_t k = begin; k < end; ++k) {
      PoseRow& row = rows_[k];
      status[k] = worker.FindStart(theta, neighbour, &row);
      if (status[k] == SolveStatus::kConverged) neighbour = &row.z;
    }
  });
  last_theta_ = theta;
  return status;
}

NormalEquations PoseRows::Assemble(const Eigen::VectorXd& theta,
                                   const std::vector<std::size_t>& chosen,
                                   const std::vector<double>& weights,
                                   bool with_derivatives) {
  const auto n = static_cast<Eigen::Index>(free_.size());
  const bool moved = (theta - last_theta_).cwiseAbs().maxCoeff() > kMoved;
  last_theta_ = theta;
  NormalEquations out;
  out.H.setZero(n, n);
  out.g.setZero(n);
  out.squares.resize(rows_.size(), 0.0);
  std::vector<NormalEquations> parts(std::max(1U, std::thread::hardware_concurrency()));
  ForEachChunk(theta, chosen.size(), [&](PoseWorker& worker, std::size_t begin, std::size_t end) {
    NormalEquations& part = parts[worker.number()];
    part.H.setZero(n, n);
    part.g.setZero(n);
    Eigen::MatrixXd J(kBlockRows, n);
    Eigen::VectorXd r(kBlockRows);
    Eigen::Index filled = 0;
    const auto flush = [&] {
      if (filled == 0 || !with_derivatives) return;
      part.H.selfadjointView<Eigen::Upper>().rankUpdate(J.topRows(filled).transpose());
      part.g.noalias() += J.topRows(filled).transpose() * r.head(filled);
      filled = 0;
    };
    for (std::size_t i = begin; i < end && part.ok; ++i) {
      PoseRow& row = rows_[chosen[i]];
      if (!worker.Linearise(&row, with_derivatives, moved)) {
        part.ok = false;
        break;
      }
      const double weight = weights.empty() ? 1.0 : weights[chosen[i]];
      const double square = worker.rho().squaredNorm();
      out.squares[chosen[i]] = square;
      part.cost += 0.5 * weight * square;
      if (!with_derivatives || weight == 0.0) continue;
      const Eigen::Index m = worker.rho().size();
      if (filled + m > kBlockRows) flush();
      J.middleRows(filled, m) = std::sqrt(weight) * worker.jacobian().topRows(m);
      r.segment(filled, m) = std::sqrt(weight) * worker.rho();
      filled += m;
    }
    flush();
  });
  for (const NormalEquations& part : parts) {
    if (part.H.size() == 0) continue;
    out.ok = out.ok && part.ok;
    out.cost += part.cost;
    out.H += part.H;
    out.g += part.g;
  }
  return out;
}

Eigen::MatrixXd PoseRows::Triangle(const Eigen::VectorXd& theta,
                                   const std::vector<std::size_t>& chosen,
                                   const std::vector<double>& weights,
                                   const Eigen::VectorXd& scale) {
  const auto n = static_cast<Eigen::Index>(free_.size());
  const Eigen::Index capacity = std::max<Eigen::Index>(2 * n + 6, 384);
  Eigen::MatrixXd stack(capacity, n);
  Eigen::Index filled = 0;
  const auto reduce = [&] {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stack.topRows(filled));
    const Eigen::Index rank_rows = std::min(filled, n);
    stack.topRows(rank_rows) =
        Eigen::MatrixXd(qr.matrixQR().topRows(rank_rows).triangularView<Eigen::Upper>());
    filled = rank_rows;
  };
  ForEachChunk(theta, 1, [&](PoseWorker& worker, std::size_t, std::size_t) {
    for (const std::size_t k : chosen) {
      const double weight = weights.empty() ? 1.0 : weights[k];
      if (weight == 0.0 || !worker.Linearise(&rows_[k], true, false)) continue;
      const Eigen::Index m = worker.rho().size();
      if (filled + m > capacity) reduce();
      stack.middleRows(filled, m) =
          std::sqrt(weight) * worker.jacobian().topRows(m) * scale.asDiagonal();
      filled += m;
    }
  });
  if (filled > n) reduce();
  return stack.topRows(filled);
}

std::vector<PoseRows::Judged> PoseRows::Judge(const Eigen::VectorXd& theta) {
  std::vector<Judged> judged(rows_.size());
  ForEachChunk(theta, rows_.size(), [&](PoseWorker& worker, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      judged[k].ok = worker.Linearise(&rows_[k], false, true);
      if (!judged[k].ok) continue;
      judged[k].errors = worker.errors();
      judged[k].whitened_square = worker.rho().squaredNorm();
    }
  });
  return judged;
}

bool PoseRows::ToolByParameters(const Eigen::VectorXd& theta,
                                std::size_t k,
                                Eigen::Matrix<double, 6, Eigen::Dynamic>* twists) {
  bool ok = false;
  ForEachChunk(theta, 1, [&](PoseWorker& worker, std::size_t, std::size_t) {
    ok = worker.ToolByParameters(&rows_[k], twists);
  });
  return ok;
}

}  // namespace kompono::calibration
