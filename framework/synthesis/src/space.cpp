// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kompono/diagnostics/expects.hpp"

namespace kompono::synthesis {
namespace {

template <class List>
int IndexOf(const List& list, std::string_view name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [name](const auto& one) { return one.name == name; });
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

}  // namespace

Count SumOf(Count a, Count b) {
  return a > kTooMany - b ? kTooMany : a + b;
}

Count ProductOf(Count a, Count b) {
  if (a == 0 || b == 0) return 0;
  return a > kTooMany / b ? kTooMany : a * b;
}

std::string CountText(Count count) {
  if (count == kTooMany) return "2^128 or more";
  std::string digits;
  do {
    digits += static_cast<char>('0' + static_cast<int>(count % 10));
    count /= 10;
  } while (count != 0);
  std::reverse(digits.begin(), digits.end());
  return digits;
}

std::string GroupedText(Count count) {
  std::string digits = CountText(count);
  if (count == kTooMany) return digits;
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::optional<Count> ParseCount(std::string_view digits) {
  if (digits.empty()) return std::nullopt;
  Count count = 0;
  for (const char digit : digits) {
    if (digit < '0' || digit > '9') return std::nullopt;
    count = SumOf(ProductOf(count, 10), static_cast<Count>(digit - '0'));
    if (count == kTooMany) return std::nullopt;
  }
  return count;
}

std::string_view NameOf(RuleKind kind) {
  switch (kind) {
    case RuleKind::kLogical:
      return "logical";
    case RuleKind::kEmpirical:
      return "empirical";
    case RuleKind::kNormative:
      break;
  }
  return "normative";
}

bool Alternative::Has(std::string_view tag) const {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

int Feature::Find(std::string_view alternative) const {
  return IndexOf(alternatives, alternative);
}

int Space::Find(std::string_view feature) const {
  return IndexOf(features_, feature);
}

int Space::Add(Feature feature) {
  KOMPONO_EXPECTS(!feature.alternatives.empty() && feature.alternatives.size() <= 65535);
  features_.push_back(std::move(feature));
  return static_cast<int>(features_.size()) - 1;
}

int Space::Add(RuleTitle rule) {
  rules_.push_back(std::move(rule));
  off_.push_back(false);
  return static_cast<int>(rules_.size()) - 1;
}

void Space::Forbid(Choice a, Choice b, int rule) {
  KOMPONO_EXPECTS(a.feature != b.feature);
  if (b < a) std::swap(a, b);
  conflicts_.push_back({a, b, rule});
}

void Space::Forbid(Choice a, int rule) {
  conflicts_.push_back({a, a, rule});
}

void Space::SwitchOff(int rule, bool off) {
  const auto i = static_cast<std::size_t>(rule);
  KOMPONO_EXPECTS(i < rules_.size() && !rules_[i].structural);
  off_[i] = off;
}

Count Space::Raw() const {
  Count raw = features_.empty() ? 0 : 1;
  for (const Feature& feature : features_) raw = ProductOf(raw, feature.alternatives.size());
  return raw;
}

double Space::RawLog10() const {
  double log = 0.0;
  for (const Feature& feature : features_) {
    log += std::log10(static_cast<double>(feature.alternatives.size()));
  }
  return log;
}

}  // namespace kompono::synthesis
