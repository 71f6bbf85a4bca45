/* SPDX-License-Identifier: Apache-2.0 */
#ifndef KOMPONO_PLUGIN_ABI_H_
#define KOMPONO_PLUGIN_ABI_H_

/* What a plugin library exports: one constant, `kompono_plugin`, and nothing else.
 *
 * The host reads and judges this constant before it calls any of the plugin's functions. The
 * version of the compiler is shown to people but never judged: only plain numbers, spans of double
 * and virtual tables of the Itanium C++ ABI cross the boundary, and those agree between compilers
 * and instruction sets.
 *
 * Promises: `magic` and `struct_size` keep their places for ever. Within one contract major,
 * members are only added at the end (struct_size grows, minor rises). An interface never changes
 * once released: a new ability is a new interface id ("kompono.mechanism/2"). */

#include <stddef.h>
#include <stdint.h>

#define KOMPONO_PLUGIN_MAGIC UINT64_C(0x314e47504f504d4b) /* "KMPOPGN1" in memory */
#define KOMPONO_CONTRACT_MAJOR 1
#define KOMPONO_CONTRACT_MINOR 0
#define KOMPONO_MECHANISM_INTERFACE "kompono.mechanism/1"
#define KOMPONO_UNIT_INTERFACE "kompono.unit/1"
#define KOMPONO_BOUND_MECHANISM_INTERFACE "kompono.bound_mechanism/1"

/* Facts about how the library was built that must agree with the host. */
typedef struct KomponoToolchain {
  uint32_t pointer_bytes;
  uint32_t glibcxx_cxx11_abi; /* _GLIBCXX_USE_CXX11_ABI */
  uint32_t glibcxx_debug;     /* 1 if _GLIBCXX_DEBUG changes the containers' layout */
  uint32_t reserved;
  const char* compiler; /* for people: __VERSION__ */
} KomponoToolchain;

/* One module. `create` returns a pointer to the C++ interface named by `interface_id`, or null
 * after writing a reason, zero-terminated, into `reason`. Neither function lets an exception out.
 * A module may have further entries with the same id and other interfaces; a host leaves those that
 * it does not know alone. */
typedef struct KomponoModule {
  const char* id;
  const char* interface_id;
  void* (*create)(char* reason, size_t reason_bytes);
  void (*destroy)(void* module);
} KomponoModule;

typedef struct KomponoPlugin {
  uint64_t magic;
  uint32_t struct_size;
  uint16_t contract_major;
  uint16_t contract_minor;
  KomponoToolchain toolchain;
  const char* id;      /* "org.kompono.pyramid", as in plugin.toml */
  const char* version; /* "0.1.0", as in plugin.toml */
  uint32_t module_count;
  uint32_t reserved;
  const KomponoModule* modules;
} KomponoPlugin;

#endif /* KOMPONO_PLUGIN_ABI_H_ */
