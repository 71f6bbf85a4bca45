// SPDX-License-Identifier: Apache-2.0
#include "kompono/diagnostics/suggestion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace kompono {
namespace {

/// Twice the Damerau-Levenshtein distance (restricted: a swapped pair is not edited again); a
/// change of case costs 1.
int DoubledDistance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> table((a.size() + 1) * width);
  const auto at = [&table, width](std::size_t i, std::size_t j) -> int& {
    return table[i * width + j];
  };
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = static_cast<int>(2 * i);
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = static_cast<int>(2 * j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : lower(a[i - 1]) == lower(b[j - 1]) ? 1 : 2;
      int best = std::min({at(i - 1, j) + 2, at(i, j - 1) + 2, at(i - 1, j - 1) + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        best = std::min(best, at(i - 2, j - 2) + 2);
      at(i, j) = best;
    }
  }
  return at(a.size(), b.size());
}

}  // namespace

std::string Nearest(std::string_view word, std::span<const std::string> candidates) {
  const int allowed = 2 * std::max<int>(1, static_cast<int>(word.size()) / 3);
  int best = allowed + 1;
  std::string nearest;
  for (const std::string& candidate : candidates) {
    const int distance = DoubledDistance(word, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string DidYouMean(std::string_view word,
                       std::span<const std::string> candidates,
                       std::size_t most) {
  if (const std::string nearest = Nearest(word, candidates); !nearest.empty()) {
    return fmt::format("did you mean '{}'?", nearest);
  }
  if (candidates.empty()) return "";
  const auto shown = candidates.first(std::min(most, candidates.size()));
  return fmt::format(
      "known are: {}{}", fmt::join(shown, ", "), candidates.size() > most ? ", …" : "");
}

}  // namespace kompono
