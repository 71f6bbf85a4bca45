// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_PLACES_HPP_
#define KOMPONO_LAYOUT_PLACES_HPP_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/layout/layout.hpp"

namespace kompono::layout {

/// Where the layout's text gives the value with these keys, or the element of the list that stands
/// there. What the file does not give is looked for one table further out: a parameter that has its
/// default is at home in the block. Line 0 if there is no such place at all.
[[nodiscard]] SourceSpan PlaceOf(const Layout& layout,
                                 const std::vector<std::string>& keys,
                                 std::optional<std::size_t> element = std::nullopt);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_PLACES_HPP_
