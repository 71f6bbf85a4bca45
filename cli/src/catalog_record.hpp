// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_CATALOG_RECORD_HPP_
#define KOMPONO_CLI_CATALOG_RECORD_HPP_

#include <string>

#include "kompono/catalog/record.hpp"
#include "kompono/kinematics/machine.hpp"
#include "kompono/plugin/registry.hpp"

namespace kompono::cli {

/// Everything the catalog keeps of a machine: its formula, blocks, numbers, and what is computed at
/// home. `source`: the file as the user named it.
[[nodiscard]] catalog::LayoutRecord RecordOf(const kinematics::Machine& machine,
                                             const plugin::Registry& registry,
                                             const std::string& source);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_CATALOG_RECORD_HPP_
