// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_CODES_HPP_
#define KOMPONO_FORMULA_CODES_HPP_

#include <array>
#include <string_view>

/// What can be said about a formula: E01xx are errors, N01xx notes on a dialect that was read. A
/// code keeps its meaning between versions; a new complaint gets a new code. docs/formula.md
/// explains them with examples.
namespace kompono::formula {

struct CodeTitle {
  std::string_view code;
  std::string_view title;
};

namespace codes {
inline constexpr CodeTitle kEmptyText{"E0101", "empty text"};
inline constexpr CodeTitle kNoBase{"E0102", "no base"};
inline constexpr CodeTitle kSecondBase{"E0103", "second base"};
inline constexpr CodeTitle kStrayBar{"E0104", "bar that does not join two bases"};
inline constexpr CodeTitle kSecondOpenBase{"E0105", "second open base"};
inline constexpr CodeTitle kUnknownLetter{"E0106", "unknown letter"};
inline constexpr CodeTitle kUnknownWord{"E0107", "unknown word"};
inline constexpr CodeTitle kRepeatedAxis{"E0108", "axis named twice"};
inline constexpr CodeTitle kRepeatedLetter{"E0109", "letter twice in a group"};
inline constexpr CodeTitle kUnclosed{"E0110", "bracket not closed"};
inline constexpr CodeTitle kUnopened{"E0111", "bracket not opened"};
inline constexpr CodeTitle kEmptyBracket{"E0112", "empty bracket"};
inline constexpr CodeTitle kSingleGroup{"E0113", "group of one letter"};
inline constexpr CodeTitle kStrayPlus{"E0114", "plus outside a fork"};
inline constexpr CodeTitle kEmptyBranch{"E0115", "empty branch"};
inline constexpr CodeTitle kWrongSide{"E0116", "leaf on the wrong side"};
inline constexpr CodeTitle kLeafInside{"E0117", "leaf that does not end its branch"};
inline constexpr CodeTitle kForkInside{"E0118", "fork that does not end its side"};
inline constexpr CodeTitle kSecondLeaf{"E0119", "second leaf on a branch"};
inline constexpr CodeTitle kBadIndex{"E0120", "bad orientation or index"};
inline constexpr CodeTitle kSpindleTranslates{"E0121", "orientation on a translation"};
inline constexpr CodeTitle kBadPlane{"E0122", "bad clamping plane"};
inline constexpr CodeTitle kNoBlockName{"E0123", "no block name behind the colon"};
inline constexpr CodeTitle kBadBlockName{"E0124", "bad block name"};
inline constexpr CodeTitle kRepeatedBlock{"E0125", "block named twice"};
inline constexpr CodeTitle kBadCount{"E0126", "bad count"};
inline constexpr CodeTitle kCountAlone{"E0127", "number without an axis or a bracket"};
inline constexpr CodeTitle kCountedFork{"E0128", "count before a fork with several branches"};
inline constexpr CodeTitle kStrayCharacter{"E0129", "character that means nothing here"};
inline constexpr CodeTitle kTooDeep{"E0130", "brackets nested too deeply"};
inline constexpr CodeTitle kTooLong{"E0131", "text too long"};
inline constexpr CodeTitle kBaseInside{"E0132", "base inside a bracket"};
inline constexpr CodeTitle kRepeatedLeaf{"E0133", "leaf named twice"};
inline constexpr CodeTitle kBadNumber{"E0134", "bad number"};
inline constexpr CodeTitle kNeitherNor{"E0135", "bracket that is neither a group nor a fork"};
inline constexpr CodeTitle kStrayPrime{"E0136", "prime on the wrong side"};
inline constexpr CodeTitle kBlockMisplaced{"E0137", "block name where none can stand"};
inline constexpr CodeTitle kIndexMisplaced{"E0138", "index where none can stand"};
inline constexpr CodeTitle kSpindleSets{"E0139", "orientation on a setting motion"};
inline constexpr CodeTitle kUnknownCommand{"E0140", "unknown LaTeX command"};

inline constexpr CodeTitle kLatex{"N0101", "LaTeX"};
inline constexpr CodeTitle kCyrillic{"N0102", "Cyrillic look-alike letters"};
inline constexpr CodeTitle kZeroBase{"N0103", "0 for O"};
inline constexpr CodeTitle kLeafMoved{"N0104", "leaf moved to the end of its side"};
inline constexpr CodeTitle kWorkpieceZ{"N0105", "Z_xy for part_xy"};
inline constexpr CodeTitle kIso{"N0106", "ISO 230-1 structural code"};
inline constexpr CodeTitle kIsoSpindle{"N0107", "ISO 230-1 spindle without orientation"};
inline constexpr CodeTitle kLeafNumbered{"N0108", "leaf numbered"};
inline constexpr CodeTitle kIndexCut{"N0109", "letters right behind an index"};
inline constexpr CodeTitle kPlaneSorted{"N0110", "letters of a plane sorted"};
inline constexpr CodeTitle kOrientationMoved{"N0111", "orientation moved to the group"};
inline constexpr CodeTitle kNumberIndex{"N0112", "number written as an index"};
}  // namespace codes

/// All of them, errors first, in ascending order.
inline constexpr std::array kCodes{codes::kEmptyText,
                                   codes::kNoBase,
                                   codes::kSecondBase,
                                   codes::kStrayBar,
                                   codes::kSecondOpenBase,
                                   codes::kUnknownLetter,
                                   codes::kUnknownWord,
                                   codes::kRepeatedAxis,
                                   codes::kRepeatedLetter,
                                   codes::kUnclosed,
                                   codes::kUnopened,
                                   codes::kEmptyBracket,
                                   codes::kSingleGroup,
                                   codes::kStrayPlus,
                                   codes::kEmptyBranch,
                                   codes::kWrongSide,
                                   codes::kLeafInside,
                                   codes::kForkInside,
                                   codes::kSecondLeaf,
                                   codes::kBadIndex,
                                   codes::kSpindleTranslates,
                                   codes::kBadPlane,
                                   codes::kNoBlockName,
                                   codes::kBadBlockName,
                                   codes::kRepeatedBlock,
                                   codes::kBadCount,
                                   codes::kCountAlone,
                                   codes::kCountedFork,
                                   codes::kStrayCharacter,
                                   codes::kTooDeep,
                                   codes::kTooLong,
                                   codes::kBaseInside,
                                   codes::kRepeatedLeaf,
                                   codes::kBadNumber,
                                   codes::kNeitherNor,
                                   codes::kStrayPrime,
                                   codes::kBlockMisplaced,
                                   codes::kIndexMisplaced,
                                   codes::kSpindleSets,
                                   codes::kUnknownCommand,
                                   codes::kLatex,
                                   codes::kCyrillic,
                                   codes::kZeroBase,
                                   codes::kLeafMoved,
                                   codes::kWorkpieceZ,
                                   codes::kIso,
                                   codes::kIsoSpindle,
                                   codes::kLeafNumbered,
                                   codes::kIndexCut,
                                   codes::kPlaneSorted,
                                   codes::kOrientationMoved,
                                   codes::kNumberIndex};

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_CODES_HPP_
