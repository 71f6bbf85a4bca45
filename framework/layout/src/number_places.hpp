// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_NUMBER_PLACES_HPP_
#define KOMPONO_LAYOUT_NUMBER_PLACES_HPP_

#include <string>
#include <vector>

#include "kompono/layout/numbers.hpp"

namespace kompono::layout {

/// A value of the file that holds one or several numbers: a number, a list, or a list of points.
struct ValuePlace {
  std::vector<std::string> path;  ///< tables and, last, the key
  std::size_t columns = 0;        ///< 0: a number; 3 for triples; for points also 3
  bool points = false;            ///< a list of lists
  std::vector<Number> numbers;
};

/// The values of a layout that its file may give, in the order: blocks, axes, open base, ends.
[[nodiscard]] std::vector<ValuePlace> ValuePlacesOf(const Layout& layout,
                                                    const plugin::Registry& registry);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_NUMBER_PLACES_HPP_
