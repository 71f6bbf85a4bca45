// SPDX-License-Identifier: Apache-2.0
#include "vocabulary.hpp"

#include <type_traits>

#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

std::string Suffix(Orientation orientation, const std::string& block) {
  std::string text;
  if (orientation != Orientation::kNone) text += {'_', LetterOf(orientation)};
  if (!block.empty()) text += ":" + block;
  return text;
}

std::string TextOf(const Axis& axis) {
  return axis.Name() + Suffix(axis.orientation, axis.block);
}

std::string TextOf(const Group& group) {
  std::string text = "(";
  for (const Axis& axis : group.axes) text += TextOf(axis);
  return text + ")" + Suffix(group.orientation, group.block);
}

std::string TextOf(const Leaf& leaf) {
  return leaf.Name();
}

std::string TextOf(const Fork& fork) {
  std::string text = fork.count == 1 ? "(" : std::to_string(fork.count) + "(";
  for (std::size_t i = 0; i < fork.branches.size(); ++i) {
    if (i > 0) text += " + ";
    text += ChainText(fork.branches[i]);
  }
  return text + ")";
}

std::string NumberText(int number) {
  return number == 0 ? "" : std::to_string(number);
}

}  // namespace

std::string Axis::Name() const {
  const char shown = working ? letter : static_cast<char>(letter - 'A' + 'a');
  return shown + NumberText(number);
}

std::string Leaf::Name() const {
  switch (kind) {
    case LeafKind::kPart:
      return "part" + NumberText(number) + (plane.empty() ? "" : "_" + plane);
    case LeafKind::kTool:
      return "tool" + NumberText(number);
    case LeafKind::kProcess:
      break;
  }
  std::string name = "P" + NumberText(number) + "_";
  name += direction;
  return name;
}

std::string ItemText(const Item& item) {
  return std::visit([](const auto& value) { return TextOf(value); }, item);
}

std::string ChainText(const Chain& chain) {
  std::string text;
  for (const Item& item : chain) {
    if (!text.empty()) text += ' ';
    text += ItemText(item);
  }
  return text;
}

std::string Canonical(const Formula& formula) {
  std::string text = ChainText(formula.left);
  if (!text.empty()) text += ' ';
  text += formula.open_base ? "O|O" : "O";
  const std::string right = ChainText(formula.right);
  return right.empty() ? text : text + ' ' + right;
}

}  // namespace kompono::formula
