// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_SRC_GLYPHS_HPP_
#define KOMPONO_FORMULA_SRC_GLYPHS_HPP_

#include "report.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

/// The first stage of reading: bytes become glyphs, each with its place in the text. What belongs
/// to the way of writing and not to the formula (LaTeX, Cyrillic look-alikes, ISO 230-1) ends here,
/// so that the reader knows one notation.
namespace kompono::formula {

struct CodePoint {
  char32_t code = 0;
  std::size_t size = 1;  ///< bytes
  bool valid = false;    ///< false: this byte is no UTF-8
};

/// The code point that begins at text[at]; a byte that is no UTF-8 counts as one invalid code
/// point.
[[nodiscard]] CodePoint DecodeAt(std::string_view text, std::size_t at);

/// What separates a glyph from the one before it. A LaTeX brace ends an index (`Z_{xy}z`) without
/// being a space.
enum class Gap { kNone, kBrace, kSpace };

struct Glyph {
  char32_t code = 0;  ///< never 0; kNoCharacter for a byte that is no UTF-8
  Range where;
  Gap gap = Gap::kNone;
};

inline constexpr char32_t kNoCharacter = 0xFFFD;

/// LaTeX and Cyrillic letters taken off, with notes N0101 and N0102; spaces become gaps.
[[nodiscard]] std::vector<Glyph> ReadGlyphs(std::string_view text, Report& report);

/// If the glyphs are a structural code of ISO 230-1 in square brackets, the same formula in ours:
/// `w` becomes part, `b` O, `t` tool, primes go, a code written from the tool is turned round, and
/// the spindle `(C)` becomes the plain axis C (ISO 230-1 does not tell how it lies). Notes N0106
/// and N0107, errors E0110 and E0136.
void ReadIso(std::vector<Glyph>& glyphs, Report& report);

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_SRC_GLYPHS_HPP_
