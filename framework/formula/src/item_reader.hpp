// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_SRC_ITEM_READER_HPP_
#define KOMPONO_FORMULA_SRC_ITEM_READER_HPP_

#include "glyphs.hpp"
#include "reader.hpp"
#include "report.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kompono::formula {

/// A place among the glyphs.
class Cursor {
 public:
  explicit Cursor(const std::vector<Glyph>& glyphs) : glyphs_(glyphs) {}

  [[nodiscard]] const std::vector<Glyph>& glyphs() const { return glyphs_; }
  [[nodiscard]] bool AtEnd() const { return at_ >= glyphs_.size(); }
  /// The glyph `ahead` of this place; not past the end.
  [[nodiscard]] const Glyph& Peek(std::size_t ahead = 0) const { return glyphs_[at_ + ahead]; }
  /// Its code, 0 past the end.
  [[nodiscard]] char32_t Code(std::size_t ahead = 0) const {
    return at_ + ahead < glyphs_.size() ? glyphs_[at_ + ahead].code : 0;
  }
  /// Its code if no space stands before it, else 0.
  [[nodiscard]] char32_t Joined(std::size_t ahead = 0) const {
    return Code(ahead) != 0 && Peek(ahead).gap != Gap::kSpace ? Code(ahead) : 0;
  }
  const Glyph& Take() { return glyphs_[at_++]; }

  /// The digits from here on, the first taken as it stands, the others without spaces between;
  /// `where` is stretched over them. More digits than an int holds give its largest value.
  int TakeNumber(Range& where);

  /// Whether `word` begins `ahead` of here.
  [[nodiscard]] bool SpellsAhead(std::string_view word, std::size_t ahead = 0) const;

 private:
  const std::vector<Glyph>& glyphs_;
  std::size_t at_ = 0;
};

/// Reads what is no bracket, base or count: axes, leaves, and what should have been one.
class ItemReader {
 public:
  ItemReader(Cursor& cursor, Report& report) : cursor_(cursor), report_(report) {}

  /// Takes at least one glyph.
  void Read(Nodes& nodes);

  /// Makes `node` the group of `members`, all axes; an incomplete bracket is not blamed for what is
  /// missing.
  void MakeGroup(Node& node, const Nodes& members, bool complete);

  /// The orientation and block name behind a closed bracket.
  void ReadBracketSuffix(Node& node);

 private:
  bool ReadWord(Nodes& nodes);
  void ReadLeafSuffix(Node& node);
  bool ReadMisspeltWord();
  void ReadUnknownLetters();
  void ReadStray();
  void ReadAxis(Nodes& nodes);
  void ReadAxisIndex(Node& node);
  bool ReadNumberIndex(Node& node);
  void ReadDirection(Node& node);
  void ReadPlane(Node& node, bool dialect);
  void ReadAxisOrientation(Node& node);
  void ReadGroupOrientation(Node& node);
  /// The index at '_'; stretches `where` over it. kNone when it was bad and complained about as a
  /// bad `what`.
  Orientation ReadOrientation(Range& where, std::string_view what, std::string help);
  void MoveOrientation(Node& node, const Node& member);
  void ReadBlock(std::string& block, Node& node);
  int ReadNumber(Range& where);
  /// Past number, index and block name of something already complained about.
  void SkipSuffix();
  void SkipSuffixIndex();

  /// The length of the run of small letters from `ahead` on; a gap ends it.
  [[nodiscard]] std::size_t SmallRun(std::size_t ahead) const;
  /// Whether the letters in [from, to) ahead can all be setting motions.
  [[nodiscard]] bool AreAxes(std::size_t from, std::size_t to) const;
  /// Takes `count` glyphs and gives their place.
  Range TakeRange(std::size_t count);
  /// Notes that letters right behind an index are the next items.
  void NoteCut(Range index);

  Cursor& cursor_;
  Report& report_;
};

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_SRC_ITEM_READER_HPP_
