// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_WAYS_HPP_
#define KOMPONO_ANALYSIS_WAYS_HPP_

#include "workshop.hpp"

#include <vector>

namespace kompono::analysis {

/// One way per part, tool and process of a side, in the order of the formula.
[[nodiscard]] std::vector<Way> WaysOf(const formula::Chain& side,
                                      const layout::Layout& layout,
                                      const plugin::Registry& registry);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_WAYS_HPP_
