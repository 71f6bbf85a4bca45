// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_REGION_HPP_
#define KOMPONO_ANALYSIS_REGION_HPP_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kompono/kinematics/machine.hpp"

/// Which poses of a machine are looked at, and how a long computation is watched and stopped.
namespace kompono::analysis {

using kinematics::Machine;
using kinematics::MatrixXd;
using kinematics::VectorXd;

/// A box in the virtual coordinates: some are varied between limits, the others held.
struct Region {
  VectorXd z;                        ///< all coordinates, mm and rad; those varied are overwritten
  std::vector<int> varied;           ///< indices into Machine::coordinates()
  std::vector<double> lower, upper;  ///< of the varied ones; mm, rad

  [[nodiscard]] std::size_t dimension() const { return varied.size(); }
  [[nodiscard]] double Extent(std::size_t i) const { return upper[i] - lower[i]; }
  /// Product of the extents: mm, mm² or mm³ when only lengths are varied.
  [[nodiscard]] double Content() const;
  /// z with the varied coordinates at `at`.
  [[nodiscard]] VectorXd At(std::span<const double> at) const;
};

/// Progress and stop of a long computation. Whatever is done when `stop` becomes true is kept.
struct RunControl {
  unsigned threads = 0;  ///< 0: all cores
  /// Called about ten times a second, always from the calling thread.
  std::function<void(std::uint64_t done, std::uint64_t all)> progress;
  const std::atomic<bool>* stop = nullptr;

  [[nodiscard]] unsigned Threads() const;
  [[nodiscard]] bool Stopped() const {
    return stop != nullptr && stop->load(std::memory_order_relaxed);
  }
};

/// Runs `work(task, worker)` for the tasks 0, 1, 2, … on all cores; the calling thread is worker 0.
/// Tasks are given out in ascending order and everything given out is finished, so that after a
/// stop the result is the number of tasks done, without gaps. `work` must not throw.
[[nodiscard]] std::uint64_t ForEachTask(
    std::uint64_t tasks,
    const RunControl& control,
    const std::function<void(std::uint64_t task, unsigned worker)>& work);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_REGION_HPP_
