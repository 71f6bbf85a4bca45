// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_SRC_JUDGE_HPP_
#define KOMPONO_FORMULA_SRC_JUDGE_HPP_

#include "reader.hpp"
#include "report.hpp"

#include "kompono/formula/formula.hpp"

namespace kompono::formula {

/// The third stage: finds the base, puts every leaf at the end of its side or branch, and checks
/// what must be unique. `whole` is the place of the formula in its text. The result means something
/// only if no error was reported.
[[nodiscard]] Formula JudgeNodes(Nodes nodes, Range whole, Report& report);

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_SRC_JUDGE_HPP_
