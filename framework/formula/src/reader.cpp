// SPDX-License-Identifier: Apache-2.0
#include "reader.hpp"

#include "item_reader.hpp"
#include "vocabulary.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace kompono::formula {
namespace {

/// Brackets, branches, counts and bases; single items are ItemReader's.
class Reader {
 public:
  Reader(const std::vector<Glyph>& glyphs, Report& report)
      : cursor_(glyphs), report_(report), items_(cursor_, report) {}

  Nodes ReadAll() {
    has_base_ = HasBase();
    std::vector<Nodes> branches(1);
    while (!cursor_.AtEnd()) ReadItem(branches, 0);
    return std::move(branches.front());
  }

 private:
  /// Whether an O stands anywhere but in a block name: if so, a 0 is not one.
  [[nodiscard]] bool HasBase() const {
    bool in_name = false;
    for (const Glyph& glyph : cursor_.glyphs()) {
      const bool ends_name = IsStructural(glyph.code) && glyph.code != U'_';
      if (glyph.gap == Gap::kSpace || ends_name) in_name = false;
      if (glyph.code == U'O' && !in_name) return true;
      if (glyph.code == U':') in_name = true;
    }
    return false;
  }

  void ReadItem(std::vector<Nodes>& branches, int depth) {
    const char32_t code = cursor_.Code();
    if (code == U'(') {
      ReadBracket(branches.back(), depth, std::nullopt);
    } else if (code == U')') {
      report_.Error(codes::kUnopened,
                    cursor_.Take().where,
                    "bracket ')' is not opened",
                    "leave it out, or write '(' where the group or fork begins");
    } else if (code == U'+') {
      ReadPlus(branches, depth);
    } else if (code == U'O') {
      PutBase(branches.back(), depth, cursor_.Take().where);
    } else if (code == U'|') {
      const Range where = cursor_.Take().where;
      if (depth > 0) {
        report_.Error(codes::kStrayBar,
                      where,
                      "'|' inside a bracket",
                      "an open base O|O divides the whole formula");
      } else {
        branches.back().push_back(Simple(Node::Kind::kBar, where));
      }
    } else if (IsDigit(code)) {
      ReadDigits(branches.back(), depth);
    } else {
      items_.Read(branches.back());
    }
  }

  static Node Simple(Node::Kind kind, Range where) {
    Node node;
    node.kind = kind;
    node.where = where;
    return node;
  }

  void PutBase(Nodes& nodes, int depth, Range where) {
    if (depth > 0) {
      report_.Error(codes::kBaseInside,
                    where,
                    "base 'O' inside a bracket",
                    "the base divides the whole formula; a bracket stands on one side of it");
    } else {
      nodes.push_back(Simple(Node::Kind::kBase, where));
    }
  }

  void ReadPlus(std::vector<Nodes>& branches, int depth) {
    const Range where = cursor_.Take().where;
    if (depth > 0) {
      branches.emplace_back();
      return;
    }
    report_.Error(codes::kStrayPlus,
                  where,
                  "'+' outside a bracket",
                  "branches side by side stand in a bracket: (tool1 + tool2)");
  }

  /// A count in front of a bracket, or 0 for O.
  void ReadDigits(Nodes& nodes, int depth) {
    if (ReadZeroBase(nodes, depth)) return;
    Range where = cursor_.Peek().where;
    const int count = cursor_.TakeNumber(where);
    const bool before_bracket = cursor_.Code() == U'(';
    const std::string text = report_.Quote(where);
    if (count == 0 && !before_bracket) {
      report_.Error(codes::kBadNumber,
                    where,
                    fmt::format("number '{}'", text),
                    "numbers of axes and leaves begin with 1; the base is already there");
    } else if (!before_bracket) {
      report_.Error(codes::kCountAlone,
                    where,
                    fmt::format("number '{}' belongs to nothing", text),
                    fmt::format("an axis' number stands right behind its letter (X{0}), a count in "
                                "front of a bracket: 2(…)",
                                count > kMaxNumber ? 2 : count));
    } else if (count < 2 || count > kMaxCount) {
      report_.Error(
          codes::kBadCount,
          where,
          fmt::format("count '{}'", text),
          fmt::format("a count says how many equal branches there are, from 2 to {}", kMaxCount));
    }
    if (before_bracket) ReadBracket(nodes, depth, Count{std::clamp(count, 2, kMaxCount), where});
  }

  bool ReadZeroBase(Nodes& nodes, int depth) {
    if (cursor_.Code() != U'0') return false;
    const bool beside_bar =
        cursor_.Code(1) == U'|' || (!nodes.empty() && nodes.back().kind == Node::Kind::kBar);
    if (has_base_ && !beside_bar) return false;
    const Range where = cursor_.Take().where;
    report_.Note(codes::kZeroBase, where, "digit '0' read as the base 'O'");
    PutBase(nodes, depth, where);
    return true;
  }

  struct Count {
    int value;
    Range where;
  };

  void ReadBracket(Nodes& nodes, int depth, std::optional<Count> count) {
    const std::size_t errors_before = report_.error_count();
    const Range open = cursor_.Take().where;
    if (depth == kMaxNesting) {
      report_.Error(
          codes::kTooDeep,
          open,
          fmt::format("more than {} brackets nested", kMaxNesting),
          "a fork inside a fork is rarely needed; branches of one fork may be as many as you like");
      SkipBracket();
      return;
    }
    const bool closed = ClosesAhead();
    if (!closed) {
      report_.Error(codes::kUnclosed,
                    open,
                    "bracket '(' is not closed",
                    "write ')' behind the last motion of the group or the last branch of the fork");
    }
    // An open bracket ends before the base at the latest, so that the rest is judged as it was
    // meant.
    const auto ends = [closed](char32_t code) {
      return code == 0 || code == U')' || (!closed && (code == U'O' || code == U'|'));
    };
    std::vector<Nodes> branches(1);
    while (!ends(cursor_.Code())) ReadItem(branches, depth + 1);
    Node node = Simple(Node::Kind::kFork, {count ? count->where.begin : open.begin, open.end});
    if (cursor_.Code() == U')') {
      node.where.end = cursor_.Take().where.end;
    } else {
      for (const Nodes& branch : branches) {
        if (!branch.empty()) node.where.end = branch.back().where.end;
      }
    }
    // Where something inside was complained about and left out, what is left says nothing about the
    // bracket.
    const bool complete = report_.error_count() == errors_before;
    const bool one_branch = branches.size() == 1;
    const bool all_axes =
        std::all_of(branches.front().begin(), branches.front().end(), [](const Node& inner) {
          return inner.kind == Node::Kind::kAxis;
        });
    if (one_branch && !count && all_axes) {
      items_.MakeGroup(node, branches.front(), complete);
    } else {
      MakeFork(node, std::move(branches), count, complete);
    }
    items_.ReadBracketSuffix(node);
    nodes.push_back(std::move(node));
  }

  void MakeFork(Node& node,
                std::vector<Nodes> branches,
                std::optional<Count> count,
                bool complete) {
    if (count) node.count = count->value;
    if (count && branches.size() > 1) {
      report_.Error(codes::kCountedFork,
                    count->where,
                    "count before a fork with several branches",
                    "write the branches out, or put the fork into a branch: 2((… + …))");
    }
    if (complete && branches.size() == 1 && branches.front().empty()) {
      report_.Error(codes::kEmptyBracket,
                    node.where,
                    "empty bracket",
                    "write its motions or branches, or leave it out");
    } else if (complete && branches.size() == 1 && !count) {
      report_.Error(codes::kNeitherNor,
                    node.where,
                    "bracket is neither a group nor a fork",
                    "a group holds motions only; a fork has branches with '+' between them");
    } else if (complete && branches.size() > 1 &&
               std::any_of(branches.begin(), branches.end(), [](const Nodes& branch) {
                 return branch.empty();
               })) {
      report_.Error(codes::kEmptyBranch,
                    node.where,
                    "fork with an empty branch",
                    "each branch has at least a leaf: (tool1 + tool2)");
    }
    node.branches = std::move(branches);
  }

  /// Whether the bracket just opened is closed somewhere.
  [[nodiscard]] bool ClosesAhead() const {
    int open = 1;
    for (std::size_t i = 0; cursor_.Code(i) != 0; ++i) {
      if (cursor_.Code(i) == U'(') ++open;
      if (cursor_.Code(i) == U')' && --open == 0) return true;
    }
    return false;
  }

  /// To behind the bracket that closes the one just opened.
  void SkipBracket() {
    int open = 1;
    while (!cursor_.AtEnd() && open > 0) {
      const char32_t code = cursor_.Take().code;
      if (code == U'(') ++open;
      if (code == U')') --open;
    }
  }

  Cursor cursor_;
  Report& report_;
  ItemReader items_;
  bool has_base_ = false;
};

}  // namespace

Nodes ReadNodes(const std::vector<Glyph>& glyphs, Report& report) {
  return Reader(glyphs, report).ReadAll();
}

}  // namespace kompono::formula
