// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_ABILITIES_HPP_
#define KOMPONO_ANALYSIS_ABILITIES_HPP_

#include <string>
#include <string_view>
#include <vector>

#include "kompono/kinematics/machine.hpp"
#include "kompono/plugin/registry.hpp"

/// What a layout makes possible (KDD table 1), inferred from its tree: which units hold parts and
/// tools, what carries them, how they stand to each other and how far they travel. Nothing of it is
/// written in a layout file.
namespace kompono::analysis {

/// The nine abilities of KDD table 1.
enum class AbilityKind {
  kSequentialParts,  ///< sequential work on two short parts
  kTakeOver,         ///< the counter-spindle takes the part over and its second end is finished
  kLongPartEnds,     ///< opposite ends of long parts
  kMoreTools,        ///< more tools and less idle time
  kTwoToolsAtOnce,   ///< two tools on a long part at once
  kParallelParts,    ///< two short parts in parallel
  kReclampedEnds,    ///< both ends of a part with automatic re-clamping
  kQuickChangeover,  ///< quick change-over to long parts
  kLargerZone,       ///< larger work zone
};

struct Ability {
  AbilityKind kind = AbilityKind::kSequentialParts;
  bool possible = false;
  std::string reason;           ///< what gives it, with names and numbers; else what is missing
  std::vector<std::string> by;  ///< ends, axes and blocks that give it; empty if it is not possible

  [[nodiscard]] std::string_view name() const;   ///< "take_over", the same in every version
  [[nodiscard]] std::string_view title() const;  ///< for people
};

/// All nine, in the order of AbilityKind, judged at home and within the ranges of the coordinates
/// and drives; a motion without range is taken as unlimited. Clearances are not judged.
[[nodiscard]] std::vector<Ability> Abilities(const kinematics::Machine& machine,
                                             const plugin::Registry& registry);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_ABILITIES_HPP_
