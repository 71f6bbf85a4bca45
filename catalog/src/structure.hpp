// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_STRUCTURE_HPP_
#define KOMPONO_CATALOG_SRC_STRUCTURE_HPP_

#include <string>
#include <string_view>
#include <vector>

#include "kompono/catalog/record.hpp"

namespace kompono::catalog {

/// The tree of a formula as JSON; empty for a text that is no formula.
[[nodiscard]] std::string TreeJson(std::string_view formula);

/// What follows from a formula's text alone; of a text that is no formula the base only.
struct FormulaFacts {
  std::string distribution;
  std::string relative_motion;
  bool open_base = false;
  std::vector<Motion> motions;
};
[[nodiscard]] FormulaFacts FactsOf(std::string_view formula);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_STRUCTURE_HPP_
