// SPDX-License-Identifier: Apache-2.0
#include "presets.hpp"

#include "manifest.hpp"
#include "parameter_reader.hpp"
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::plugin {
namespace {

std::string Listing(const PluginRecord& record) {
  return fmt::format("'{}' ({})", record.description.id, record.description.sidecar.string());
}

/// One pass over all enabled plugins. A plugin found bad makes the pass void: the next one goes
/// without it.
class Pass {
 public:
  explicit Pass(std::vector<FoundPlugin>& plugins) : plugins_(plugins) {}

  /// True if no plugin had to be disabled.
  [[nodiscard]] bool Run(Offer& offer) {
    CollectIds();
    if (!clean_) return false;
    for (const auto& [id, place] : places_) {
      if (std::optional<ModuleDescription> module = Resolve(id))
        offer.modules.push_back(std::move(*module));
      if (place.preset == nullptr) offer.implementers[id] = place.plugin;
    }
    return clean_;
  }

 private:
  struct Place {
    std::size_t plugin = 0;
    const ModuleDescription* module = nullptr;
    const PresetDescription* preset = nullptr;
  };

  void Disable(std::size_t plugin,
               std::string code,
               SourceSpan span,
               std::string message,
               std::string help) {
    PluginRecord& record = plugins_[plugin].record;
    record.enabled = false;
    clean_ = false;
    record.reasons.push_back({.code = std::move(code),
                              .file = record.description.sidecar.string(),
                              .span = std::move(span),
                              .message = std::move(message),
                              .help = std::move(help)});
  }

  void Offered(const std::string& id, Place place) {
    const auto [at, added] = places_.emplace(id, place);
    if (added) return;
    Disable(place.plugin,
            CodeOf(LoadError::kDuplicateId),
            {},
            fmt::format("module '{}' is already offered by plugin {}",
                        id,
                        Listing(plugins_[at->second.plugin].record)),
            "rename the module, or leave one of the two plugins out");
  }

  void CollectIds() {
    for (std::size_t i = 0; i < plugins_.size(); ++i) {
      const FoundPlugin& plugin = plugins_[i];
      if (!plugin.record.enabled) continue;
      for (const ModuleDescription& module : plugin.record.description.modules)
        Offered(module.id, {.plugin = i, .module = &module});
      for (const PresetDescription& preset : plugin.presets)
        Offered(preset.own.id, {.plugin = i, .preset = &preset});
    }
  }

  /// The module, with all presets on the way put on it; nothing if it is broken, which was then
  /// said of its plugin, once.
  std::optional<ModuleDescription> Resolve(const std::string& id) {
    if (const auto known = resolved_.find(id); known != resolved_.end()) return known->second;
    std::optional<ModuleDescription> module = ResolveAnew(id);
    resolved_.insert_or_assign(id, module);
    return module;
  }

  std::optional<ModuleDescription> ResolveAnew(const std::string& id) {
    const Place& place = places_.at(id);
    if (place.preset == nullptr) return *place.module;
    if (std::find(chain_.begin(), chain_.end(), id) != chain_.end()) {
      chain_.push_back(id);
      Disable(place.plugin,
              "E0227",
              SpanOf(*place.preset, "of"),
              fmt::format("presets stand on each other in a circle: {}", fmt::join(chain_, " -> ")),
              "one of them must stand on a module");
      chain_.pop_back();
      return std::nullopt;
    }
    const std::string& base_id = place.preset->own.implementation;
    if (!places_.contains(base_id)) {
      RefuseUnknownBase(place, base_id);
      return std::nullopt;
    }
    chain_.push_back(id);
    const std::optional<ModuleDescription> base = Resolve(base_id);
    chain_.pop_back();
    if (!base) return std::nullopt;
    return Apply(place, *base);
  }

  void RefuseUnknownBase(const Place& place, const std::string& base_id) {
    std::vector<std::string> known;
    for (const auto& [id, other] : places_) {
      if (id != place.preset->own.id) known.push_back(id);
    }
    std::string help = DidYouMean(base_id, known);
    for (const FoundPlugin& plugin : plugins_) {
      if (!plugin.record.enabled && Describes(plugin, base_id))
        help = fmt::format("plugin {} has it, but is disabled", Listing(plugin.record));
    }
    Disable(place.plugin,
            CodeOf(LoadError::kUnknownModule),
            SpanOf(*place.preset, "of"),
            fmt::format("preset '{}' stands on unknown module '{}'", place.preset->own.id, base_id),
            std::move(help));
  }

  static bool Describes(const FoundPlugin& plugin, const std::string& id) {
    const auto& modules = plugin.record.description.modules;
    return std::any_of(modules.begin(),
                       modules.end(),
                       [&id](const ModuleDescription& module) { return module.id == id; }) ||
           std::any_of(plugin.presets.begin(),
                       plugin.presets.end(),
                       [&id](const PresetDescription& preset) { return preset.own.id == id; });
  }

  static SourceSpan SpanOf(const PresetDescription& preset, const std::string& key) {
    const auto found = preset.places.find(key);
    return found == preset.places.end() ? SourceSpan{} : found->second;
  }

  std::optional<ModuleDescription> Apply(const Place& place, ModuleDescription module) {
    const PresetDescription& preset = *place.preset;
    bool good = true;
    for (const auto& [name, values] : preset.fixed)
      good = SetParameter(place, module, "fixed." + name, name, values) && good;
    for (const auto& [name, values] : preset.defaults)
      good = SetParameter(place, module, "defaults." + name, name, values) && good;
    for (const auto& [name, sign] : preset.mode_defaults)
      good = SetMode(place, module, name, sign) && good;
    if (!good) return std::nullopt;
    for (const auto& [name, values] : preset.fixed) {
      for (ParameterDescription& parameter : module.parameters)
        parameter.fixed = parameter.fixed || parameter.name == name;
    }
    module.id = preset.own.id;
    module.title = preset.own.title;
    module.summary = preset.own.summary;
    module.plugin_id = preset.own.plugin_id;
    module.plugin_version = preset.own.plugin_version;
    if (!preset.own.capabilities.empty()) module.capabilities = preset.own.capabilities;
    if (!preset.own.sources.empty()) module.sources = preset.own.sources;
    return module;
  }

  bool SetParameter(const Place& place,
                    ModuleDescription& module,
                    const std::string& key,
                    const std::string& name,
                    const std::vector<double>& values) {
    const auto found = std::find_if(
        module.parameters.begin(), module.parameters.end(), [&name](const ParameterDescription& p) {
          return p.name == name;
        });
    std::string code = "E0224";
    std::string message;
    std::string help;
    if (found == module.parameters.end()) {
      std::vector<std::string> known;
      for (const ParameterDescription& parameter : module.parameters)
        known.push_back(parameter.name);
      code = "E0226";
      message = fmt::format("module '{}' has no parameter '{}'", module.id, name);
      help = DidYouMean(name, known);
    } else if (found->fixed) {
      message = fmt::format("preset '{}' fixes '{}' already", module.id, name);
    } else if (static_cast<int>(values.size()) != found->Numbers()) {
      message = fmt::format("'{}' is {}: {} numbers are needed, {} are given",
                            name,
                            ShapeText(*found),
                            found->Numbers(),
                            values.size());
    } else if (const std::string wrong = OutOfRange(*found, values); !wrong.empty()) {
      message = fmt::format("'{}': {}", name, wrong);
    } else {
      found->default_value = values;
      return true;
    }
    Disable(place.plugin, code, SpanOf(*place.preset, key), std::move(message), std::move(help));
    return false;
  }

  bool SetMode(const Place& place, ModuleDescription& module, const std::string& name, int sign) {
    std::vector<std::string> known;
    for (ModeDescription& mode : module.modes) {
      if (mode.name == name) {
        mode.default_sign = sign;
        return true;
      }
      known.push_back(mode.name);
    }
    Disable(place.plugin,
            "E0226",
            SpanOf(*place.preset, "modes." + name),
            fmt::format("module '{}' has no mode '{}'", module.id, name),
            DidYouMean(name, known));
    return false;
  }

  std::vector<FoundPlugin>& plugins_;
  std::map<std::string, Place> places_;
  std::map<std::string, std::optional<ModuleDescription>> resolved_;
  std::vector<std::string> chain_;
  bool clean_ = true;
};

}  // namespace

Offer ResolveOffer(std::vector<FoundPlugin>& plugins) {
  for (;;) {
    Offer offer;
    if (Pass(plugins).Run(offer)) return offer;
  }
}

}  // namespace kompono::plugin
