// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_SRC_READER_HPP_
#define KOMPONO_FORMULA_SRC_READER_HPP_

#include "glyphs.hpp"
#include "report.hpp"

#include <vector>

#include "kompono/formula/formula.hpp"

/// The second stage: glyphs become a tree of nodes that still know their places. What a single node
/// can be blamed for is complained about here; what concerns sides, ends and names is left to the
/// judge.
namespace kompono::formula {

struct Node {
  enum class Kind { kAxis, kGroup, kLeaf, kFork, kBase, kBar };
  Kind kind = Kind::kAxis;
  Range where;
  Range block_where;     ///< of the block name, if there is one
  bool implied = false;  ///< a leaf that the text left out
  Axis axis;
  Group group;
  Leaf leaf;
  int count = 1;                            ///< forks
  std::vector<std::vector<Node>> branches;  ///< forks

  [[nodiscard]] bool IsEnd() const { return kind == Kind::kLeaf || kind == Kind::kFork; }
};
using Nodes = std::vector<Node>;

inline constexpr int kMaxNesting = 32;  ///< brackets in brackets
inline constexpr int kMaxNumber = 999;  ///< behind a letter or a leaf
inline constexpr int kMaxCount = 99;    ///< in front of a bracket

/// Reads everything, with complaints to `report`; always comes to an end.
[[nodiscard]] Nodes ReadNodes(const std::vector<Glyph>& glyphs, Report& report);

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_SRC_READER_HPP_
