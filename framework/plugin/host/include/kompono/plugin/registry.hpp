// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_REGISTRY_HPP_
#define KOMPONO_PLUGIN_REGISTRY_HPP_

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/plugin/bound_mechanism.hpp"
#include "kompono/plugin/description.hpp"
#include "kompono/plugin/interfaces.hpp"

/// Finds plugins by their sidecars and loads a library only when one of its modules is first
/// created.
///
///     Registry registry = Registry::Discover(PluginFolders({}));
///     auto mechanism = registry.CreateMechanism("pyramid");
///     if (!mechanism) std::cerr << Render(mechanism.error(), {});
namespace kompono::plugin {

/// Why a plugin or module was refused. Each has its code in the diagnostics: E0201 CannotOpen,
/// E0202 NotAPlugin, E0203 ContractTooNew, E0204 ContractTooOld, E0205 ToolchainMismatch, E0206
/// SidecarMismatch, E0207 DuplicateId, E0208 UnknownModule, E0209 CreateFailed, E0210 UnsafePath,
/// E0211 BadValue; E022x: the sidecar itself is wrong.
enum class LoadError {
  kCannotOpen = 201,
  kNotAPlugin = 202,
  kContractTooNew = 203,
  kContractTooOld = 204,
  kToolchainMismatch = 205,
  kSidecarMismatch = 206,
  kDuplicateId = 207,
  kUnknownModule = 208,
  kCreateFailed = 209,
  kUnsafePath = 210,
  kBadValue = 211,  ///< a module evaluated to what its contract does not allow
};

/// A plugin as it was found; a bad one stays in the list with the reason.
struct PluginRecord {
  PluginDescription description;
  bool enabled = true;
  Diagnostics reasons;   ///< why it is disabled
  std::string compiler;  ///< known once the library is loaded
};

/// The folders to search, in order: `given` (--plugin-dir), the entries of KOMPONO_PLUGIN_PATH
/// (colon-separated), and lib/kompono/plugins beside the folder of the running program
/// (../lib/kompono/plugins from bin).
[[nodiscard]] std::vector<std::filesystem::path> PluginFolders(
    std::span<const std::filesystem::path> given);

class Registry {
 public:
  /// Reads every `<folder>/*/plugin.toml`, and `<folder>/plugin.toml` if there is one. Folders are
  /// taken in the given order, plugins in a folder by name. The first plugin with an id wins; a
  /// second one is listed as disabled. Never throws for bad plugins; folders that do not exist are
  /// passed over.
  [[nodiscard]] static Registry Discover(std::span<const std::filesystem::path> folders);

  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;
  Registry(Registry&&) noexcept;
  Registry& operator=(Registry&&) noexcept;
  ~Registry();

  /// Everything found, in the order of the search. A record's modules include its presets, put on
  /// their bases if it is enabled.
  [[nodiscard]] std::span<const PluginRecord> plugins() const;
  /// All modules of enabled plugins, presets resolved, sorted by id.
  [[nodiscard]] std::span<const ModuleDescription> modules() const;
  [[nodiscard]] const ModuleDescription* Find(std::string_view module_id) const;
  [[nodiscard]] std::vector<std::string> ModuleIds(ModuleKind kind) const;

  /// E0208 for an id that Find does not know: what was perhaps meant, or which disabled plugin
  /// would have offered it and why it is disabled. Without a place; the caller knows where the id
  /// stood.
  [[nodiscard]] Diagnostic UnknownModule(std::string_view module_id) const;

  /// Loads the library if need be (thread-safe) and creates the module. The object keeps its
  /// library mapped.
  [[nodiscard]] tl::expected<std::shared_ptr<const Mechanism>, Diagnostic> CreateMechanism(
      std::string_view module_id) const;
  [[nodiscard]] tl::expected<std::shared_ptr<const Unit>, Diagnostic> CreateUnit(
      std::string_view module_id) const;

  /// The mechanism with its geometry fixed, where its plugin offers kompono.bound_mechanism/1: one
  /// pose at a time costs least so. Numbers as the sidecar orders them, mm and rad. E0209 if it
  /// does not offer it.
  [[nodiscard]] tl::expected<std::shared_ptr<const BoundMechanism>, Diagnostic> CreateBound(
      std::string_view module_id,
      std::span<const double> parameters,
      std::span<const double> modes) const;

  /// Loads every library and checks it, and each of its modules, against the sidecar, so that
  /// `plugins()` tells what is really usable. Spans and pointers given out before are void then.
  void LoadAll();

 private:
  struct State;
  explicit Registry(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_REGISTRY_HPP_
