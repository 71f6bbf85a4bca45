// SPDX-License-Identifier: Apache-2.0
#include "kompono/plugin/registry.hpp"

#include "library.hpp"
#include "manifest.hpp"
#include "path_safety.hpp"
#include "presets.hpp"
#include "sidecar_reading.hpp"
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::plugin {
namespace {

namespace fs = std::filesystem;

/// The sidecars of one folder, by name, so that listings and tests do not depend on the disk.
std::vector<fs::path> SidecarsIn(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> sidecars;
  if (fs::exists(folder / "plugin.toml", error)) sidecars.push_back(folder / "plugin.toml");
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path sidecar = entry->path() / "plugin.toml";
    std::error_code absent;
    if (fs::exists(sidecar, absent)) sidecars.push_back(sidecar);
  }
  std::sort(sidecars.begin(), sidecars.end());
  return sidecars;
}

FoundPlugin ReadPlugin(const fs::path& sidecar, const fs::path& folder) {
  SidecarReading reading = ReadFileLeniently(sidecar);
  FoundPlugin found;
  found.record.description = std::move(reading.sidecar.plugin);
  found.record.reasons = std::move(reading.problems);
  found.presets = std::move(reading.sidecar.presets);
  if (found.record.description.id.empty())
    found.record.description.id = sidecar.parent_path().filename().string();
  // A stranger who may write into the folder of folders can add a plugin to it, too.
  std::optional<Diagnostic> unsafe = JudgePath(sidecar);
  if (!unsafe && sidecar.parent_path() != folder) unsafe = JudgePath(sidecar.parent_path());
  if (unsafe) found.record.reasons.insert(found.record.reasons.begin(), std::move(*unsafe));
  found.record.enabled = !HasErrors(found.record.reasons);
  return found;
}

void DisableSecondOnes(std::vector<FoundPlugin>& plugins) {
  std::map<std::string, const FoundPlugin*> first;
  for (FoundPlugin& plugin : plugins) {
    PluginRecord& record = plugin.record;
    if (!record.enabled) continue;
    const auto [at, added] = first.emplace(record.description.id, &plugin);
    if (added) continue;
    record.enabled = false;
    record.reasons.push_back(
        {.code = CodeOf(LoadError::kDuplicateId),
         .file = record.description.sidecar.string(),
         .message = fmt::format("plugin '{}' was already found as {}",
                                record.description.id,
                                at->second->record.description.sidecar.string()),
         .help = "the first in the order of the search is used"});
  }
}

/// One plugin's library, opened when it is first needed.
struct Slot {
  std::mutex mutex;
  std::optional<tl::expected<std::shared_ptr<const Library>, Diagnostic>> opened;
};

std::string_view KindName(ModuleKind kind) {
  return kind == ModuleKind::kMechanism ? "mechanism" : "unit";
}

}  // namespace

struct Registry::State {
  std::vector<FoundPlugin> found;
  std::deque<Slot> slots;  ///< one per found plugin
  std::vector<PluginRecord> records;
  Offer offer;
  std::vector<std::string> folders;

  /// Works out what is offered and makes the listing of it.
  void Publish() {
    offer = ResolveOffer(found);
    records.clear();
    for (const FoundPlugin& plugin : found) {
      PluginRecord record = plugin.record;
      for (const PresetDescription& preset : plugin.presets) {
        const ModuleDescription* resolved = record.enabled ? Find(preset.own.id) : nullptr;
        record.description.modules.push_back(resolved == nullptr ? preset.own : *resolved);
      }
      records.push_back(std::move(record));
    }
  }

  [[nodiscard]] const ModuleDescription* Find(std::string_view id) const {
    const auto at = std::lower_bound(
        offer.modules.begin(),
        offer.modules.end(),
        id,
        [](const ModuleDescription& module, std::string_view word) { return module.id < word; });
    return at != offer.modules.end() && at->id == id ? &*at : nullptr;
  }

  [[nodiscard]] tl::expected<std::shared_ptr<const Library>, Diagnostic> Open(std::size_t plugin) {
    Slot& slot = slots[plugin];
    const std::lock_guard<std::mutex> lock(slot.mutex);
    if (!slot.opened) slot.opened = Library::Open(found[plugin].record.description);
    return *slot.opened;
  }

  template <class Interface>
  [[nodiscard]] tl::expected<std::shared_ptr<const Interface>, Diagnostic> Create(
      const ModuleDescription& module) {
    const std::size_t plugin = offer.implementers.at(module.implementation);
    auto library = Open(plugin);
    if (!library) return tl::unexpected(std::move(library.error()));
    return Library::Create<Interface>(*library, *Find(module.implementation));
  }

  template <class Interface>
  [[nodiscard]] tl::expected<std::shared_ptr<const Interface>, Diagnostic> Create(
      const Registry& registry, std::string_view id, ModuleKind kind) {
    const ModuleDescription* module = Find(id);
    if (module == nullptr) return tl::unexpected(registry.UnknownModule(id));
    if (module->kind == kind) return Create<Interface>(*module);
    return tl::unexpected(
        Diagnostic{.code = CodeOf(LoadError::kUnknownModule),
                   .message = fmt::format(
                       "module '{}' is a {}, not a {}", id, KindName(module->kind), KindName(kind)),
                   .help = DidYouMean(id, registry.ModuleIds(kind))});
  }

  /// Opens a plugin's library and makes each of its modules once.
  [[nodiscard]] std::optional<Diagnostic> TryOut(std::size_t plugin) {
    auto library = Open(plugin);
    if (!library) return std::move(library.error());
    PluginRecord& record = found[plugin].record;
    record.compiler = (*library)->compiler();
    for (const ModuleDescription& module : record.description.modules) {
      if (module.kind == ModuleKind::kMechanism) {
        if (auto made = Library::Create<Mechanism>(*library, module); !made) return made.error();
      } else {
        if (auto made = Library::Create<Unit>(*library, module); !made) return made.error();
      }
    }
    return std::nullopt;
  }
};

Registry::Registry(std::unique_ptr<State> state) : state_(std::move(state)) {}
Registry::Registry(Registry&&) noexcept = default;
Registry& Registry::operator=(Registry&&) noexcept = default;
Registry::~Registry() = default;

Registry Registry::Discover(std::span<const std::filesystem::path> folders) {
  auto state = std::make_unique<State>();
  std::set<fs::path> seen;
  for (const fs::path& folder : folders) {
    state->folders.push_back(folder.string());
    for (const fs::path& sidecar : SidecarsIn(folder)) {
      std::error_code error;
      if (seen.insert(fs::canonical(sidecar, error)).second)
        state->found.push_back(ReadPlugin(sidecar, folder));
    }
  }
  DisableSecondOnes(state->found);
  state->slots.resize(state->found.size());
  state->Publish();
  return Registry(std::move(state));
}

std::span<const PluginRecord> Registry::plugins() const {
  return state_->records;
}

std::span<const ModuleDescription> Registry::modules() const {
  return state_->offer.modules;
}

const ModuleDescription* Registry::Find(std::string_view module_id) const {
  return state_->Find(module_id);
}

std::vector<std::string> Registry::ModuleIds(ModuleKind kind) const {
  std::vector<std::string> ids;
  for (const ModuleDescription& module : modules()) {
    if (module.kind == kind) ids.push_back(module.id);
  }
  return ids;
}

Diagnostic Registry::UnknownModule(std::string_view module_id) const {
  Diagnostic diagnostic{.code = CodeOf(LoadError::kUnknownModule),
                        .message = fmt::format("unknown module '{}'", module_id)};
  for (const PluginRecord& record : state_->records) {
    const auto& modules = record.description.modules;
    const bool has =
        std::any_of(modules.begin(), modules.end(), [module_id](const ModuleDescription& module) {
          return module.id == module_id;
        });
    if (record.enabled || !has || record.reasons.empty()) continue;
    diagnostic.help = fmt::format("plugin '{}' ({}) would offer it, but is disabled: {} [{}]",
                                  record.description.id,
                                  record.description.sidecar.string(),
                                  record.reasons.front().message,
                                  record.reasons.front().code);
    return diagnostic;
  }
  std::vector<std::string> known;
  for (const ModuleDescription& module : modules()) known.push_back(module.id);
  diagnostic.help = DidYouMean(module_id, known);
  if (known.empty())
    diagnostic.help = fmt::format(
        "no plugin was found in: {}; name a folder with --plugin-dir or "
        "KOMPONO_PLUGIN_PATH",
        fmt::join(state_->folders, ", "));
  return diagnostic;
}

tl::expected<std::shared_ptr<const Mechanism>, Diagnostic> Registry::CreateMechanism(
    std::string_view module_id) const {
  return state_->Create<Mechanism>(*this, module_id, ModuleKind::kMechanism);
}

tl::expected<std::shared_ptr<const Unit>, Diagnostic> Registry::CreateUnit(
    std::string_view module_id) const {
  return state_->Create<Unit>(*this, module_id, ModuleKind::kUnit);
}

tl::expected<std::shared_ptr<const BoundMechanism>, Diagnostic> Registry::CreateBound(
    std::string_view module_id,
    std::span<const double> parameters,
    std::span<const double> modes) const {
  const ModuleDescription* module = Find(module_id);
  if (module == nullptr) return tl::unexpected(UnknownModule(module_id));
  const std::size_t plugin = state_->offer.implementers.at(module->implementation);
  auto library = state_->Open(plugin);
  if (!library) return tl::unexpected(std::move(library.error()));
  return Library::CreateBound(*library, *Find(module->implementation), parameters, modes);
}

void Registry::LoadAll() {
  for (std::size_t i = 0; i < state_->found.size(); ++i) {
    PluginRecord& record = state_->found[i].record;
    if (!record.enabled || record.description.library.empty()) continue;
    if (auto refusal = state_->TryOut(i)) {
      record.enabled = false;
      record.reasons.push_back(std::move(*refusal));
    }
  }
  state_->Publish();
}

}  // namespace kompono::plugin
