// SPDX-License-Identifier: Apache-2.0
#include "judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace kompono::formula {
namespace {

enum class Side { kLeft, kRight };

struct Sides {
  Nodes left;
  Nodes right;
  Range base;
  bool found = false;
  bool open = false;
};

std::string_view KindName(LeafKind kind) {
  switch (kind) {
    case LeafKind::kPart:
      return "workpiece";
    case LeafKind::kTool:
      return "tool";
    case LeafKind::kProcess:
      break;
  }
  return "process";
}

bool BelongsTo(Side side, const Leaf& leaf) {
  return (side == Side::kLeft) == (leaf.kind == LeafKind::kPart);
}

Range Whole(const Nodes& nodes, Range if_empty) {
  return nodes.empty() ? if_empty : Range{nodes.front().where.begin, nodes.back().where.end};
}

Chain ToChain(Nodes nodes);

Item ToItem(Node node) {
  switch (node.kind) {
    case Node::Kind::kGroup:
      return std::move(node.group);
    case Node::Kind::kLeaf:
      return std::move(node.leaf);
    case Node::Kind::kFork: {
      Fork fork{node.count, {}};
      for (Nodes& branch : node.branches) fork.branches.push_back(ToChain(std::move(branch)));
      return fork;
    }
    default:
      return std::move(node.axis);
  }
}

Chain ToChain(Nodes nodes) {
  Chain chain;
  chain.reserve(nodes.size());
  for (Node& node : nodes) chain.push_back(ToItem(std::move(node)));
  return chain;
}

class Judge {
 public:
  explicit Judge(Report& report) : report_(report) {}

  Formula Build(Nodes nodes, Range whole) {
    CollectNames(nodes);
    CheckNames(nodes);
    Sides sides = FindBase(std::move(nodes), whole);
    if (!sides.found) return {};
    FinishSide(sides.left, Side::kLeft, false, sides.base);
    FinishSide(sides.right, Side::kRight, false, sides.base);
    CollectLeaves(sides.left);
    CollectLeaves(sides.right);
    CheckLeaves();
    if (report_.error_count() != 0) return {};
    NumberLeaves();
    return {ToChain(std::move(sides.left)), ToChain(std::move(sides.right)), sides.open};
  }

 private:
  void CollectNames(const Nodes& nodes) {
    for (const Node& node : nodes) {
      if (node.kind == Node::Kind::kAxis) names_.insert(node.axis.Name());
      for (const Nodes& branch : node.branches) CollectNames(branch);
    }
  }

  void CheckNames(const Nodes& nodes) {
    for (const Node& node : nodes) {
      if (node.kind == Node::Kind::kAxis) CheckAxis(node);
      if (node.kind == Node::Kind::kGroup) CheckBlock(node, node.group.block);
      for (const Nodes& branch : node.branches) CheckNames(branch);
    }
  }

  void CheckAxis(const Node& node) {
    const std::string name = node.axis.Name();
    if (!seen_axes_.insert(name).second) {
      Axis other = node.axis;
      for (other.number = 2; names_.count(other.Name()) != 0;) ++other.number;
      names_.insert(other.Name());
      report_.Error(codes::kRepeatedAxis,
                    node.where,
                    fmt::format("axis '{}' is named twice", name),
                    fmt::format("tell them apart by number: write {}", other.Name()));
    }
    if (node.axis.number != 0 && node.axis.number % 10 == 0) {
      base_help_ = fmt::format("if the 0 of '{}' is the base, put a space before it", name);
    }
    CheckBlock(node, node.axis.block);
  }

  void CheckBlock(const Node& node, const std::string& block) {
    if (block.empty()) return;
    if (!seen_blocks_.insert(block).second) {
      report_.Error(
          codes::kRepeatedBlock,
          node.block_where,
          fmt::format("block '{}' is named twice", block),
          "one block is one group; motions that one mechanism realises stand in one bracket: "
          "(XY):drive");
    }
    if (block.find('O') != std::string::npos) {
      base_help_ = fmt::format(
          "the block name '{}' goes on to the next space; if its O is the base, put a space before "
          "it",
          block);
    }
  }

  Sides FindBase(Nodes nodes, Range whole) {
    const auto is = [&nodes](std::size_t i, Node::Kind kind) {
      return i < nodes.size() && nodes[i].kind == kind;
    };
    std::vector<std::size_t> bases;
    std::vector<std::size_t> bars;
    std::vector<std::size_t> joints;  // bars that join two bases
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (is(i, Node::Kind::kBase)) bases.push_back(i);
      if (!is(i, Node::Kind::kBar)) continue;
      bars.push_back(i);
      if (i > 0 && is(i - 1, Node::Kind::kBase) && is(i + 1, Node::Kind::kBase))
        joints.push_back(i);
    }
    Sides sides;
    sides.found = !bases.empty();
    sides.open = !joints.empty();
    BlameBars(nodes, bars, joints);
    if (!sides.found) {
      if (report_.Has(codes::kBaseInside)) return sides;
      if (report_.Has(codes::kIso)) {
        base_help_ =
            "write b between the axes that move the workpiece and those that move the tool";
      } else if (base_help_.empty()) {
        base_help_ =
            "write O between the blocks that carry the workpiece and those that carry the tool: "
            "X Y O Z C_v";
      }
      report_.Error(codes::kNoBase, whole, "the base O is missing", base_help_);
      return sides;
    }
    const std::size_t first = sides.open ? joints.front() - 1 : bases.front();
    const std::size_t last = sides.open ? joints.front() + 1 : bases.front();
    sides.base = {nodes[first].where.begin, nodes[last].where.end};
    // Where bars are wrong, they explain the surplus bases.
    const bool count_bases = bars.size() == joints.size() && bars.size() <= 1;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (is(i, Node::Kind::kBar) || (i >= first && i <= last)) continue;
      if (is(i, Node::Kind::kBase)) {
        if (!count_bases) continue;
        report_.Error(codes::kSecondBase,
                      nodes[i].where,
                      "second base 'O'",
                      "two foundations that are coupled only electronically are written O|O");
      } else {
        (i < first ? sides.left : sides.right).push_back(std::move(nodes[i]));
      }
    }
    return sides;
  }

  void BlameBars(const Nodes& nodes,
                 const std::vector<std::size_t>& bars,
                 const std::vector<std::size_t>& joints) {
    for (const std::size_t bar : bars) {
      const bool joint = std::find(joints.begin(), joints.end(), bar) != joints.end();
      if (!joint) {
        report_.Error(codes::kStrayBar,
                      nodes[bar].where,
                      "'|' does not stand between two bases",
                      "an open base is written O|O");
      } else if (bar != joints.front()) {
        report_.Error(codes::kSecondOpenBase,
                      nodes[bar].where,
                      "second open base",
                      "a machine has one base, or one open base O|O of two foundations");
      }
    }
  }

  /// Leaves `nodes` with exactly one end at the outer place, or with complaints.
  void FinishSide(Nodes& nodes, Side side, bool in_fork, Range if_empty) {
    const Range whole = Whole(nodes, if_empty);
    RemoveForeignLeaves(nodes, side);
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].IsEnd()) ends.push_back(i);
    }
    if (ends.empty()) {
      Node leaf;
      leaf.kind = Node::Kind::kLeaf;
      leaf.where = whole;
      leaf.implied = true;
      leaf.leaf.kind = side == Side::kLeft ? LeafKind::kPart : LeafKind::kTool;
      nodes.insert(side == Side::kLeft ? nodes.begin() : nodes.end(), std::move(leaf));
    } else if (ends.size() > 1) {
      BlameSurplus(nodes, ends);
    } else if (ends.front() != (side == Side::kLeft ? 0 : nodes.size() - 1)) {
      MoveOut(nodes, ends.front(), side, in_fork);
    }
    for (Node& node : nodes) {
      for (Nodes& branch : node.branches) FinishSide(branch, side, true, node.where);
    }
  }

  void RemoveForeignLeaves(Nodes& nodes, Side side) {
    const auto foreign = [side](const Node& node) {
      return node.kind == Node::Kind::kLeaf && !BelongsTo(side, node.leaf);
    };
    for (const Node& node : nodes) {
      if (!foreign(node)) continue;
      report_.Error(
          codes::kWrongSide,
          node.where,
          fmt::format("'{}' stands {} of the base",
                      node.leaf.Name(),
                      side == Side::kLeft ? "left" : "right"),
          "a formula is read from the workpiece, left of O, to the tool or process, right of it");
    }
    nodes.erase(std::remove_if(nodes.begin(), nodes.end(), foreign), nodes.end());
  }

  void BlameSurplus(const Nodes& nodes, const std::vector<std::size_t>& ends) {
    const auto fork = std::find_if(ends.begin(), ends.end(), [&nodes](std::size_t i) {
      return nodes[i].kind == Node::Kind::kFork;
    });
    for (auto end = ends.begin(); end != ends.end(); ++end) {
      const Node& node = nodes[*end];
      if (node.kind == Node::Kind::kFork && end != fork) {
        report_.Error(codes::kForkInside,
                      node.where,
                      "second fork on one side",
                      "nest the forks, or make one fork of all branches");
      } else if (node.kind == Node::Kind::kLeaf && fork != ends.end()) {
        report_.Error(codes::kLeafInside,
                      node.where,
                      fmt::format("'{}' beside a fork", node.leaf.Name()),
                      "the branches of a fork have their own leaves");
      } else if (node.kind == Node::Kind::kLeaf && end != ends.begin()) {
        report_.Error(codes::kSecondLeaf,
                      node.where,
                      fmt::format("second leaf '{}' on one branch", node.leaf.Name()),
                      fmt::format("side by side they are a fork: ({} + {})",
                                  nodes[ends.front()].leaf.Name(),
                                  node.leaf.Name()));
      }
    }
  }

  void MoveOut(Nodes& nodes, std::size_t end, Side side, bool in_fork) {
    const bool left = side == Side::kLeft;
    const auto place = nodes.begin() + static_cast<std::ptrdiff_t>(end);
    const Range outside = left ? Range{nodes.front().where.begin, std::prev(place)->where.end}
                               : Range{std::next(place)->where.begin, nodes.back().where.end};
    if (place->kind == Node::Kind::kFork) {
      report_.Error(
          codes::kForkInside,
          outside,
          fmt::format(
              "'{}' stands {} a fork", report_.Quote(outside), left ? "in front of" : "behind"),
          left ? "a fork is first on the workpiece side; move this behind it or into a branch"
               : "a fork is last on the tool side; move this in front of it or into a branch");
      return;
    }
    const std::string name = place->leaf.Name();
    const std::string_view which = left ? "first" : "last";
    if (in_fork) {
      report_.Error(codes::kLeafInside,
                    place->where,
                    fmt::format("'{}' is not {} on its branch", name, which),
                    fmt::format("branches are read from workpiece to tool too; write '{}' {}",
                                name,
                                left ? "in front" : "at the end"));
      return;
    }
    report_.Note(codes::kLeafMoved,
                 place->where,
                 fmt::format("'{}' moved {} '{}': a {} is {} on its side",
                             name,
                             left ? "in front of" : "behind",
                             report_.Quote(outside),
                             KindName(place->leaf.kind),
                             which));
    if (left) {
      std::rotate(nodes.begin(), place, std::next(place));
    } else {
      std::rotate(place, std::next(place), nodes.end());
    }
  }

  void CollectLeaves(Nodes& nodes) {
    for (Node& node : nodes) {
      // A process along z is not mistaken for one along x.
      if (node.kind == Node::Kind::kLeaf)
        leaves_[{node.leaf.kind, node.leaf.direction}].push_back(&node);
      for (Nodes& branch : node.branches) CollectLeaves(branch);
    }
  }

  void CheckLeaves() {
    for (const auto& [kind, leaves] : leaves_) {
      std::set<int> taken;
      for (const Node* node : leaves) {
        const int number = node->leaf.number;
        if (number == 0 || taken.insert(number).second) continue;
        report_.Error(codes::kRepeatedLeaf,
                      node->where,
                      fmt::format("leaf '{}' is named twice", node->leaf.Name()),
                      fmt::format("number each {} of its own", KindName(kind.first)));
      }
    }
  }

  void NumberLeaves() {
    for (const auto& [kind, leaves] : leaves_) {
      std::set<int> taken;
      for (const Node* node : leaves) taken.insert(node->leaf.number);
      if (std::count_if(leaves.begin(), leaves.end(), [](const Node* node) {
            return node->leaf.number == 0;
          }) < 2) {
        continue;
      }
      int next = 1;
      for (Node* node : leaves) {
        if (node->leaf.number != 0) continue;
        while (taken.count(next) != 0) ++next;
        GiveNumber(*node, next++);
      }
    }
  }

  void GiveNumber(Node& node, int number) {
    const std::string before = node.leaf.Name();
    node.leaf.number = number;
    report_.Note(
        codes::kLeafNumbered,
        node.where,
        node.implied
            ? fmt::format("leaf '{}' put in: this branch names none", node.leaf.Name())
            : fmt::format("leaf '{}' read as '{}': there are several", before, node.leaf.Name()));
  }

  Report& report_;
  std::set<std::string> names_;
  std::set<std::string> seen_axes_;
  std::set<std::string> seen_blocks_;
  std::string base_help_;
  std::map<std::pair<LeafKind, char>, std::vector<Node*>> leaves_;
};

}  // namespace

Formula JudgeNodes(Nodes nodes, Range whole, Report& report) {
  return Judge(report).Build(std::move(nodes), whole);
}

}  // namespace kompono::formula
