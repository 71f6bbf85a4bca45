// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_MANIFEST_HPP_
#define KOMPONO_PLUGIN_HOST_MANIFEST_HPP_

#include <optional>
#include <string>
#include <string_view>

#include "kompono/plugin/abi.h"
#include "kompono/plugin/description.hpp"
#include "kompono/plugin/interfaces.hpp"
#include "kompono/plugin/registry.hpp"

/// Judges what a library says of itself, before any of its functions is called. No files, no
/// libraries here: only numbers and words are compared.
namespace kompono::plugin {

struct Refusal {
  std::string code, message, help;
};

/// "E0203"
[[nodiscard]] std::string CodeOf(LoadError error);

/// The interface that a module of this kind must offer.
[[nodiscard]] std::string_view MainInterface(ModuleKind kind);

/// The first entry of a module with this interface (empty: any); null if there is none.
[[nodiscard]] const KomponoModule* FindEntry(const KomponoPlugin& manifest,
                                             std::string_view module_id,
                                             std::string_view interface_id);

/// Whether a plugin written for this contract can run here.
[[nodiscard]] std::optional<Refusal> JudgeContract(int major, int minor);

/// Whether the symbol is a manifest, for this host, and says the same as the sidecar.
[[nodiscard]] std::optional<Refusal> JudgeManifest(const KomponoPlugin& manifest,
                                                   const PluginDescription& plugin);

/// Whether a created module has as many numbers of everything as its sidecar says.
[[nodiscard]] std::optional<Refusal> JudgeShape(const MechanismShape& shape,
                                                const ModuleDescription& module);
[[nodiscard]] std::optional<Refusal> JudgeShape(const UnitShape& shape,
                                                const ModuleDescription& module);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_MANIFEST_HPP_
