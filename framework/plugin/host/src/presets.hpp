// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_PRESETS_HPP_
#define KOMPONO_PLUGIN_HOST_PRESETS_HPP_

#include <map>
#include <string>
#include <vector>

#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {

/// A plugin as found, with its presets before they were put on their bases.
struct FoundPlugin {
  PluginRecord record;
  std::vector<PresetDescription> presets;
};

/// What all enabled plugins offer together.
struct Offer {
  std::vector<ModuleDescription> modules;           ///< presets resolved, sorted by id
  std::map<std::string, std::size_t> implementers;  ///< module with code -> index of its plugin
};

/// Puts every preset on its base. Plugins whose presets cannot be resolved, or that offer a module
/// another plugin before them offers, are disabled, with reasons in their records; so are those
/// that stand on them.
[[nodiscard]] Offer ResolveOffer(std::vector<FoundPlugin>& plugins);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_PRESETS_HPP_
