// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_MODULE_SHEET_HPP_
#define KOMPONO_CLI_MODULE_SHEET_HPP_

#include <nlohmann/json_fwd.hpp>

#include <string>

#include "kompono/plugin/description.hpp"

namespace kompono::cli {

/// Everything a sidecar says of one module, as a page for people.
[[nodiscard]] std::string ModuleText(const plugin::ModuleDescription& module);
[[nodiscard]] nlohmann::ordered_json ModuleJson(const plugin::ModuleDescription& module);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_MODULE_SHEET_HPP_
