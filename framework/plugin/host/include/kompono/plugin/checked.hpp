// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_CHECKED_HPP_
#define KOMPONO_PLUGIN_CHECKED_HPP_

#include <optional>
#include <string_view>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/plugin/interfaces.hpp"

namespace kompono::plugin {

/// "platform", "drives", ...: how a quantity is called in messages.
[[nodiscard]] std::string_view QuantityName(Quantity quantity);

/// Evaluates and then holds the module to its contract: the status is kOk and all values are
/// finite. Drive positions and their derivatives may be not-a-number, the contract's sign for a
/// drive that cannot reach, but never infinite. E0211 if not; the values stay as the module left
/// them.
///
/// For trying modules out. Where speed counts, Mechanism::Evaluate is called bare and a value that
/// is not a number travels through the sums to where it is looked at.
[[nodiscard]] std::optional<Diagnostic> EvaluateChecked(const Mechanism& mechanism,
                                                        std::string_view module_id,
                                                        Quantity quantity,
                                                        const MechanismState& state,
                                                        const MechanismValues& values);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_CHECKED_HPP_
