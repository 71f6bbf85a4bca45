// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_CAPABILITY_WORDS_HPP_
#define KOMPONO_PLUGIN_CAPABILITY_WORDS_HPP_

#include <array>
#include <string_view>

/// The words a sidecar's `capabilities` may use. They are facts about one module, from which the
/// abilities of a whole machine are inferred; a plugin's own words have a dot: "example.milling".
namespace kompono::plugin {

struct CapabilityWord {
  std::string_view word;
  std::string_view meaning;
};

namespace words {
inline constexpr std::string_view kCarriesPart = "carries_part";
inline constexpr std::string_view kCarriesTool = "carries_tool";
inline constexpr std::string_view kMainMotion = "main_motion";
inline constexpr std::string_view kManyTools = "many_tools";
inline constexpr std::string_view kProcessJet = "process_jet";
inline constexpr std::string_view kSupportsPart = "supports_part";
inline constexpr std::string_view kSwivelsTool = "swivels_tool";
inline constexpr std::string_view kTwoTurrets = "two_turrets";
}  // namespace words

/// In alphabetical order.
inline constexpr std::array kCapabilityWords{
    CapabilityWord{words::kCarriesPart, "holds a workpiece by one end or clamps it"},
    CapabilityWord{words::kCarriesTool, "holds a tool"},
    CapabilityWord{words::kMainMotion, "turns what it holds at cutting speed"},
    CapabilityWord{words::kManyTools, "holds several tools and indexes from one to another"},
    CapabilityWord{words::kProcessJet, "cuts with a jet or beam instead of a tool"},
    CapabilityWord{words::kSupportsPart, "supports the free end of a part that another unit holds"},
    CapabilityWord{words::kSwivelsTool, "swings its tools towards either end of the part"},
    CapabilityWord{words::kTwoTurrets,
                   "two sets of tools that index by themselves and look at either end of the part"},
};

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_CAPABILITY_WORDS_HPP_
