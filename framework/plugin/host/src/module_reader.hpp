// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_MODULE_READER_HPP_
#define KOMPONO_PLUGIN_HOST_MODULE_READER_HPP_

#include "toml_table.hpp"

#include <string>
#include <string_view>

#include "kompono/plugin/description.hpp"

namespace kompono::plugin {

/// One [[module]] of a sidecar. What is wrong goes to the table's complaints; the rest is filled
/// in.
[[nodiscard]] ModuleDescription ReadModule(TableReader& table);

/// One [[preset]]; whether it fits its base can only be told when all sidecars are read.
[[nodiscard]] PresetDescription ReadPreset(TableReader& table);

/// Lower-case words for ids of modules, "linear_delta"; any case for names in a module, "L1".
[[nodiscard]] bool IsModuleId(std::string_view word);
[[nodiscard]] bool IsName(std::string_view word);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_MODULE_READER_HPP_
