// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_PARAMETER_READER_HPP_
#define KOMPONO_PLUGIN_HOST_PARAMETER_READER_HPP_

#include "toml_table.hpp"

#include <initializer_list>
#include <string>
#include <string_view>

#include "kompono/plugin/description.hpp"

namespace kompono::plugin {

/// One [[module.parameter]], all but its name and its place in the parameter vector.
[[nodiscard]] ParameterDescription ReadParameter(TableReader& table);

/// A string that must be one of `words`; empty if it is missing or was complained about.
[[nodiscard]] std::string ReadWord(TableReader& table,
                                   std::string_view key,
                                   Need need,
                                   std::initializer_list<std::string_view> words);

/// "numbers[3]", as it is written in the sidecar.
[[nodiscard]] std::string ShapeText(const ParameterDescription& parameter);

/// Empty if all of `values` (in the parameter's unit) lie in its range, else what is wrong.
[[nodiscard]] std::string OutOfRange(const ParameterDescription& parameter,
                                     const std::vector<double>& values);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_PARAMETER_READER_HPP_
