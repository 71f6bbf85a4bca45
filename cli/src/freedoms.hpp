// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_FREEDOMS_HPP_
#define KOMPONO_CLI_FREEDOMS_HPP_

#include "session.hpp"

#include <optional>

#include "kompono/kinematics/machine.hpp"

namespace kompono::cli {

/// `kompono describe --freedoms`: which motions the struts of each mechanism can meet at home, for
/// people or as JSON. Without a length a radian counts the platform's own size.
void PrintFreedoms(Session& session,
                   const kinematics::Machine& machine,
                   std::optional<double> length_mm);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_FREEDOMS_HPP_
