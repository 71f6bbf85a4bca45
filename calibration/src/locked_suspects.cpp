// SPDX-License-Identifier: Apache-2.0
#include "locked_suspects.hpp"

#include <algorithm>
#include <iterator>

#include <Eigen/Eigenvalues>

namespace kompono::calibration {
namespace {

constexpr std::size_t kMostNames = 3;
constexpr double kWorthNaming = 0.05;  ///< of the squares left
constexpr double kSeen = 1e-6;         ///< of a column's square, beside those taken out
constexpr double kRegular = 1e-9;      ///< eigenvalues with columns of unit length

/// Applies the inverse of the part of A that is seen.
class PseudoInverse {
 public:
  explicit PseudoInverse(const Eigen::MatrixXd& A) : eigen_(A) {
    const Eigen::VectorXd& values = eigen_.eigenvalues();
    inverse_ = (values.array() > kRegular).select(values.cwiseMax(kRegular).cwiseInverse(), 0.0);
  }
  [[nodiscard]] Eigen::MatrixXd operator*(const Eigen::MatrixXd& b) const {
    const Eigen::MatrixXd& V = eigen_.eigenvectors();
    return V * inverse_.asDiagonal() * (V.transpose() * b);
  }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen_;
  Eigen::VectorXd inverse_;
};

/// Normal equations of some unknowns: the squares fall by gᵀ H⁻¹ g.
struct Equations {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;

  void TakeOut(Eigen::Index i) {
    const Eigen::VectorXd column = H.col(i) / H(i, i);
    g -= column * g[i];
    H -= column * H.row(i).eval();
  }
  /// By how much number i alone would lower the squares.
  [[nodiscard]] double Gain(Eigen::Index i) const {
    return H(i, i) > kSeen ? g[i] * g[i] / H(i, i) : 0.0;
  }
};

std::vector<int> Locked(const kinematics::Machine& machine, const Selection& selection) {
  std::vector<int> locked;
  for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
    const kinematics::Parameter& parameter = machine.parameters()[i];
    const auto index = static_cast<int>(i);
    const bool free = std::binary_search(selection.free.begin(), selection.free.end(), index);
    const bool may_be_off = parameter.tolerance > 0.0 || parameter.identifiable ||
                            GroupOf(parameter.name) == ParameterGroup::kFrames;
    if (!free && may_be_off) locked.push_back(index);
  }
  return locked;
}

/// Equations of the locked numbers (columns of unit length), the free ones eliminated.
Equations Eliminate(const NormalEquations& all,
                    const std::vector<Eigen::Index>& free,
                    const std::vector<Eigen::Index>& locked) {
  const Eigen::MatrixXd full = all.H.selfadjointView<Eigen::Upper>();
  const Eigen::VectorXd norm =
      (full.diagonal().array() > 0.0)
          .select(full.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse(), 0.0);
  const Eigen::MatrixXd H = norm.asDiagonal() * full * norm.asDiagonal();
  const Eigen::VectorXd g = norm.asDiagonal() * all.g;
  const PseudoInverse inverse(H(free, free));
  const Eigen::MatrixXd cross = H(free, locked);
  return {.H = H(locked, locked) - cross.transpose() * (inverse * cross),
          .g = g(locked) - cross.transpose() * (inverse * Eigen::MatrixXd(g(free)))};
}

}  // namespace

LockedSuspects SuspectLocked(const kinematics::Machine& machine,
                             const MeasurementSet& set,
                             const std::vector<std::size_t>& rows,
                             const Selection& selection,
                             const Eigen::VectorXd& theta,
                             const RowNoise& noise) {
  LockedSuspects out;
  const std::vector<int> locked = Locked(machine, selection);
  if (locked.empty() || rows.empty()) return out;
  MeasurementSet some{.fixtures = set.fixtures};
  for (const std::size_t k : rows) some.measurements.push_back(set.measurements[k]);
  std::vector<int> both;
  std::merge(selection.free.begin(),
             selection.free.end(),
             locked.begin(),
             locked.end(),
             std::back_inserter(both));
  std::vector<Eigen::Index> of_free;
  std::vector<Eigen::Index> of_locked;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const bool free = std::binary_search(selection.free.begin(), selection.free.end(), both[i]);
    (free ? of_free : of_locked).push_back(static_cast<Eigen::Index>(i));
  }
  PoseRows poses(machine, some, both, noise);
  poses.Start(theta);
  std::vector<std::size_t> chosen(some.measurements.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) chosen[k] = k;
  const NormalEquations all = poses.Assemble(theta, chosen, {}, true);
  const double squares = 2.0 * all.cost;
  if (!all.ok || squares <= 0.0) return out;
  Equations left = Eliminate(all, of_free, of_locked);
  out.share_of_all =
      std::clamp(left.g.dot(Eigen::VectorXd(PseudoInverse(left.H) * left.g)) / squares, 0.0, 1.0);
  while (out.names.size() < kMostNames) {
    Eigen::Index best = 0;
    for (Eigen::Index i = 1; i < left.g.size(); ++i) {
      if (left.Gain(i) > left.Gain(best)) best = i;
    }
    const double share = left.Gain(best) / squares;
    if (share < kWorthNaming) break;
    out.names.push_back(
        machine.parameters()[static_cast<std::size_t>(locked[static_cast<std::size_t>(best)])]
            .name);
    out.share += share;
    left.TakeOut(best);
  }
  return out;
}

}  // namespace kompono::calibration
