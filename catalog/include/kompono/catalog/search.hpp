// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SEARCH_HPP_
#define KOMPONO_CATALOG_SEARCH_HPP_

#include <cstdint>
#include <string>
#include <vector>

#include "kompono/formula/formula.hpp"

namespace kompono::catalog {

/// A layout or study that has the words searched for.
struct SearchHit {
  enum class Kind { kLayout, kStudy } kind = Kind::kLayout;
  std::int64_t id = 0;
  std::string name;
  std::string formula;  ///< of a layout
  std::string snippet;  ///< where the words stand, in [brackets]
};

struct SimilarLayout {
  std::int64_t id = 0;
  std::string name;
  std::string formula;
  std::string hash;
  double similarity = 0.0;  ///< 0 nothing in common, 1 equal structure
};

/// What a structure consists of, with repetitions: the motions with their side and whether they
/// work ("part X"), their neighbours ("part X>Y"), the groups ("part (XY)"), the leaves, the base,
/// and the modules of the blocks. Sorted.
[[nodiscard]] std::vector<std::string> StructureFeatures(const formula::Formula& formula,
                                                         const std::vector<std::string>& modules);

/// Jaccard's index of two sorted lists with repetitions: what they share over what they have
/// together. 1 for two empty lists.
[[nodiscard]] double Similarity(const std::vector<std::string>& a,
                                const std::vector<std::string>& b);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SEARCH_HPP_
