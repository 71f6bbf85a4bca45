// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_PLUGIN_HPP_
#define KOMPONO_SDK_PLUGIN_HPP_

#include <cstddef>
#include <cstdio>
#include <exception>
#include <type_traits>

#include "kompono/plugin/abi.h"
#include "kompono/plugin/interfaces.hpp"

/// KOMPONO_PLUGIN(id, version, KOMPONO_MODULE(module_id, Class), ...) stands once in a plugin, at
/// file scope, and makes the one symbol the library exports. Everything in it is constant: no code
/// runs when the library is opened.
namespace kompono::sdk {

template <class Module>
using InterfaceOf = std::
    conditional_t<std::is_base_of_v<plugin::Mechanism, Module>, plugin::Mechanism, plugin::Unit>;

template <class Object, class Interface>
void* CreateObject(char* reason, std::size_t reason_bytes) {
  try {
    return static_cast<Interface*>(new Object());
  } catch (const std::exception& error) {
    std::snprintf(reason, reason_bytes, "%s", error.what());
  } catch (...) {
    std::snprintf(
        reason, reason_bytes, "the constructor threw something that is no std::exception");
  }
  return nullptr;
}

template <class Interface>
void DestroyObject(void* object) {
  delete static_cast<Interface*>(object);
}

template <class Module>
void* CreateModule(char* reason, std::size_t reason_bytes) {
  static_assert(
      std::is_base_of_v<plugin::Mechanism, Module> || std::is_base_of_v<plugin::Unit, Module>,
      "a module derives from AutodiffMechanism or AutodiffUnit");
  return CreateObject<Module, InterfaceOf<Module>>(reason, reason_bytes);
}

template <class Module>
void DestroyModule(void* module) {
  DestroyObject<InterfaceOf<Module>>(module);
}

template <class Module>
constexpr KomponoModule ModuleEntry(const char* id) noexcept {
  return {id,
          std::is_base_of_v<plugin::Mechanism, Module> ? KOMPONO_MECHANISM_INTERFACE
                                                       : KOMPONO_UNIT_INTERFACE,
          &CreateModule<Module>,
          &DestroyModule<Module>};
}

constexpr KomponoToolchain ThisToolchain() noexcept {
  return {static_cast<uint32_t>(sizeof(void*)),
          _GLIBCXX_USE_CXX11_ABI,
#ifdef _GLIBCXX_DEBUG
          1,
#else
          0,
#endif
          0,
          __VERSION__};
}

}  // namespace kompono::sdk

#define KOMPONO_MODULE(module_id, Class) ::kompono::sdk::ModuleEntry<Class>(module_id)

#define KOMPONO_PLUGIN(plugin_id, plugin_version, ...)                                  \
  static constexpr KomponoModule kKomponoModules[] = {__VA_ARGS__};                     \
  extern "C" __attribute__((visibility("default"))) const KomponoPlugin kompono_plugin; \
  extern "C" constinit const KomponoPlugin kompono_plugin = {                           \
      KOMPONO_PLUGIN_MAGIC,                                                             \
      static_cast<uint32_t>(sizeof(KomponoPlugin)),                                     \
      KOMPONO_CONTRACT_MAJOR,                                                           \
      KOMPONO_CONTRACT_MINOR,                                                           \
      ::kompono::sdk::ThisToolchain(),                                                  \
      plugin_id,                                                                        \
      plugin_version,                                                                   \
      static_cast<uint32_t>(sizeof(kKomponoModules) / sizeof(kKomponoModules[0])),      \
      0,                                                                                \
      kKomponoModules};

#endif  // KOMPONO_SDK_PLUGIN_HPP_
