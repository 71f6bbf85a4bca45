// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_SIZING_HPP_
#define KOMPONO_SYNTHESIS_SIZING_HPP_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kompono/analysis/region.hpp"
#include "kompono/kinematics/machine.hpp"
#include "kompono/synthesis/evaluation.hpp"

/// Sizes before layouts are compared: the smallest mechanism that reaches the whole required zone
/// and is nowhere worse conditioned than the study asks.
namespace kompono::synthesis {

/// A number that may be chosen. All of `numbers` (indices into the machine's θ) get its value; or
/// it is the place of the zone's middle in the mechanism: the zone moves along `coordinate` (index
/// into z) by `sign` times what the value differs from `start`, which is where the machine has it.
struct FreeNumber {
  std::vector<int> numbers;
  int coordinate = -1;
  double sign = 1.0;
  double lower = 0.0, upper = 0.0, start = 0.0;  ///< mm or rad
};

/// One mechanism of a machine and the zone it must serve.
struct SizingTask {
  const kinematics::Machine* machine = nullptr;
  std::size_t mechanism = 0;                 ///< of Machine::blocks()
  const analysis::Region* region = nullptr;  ///< in the machine's coordinates
  std::vector<FreeNumber> free;
};

struct SizingResult {
  std::vector<double> values;    ///< of the free numbers
  double dexterity_worst = 0.0;  ///< 1/condition over the grid; 0 where the zone is not reached
  double share = 0.0;            ///< of the grid that is reached
  double size_mm = 0.0;          ///< diagonal of the box around the mechanism in all of the zone
  int evaluations = 0;
  [[nodiscard]] bool Reaches() const { return share >= 1.0; }
};

/// Minimises the size under `dexterity_worst >= dexterity_goal` and full reach: the best of
/// quasi-random starts (Halton), then COBYLA (NLopt; Powell 1994). Deterministic. Where the goal
/// cannot be met the result is the nearest to it.
[[nodiscard]] SizingResult SizeMechanism(const SizingTask& task,
                                         const EvaluationSettings& settings);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_SIZING_HPP_
