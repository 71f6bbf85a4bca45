// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_SRC_VOCABULARY_HPP_
#define KOMPONO_FORMULA_SRC_VOCABULARY_HPP_

#include <string>
#include <string_view>

#include "kompono/formula/formula.hpp"

/// Letters and words of the notation, in the text and in explanations.
namespace kompono::formula {

[[nodiscard]] bool IsDigit(char32_t code);
[[nodiscard]] bool IsLower(char32_t code);  ///< a to z
[[nodiscard]] bool IsUpper(char32_t code);  ///< A to Z
[[nodiscard]] bool IsLetter(char32_t code);
/// A sign that can follow a name or an index: ( ) + | _ :
[[nodiscard]] bool IsStructural(char32_t code);
/// A letter of ISO 841, capital or not: X Y Z U V W P Q R A B C D E.
[[nodiscard]] bool IsAxisLetter(char32_t code);
/// x, y or z.
[[nodiscard]] bool IsDirection(char32_t code);
/// kNone when the letter is not h, v or i.
[[nodiscard]] Orientation OrientationOf(char32_t code);
[[nodiscard]] char LetterOf(Orientation orientation);

/// "translation along X", "secondary translation parallel to X", "rotation about Z".
[[nodiscard]] std::string_view MotionOf(char letter);

/// Help for a word that is not part of the notation, or an empty string if it resembles nothing.
[[nodiscard]] std::string HelpForWord(std::string_view word);
/// Help for letters that name no motion.
[[nodiscard]] std::string HelpForLetters(std::string_view letters);

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_SRC_VOCABULARY_HPP_
