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

/// Same distribution of motions: neighbouring translations on one side commute. A group is one
/// item; its own neighbouring translations are sorted too (a rotation keeps its place, since `XC`
/// and `CX` move differently), and a group of translations only commutes like a translation. The
/// branches of a fork have no order. O and O|O differ.
[[nodiscard]] std::string DistributionKey(const Formula& formula);

/// Same motion of the tool relative to the workpiece: additionally, moving an axis across O only
/// changes its sign, so that the chain is read from workpiece to tool with O (or O|O) and the signs
/// left out.
[[nodiscard]] std::string RelativeMotionKey(const Formula& formula);

/// Calls `visit` with every serial layout of the given motions: all orders, all positions of O,
/// leaves implied, always in the same sequence; n motions give (n+1)! of them. `letters` such as
/// "XYZC"; small letters are setting motions, digits number the letter in front ("XYZX2"). A
/// visitor that returns false stops the walk.
/// @throws std::logic_error if `letters` has something else than axes, or one of them twice.
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
/// Counted by enumeration: 9 motions are 3.6 million strings. Throws as ForEachDistribution.
[[nodiscard]] ClassCounts CountClasses(std::string_view letters);

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_EQUIVALENCE_HPP_
