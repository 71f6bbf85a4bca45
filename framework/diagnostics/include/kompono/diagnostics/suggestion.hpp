// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_DIAGNOSTICS_SUGGESTION_HPP_
#define KOMPONO_DIAGNOSTICS_SUGGESTION_HPP_

#include <span>
#include <string>
#include <string_view>

namespace kompono {

/// The candidate nearest to `word` by Damerau-Levenshtein distance (letter case counts half), or an
/// empty string when none is within a third of the word's length (at least one edit).
[[nodiscard]] std::string Nearest(std::string_view word, std::span<const std::string> candidates);

/// "did you mean 'pyramid'?" if something is near, else "known are: a, b, c" (at most `most`
/// names), else "".
[[nodiscard]] std::string DidYouMean(std::string_view word,
                                     std::span<const std::string> candidates,
                                     std::size_t most = 12);

}  // namespace kompono

#endif  // KOMPONO_DIAGNOSTICS_SUGGESTION_HPP_
