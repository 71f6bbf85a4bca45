// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_CODES_HPP_
#define KOMPONO_SYNTHESIS_CODES_HPP_

#include <array>
#include <string_view>

/// What can be said about a study and its space: E0801 to E0839, W08xx. A code keeps its meaning
/// between versions; a new complaint gets a new code. docs/study-file.md explains them.
namespace kompono::synthesis {

struct CodeTitle {
  std::string_view code;
  std::string_view title;
};

namespace codes {
inline constexpr CodeTitle kNotToml{"E0801", "study: not TOML"};
inline constexpr CodeTitle kUnknownKey{"E0802", "study: unknown key"};
inline constexpr CodeTitle kMissingKey{"E0803", "study: missing key"};
inline constexpr CodeTitle kWrongType{"E0804", "study: wrong type"};
inline constexpr CodeTitle kWrongCount{"E0805", "study: wrong count"};
inline constexpr CodeTitle kNotFinite{"E0806", "study: number that is not finite"};
inline constexpr CodeTitle kOutOfRange{"E0807", "study: number out of range"};
inline constexpr CodeTitle kUnknownWord{"E0808", "study: word that is no choice here"};
inline constexpr CodeTitle kNewerFormat{"E0809", "study: format of another version"};
inline constexpr CodeTitle kReversedRange{"E0810", "study: lower limit above the upper one"};
inline constexpr CodeTitle kBadMotion{"E0811", "study: not the name of a motion"};
inline constexpr CodeTitle kUnknownModule{"E0812", "study: unknown module"};
inline constexpr CodeTitle kNoMechanism{"E0813", "study: unit in place of a mechanism"};
inline constexpr CodeTitle kUnknownParameter{"E0814", "study: unknown or fixed parameter"};
inline constexpr CodeTitle kMissingParameter{"E0815", "study: missing parameter"};
inline constexpr CodeTitle kUnknownMode{"E0816", "study: unknown assembly mode"};
inline constexpr CodeTitle kUnknownDrive{"E0817", "study: unknown drive"};
inline constexpr CodeTitle kBadHome{"E0818", "study: not a translation of the module"};
inline constexpr CodeTitle kNothingRealised{"E0819", "study: module that realises no motions"};
inline constexpr CodeTitle kUnknownLetters{"E0820", "study: motions that are not required"};
inline constexpr CodeTitle kBadChain{"E0821", "study: end that is no end"};
inline constexpr CodeTitle kUnknownTag{"E0822", "study: unknown tag"};
inline constexpr CodeTitle kBadRule{"E0823", "study: rule that forbids nothing or everything"};
inline constexpr CodeTitle kUnknownMetric{"E0824", "study: unknown metric"};
inline constexpr CodeTitle kNameTaken{"E0825", "study: name used twice"};
inline constexpr CodeTitle kMotionWithoutItem{"E0826", "study: motion that nothing realises"};
inline constexpr CodeTitle kEmptySpace{"E0827", "study: no layout is left"};
inline constexpr CodeTitle kBadLayout{"E0828", "study: alternative whose layouts cannot be read"};
inline constexpr CodeTitle kUnknownChoice{"E0829", "space: unknown feature or alternative"};
inline constexpr CodeTitle kCannotRead{"E0830", "study: file that cannot be read"};
inline constexpr CodeTitle kBadReference{"E0831", "study: reference that is not in the space"};
inline constexpr CodeTitle kTooManyGroupings{"E0832", "study: too many groupings"};

inline constexpr CodeTitle kIdleRule{"W0801", "study: rule that nothing meets"};
inline constexpr CodeTitle kBlurredRule{"W0802", "study: rule that the equivalence blurs"};
}  // namespace codes

/// All of them, errors first, in ascending order.
inline constexpr std::array kCodes{
    codes::kNotToml,         codes::kUnknownKey,        codes::kMissingKey,
    codes::kWrongType,       codes::kWrongCount,        codes::kNotFinite,
    codes::kOutOfRange,      codes::kUnknownWord,       codes::kNewerFormat,
    codes::kReversedRange,   codes::kBadMotion,         codes::kUnknownModule,
    codes::kNoMechanism,     codes::kUnknownParameter,  codes::kMissingParameter,
    codes::kUnknownMode,     codes::kUnknownDrive,      codes::kBadHome,
    codes::kNothingRealised, codes::kUnknownLetters,    codes::kBadChain,
    codes::kUnknownTag,      codes::kBadRule,           codes::kUnknownMetric,
    codes::kNameTaken,       codes::kMotionWithoutItem, codes::kEmptySpace,
    codes::kBadLayout,       codes::kUnknownChoice,     codes::kCannotRead,
    codes::kBadReference,    codes::kTooManyGroupings,  codes::kIdleRule,
    codes::kBlurredRule};

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_CODES_HPP_
