// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_PROCESSOR_HPP_
#define KOMPONO_PLUGIN_PROCESSOR_HPP_

#include <filesystem>
#include <string>

namespace kompono::plugin {

/// `folder/library`, or its build for the highest x86-64 level that this processor runs and the
/// plugin brings: `folder/x86-64-v4/library` or `folder/x86-64-v3/library`. The environment
/// variable KOMPONO_X86_LEVEL lowers the choice: x86-64-v3, or x86-64 for none.
[[nodiscard]] std::filesystem::path BestForThisProcessor(const std::filesystem::path& folder,
                                                         const std::string& library);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_PROCESSOR_HPP_
