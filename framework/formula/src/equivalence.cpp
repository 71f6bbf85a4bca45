// SPDX-License-Identifier: Apache-2.0
#include "kompono/formula/equivalence.hpp"

#include "vocabulary.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <set>
#include <unordered_set>
#include <utility>
#include <vector>

#include "kompono/diagnostics/expects.hpp"

namespace kompono::formula {
namespace {

/// An item's part of a key, and whether it is a pure translation, which commutes with another one
/// beside it.
struct Element {
  std::string text;
  bool translates = false;
};

void SortTranslations(std::vector<Element>& elements) {
  const auto translates = [](const Element& element) { return element.translates; };
  for (auto begin = elements.begin(); begin != elements.end();) {
    const auto end = std::find_if_not(begin, elements.end(), translates);
    std::sort(begin, end, [](const Element& a, const Element& b) { return a.text < b.text; });
    begin = end == elements.end() ? end : end + 1;
  }
}

std::string Join(const std::vector<Element>& elements) {
  std::string text;
  for (const Element& element : elements) {
    if (!text.empty()) text += ' ';
    text += element.text;
  }
  return text;
}

std::string KeyOf(const Chain& chain);

Element ElementOf(const Axis& axis) {
  return {ItemText(axis), !axis.rotary()};
}

Element ElementOf(const Leaf& leaf) {
  return {leaf.Name(), false};
}

Element ElementOf(const Group& group) {
  std::vector<Element> members;
  for (const Axis& axis : group.axes) members.push_back(ElementOf(axis));
  SortTranslations(members);
  Group letterless = group;
  letterless.axes.clear();
  // "()_v:block": what is left of the group's text when its letters are taken out.
  std::string text = ItemText(letterless);
  std::string letters;
  for (const Element& member : members) letters += member.text;
  text.insert(1, letters);
  const bool translates = std::all_of(
      members.begin(), members.end(), [](const Element& member) { return member.translates; });
  return {std::move(text), translates};
}

Element ElementOf(const Fork& fork) {
  std::vector<std::string> branches;
  for (const Chain& branch : fork.branches) branches.push_back(KeyOf(branch));
  std::sort(branches.begin(), branches.end());
  std::string text = fork.count == 1 ? "(" : std::to_string(fork.count) + "(";
  for (std::size_t i = 0; i < branches.size(); ++i) text += (i == 0 ? "" : " + ") + branches[i];
  return {text + ")", false};
}

std::vector<Element> ElementsOf(const Chain& chain) {
  std::vector<Element> elements;
  elements.reserve(chain.size());
  for (const Item& item : chain) {
    elements.push_back(std::visit([](const auto& value) { return ElementOf(value); }, item));
  }
  return elements;
}

std::string KeyOf(const Chain& chain) {
  std::vector<Element> elements = ElementsOf(chain);
  SortTranslations(elements);
  return Join(elements);
}

Chain Motions(std::string_view letters) {
  Chain motions;
  std::set<std::string> names;
  for (std::size_t i = 0; i < letters.size();) {
    const auto letter = static_cast<unsigned char>(letters[i++]);
    KOMPONO_EXPECTS(IsAxisLetter(letter));
    Axis axis{.letter = static_cast<char>(std::toupper(letter)), .working = IsUpper(letter)};
    while (i < letters.size() && IsDigit(static_cast<unsigned char>(letters[i]))) {
      KOMPONO_EXPECTS(axis.number < 100);
      axis.number = axis.number * 10 + (letters[i++] - '0');
    }
    KOMPONO_EXPECTS(names.insert(axis.Name()).second);
    motions.emplace_back(std::move(axis));
  }
  return motions;
}

}  // namespace

std::string StringKey(const Formula& formula) {
  return Canonical(formula);
}

std::string DistributionKey(const Formula& formula) {
  return KeyOf(formula.left) + (formula.open_base ? " O|O " : " O ") + KeyOf(formula.right);
}

std::string RelativeMotionKey(const Formula& formula) {
  Chain chain = formula.left;
  chain.insert(chain.end(), formula.right.begin(), formula.right.end());
  return KeyOf(chain);
}

void ForEachDistribution(std::string_view letters,
                         const std::function<bool(const Formula&)>& visit) {
  const Chain motions = Motions(letters);
  std::vector<std::size_t> order(motions.size());
  std::iota(order.begin(), order.end(), 0U);
  do {
    for (std::size_t left = 0; left <= order.size(); ++left) {
      Formula formula;
      formula.left.emplace_back(Leaf{.kind = LeafKind::kPart});
      for (std::size_t i = 0; i < order.size(); ++i) {
        (i < left ? formula.left : formula.right).push_back(motions[order[i]]);
      }
      formula.right.emplace_back(Leaf{.kind = LeafKind::kTool});
      if (!visit(formula)) return;
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

ClassCounts CountClasses(std::string_view letters) {
  ClassCounts counts;
  std::unordered_set<std::string> distributions;
  std::unordered_set<std::string> relative_motions;
  ForEachDistribution(letters, [&](const Formula& formula) {
    ++counts.strings;
    distributions.insert(DistributionKey(formula));
    relative_motions.insert(RelativeMotionKey(formula));
    return true;
  });
  counts.distributions = static_cast<long>(distributions.size());
  counts.relative_motions = static_cast<long>(relative_motions.size());
  return counts;
}

}  // namespace kompono::formula
