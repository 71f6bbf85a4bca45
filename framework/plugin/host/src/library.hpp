// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_LIBRARY_HPP_
#define KOMPONO_PLUGIN_HOST_LIBRARY_HPP_

#include <memory>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/plugin/abi.h"
#include "kompono/plugin/bound_mechanism.hpp"
#include "kompono/plugin/description.hpp"
#include "kompono/plugin/interfaces.hpp"

namespace kompono::plugin {

/// An open plugin library whose manifest was found good. It stays mapped as long as anybody holds
/// the pointer; every module made from it does.
class Library {
 public:
  static tl::expected<std::shared_ptr<const Library>, Diagnostic> Open(
      const PluginDescription& plugin);

  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library();

  [[nodiscard]] const std::string& compiler() const { return compiler_; }

  /// Makes `module`, one of this library's own, and compares its numbers with the sidecar.
  /// Interface is Mechanism or Unit, as the module's kind says.
  template <class Interface>
  [[nodiscard]] static tl::expected<std::shared_ptr<const Interface>, Diagnostic> Create(
      const std::shared_ptr<const Library>& library, const ModuleDescription& module);

  /// Makes the module's second interface and gives it its geometry.
  [[nodiscard]] static tl::expected<std::shared_ptr<const BoundMechanism>, Diagnostic> CreateBound(
      const std::shared_ptr<const Library>& library,
      const ModuleDescription& module,
      std::span<const double> parameters,
      std::span<const double> modes);

 private:
  struct Handle;
  Library();

  /// Calls the plugin's factory; null and a reason if it gives nothing.
  [[nodiscard]] static void* Make(const KomponoModule& entry, std::string& reason);

  template <class Interface>
  [[nodiscard]] static tl::expected<std::shared_ptr<Interface>, Diagnostic> Object(
      const std::shared_ptr<const Library>& library, const KomponoModule& entry);

  std::unique_ptr<Handle> handle_;
  const KomponoPlugin* manifest_ = nullptr;
  std::string path_;
  std::string compiler_;
};

extern template tl::expected<std::shared_ptr<const Mechanism>, Diagnostic> Library::Create(
    const std::shared_ptr<const Library>& library, const ModuleDescription& module);
extern template tl::expected<std::shared_ptr<const Unit>, Diagnostic> Library::Create(
    const std::shared_ptr<const Library>& library, const ModuleDescription& module);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_LIBRARY_HPP_
