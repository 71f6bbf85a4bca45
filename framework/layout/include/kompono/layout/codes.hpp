// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_CODES_HPP_
#define KOMPONO_LAYOUT_CODES_HPP_

#include <array>
#include <string_view>

/// What can be said about a layout file: E03xx are errors, W03xx warnings, N03xx notes. A code
/// keeps its meaning between versions; a new complaint gets a new code. docs/layout-file.md
/// explains them.
namespace kompono::layout {

struct CodeTitle {
  std::string_view code;
  std::string_view title;
};

namespace codes {
inline constexpr CodeTitle kNotToml{"E0301", "not TOML"};
inline constexpr CodeTitle kUnknownKey{"E0302", "unknown key"};
inline constexpr CodeTitle kMissingKey{"E0303", "missing key"};
inline constexpr CodeTitle kUnknownModule{"E0304", "unknown module"};
inline constexpr CodeTitle kWrongType{"E0305", "wrong type"};
inline constexpr CodeTitle kWrongCount{"E0306", "wrong count"};
inline constexpr CodeTitle kNotFinite{"E0307", "number that is not finite"};
inline constexpr CodeTitle kOutOfRange{"E0308", "number out of range"};
inline constexpr CodeTitle kMissingParameter{"E0309", "missing parameter"};
inline constexpr CodeTitle kUnknownWord{"E0310", "word that is no choice here"};
inline constexpr CodeTitle kNewerFormat{"E0311", "format of another version"};
inline constexpr CodeTitle kWrongModuleKind{"E0312",
                                            "unit in place of a mechanism, or the reverse"};
inline constexpr CodeTitle kUnknownParameter{"E0313", "unknown parameter"};
inline constexpr CodeTitle kFixedParameter{"E0314", "parameter that the preset has fixed"};
inline constexpr CodeTitle kUnknownMode{"E0315", "unknown assembly mode"};
inline constexpr CodeTitle kBadSign{"E0316", "bad sign"};
inline constexpr CodeTitle kUnknownDrive{"E0317", "unknown drive"};
inline constexpr CodeTitle kUndefinedBlock{"E0318", "block named but not defined"};
inline constexpr CodeTitle kUnnamedBlock{"E0319", "block defined but not named"};
inline constexpr CodeTitle kAmbiguousGroup{"E0320", "group without a block"};
inline constexpr CodeTitle kUnknownAxis{"E0321", "not a plain axis of the formula"};
inline constexpr CodeTitle kNoOpenBase{"E0322", "open base of a machine with one base"};
inline constexpr CodeTitle kReversedRange{"E0323", "lower limit above the upper one"};
inline constexpr CodeTitle kLetterDirection{"E0324", "letters that the block does not realise"};
inline constexpr CodeTitle kLetterCount{"E0325", "more or fewer letters than the block realises"};
inline constexpr CodeTitle kUnknownEnd{"E0326", "not an end of the formula"};
inline constexpr CodeTitle kUnknownStation{"E0327", "unknown station"};
inline constexpr CodeTitle kNeedsModule{"E0328", "key that needs a module"};
inline constexpr CodeTitle kEmptyPattern{"E0329", "pattern that names no number"};
inline constexpr CodeTitle kMixedPattern{"E0330", "pattern that names lengths and angles"};
inline constexpr CodeTitle kUnknownNumber{"E0331", "number that the layout does not have"};
inline constexpr CodeTitle kCannotWrite{"E0332", "number that cannot be written into the file"};
inline constexpr CodeTitle kCannotRead{"E0333", "file that cannot be read"};
inline constexpr CodeTitle kUnknownLetter{"E0334", "not a letter of the block"};
inline constexpr CodeTitle kNameTaken{"E0335", "block with the name of an axis or an end"};
inline constexpr CodeTitle kUnknownJoint{"E0336", "not a joint of the module's struts"};

inline constexpr CodeTitle kHomeOutside{"W0301", "home outside its range"};
inline constexpr CodeTitle kNoSpindle{"W0302", "'positioning' of an axis that is no spindle"};

inline constexpr CodeTitle kOwnAxes{"N0301", "coordinates along the mechanism's own axes"};
inline constexpr CodeTitle kBlockFound{"N0302", "block found for a group that names none"};
}  // namespace codes

/// All of them, errors first, in ascending order.
inline constexpr std::array kCodes{
    codes::kNotToml,          codes::kUnknownKey,     codes::kMissingKey,
    codes::kUnknownModule,    codes::kWrongType,      codes::kWrongCount,
    codes::kNotFinite,        codes::kOutOfRange,     codes::kMissingParameter,
    codes::kUnknownWord,      codes::kNewerFormat,    codes::kWrongModuleKind,
    codes::kUnknownParameter, codes::kFixedParameter, codes::kUnknownMode,
    codes::kBadSign,          codes::kUnknownDrive,   codes::kUndefinedBlock,
    codes::kUnnamedBlock,     codes::kAmbiguousGroup, codes::kUnknownAxis,
    codes::kNoOpenBase,       codes::kReversedRange,  codes::kLetterDirection,
    codes::kLetterCount,      codes::kUnknownEnd,     codes::kUnknownStation,
    codes::kNeedsModule,      codes::kEmptyPattern,   codes::kMixedPattern,
    codes::kUnknownNumber,    codes::kCannotWrite,    codes::kCannotRead,
    codes::kUnknownLetter,    codes::kNameTaken,      codes::kHomeOutside,
    codes::kNoSpindle,        codes::kOwnAxes,        codes::kBlockFound};

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_CODES_HPP_
