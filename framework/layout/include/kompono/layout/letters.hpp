// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_LETTERS_HPP_
#define KOMPONO_LAYOUT_LETTERS_HPP_

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/formula/formula.hpp"
#include "kompono/layout/layout.hpp"

namespace kompono::layout {

/// How a module's local letters meet the letters of a group of the formula.
struct LetterFit {
  enum class Kind {
    kFits,
    kOwnAxes,    ///< fits as a whole, the coordinates count along the mechanism's own axes
    kCount,      ///< other numbers of translations or rotations
    kDirection,  ///< the right numbers in the wrong directions
  } kind = Kind::kCount;
  std::vector<Block::LetterMap> letters;  ///< one per local letter, if it fits

  [[nodiscard]] bool ok() const { return kind == Kind::kFits || kind == Kind::kOwnAxes; }
};

/// Each local letter's axis, turned by the mount, must lie within 10 degrees of the axis of one of
/// the group's letters of the same kind, along or against it. Where a kind does not match letter by
/// letter but the module realises all three of it and the group asks for all three, the letters are
/// taken as they are named.
[[nodiscard]] LetterFit FitLetters(std::string_view local,
                                   const Placement& mount,
                                   const std::vector<formula::Axis>& wanted);

/// "X Z": what the module realises under its mount, with "(X)" for a letter whose axis lies along
/// none of the carrier's axes.
[[nodiscard]] std::string LettersUnderMount(std::string_view local, const Placement& mount);

/// A rotation by multiples of 90 degrees under which the letters would fit: the one with the fewest
/// angles, and among those the one with the fewest letters that count backwards.
[[nodiscard]] std::optional<std::array<int, 3>> RotationThatFits(
    std::string_view local, const std::vector<formula::Axis>& wanted);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_LETTERS_HPP_
