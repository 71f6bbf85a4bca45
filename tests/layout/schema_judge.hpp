// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_LAYOUT_SCHEMA_JUDGE_HPP_
#define KOMPONO_TESTS_LAYOUT_SCHEMA_JUDGE_HPP_

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace kompono::layout {

/// What an instance breaks of a schema, by the part of JSON Schema 2020-12 that LayoutSchema uses;
/// a keyword it does not know is a fault as well, so that nothing is passed over in silence.
[[nodiscard]] std::vector<std::string> Faults(const nlohmann::json& schema,
                                              const nlohmann::json& instance);

}  // namespace kompono::layout

#endif  // KOMPONO_TESTS_LAYOUT_SCHEMA_JUDGE_HPP_
