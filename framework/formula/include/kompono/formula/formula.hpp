// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_FORMULA_HPP_
#define KOMPONO_FORMULA_FORMULA_HPP_

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

/// Structural formulas: a machine written as a line of letters (grammar: docs/design.md, section
/// 4).
///
///     part_xy (XY):drive O|O Z P_z
///
/// Left of the base `O` stand the blocks between the workpiece and the base, read from the
/// workpiece; right of it those that lead to the tool. The tree below is a plain value: equal trees
/// print equal text.
namespace kompono::formula {

/// How a main-motion spindle lies; kNone marks an axis that is no main-motion spindle.
enum class Orientation { kNone, kHorizontal, kVertical, kInclined };

/// One motion: `Z`, `z` (setting motion), `X4`, `C_h` (main-motion spindle), `B:table`.
struct Axis {
  char letter = 'X';    ///< always the capital
  int number = 0;       ///< digits behind the letter; 0 when there are none
  bool working = true;  ///< capital in the text; false: a setting motion
  Orientation orientation = Orientation::kNone;
  std::string block;  ///< behind the colon, or empty
  bool operator==(const Axis&) const = default;

  [[nodiscard]] bool rotary() const {
    return letter == 'A' || letter == 'B' || letter == 'C' || letter == 'D' || letter == 'E';
  }
  /// "Z", "z", "X4": letter and number as the text has them; the axis' name in layouts and results.
  [[nodiscard]] std::string Name() const;
};

/// Motions that one parallel mechanism realises together: `(XY):drive`. Vragov's `(CZ)_v` gives the
/// group an orientation.
struct Group {
  std::vector<Axis> axes;
  Orientation orientation = Orientation::kNone;
  std::string
      block;  ///< empty when the text names none; the layout must then say which block realises it
  bool operator==(const Group&) const = default;
};

enum class LeafKind { kPart, kTool, kProcess };

/// The end of a chain: `part1_xy`, `tool2`, `P_z`.
struct Leaf {
  LeafKind kind = LeafKind::kPart;
  int number = 0;      ///< 0 when there are no digits; parsing numbers leaves that would be equal
  std::string plane;   ///< part only: "xy", or empty
  char direction = 0;  ///< process only: 'x', 'y' or 'z'
  bool operator==(const Leaf&) const = default;

  [[nodiscard]] std::string Name() const;  ///< "part1_xy", "tool", "P_z"
};

struct Fork;
using Item = std::variant<Axis, Group, Leaf, Fork>;
using Chain = std::vector<Item>;

/// Branches carried side by side: `(part1 C_h + part2 C2_h Z2)`. `2(...)` is one branch with
/// count 2.
struct Fork {
  int count = 1;
  std::vector<Chain> branches;
  bool operator==(const Fork&) const = default;
};

/// A whole layout. Every chain ends in its leaf: one that the text left out is put in when parsing.
struct Formula {
  Chain left;   ///< in the order of the text: workpiece first, base last
  Chain right;  ///< base first, tool last
  bool open_base = false;
  bool operator==(const Formula&) const = default;
};

/// Longer texts are not looked into (E0131).
inline constexpr std::size_t kMaxTextBytes = 1024;

/// The formula, or every complaint (codes E01xx, see codes.hpp) with spans into `text`. Input
/// dialects (LaTeX as printed, Cyrillic look-alike letters, `0` for `O`, a leaf before an axis, ISO
/// 230-1 in brackets) are read too: each change made on the way is appended to `notes` (severity
/// kNote, code N01xx) if it is not null. `file` goes into the diagnostics.
[[nodiscard]] Parsed<Formula> ParseFormula(std::string_view text,
                                           std::string_view file = "formula",
                                           Diagnostics* notes = nullptr);

/// The canonical text, e.g. "part_xy (XY):drive O|O Z P_z". ParseFormula(Canonical(f)) == f for
/// every f.
[[nodiscard]] std::string Canonical(const Formula& formula);

/// The text of one element or of a chain of them, as Canonical writes it.
[[nodiscard]] std::string ItemText(const Item& item);
[[nodiscard]] std::string ChainText(const Chain& chain);

/// One line per block from workpiece to tool, in words: what it is, what carries it, working or
/// setting motion.
struct Explanation {
  std::string text;     ///< the block as canonical text
  std::string meaning;  ///< "translation along X, working motion, carries the workpiece side"
  int depth = 0;        ///< nesting in forks
};
[[nodiscard]] std::vector<Explanation> Explain(const Formula& formula);

/// All axes, in the order of the text, forks unrolled branch by branch (the equal branches of a
/// counted fork once); groups give their members.
[[nodiscard]] std::vector<Axis> AxesOf(const Formula& formula);

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_FORMULA_HPP_
