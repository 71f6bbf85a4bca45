// SPDX-License-Identifier: Apache-2.0
#include "identifiability.hpp"

#include "null_words.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace kompono::calibration {
namespace {

/// Smaller entries of a null vector are rounding.
constexpr double kPart = 1e-9;

/// J without the held columns, columns of unit length, reduced to its triangle.
Eigen::MatrixXd Reduced(const Eigen::MatrixXd& J) {
  if (J.rows() <= J.cols()) return J;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(J);
  return qr.matrixQR().topRows(J.cols()).triangularView<Eigen::Upper>();
}

Eigen::MatrixXd Orthonormal(const Eigen::MatrixXd& basis) {
  if (basis.cols() == 0) return basis;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
  return qr.householderQ() * Eigen::MatrixXd::Identity(basis.rows(), basis.cols());
}

/// Gauss-Jordan on the columns of `basis`: every pivot row belongs to one column alone, so that the
/// columns have few entries. Rows in `preferred` become pivots first: frames read better as "the
/// mount against the joints" than as "one joint against the others".
void ReduceColumns(const std::vector<bool>& preferred, Eigen::MatrixXd* basis) {
  const Eigen::Index rows = basis->rows();
  const Eigen::Index columns = basis->cols();
  for (Eigen::Index k = 0; k < columns; ++k) {
    Eigen::Index best_row = 0;
    Eigen::Index best_column = k;
    double best = -1.0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (Eigen::Index j = k; j < columns; ++j) {
        const double size = std::abs((*basis)(i, j));
        const double weight = preferred[static_cast<std::size_t>(i)] && size > 1e-3 ? 1e3 : 1.0;
        if (size * weight <= best) continue;
        best = size * weight;
        best_row = i;
        best_column = j;
      }
    }
    basis->col(k).swap(basis->col(best_column));
    basis->col(k) /= (*basis)(best_row, k);
    for (Eigen::Index j = 0; j < columns; ++j) {
      if (j != k) basis->col(j) -= (*basis)(best_row, j) * basis->col(k);
    }
  }
}

/// Directions in u that J sees so weakly that their deviation exceeds `weakest`.
struct WeakDirections {
  Eigen::MatrixXd u;  ///< orthonormal, orthogonal to the exact null space
  std::vector<double> sigma;
};

WeakDirections FindWeak(const Eigen::MatrixXd& J,
                        const Eigen::MatrixXd& gauge,
                        Eigen::Index rank,
                        double weakest) {
  const Eigen::MatrixXd triangle = Reduced(J);
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(triangle - triangle * gauge * gauge.transpose(),
                                           Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  Eigen::Index strong = rank;
  while (strong > 0 && values[strong - 1] * weakest < 1.0) --strong;
  WeakDirections weak{.u = svd.matrixV().middleCols(strong, rank - strong), .sigma = {}};
  for (Eigen::Index k = strong; k < rank; ++k) weak.sigma.push_back(1.0 / values[k]);
  return weak;
}

/// Weak directions behind the null space. A number counts as part of one if that alone adds more
/// than one to its deviation.
void AddWeak(const WeakDirections& weak,
             const Eigen::VectorXd& norm,
             Eigen::MatrixXd* null_active,
             Eigen::MatrixXd* gauge_active) {
  const auto more = static_cast<Eigen::Index>(weak.sigma.size());
  const Eigen::Index exact = gauge_active->cols();
  null_active->conservativeResize(Eigen::NoChange, exact + more);
  gauge_active->conservativeResize(Eigen::NoChange, exact + more);
  gauge_active->rightCols(more) = weak.u;
  for (Eigen::Index k = 0; k < more; ++k) {
    for (Eigen::Index i = 0; i < norm.size(); ++i) {
      const double part = weak.u(i, k);
      const bool matters = std::abs(part) * weak.sigma[static_cast<std::size_t>(k)] > 1.0;
      (*null_active)(i, exact + k) = matters ? norm[i] * part : 0.0;
    }
    null_active->col(exact + k).normalize();
  }
}

bool IsSingleNumber(const std::string& name) {
  return name.find('[') == std::string::npos && !name.ends_with(".zero");
}

}  // namespace

RankAnalysis AnalyzeRank(const Eigen::MatrixXd& J,
                         const std::vector<bool>& held,
                         double threshold,
                         double weakest) {
  const Eigen::Index n = J.cols();
  RankAnalysis analysis;
  analysis.column_norm = J.colwise().norm();
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!held[static_cast<std::size_t>(i)]) active.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(active.size());
  if (count == 0) {  // every parameter stands at a bound
    analysis.null_unit.setZero(n, 0);
    analysis.gauge.setZero(n, 0);
    analysis.covariance.setZero(n, n);
    return analysis;
  }
  const double largest_column = n > 0 ? analysis.column_norm.maxCoeff() : 0.0;
  Eigen::VectorXd norm(count);
  Eigen::MatrixXd unit(J.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index i = active[static_cast<std::size_t>(k)];
    // A column of rounding errors stays one when it is not blown up to unit length.
    const bool empty = analysis.column_norm[i] <= 1e-13 * largest_column;
    norm[k] = empty ? 1.0 : analysis.column_norm[i];
    if (empty) {
      unit.col(k).setZero();
    } else {
      unit.col(k) = J.col(i) / norm[k];
    }
  }
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(Reduced(unit), Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  while (analysis.rank < values.size() && values[analysis.rank] > threshold * values[0]) {
    ++analysis.rank;
  }
  if (analysis.rank > 0) analysis.condition = values[0] / values[analysis.rank - 1];
  Eigen::MatrixXd null_active = svd.matrixV().rightCols(count - analysis.rank);
  Eigen::MatrixXd gauge_active = Orthonormal(norm.cwiseInverse().asDiagonal() * null_active);
  const Eigen::MatrixXd root = norm.cwiseInverse().asDiagonal() *
                               svd.matrixV().leftCols(analysis.rank) *
                               values.head(analysis.rank).cwiseInverse().asDiagonal();
  const Eigen::MatrixXd exact_root = root - gauge_active * (gauge_active.transpose() * root);
  // No direction has more variance than all together.
  if (exact_root.squaredNorm() > weakest * weakest) {
    WeakDirections weak = FindWeak(J(Eigen::all, active), gauge_active, analysis.rank, weakest);
    analysis.rank -= static_cast<Eigen::Index>(weak.sigma.size());
    AddWeak(weak, norm, &null_active, &gauge_active);
    analysis.weak_sigma = std::move(weak.sigma);
  }
  const Eigen::Index null = gauge_active.cols();
  const Eigen::MatrixXd free_root = root - gauge_active * (gauge_active.transpose() * root);
  const Eigen::MatrixXd covariance_active = free_root * free_root.transpose();
  analysis.null_unit.setZero(n, null);
  analysis.gauge.setZero(n, null);
  analysis.covariance.setZero(n, n);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index i = active[static_cast<std::size_t>(k)];
    analysis.null_unit.row(i) = null_active.row(k);
    analysis.gauge.row(i) = gauge_active.row(k);
    for (Eigen::Index m = 0; m < count; ++m) {
      analysis.covariance(i, active[static_cast<std::size_t>(m)]) = covariance_active(k, m);
    }
  }
  return analysis;
}

std::vector<NullDirection> DescribeNullSpace(const RankAnalysis& analysis,
                                             const kinematics::Machine& machine,
                                             const Selection& selection,
                                             const std::vector<RowModel*>& rows,
                                             const Eigen::VectorXd& theta) {
  std::vector<NullDirection> directions;
  const auto weak = static_cast<Eigen::Index>(analysis.weak_sigma.size());
  const Eigen::Index exact = analysis.null_unit.cols() - weak;
  Eigen::MatrixXd basis = analysis.null_unit.leftCols(exact);
  std::vector<bool> preferred;
  for (const int index : selection.free) {
    preferred.push_back(IsSingleNumber(selection.parameters[static_cast<std::size_t>(index)].name));
  }
  if (analysis.null_unit.cols() == 0) return directions;
  ReduceColumns(preferred, &basis);
  basis.conservativeResize(Eigen::NoChange, exact + weak);
  basis.rightCols(weak) = analysis.null_unit.rightCols(weak);
  const NullWords words(machine, selection.parameters, rows, theta);
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    basis.col(k) /= basis.col(k).cwiseAbs().maxCoeff();
    Eigen::VectorXd change = Eigen::VectorXd::Zero(theta.size());
    for (Eigen::Index i = 0; i < basis.rows(); ++i) {
      if (std::abs(basis(i, k)) < kPart) continue;
      const double norm = analysis.column_norm[i] > 0.0 ? analysis.column_norm[i] : 1.0;
      change[selection.free[static_cast<std::size_t>(i)]] = basis(i, k) * selection.scale[i] / norm;
    }
    change /= change.cwiseAbs().maxCoeff();
    directions.push_back(words.Describe(change));
    if (k < exact) continue;
    const double sigma = analysis.weak_sigma[static_cast<std::size_t>(k - exact)];
    NullDirection& last = directions.back();
    last.weak = true;
    constexpr std::string_view kNone = "without any effect";
    const std::size_t none = last.words.find(kNone);
    if (none != std::string::npos) last.words.replace(none, kNone.size(), "with hardly any effect");
    last.words += fmt::format(
        "; seen so weakly that it would be known to no better than {:.0f} tolerances, and "
        "therefore held at the smallest change",
        sigma);
  }
  return directions;
}

}  // namespace kompono::calibration
