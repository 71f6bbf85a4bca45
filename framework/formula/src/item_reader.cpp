// SPDX-License-Identifier: Apache-2.0
#include "item_reader.hpp"

#include "vocabulary.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>

namespace kompono::formula {
namespace {

constexpr std::size_t kMaxBlockName = 64;

bool IsPrime(char32_t code) {
  return code == U'\'' || code == 0x2032 || code == 0x2019;
}

bool IsCyrillic(char32_t code) {
  return code >= 0x400 && code <= 0x52F;
}

bool IsBlockName(std::string_view name) {
  const auto allowed = [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return IsLetter(code) || IsDigit(code) || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kMaxBlockName &&
         IsLetter(static_cast<unsigned char>(name.front())) &&
         std::all_of(name.begin(), name.end(), allowed);
}

std::string HelpForStray(char32_t code) {
  if (code == U'З' || code == U'з') {
    return "write part for the workpiece (заготовка), Z for the axis";
  }
  if (IsCyrillic(code)) return "formulas are written in Latin letters";
  if (code == U'[' || code == U']') {
    return "square brackets stand only around a whole structural code of ISO 230-1: [w X' b Y Z "
           "(C) t]";
  }
  if (code == U'/' || code == U'\\') return "an open base is written O|O";
  if (code == U',' || code == U';' || code == U'-' || code == U'*' || code == U'.') {
    return "the elements follow each other without signs between them: part X Y O Z tool";
  }
  return "a formula has Latin letters, digits, brackets and the signs + | _ :";
}

}  // namespace

int Cursor::TakeNumber(Range& where) {
  constexpr int kLargest = std::numeric_limits<int>::max();
  int number = 0;
  do {
    const Glyph& glyph = Take();
    const int digit = static_cast<int>(glyph.code - U'0');
    number = number > (kLargest - digit) / 10 ? kLargest : number * 10 + digit;
    where.end = glyph.where.end;
  } while (IsDigit(Joined()));
  return number;
}

bool Cursor::SpellsAhead(std::string_view word, std::size_t ahead) const {
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char32_t code = i == 0 ? Code(ahead) : Joined(ahead + i);
    if (code != static_cast<unsigned char>(word[i])) return false;
  }
  return true;
}

std::size_t ItemReader::SmallRun(std::size_t ahead) const {
  std::size_t i = ahead;
  while (IsLower(cursor_.Code(i)) && (i == ahead || cursor_.Peek(i).gap == Gap::kNone) &&
         !cursor_.SpellsAhead("part", i) && !cursor_.SpellsAhead("tool", i)) {
    ++i;
  }
  return i - ahead;
}

bool ItemReader::AreAxes(std::size_t from, std::size_t to) const {
  for (std::size_t i = from; i < to; ++i) {
    if (!IsAxisLetter(cursor_.Code(i))) return false;
  }
  return true;
}

Range ItemReader::TakeRange(std::size_t count) {
  Range where = cursor_.Peek().where;
  for (std::size_t i = 0; i < count; ++i) where.end = cursor_.Take().where.end;
  return where;
}

void ItemReader::Read(Nodes& nodes) {
  if (ReadWord(nodes)) return;
  const char32_t code = cursor_.Code();
  if (!IsLetter(code)) {
    ReadStray();
  } else if (!ReadMisspeltWord()) {
    if (IsAxisLetter(code)) {
      ReadAxis(nodes);
    } else {
      ReadUnknownLetters();
    }
  }
}

bool ItemReader::ReadWord(Nodes& nodes) {
  const bool part = cursor_.SpellsAhead("part");
  if (!part && !cursor_.SpellsAhead("tool")) return false;
  Node node;
  node.kind = Node::Kind::kLeaf;
  node.leaf.kind = part ? LeafKind::kPart : LeafKind::kTool;
  node.where = TakeRange(4);
  if (IsDigit(cursor_.Joined()) && cursor_.Joined() != U'0')
    node.leaf.number = ReadNumber(node.where);
  if (part && cursor_.Code() == U'_') ReadPlane(node, false);
  ReadLeafSuffix(node);
  nodes.push_back(std::move(node));
  return true;
}

void ItemReader::ReadLeafSuffix(Node& node) {
  if (cursor_.Code() == U'_') {
    const Range where = TakeRange(1 + (cursor_.Joined(1) != 0 ? SmallRun(1) : 0));
    report_.Error(
        codes::kIndexMisplaced,
        where,
        fmt::format("'{}' takes no index '{}'", report_.Quote(node.where), report_.Quote(where)),
        "only a workpiece has a plane (part_xy), a process a direction (P_z) and a spindle an "
        "orientation (C_v)");
  }
  if (cursor_.Code() == U':') {
    const Range colon = cursor_.Peek().where;
    SkipSuffix();
    report_.Error(codes::kBlockMisplaced,
                  colon,
                  fmt::format("'{}' takes no block name", report_.Quote(node.where)),
                  "block names stand behind motions and groups: (XY):drive");
  }
}

bool ItemReader::ReadMisspeltWord() {
  std::size_t length = 0;
  if (IsLower(cursor_.Code())) {
    length = SmallRun(0);
  } else if (IsLower(cursor_.Code(1)) && cursor_.Peek(1).gap == Gap::kNone) {
    length = 1 + SmallRun(1);
  } else {
    length = 1;
    while (IsUpper(cursor_.Code(length)) && cursor_.Peek(length).gap == Gap::kNone) ++length;
  }
  if (length < 3) return false;
  std::string word;
  bool all_known = true;
  for (std::size_t i = 0; i < length; ++i) {
    const char32_t code = cursor_.Code(i);
    all_known = all_known && (IsAxisLetter(code) || code == U'O');
    word += static_cast<char>(code);
  }
  if (all_known) return false;
  std::string help = HelpForWord(word);
  if (help.empty()) return false;
  const Range where = TakeRange(length);
  SkipSuffix();
  report_.Error(
      codes::kUnknownWord, where, fmt::format("unknown word '{}'", word), std::move(help));
  return true;
}

void ItemReader::ReadUnknownLetters() {
  std::string letters;
  const auto is_unknown = [this](std::size_t i) {
    return IsLetter(cursor_.Code(i)) && !IsAxisLetter(cursor_.Code(i)) && cursor_.Code(i) != U'O' &&
           (i == 0 || (cursor_.Peek(i).gap == Gap::kNone && !cursor_.SpellsAhead("tool", i)));
  };
  while (is_unknown(letters.size())) letters += static_cast<char>(cursor_.Code(letters.size()));
  const Range where = TakeRange(letters.size());
  SkipSuffix();
  report_.Error(codes::kUnknownLetter,
                where,
                fmt::format("unknown letter{} '{}'", letters.size() == 1 ? "" : "s", letters),
                HelpForLetters(letters));
}

void ItemReader::SkipSuffix() {
  Range ignored;
  if (IsDigit(cursor_.Joined()) && cursor_.Joined() != U'0') cursor_.TakeNumber(ignored);
  if (cursor_.Code() == U'_') SkipSuffixIndex();
  if (cursor_.Code() == U':') {
    cursor_.Take();
    while (cursor_.Joined() != 0 && (cursor_.Joined() == U'_' || !IsStructural(cursor_.Joined()))) {
      cursor_.Take();
    }
  }
}

void ItemReader::ReadStray() {
  const char32_t first = cursor_.Code();
  if (first == U'_' || first == U':') {
    const Range where = cursor_.Peek().where;
    SkipSuffix();
    if (first == U'_') {
      report_.Error(codes::kIndexMisplaced,
                    where,
                    "index without an axis in front of it",
                    "an index follows a spindle (C_v), a workpiece (part_xy) or a process (P_z)");
    } else {
      report_.Error(codes::kBlockMisplaced,
                    where,
                    "block name without a motion in front of it",
                    "block names stand behind motions and groups: (XY):drive");
    }
    return;
  }
  if (IsPrime(first)) {
    report_.Error(codes::kStrayPrime,
                  cursor_.Take().where,
                  "prime outside a code of ISO 230-1",
                  "leave it out: the side of O tells which axes move the workpiece");
    return;
  }
  std::size_t length = 1;
  const auto is_stray = [this](std::size_t i) {
    const char32_t code = cursor_.Code(i);
    return code != 0 && cursor_.Peek(i).gap == Gap::kNone && !IsLetter(code) && !IsDigit(code) &&
           !IsStructural(code) && !IsPrime(code);
  };
  while (is_stray(length)) ++length;
  const Range where = TakeRange(length);
  report_.Error(codes::kStrayCharacter,
                where,
                fmt::format("'{}' means nothing here", report_.Quote(where)),
                HelpForStray(first));
  if (cursor_.Joined() == U'_') SkipSuffixIndex();
}

int ItemReader::ReadNumber(Range& where) {
  Range digits = cursor_.Peek().where;
  const int number = cursor_.TakeNumber(digits);
  where.end = digits.end;
  if (number > kMaxNumber || number == 0) {
    report_.Error(codes::kBadNumber,
                  digits,
                  fmt::format("number '{}'", report_.Quote(digits)),
                  fmt::format("numbers go from 1 to {}", kMaxNumber));
  }
  return number;
}

void ItemReader::ReadAxis(Nodes& nodes) {
  Node node;
  const Glyph& glyph = cursor_.Take();
  node.where = glyph.where;
  node.axis.letter = static_cast<char>(std::toupper(static_cast<int>(glyph.code)));
  node.axis.working = IsUpper(glyph.code);
  if (IsDigit(cursor_.Joined()) && cursor_.Joined() != U'0')
    node.axis.number = ReadNumber(node.where);
  if (cursor_.Code() == U'_') ReadAxisIndex(node);
  if (node.kind == Node::Kind::kLeaf) {
    ReadLeafSuffix(node);
  } else if (cursor_.Code() == U':') {
    ReadBlock(node.axis.block, node);
  }
  nodes.push_back(std::move(node));
}

void ItemReader::ReadAxisIndex(Node& node) {
  if (IsDigit(cursor_.Joined(1)) && (!ReadNumberIndex(node) || cursor_.Code() != U'_')) return;
  const bool direction = node.axis.working && IsDirection(cursor_.Joined(1));
  if (direction && node.axis.letter == 'P') {
    ReadDirection(node);
  } else if (direction && node.axis.letter == 'Z' && IsDirection(cursor_.Joined(2))) {
    ReadPlane(node, true);
  } else {
    ReadAxisOrientation(node);
  }
}

bool ItemReader::ReadNumberIndex(Node& node) {
  Range where = cursor_.Take().where;
  const int number = ReadNumber(where);
  if (node.axis.number != 0) {
    report_.Error(codes::kBadIndex,
                  where,
                  fmt::format("second number of '{}'", report_.Quote(node.where)),
                  "an axis has one number, right behind its letter");
    return false;
  }
  node.axis.number = number;
  node.where.end = where.end;
  report_.Note(codes::kNumberIndex,
               node.where,
               fmt::format("index read as the number of the axis: '{}'", node.axis.Name()));
  return true;
}

void ItemReader::ReadDirection(Node& node) {
  node.kind = Node::Kind::kLeaf;
  node.leaf.kind = LeafKind::kProcess;
  node.leaf.number = node.axis.number;
  node.leaf.direction = static_cast<char>(cursor_.Code(1));
  const Range index = TakeRange(2);
  node.where.end = index.end;
  NoteCut(index);
}

void ItemReader::ReadPlane(Node& node, bool dialect) {
  const char32_t first = cursor_.Joined(1);
  const char32_t second = cursor_.Joined(2);
  const std::size_t run = first == 0 ? 0 : SmallRun(1);
  const bool good = IsDirection(first) && IsDirection(second) && first != second &&
                    (run <= 2 || AreAxes(3, 1 + run));
  if (!good) {
    std::size_t length = run;
    while (length < 2 && IsUpper(cursor_.Joined(1 + length))) ++length;
    const Range where = TakeRange(1 + length);
    report_.Error(codes::kBadPlane,
                  where,
                  length == 0 ? std::string("the clamping plane is missing behind '_'")
                              : fmt::format("bad clamping plane '{}'", report_.Quote(where)),
                  "the plane is two different letters of x, y and z: part_xy, part_xz or part_yz");
    node.where.end = where.end;
  } else {
    const Range index = TakeRange(3);
    node.where.end = index.end;
    node.leaf.plane = {static_cast<char>(std::min(first, second)),
                       static_cast<char>(std::max(first, second))};
    if (first > second) {
      report_.Note(codes::kPlaneSorted,
                   index,
                   fmt::format("plane '{}' read as '_{}'", report_.Quote(index), node.leaf.plane));
    }
    NoteCut(index);
  }
  node.kind = Node::Kind::kLeaf;
  node.leaf.kind = LeafKind::kPart;
  if (!dialect) return;
  node.leaf.number = node.axis.number;
  report_.Note(
      codes::kWorkpieceZ,
      node.where,
      fmt::format("'{}' read as the workpiece '{}'", report_.Quote(node.where), node.leaf.Name()));
}

Orientation ItemReader::ReadOrientation(Range& where, std::string_view what, std::string help) {
  const char32_t letter = cursor_.Joined(1);
  const std::size_t run = letter == 0 ? 0 : SmallRun(1);
  const Orientation orientation = OrientationOf(letter);
  Range index;
  if (orientation != Orientation::kNone && run > 0 && AreAxes(2, 1 + run)) {
    index = TakeRange(2);
    NoteCut(index);
  } else {
    const bool sign = run == 0 && letter != 0 && !IsStructural(letter);
    index = TakeRange(1 + (sign ? 1 : run));
    const bool missing = !sign && run == 0;
    report_.Error(codes::kBadIndex,
                  index,
                  missing ? fmt::format("the {} is missing behind '_'", what)
                          : fmt::format("bad {} '{}'", what, report_.Quote(index)),
                  std::move(help));
    where.end = index.end;
    return Orientation::kNone;
  }
  where.end = index.end;
  if (cursor_.Code() == U'_') {
    const Range second = cursor_.Peek().where;
    SkipSuffixIndex();
    report_.Error(codes::kBadIndex,
                  second,
                  fmt::format("second index of '{}'", report_.Quote(where)),
                  "a main-motion spindle has one orientation");
  }
  return orientation;
}

void ItemReader::ReadAxisOrientation(Node& node) {
  const std::string name = node.axis.Name();
  const Range axis = node.where;
  std::string help =
      fmt::format("{0}_h is a horizontal, {0}_v a vertical, {0}_i an inclined spindle", name);
  if (node.axis.letter == 'P') {
    help = "a process acts along P_x, P_y or P_z; the tertiary axis P takes no index";
  } else if (node.axis.letter == 'Z') {
    help = "the axis Z takes no index; a workpiece clamped in the xy plane is part_xy";
  } else if (!node.axis.rotary()) {
    help = fmt::format("the translation {} takes no index", name);
  }
  const Orientation orientation =
      ReadOrientation(node.where, node.axis.rotary() ? "orientation" : "index", help);
  if (orientation == Orientation::kNone) return;
  const Range index{axis.end, node.where.end};
  if (!node.axis.rotary()) {
    report_.Error(codes::kSpindleTranslates,
                  index,
                  fmt::format("orientation on the translation '{}'", name),
                  node.axis.letter == 'P' || node.axis.letter == 'Z'
                      ? help
                      : "only a rotation can be a main-motion spindle: C_h, C_v or C_i");
  } else if (!node.axis.working) {
    report_.Error(codes::kSpindleSets,
                  index,
                  fmt::format("orientation on the setting motion '{}'", name),
                  fmt::format("a main-motion spindle is a working motion: {}_{}",
                              node.axis.letter,
                              LetterOf(orientation)));
  }
  node.axis.orientation = orientation;
}

void ItemReader::NoteCut(Range index) {
  if (cursor_.AtEnd() || cursor_.Peek().gap != Gap::kNone) return;
  const std::size_t rest = SmallRun(0);
  if (rest == 0 || !AreAxes(0, rest)) return;
  const Range letters{cursor_.Peek().where.begin, cursor_.Peek(rest - 1).where.end};
  report_.Note(codes::kIndexCut,
               letters,
               fmt::format("index '{}' ends before '{}', read as {}",
                           report_.Quote(index),
                           report_.Quote(letters),
                           rest == 1 ? "a setting motion" : "setting motions"),
               "a space makes it plain");
}

void ItemReader::ReadBlock(std::string& block, Node& node) {
  Range where = cursor_.Take().where;
  std::string name;
  bool ascii = true;
  Range name_where{where.end, where.end};
  while (cursor_.Joined() != 0 && (cursor_.Joined() == U'_' || !IsStructural(cursor_.Joined()))) {
    const Glyph& glyph = cursor_.Take();
    if (name.empty()) name_where.begin = glyph.where.begin;
    name_where.end = glyph.where.end;
    ascii = ascii && glyph.code < 0x80;
    name += ascii ? static_cast<char>(glyph.code) : '?';
  }
  if (name.empty()) {
    report_.Error(codes::kNoBlockName,
                  where,
                  "no block name behind ':'",
                  "the name follows the colon without a space: (XY):drive");
    return;
  }
  node.where.end = name_where.end;
  node.block_where = name_where;
  if (!ascii || !IsBlockName(name)) {
    report_.Error(
        codes::kBadBlockName,
        name_where,
        fmt::format("bad block name '{}'", report_.Quote(name_where)),
        fmt::format("a name begins with a Latin letter and has letters, digits, '_' and '-', at "
                    "most {} of them",
                    kMaxBlockName));
    return;
  }
  block = std::move(name);
}

void ItemReader::MakeGroup(Node& node, const Nodes& members, bool complete) {
  node.kind = Node::Kind::kGroup;
  if (complete && members.empty()) {
    report_.Error(codes::kEmptyBracket,
                  node.where,
                  "empty bracket",
                  "write its motions or branches, or leave it out");
  } else if (complete && members.size() == 1) {
    report_.Error(codes::kSingleGroup,
                  node.where,
                  fmt::format("group of the single motion '{}'", members.front().axis.Name()),
                  fmt::format("write {} without brackets; a group joins two motions or more",
                              members.front().axis.Name()));
  }
  std::string letters;
  for (const Node& member : members) {
    Axis axis = member.axis;
    if (letters.find(axis.letter) != std::string::npos) {
      report_.Error(codes::kRepeatedLetter,
                    member.where,
                    fmt::format("letter '{}' twice in a group", axis.letter),
                    "a mechanism's coordinates are told apart by their letters");
    }
    letters += axis.letter;
    if (!axis.block.empty()) {
      report_.Error(codes::kBlockMisplaced,
                    member.block_where,
                    "block name inside a group",
                    "one mechanism realises the whole group; its name stands behind the bracket");
    }
    if (axis.orientation != Orientation::kNone) MoveOrientation(node, member);
    axis.block.clear();
    axis.orientation = Orientation::kNone;
    node.group.axes.push_back(std::move(axis));
  }
}

void ItemReader::MoveOrientation(Node& node, const Node& member) {
  if (node.group.orientation != Orientation::kNone) {
    report_.Error(codes::kBadIndex,
                  member.where,
                  "second orientation in a group",
                  "a group has one main-motion spindle at most");
    return;
  }
  node.group.orientation = member.axis.orientation;
  report_.Note(
      codes::kOrientationMoved,
      member.where,
      fmt::format("orientation '_{}' moved behind the bracket", LetterOf(member.axis.orientation)));
}

void ItemReader::ReadBracketSuffix(Node& node) {
  const bool group = node.kind == Node::Kind::kGroup;
  if (cursor_.Code() == U'_' && group) {
    ReadGroupOrientation(node);
  } else if (cursor_.Code() == U'_') {
    const Range where = cursor_.Peek().where;
    SkipSuffixIndex();
    report_.Error(codes::kIndexMisplaced,
                  where,
                  "index behind a fork",
                  "orientations belong to spindles inside the branches");
  }
  if (cursor_.Code() == U':' && group) {
    ReadBlock(node.group.block, node);
  } else if (cursor_.Code() == U':') {
    const Range where = cursor_.Peek().where;
    SkipSuffix();
    report_.Error(codes::kBlockMisplaced,
                  where,
                  "block name behind a fork",
                  "name the motions and groups inside the branches: 2((XY):drive)");
  }
}

void ItemReader::ReadGroupOrientation(Node& node) {
  const Range bracket = node.where;
  const Orientation orientation =
      ReadOrientation(node.where,
                      "orientation",
                      "_h marks a horizontal, _v a vertical, _i an inclined spindle in the group");
  if (orientation == Orientation::kNone) return;
  const Range index{bracket.end, node.where.end};
  const auto spindle = [](const Axis& axis) { return axis.rotary() && axis.working; };
  const std::vector<Axis>& axes = node.group.axes;
  if (node.group.orientation != Orientation::kNone) {
    report_.Error(codes::kBadIndex,
                  index,
                  "second orientation of a group",
                  "a group has one main-motion spindle at most");
  } else if (std::none_of(
                 axes.begin(), axes.end(), [](const Axis& axis) { return axis.rotary(); })) {
    report_.Error(codes::kSpindleTranslates,
                  index,
                  "orientation on a group of translations",
                  "only a rotation can be a main-motion spindle: (CZ)_v");
  } else if (std::none_of(axes.begin(), axes.end(), spindle)) {
    report_.Error(codes::kSpindleSets,
                  index,
                  "orientation on a group without a working rotation",
                  "a main-motion spindle is a working motion: (CZ)_v");
  }
  node.group.orientation = orientation;
}

void ItemReader::SkipSuffixIndex() {
  cursor_.Take();
  if (IsLower(cursor_.Joined())) TakeRange(SmallRun(0));
}

}  // namespace kompono::formula
