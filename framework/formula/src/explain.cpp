// SPDX-License-Identifier: Apache-2.0
#include "vocabulary.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

std::string_view Lie(Orientation orientation) {
  switch (orientation) {
    case Orientation::kHorizontal:
      return "horizontal";
    case Orientation::kVertical:
      return "vertical";
    case Orientation::kInclined:
      return "inclined";
    case Orientation::kNone:
      break;
  }
  return "";
}

std::string Numbered(std::string_view what, int number) {
  return number == 0 ? std::string(what) : fmt::format("{} {}", what, number);
}

std::string Meaning(const Axis& axis) {
  std::string text;
  if (axis.orientation != Orientation::kNone) {
    text = fmt::format("main-motion spindle, {}, {}", Lie(axis.orientation), MotionOf(axis.letter));
  } else {
    text =
        fmt::format("{}, {} motion", MotionOf(axis.letter), axis.working ? "working" : "setting");
  }
  if (!axis.block.empty()) text += fmt::format(", realised by block '{}'", axis.block);
  return text;
}

std::string Meaning(const Group& group) {
  std::string text = fmt::format("{} motions realised together by ", group.axes.size());
  text += group.block.empty() ? "one mechanism that the layout must name"
                              : fmt::format("the mechanism '{}'", group.block);
  for (std::size_t i = 0; i < group.axes.size(); ++i) {
    const Axis& axis = group.axes[i];
    text += fmt::format("{}{} {}{}",
                        i == 0 ? ": " : ", ",
                        axis.Name(),
                        MotionOf(axis.letter),
                        axis.working ? "" : " (setting)");
  }
  if (group.orientation != Orientation::kNone) {
    text += fmt::format("; its rotation is a main-motion spindle, {}", Lie(group.orientation));
  }
  return text;
}

std::string Meaning(const Leaf& leaf) {
  switch (leaf.kind) {
    case LeafKind::kPart:
      return Numbered("workpiece", leaf.number) +
             (leaf.plane.empty() ? "" : fmt::format(", clamped in the {} plane", leaf.plane));
    case LeafKind::kTool:
      return Numbered("tool or turret", leaf.number);
    case LeafKind::kProcess:
      break;
  }
  return fmt::format(
      "{} (jet or beam) acting along {}", Numbered("process", leaf.number), leaf.direction);
}

std::string Meaning(const Fork& fork) {
  return fork.count > 1 ? fmt::format("{} identical branches side by side", fork.count)
                        : fmt::format("{} branches side by side", fork.branches.size());
}

/// What an item is called when another one's line speaks of it.
std::string NameOf(const Item& item) {
  return std::holds_alternative<Fork>(item) ? "the fork" : ItemText(item);
}

class Explainer {
 public:
  std::vector<Explanation> Run(const Formula& formula) {
    const bool open = formula.open_base;
    Explain(formula.left, true, open ? "the workpiece-side foundation" : "the base", 0);
    lines_.push_back(
        {open ? "O|O" : "O",
         open ? "open base: two foundations coupled only electronically, their mutual pose is "
                "identified"
              : "base: carries both sides",
         0});
    Explain(formula.right, false, open ? "the tool-side foundation" : "the base", 0);
    return std::move(lines_);
  }

 private:
  /// `base` is what carries the whole chain.
  void Explain(const Chain& chain, bool left, const std::string& base, int depth) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const bool innermost = left ? i + 1 == chain.size() : i == 0;
      const std::string carrier = innermost ? base : NameOf(chain[left ? i + 1 : i - 1]);
      const Item& item = chain[i];
      std::string meaning = std::visit([](const auto& value) { return Meaning(value); }, item);
      if (std::holds_alternative<Axis>(item) || std::holds_alternative<Group>(item)) {
        meaning += left ? ", workpiece side" : ", tool side";
      }
      meaning += fmt::format("; carried by {}", carrier);
      const bool outermost = left ? i == 0 : i + 1 == chain.size();
      if (!outermost) meaning += fmt::format(", carries {}", NameOf(chain[left ? i - 1 : i + 1]));
      lines_.push_back({ItemText(item), std::move(meaning), depth});
      if (const auto* fork = std::get_if<Fork>(&item)) ExplainBranches(*fork, left, carrier, depth);
    }
  }

  void ExplainBranches(const Fork& fork, bool left, const std::string& base, int depth) {
    for (std::size_t i = 0; i < fork.branches.size(); ++i) {
      const Chain& branch = fork.branches[i];
      const bool counted = fork.count > 1;
      lines_.push_back({ChainText(branch),
                        counted ? fmt::format("each of the {} branches", fork.count)
                                : fmt::format("branch {} of {}", i + 1, fork.branches.size()),
                        depth + 1});
      Explain(branch, left, base, depth + 2);
    }
  }

  std::vector<Explanation> lines_;
};

}  // namespace

std::vector<Explanation> Explain(const Formula& formula) {
  return Explainer().Run(formula);
}

}  // namespace kompono::formula
