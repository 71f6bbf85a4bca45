// SPDX-License-Identifier: Apache-2.0
#include "manifest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace kompono::plugin {
namespace {

constexpr std::size_t kHeadBytes = offsetof(KomponoPlugin, toolchain);
constexpr std::uint32_t kMostModules = 10000;

Refusal Refuse(LoadError error, std::string message, std::string help = {}) {
  return {CodeOf(error), std::move(message), std::move(help)};
}

std::string_view TextOf(const char* text) {
  return text == nullptr ? std::string_view("(nothing)") : std::string_view(text);
}

std::optional<Refusal> JudgeToolchain(const KomponoPlugin& manifest) {
  const KomponoToolchain& theirs = manifest.toolchain;
#ifdef _GLIBCXX_DEBUG
  constexpr std::uint32_t kDebug = 1;
#else
  constexpr std::uint32_t kDebug = 0;
#endif
  struct Fact {
    std::string_view name;
    std::uint32_t theirs, ours;
  };
  const Fact facts[] = {
      {"bytes of a pointer", theirs.pointer_bytes, sizeof(void*)},
      {"_GLIBCXX_USE_CXX11_ABI", theirs.glibcxx_cxx11_abi, _GLIBCXX_USE_CXX11_ABI},
      {"_GLIBCXX_DEBUG", theirs.glibcxx_debug, kDebug},
  };
  std::vector<std::string> differences;
  for (const Fact& fact : facts) {
    if (fact.theirs != fact.ours)
      differences.push_back(
          fmt::format("{} is {} in the library and {} here", fact.name, fact.theirs, fact.ours));
  }
  if (differences.empty()) return std::nullopt;
  return Refuse(
      LoadError::kToolchainMismatch,
      fmt::format("the library was built with other settings: {}", fmt::join(differences, "; ")),
      "build the plugin with the settings this kompono was built with");
}

std::optional<Refusal> JudgeTable(const KomponoPlugin& manifest) {
  std::string wrong;
  if (manifest.module_count == 0 || manifest.module_count > kMostModules ||
      manifest.modules == nullptr) {
    wrong = fmt::format("a table of {} modules", manifest.module_count);
  } else {
    for (std::uint32_t i = 0; i < manifest.module_count && wrong.empty(); ++i) {
      const KomponoModule& module = manifest.modules[i];
      if (module.id == nullptr || module.interface_id == nullptr || module.create == nullptr ||
          module.destroy == nullptr)
        wrong = fmt::format("module {} of {} is not filled in", i + 1, manifest.module_count);
    }
  }
  if (wrong.empty()) return std::nullopt;
  return Refuse(LoadError::kNotAPlugin,
                "the library's manifest is damaged: " + wrong,
                "make it with KOMPONO_PLUGIN of the SDK");
}

/// Everything in which the library and its sidecar contradict each other.
std::vector<std::string> Contradictions(const KomponoPlugin& manifest,
                                        const PluginDescription& plugin) {
  std::vector<std::string> list;
  const auto compare = [&list](
                           std::string_view what, std::string_view theirs, std::string_view toml) {
    if (theirs != toml)
      list.push_back(
          fmt::format("{} is '{}' in the library and '{}' in plugin.toml", what, theirs, toml));
  };
  compare("the id", TextOf(manifest.id), plugin.id);
  compare("the version", TextOf(manifest.version), plugin.version);
  compare("the contract",
          fmt::format("{}.{}", manifest.contract_major, manifest.contract_minor),
          fmt::format("{}.{}", plugin.contract_major, plugin.contract_minor));
  std::set<std::string_view> offered;
  for (std::uint32_t i = 0; i < manifest.module_count; ++i) offered.insert(manifest.modules[i].id);
  std::set<std::string_view> described;
  for (const ModuleDescription& module : plugin.modules) {
    if (module.implementation != module.id) continue;
    described.insert(module.id);
    if (!offered.contains(module.id))
      list.push_back(fmt::format("module '{}' is only in plugin.toml", module.id));
  }
  for (const std::string_view id : offered) {
    if (!described.contains(id))
      list.push_back(fmt::format("module '{}' is only in the library", id));
  }
  for (const ModuleDescription& module : plugin.modules) {
    const std::string_view wanted = MainInterface(module.kind);
    const KomponoModule* first = FindEntry(manifest, module.id, {});
    if (first != nullptr && FindEntry(manifest, module.id, wanted) == nullptr)
      compare(fmt::format("the interface of '{}'", module.id), first->interface_id, wanted);
  }
  return list;
}

struct Count {
  std::string_view what;
  std::int32_t library;
  std::size_t sidecar;
};

std::optional<Refusal> JudgeCounts(const ModuleDescription& module, std::span<const Count> counts) {
  std::vector<std::string> list;
  for (const Count& count : counts) {
    if (count.library < 0 || static_cast<std::size_t>(count.library) != count.sidecar)
      list.push_back(fmt::format(
          "{} {} in the library, {} in plugin.toml", count.library, count.what, count.sidecar));
  }
  if (list.empty()) return std::nullopt;
  return Refuse(
      LoadError::kSidecarMismatch,
      fmt::format("the library and its plugin.toml disagree about module '{}': {}",
                  module.id,
                  fmt::join(list, "; ")),
      "a point counts as three parameters; install library and plugin.toml of the same build");
}

}  // namespace

std::string CodeOf(LoadError error) {
  return fmt::format("E{:04}", static_cast<int>(error));
}

std::string_view MainInterface(ModuleKind kind) {
  return kind == ModuleKind::kMechanism ? KOMPONO_MECHANISM_INTERFACE : KOMPONO_UNIT_INTERFACE;
}

const KomponoModule* FindEntry(const KomponoPlugin& manifest,
                               std::string_view module_id,
                               std::string_view interface_id) {
  for (std::uint32_t i = 0; i < manifest.module_count; ++i) {
    const KomponoModule& entry = manifest.modules[i];
    if (module_id == entry.id && (interface_id.empty() || interface_id == entry.interface_id))
      return &entry;
  }
  return nullptr;
}

std::optional<Refusal> JudgeContract(int major, int minor) {
  const std::string message =
      fmt::format("the plugin needs contract {}.{}, this kompono offers {}.{}",
                  major,
                  minor,
                  KOMPONO_CONTRACT_MAJOR,
                  KOMPONO_CONTRACT_MINOR);
  if (major < KOMPONO_CONTRACT_MAJOR)
    return Refuse(
        LoadError::kContractTooOld, message, "build the plugin again with the SDK of this kompono");
  if (major > KOMPONO_CONTRACT_MAJOR || minor > KOMPONO_CONTRACT_MINOR)
    return Refuse(LoadError::kContractTooNew,
                  message,
                  "install a newer kompono, or a build of the plugin for this one");
  return std::nullopt;
}

std::optional<Refusal> JudgeManifest(const KomponoPlugin& manifest,
                                     const PluginDescription& plugin) {
  if (manifest.magic != KOMPONO_PLUGIN_MAGIC)
    return Refuse(
        LoadError::kNotAPlugin,
        fmt::format("the library's symbol 'kompono_plugin' is no manifest: it begins with "
                    "{:#018x} instead of {:#018x}",
                    manifest.magic,
                    KOMPONO_PLUGIN_MAGIC),
        "make it with KOMPONO_PLUGIN of the SDK");
  if (manifest.struct_size < kHeadBytes)
    return Refuse(LoadError::kNotAPlugin,
                  fmt::format("the library's manifest is damaged: it says it is {} bytes long",
                              manifest.struct_size),
                  "make it with KOMPONO_PLUGIN of the SDK");
  if (auto refusal = JudgeContract(manifest.contract_major, manifest.contract_minor))
    return refusal;
  // Within the contract that both agree on so far, another size means other alignment or packing.
  if (manifest.struct_size != sizeof(KomponoPlugin))
    return Refuse(LoadError::kToolchainMismatch,
                  fmt::format("the library's manifest is {} bytes long, contract {}.{} has {}",
                              manifest.struct_size,
                              KOMPONO_CONTRACT_MAJOR,
                              KOMPONO_CONTRACT_MINOR,
                              sizeof(KomponoPlugin)),
                  "build the plugin with the settings this kompono was built with");
  if (auto refusal = JudgeToolchain(manifest)) return refusal;
  if (auto refusal = JudgeTable(manifest)) return refusal;
  const std::vector<std::string> list = Contradictions(manifest, plugin);
  if (list.empty()) return std::nullopt;
  return Refuse(LoadError::kSidecarMismatch,
                fmt::format("the library and its plugin.toml disagree: {}", fmt::join(list, "; ")),
                "install library and plugin.toml of the same build");
}

std::optional<Refusal> JudgeShape(const MechanismShape& shape, const ModuleDescription& module) {
  const Count counts[] = {
      {"coordinates", shape.coordinates, module.letters.size()},
      {"drives", shape.drives, module.drives.size()},
      {"parameters", shape.parameters, static_cast<std::size_t>(module.ParameterNumbers())},
      {"modes", shape.modes, module.modes.size()},
      {"points", shape.points, module.points.size()},
  };
  return JudgeCounts(module, counts);
}

std::optional<Refusal> JudgeShape(const UnitShape& shape, const ModuleDescription& module) {
  if (shape.states < 1)
    return Refuse(LoadError::kSidecarMismatch,
                  fmt::format("unit '{}' says it has {} states; one that does not move has 1",
                              module.id,
                              shape.states));
  const Count counts[] = {
      {"parameters", shape.parameters, static_cast<std::size_t>(module.ParameterNumbers())},
      {"stations", shape.stations, module.stations.size()},
      {"states", shape.states, static_cast<std::size_t>(module.states)},
  };
  return JudgeCounts(module, counts);
}

}  // namespace kompono::plugin
