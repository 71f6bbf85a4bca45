// SPDX-License-Identifier: Apache-2.0
// [calibration]: patterns against the numbers of the layout.
#include "reader.hpp"
#include "shape.hpp"
#include <fmt/format.h>

#include <algorithm>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/layout/numbers.hpp"

namespace kompono::layout {

void LayoutReader::ReadCalibration() {
  const toml::table* table = TableAt(root_, "calibration");
  if (table == nullptr || !formula_good_ || !names_known_) return;
  numbers_ = NumbersOf(layout_, registry_);
  ReadPatterns(*table, "free", layout_.calibration.free);
  ReadPatterns(*table, "lock", layout_.calibration.lock);
  if (const toml::table* priors = TableAt(*table, "prior")) {
    for (const auto& [pattern, node] : *priors) {
      const auto factor = FactorOfPattern(pattern.str(), complaints_.Span(pattern.source()));
      const auto sigma = NumberOf(&node);
      if (factor && sigma)
        layout_.calibration.prior_sigma[std::string(pattern.str())] = *sigma * *factor;
    }
  }
  if (const toml::table* bounds = TableAt(*table, "bounds")) {
    for (const auto& [pattern, node] : *bounds) {
      const auto factor = FactorOfPattern(pattern.str(), complaints_.Span(pattern.source()));
      const auto interval = IntervalOf(&node);
      if (!factor || !interval) continue;
      layout_.calibration.bounds[std::string(pattern.str())] = {(*interval)[0] * *factor,
                                                                (*interval)[1] * *factor};
    }
  }
}

void LayoutReader::ReadPatterns(const toml::table& table,
                                std::string_view key,
                                std::vector<std::string>& patterns) {
  const toml::node* node = table.get(key);
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr) return;
  for (const toml::node& element : *list) {
    const auto pattern = element.value_exact<std::string>();
    if (!pattern) continue;
    if (!NumbersOfPattern(*pattern, complaints_.Span(element)).empty())
      patterns.push_back(*pattern);
  }
}

std::vector<const Number*> LayoutReader::NumbersOfPattern(std::string_view pattern,
                                                          const SourceSpan& place) {
  std::vector<const Number*> matching;
  std::vector<std::string> names;
  for (const Number& number : numbers_) {
    names.push_back(number.name);
    const auto matches = [pattern](const std::string& name) {
      return MatchesPattern(pattern, name);
    };
    if (matches(number.name) ||
        std::any_of(number.other_names.begin(), number.other_names.end(), matches))
      matching.push_back(&number);
  }
  if (matching.empty()) {
    complaints_.Error(codes::kEmptyPattern,
                      place,
                      fmt::format("'{}' names no number of this layout", pattern),
                      DidYouMean(pattern, names));
  }
  return matching;
}

std::optional<double> LayoutReader::FactorOfPattern(std::string_view pattern,
                                                    const SourceSpan& place) {
  const std::vector<const Number*> matching = NumbersOfPattern(pattern, place);
  if (matching.empty()) return std::nullopt;
  const Number& first = *matching.front();
  const auto other = std::find_if(matching.begin(), matching.end(), [&first](const Number* n) {
    return n->angle != first.angle || n->pure != first.pure;
  });
  if (other == matching.end()) return first.pure ? 1.0 : units_.Of(first.angle);
  complaints_.Error(
      codes::kMixedPattern,
      place,
      fmt::format(
          "'{}' names lengths and angles, such as {} and {}", pattern, first.name, (*other)->name),
      "write one pattern for each kind");
  return std::nullopt;
}

}  // namespace kompono::layout
