// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_NUMBERS_HPP_
#define KOMPONO_LAYOUT_NUMBERS_HPP_

#include <string>
#include <string_view>
#include <vector>

#include "kompono/layout/layout.hpp"
#include "kompono/plugin/registry.hpp"

/// The numbers of a layout by name: what a calibration frees, locks and replaces.
///
///     struts.base[1].x  struts.L1  struts.q1.zero   parameters and drive zeros of a block
///     struts.mount.x … struts.mount.c               mount: x y z in mm, a b c in rad
///     Z.position.x … Z.rotation.c  Z.zero           a plain axis
///     open_base.x … open_base.c                     the tool-side foundation
///     tool.length  tool.mount.a                     an end
///
/// Every placement also answers to the long form, "struts.mount.position.x",
/// "open_base.rotation.c", and an axis to the short one, "Z.x".
namespace kompono::layout {

struct Number {
  std::string name;
  std::vector<std::string> other_names;  ///< other forms of the same
  double value = 0.0;                    ///< mm, rad or a pure number
  bool angle = false;
  bool pure = false;  ///< neither length nor angle
};

/// Every number of the layout that its file may give: what a preset has fixed is left out.
[[nodiscard]] std::vector<Number> NumbersOf(const Layout& layout, const plugin::Registry& registry);

/// `*` stands for any characters, brackets are literal: "struts.base[*]", "*.zero". A name without
/// the rest means all below it: "open_base", "struts.base".
[[nodiscard]] bool MatchesPattern(std::string_view pattern, std::string_view name);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_NUMBERS_HPP_
