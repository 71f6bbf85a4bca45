// SPDX-License-Identifier: Apache-2.0
#include "random_formula.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <set>
#include <string_view>

namespace kompono::formula {
namespace {

class Generator {
 public:
  explicit Generator(std::mt19937& random) : random_(random) {}

  Formula Run() {
    Formula formula;
    formula.left = Side(true, 0);
    formula.right = Side(false, 0);
    formula.open_base = Pick(random_, 3) == 0;
    return formula;
  }

 private:
  bool Once(int in) { return Pick(random_, in - 1) == 0; }

  char Letter() {
    constexpr std::string_view kLetters = "XYZUVWPQRABCDE";
    return kLetters[static_cast<std::size_t>(Pick(random_, 13))];
  }

  Orientation Spindle() { return static_cast<Orientation>(1 + Pick(random_, 2)); }

  std::string Block() {
    constexpr std::array<std::string_view, 6> kNames{
        "drive", "O", "part", "front-2", "Z_xy", "tool"};
    std::string name(kNames[static_cast<std::size_t>(Pick(random_, 5))]);
    return name + std::to_string(blocks_++);
  }

  Axis NewAxis() {
    Axis axis{.letter = Letter(), .working = !Once(4)};
    if (Once(4)) axis.number = 1 + Pick(random_, Once(3) ? 998 : 8);
    while (!axes_.insert(axis.Name()).second) axis.number = 1 + Pick(random_, 998);
    if (axis.rotary() && axis.working && Once(3)) axis.orientation = Spindle();
    if (Once(5)) axis.block = Block();
    return axis;
  }

  Group NewGroup() {
    Group group;
    std::string letters;
    const std::size_t size = std::size_t{2} + static_cast<std::size_t>(Pick(random_, 4));
    while (letters.size() < size) {
      const char letter = Letter();
      if (letters.find(letter) != std::string::npos) continue;
      letters += letter;
      group.axes.push_back(
          {.letter = letter, .number = Once(4) ? 1 + Pick(random_, 8) : 0, .working = !Once(5)});
    }
    const bool spindle = std::any_of(group.axes.begin(), group.axes.end(), [](const Axis& axis) {
      return axis.rotary() && axis.working;
    });
    if (spindle && Once(3)) group.orientation = Spindle();
    if (!Once(3)) group.block = Block();
    return group;
  }

  Leaf NewLeaf(bool left) {
    Leaf leaf{.kind = left ? LeafKind::kPart : Once(3) ? LeafKind::kProcess : LeafKind::kTool};
    if (leaf.kind == LeafKind::kPart && Once(2)) {
      constexpr std::array<const char*, 3> kPlanes{"xy", "xz", "yz"};
      leaf.plane = kPlanes[static_cast<std::size_t>(Pick(random_, 2))];
    }
    if (leaf.kind == LeafKind::kProcess) leaf.direction = static_cast<char>('x' + Pick(random_, 2));
    // One leaf of a kind may go without a number.
    const auto name = [&leaf] { return Leaf{leaf.kind, leaf.number, "", leaf.direction}.Name(); };
    if (Once(3)) leaf.number = 1 + Pick(random_, 998);
    while (!leaves_.insert(name()).second) leaf.number = 1 + Pick(random_, 998);
    return leaf;
  }

  Fork NewFork(bool left, int depth) {
    Fork fork;
    if (Once(3)) fork.count = 2 + Pick(random_, 97);
    const int branches = fork.count > 1 ? 1 : 2 + Pick(random_, 2);
    for (int i = 0; i < branches; ++i) fork.branches.push_back(Side(left, depth + 1));
    return fork;
  }

  /// Written from the base outwards, then turned to the order of the text.
  Chain Side(bool left, int depth) {
    Chain chain;
    for (int i = Pick(random_, depth == 0 ? 4 : 2); i > 0; --i) {
      if (Once(3)) {
        chain.emplace_back(NewGroup());
      } else {
        chain.emplace_back(NewAxis());
      }
    }
    if (depth < 3 && Once(3)) {
      chain.emplace_back(NewFork(left, depth));
    } else {
      chain.emplace_back(NewLeaf(left));
    }
    if (left) std::reverse(chain.begin(), chain.end());
    return chain;
  }

  std::mt19937& random_;
  std::set<std::string> axes_;
  std::set<std::string> leaves_;
  int blocks_ = 0;
};

}  // namespace

unsigned Seed(unsigned otherwise) {
  const char* given = std::getenv("KOMPONO_SEED");
  const unsigned seed =
      given == nullptr ? otherwise : static_cast<unsigned>(std::strtoul(given, nullptr, 10));
  std::cout << "seed " << seed << " (set KOMPONO_SEED for another)\n";
  return seed;
}

Formula RandomFormula(std::mt19937& random) {
  return Generator(random).Run();
}

int Pick(std::mt19937& random, int last) {
  return std::uniform_int_distribution<int>(0, last)(random);
}

}  // namespace kompono::formula
