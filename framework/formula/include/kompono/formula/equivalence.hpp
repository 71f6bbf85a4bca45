// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_EQUIVALENCE_HPP_
#define KOMPONO_FORMULA_EQUIVALENCE_HPP_

#include <functional>
#include <string>
#include <string_view>

#include "kompono/formula/formula.hpp"

/// Three equivalences of layouts, from fine to coarse. Each is given by a key: two formulas are
/// equivalent exactly when their keys are equal.
namespace kompono::formula {

/// Same string: the canonical text.
[[nodiscard]] std::string StringKey(const Formula& formula);

/// Same distribution of motions: neighbouring translations on one side commute.
[[nodiscard]] std::string DistributionKey(const Formula& formula);

/// Same motion of the tool relative to the workpiece: additionally, moving an axis across O only
/// changes its sign, so that the chain is read from workpiece to tool with O left out.
[[nodiscard]] std::string RelativeMotionKey(const Formula& formula);

/// Calls `visit` with every serial layout of the given motions: all orders, all positions of O,
/// leaves implied. `letters` such as "XYZC"; n letters give (n+1)! strings. A visitor that returns
/// false stops the walk.
void ForEachDistribution(std::string_view letters,
                         const std::function<bool(const Formula&)>& visit);

/// How many classes the layouts of `letters` fall into under each equivalence (design.md, section
/// 4: XYZ 24 / 8 / 1).
struct ClassCounts {
  long strings = 0;
  long distributions = 0;
  long relative_motions = 0;
  bool operator==(const ClassCounts&) const = default;
};
[[nodiscard]] ClassCounts CountClasses(std::string_view letters);

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_EQUIVALENCE_HPP_
