// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/candidate.hpp"

#include "space_builder.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kompono/diagnostics/expects.hpp"
#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::synthesis {
namespace {

template <class List>
std::vector<std::string> NamesOf(const List& list) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& one : list) names.push_back(one.name);
  return names;
}

Diagnostic UnknownChoice(std::string message, std::string help) {
  return {.code = std::string(codes::kUnknownChoice.code),
          .file = "",
          .span = {},
          .message = std::move(message),
          .help = std::move(help)};
}

/// The value sizing gave to this parameter, else its level, else where sizing starts.
double ValueOf(const StudyParameter& parameter,
               int level,
               std::size_t number,
               int module,
               int index,
               std::span<const Size> sizes) {
  if (!parameter.range) return parameter.levels[static_cast<std::size_t>(level)].numbers[number];
  for (const Size& size : sizes) {
    if (size.module == module && size.parameter == index) return size.value;
  }
  return parameter.start;
}

/// Takes `end` off the chain's far side (its begin for the part); false if it does not stand there.
bool StripEnd(const formula::Chain& end, bool part, formula::Chain& chain) {
  if (chain.size() < end.size()) return false;
  const auto begin = part ? chain.begin() : chain.end() - static_cast<long>(end.size());
  if (!std::equal(end.begin(), end.end(), begin)) return false;
  chain.erase(begin, begin + static_cast<long>(end.size()));
  return true;
}

}  // namespace

Parsed<StudySpace> StudySpace::Build(Study study,
                                     const plugin::Registry& registry,
                                     Diagnostics* notes) {
  return StudySpaceBuilder(std::move(study), registry).Build(notes);
}

Candidate StudySpace::At(const Selection& selection, std::uint64_t index) const {
  KOMPONO_EXPECTS(selection.size() == space_.features().size());
  const auto chosen = [&selection](int feature) {
    return static_cast<std::size_t>(selection[static_cast<std::size_t>(feature)]);
  };
  Candidate candidate{.index = index};
  const Grouping& grouping = groupings_[chosen(grouping_feature_)];
  candidate.part_end = part_ends_[chosen(part_end_feature_)];
  candidate.tool_end = tool_ends_[chosen(tool_end_feature_)];
  candidate.open_base = study_.open_bases[chosen(base_feature_)];
  candidate.chain.reserve(grouping.items.size());
  for (int place = 0; place < place_count_; ++place) {
    const PlaceMeaning& meaning = places_[chosen(first_place_ + place)];
    if (meaning.kind == PlaceMeaning::Kind::kItem) {
      candidate.chain.push_back({meaning.item, meaning.part_side});
    }
  }
  const auto of_module = [&](int feature) {
    return feature < 0 ? 0 : static_cast<int>(chosen(feature)) - 1;
  };
  for (const int item : grouping.items) {
    const int module = items_[static_cast<std::size_t>(item)].module;
    if (module < 0) continue;
    const ModuleFeatures& features = module_features_[static_cast<std::size_t>(module)];
    Candidate::Block block{.module = module,
                           .item = item,
                           .mount = of_module(features.mount),
                           .mode = of_module(features.mode)};
    const auto& parameters = study_.modules[static_cast<std::size_t>(module)].parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      block.levels.push_back(parameters[i].range ? -1 : of_module(features.parameters[i]));
    }
    candidate.blocks.push_back(std::move(block));
  }
  std::sort(candidate.blocks.begin(), candidate.blocks.end(), [](const auto& a, const auto& b) {
    return a.module < b.module;
  });
  return candidate;
}

formula::Formula StudySpace::FormulaOf(const Candidate& candidate) const {
  formula::Formula formula;
  formula.open_base = candidate.open_base;
  formula.left = study_.ends[static_cast<std::size_t>(candidate.part_end)].chain;
  for (const Candidate::Placed& placed : candidate.chain) {
    const Item& item = items_[static_cast<std::size_t>(placed.item)];
    formula::Chain& side = placed.part_side ? formula.left : formula.right;
    if (item.module < 0) {
      side.emplace_back(study_.motions[static_cast<std::size_t>(item.motions[0])].axis);
      continue;
    }
    formula::Group group{.block = study_.modules[static_cast<std::size_t>(item.module)].name};
    for (const int motion : item.motions) {
      group.axes.push_back(study_.motions[static_cast<std::size_t>(motion)].axis);
    }
    side.emplace_back(std::move(group));
  }
  const formula::Chain& end = study_.ends[static_cast<std::size_t>(candidate.tool_end)].chain;
  formula.right.insert(formula.right.end(), end.begin(), end.end());
  return formula;
}

std::optional<Fixing> StudySpace::FixFormula(const formula::Formula& formula) const {
  for (std::size_t p = 0; p < part_ends_.size(); ++p) {
    for (std::size_t t = 0; t < tool_ends_.size(); ++t) {
      formula::Chain left = formula.left;
      formula::Chain right = formula.right;
      const EndChoice& part = study_.ends[static_cast<std::size_t>(part_ends_[p])];
      const EndChoice& tool = study_.ends[static_cast<std::size_t>(tool_ends_[t])];
      if (!StripEnd(part.chain, true, left) || !StripEnd(tool.chain, false, right)) continue;
      auto fixing = FixChains(left, right);
      if (!fixing) continue;
      const auto base =
          std::find(study_.open_bases.begin(), study_.open_bases.end(), formula.open_base);
      if (base == study_.open_bases.end()) return std::nullopt;
      fixing->push_back({base_feature_, static_cast<int>(base - study_.open_bases.begin())});
      fixing->push_back({part_end_feature_, static_cast<int>(p)});
      fixing->push_back({tool_end_feature_, static_cast<int>(t)});
      return fixing;
    }
  }
  return std::nullopt;
}

std::optional<Fixing> StudySpace::FixChains(const formula::Chain& left,
                                            const formula::Chain& right) const {
  std::vector<Candidate::Placed> placed;
  for (const formula::Chain* chain : {&left, &right}) {
    for (const formula::Item& one : *chain) {
      const std::string text = formula::ItemText(one);
      const auto found = std::find_if(
          items_.begin(), items_.end(), [&text](const Item& item) { return item.text == text; });
      if (found == items_.end()) return std::nullopt;
      placed.push_back({static_cast<int>(found - items_.begin()),
                        chain == &left && study_.equivalence != Equivalence::kRelativeMotion});
    }
  }
  SortTranslations(placed);
  Fixing fixing;
  const auto on_part =
      std::count_if(placed.begin(), placed.end(), [](const auto& item) { return item.part_side; });
  for (int place = 0; place < place_count_; ++place) {
    PlaceMeaning wanted{.kind = PlaceMeaning::Kind::kEmpty};
    if (place == on_part) wanted.kind = PlaceMeaning::Kind::kBase;
    const auto i = static_cast<std::size_t>(place > on_part ? place - 1 : place);
    if (place != on_part && i < placed.size()) {
      wanted = {PlaceMeaning::Kind::kItem, placed[i].item, placed[i].part_side};
    }
    const auto found = std::find(places_.begin(), places_.end(), wanted);
    if (found == places_.end()) return std::nullopt;
    fixing.push_back({first_place_ + place, static_cast<int>(found - places_.begin())});
  }
  std::vector<int> items;
  items.reserve(placed.size());
  for (const auto& item : placed) items.push_back(item.item);
  std::sort(items.begin(), items.end());
  bool known = false;
  for (std::size_t g = 0; g < groupings_.size(); ++g) {
    std::vector<int> theirs = groupings_[g].items;
    std::sort(theirs.begin(), theirs.end());
    if (theirs != items) continue;
    known = true;
    fixing.push_back({grouping_feature_, static_cast<int>(g)});
  }
  return known ? std::optional(std::move(fixing)) : std::nullopt;
}

/// As the equivalence orders them.
void StudySpace::SortTranslations(std::vector<Candidate::Placed>& placed) const {
  if (study_.equivalence == Equivalence::kString) return;
  const auto translates = [this](const Candidate::Placed& one) {
    return items_[static_cast<std::size_t>(one.item)].translates;
  };
  for (auto begin = placed.begin(); begin != placed.end();) {
    auto end = begin;
    while (end != placed.end() && translates(*end) && end->part_side == begin->part_side) ++end;
    std::sort(begin, end, [this](const auto& a, const auto& b) {
      return items_[static_cast<std::size_t>(a.item)].text <
             items_[static_cast<std::size_t>(b.item)].text;
    });
    begin = end == begin ? begin + 1 : end;
  }
}

tl::expected<Choice, Diagnostic> StudySpace::ParseChoice(std::string_view text) const {
  const std::size_t sign = text.find('=');
  if (sign == std::string_view::npos) {
    return tl::unexpected(UnknownChoice(fmt::format("'{}' is not feature=alternative", text),
                                        "such as base=open or p1=X.part"));
  }
  const std::string_view feature = text.substr(0, sign);
  const std::string_view alternative = text.substr(sign + 1);
  const int f = space_.Find(feature);
  if (f < 0) {
    return tl::unexpected(UnknownChoice(fmt::format("the space has no feature '{}'", feature),
                                        DidYouMean(feature, NamesOf(space_.features()), 40)));
  }
  const Feature& known = space_.features()[static_cast<std::size_t>(f)];
  const int a = known.Find(alternative);
  if (a < 0) {
    return tl::unexpected(
        UnknownChoice(fmt::format("'{}' has no alternative '{}'", feature, alternative),
                      DidYouMean(alternative, NamesOf(known.alternatives), 24)));
  }
  return Choice{f, a};
}

std::vector<double> ParametersOf(const StudySpace& space,
                                 const Candidate::Block& block,
                                 std::span<const Size> sizes) {
  const StudyModule& module = space.study().modules[static_cast<std::size_t>(block.module)];
  std::vector<double> numbers = module.defaults;
  for (std::size_t i = 0; i < module.parameters.size(); ++i) {
    const StudyParameter& parameter = module.parameters[i];
    if (parameter.coordinate >= 0) continue;
    for (int k = 0; k < parameter.count; ++k) {
      numbers[static_cast<std::size_t>(parameter.offset) + static_cast<std::size_t>(k)] =
          ValueOf(parameter,
                  block.levels[i],
                  static_cast<std::size_t>(k),
                  block.module,
                  static_cast<int>(i),
                  sizes);
    }
  }
  return numbers;
}

std::vector<double> HomeOf(const StudySpace& space,
                           const Candidate::Block& block,
                           std::span<const Size> sizes) {
  const StudyModule& module = space.study().modules[static_cast<std::size_t>(block.module)];
  std::vector<double> home = module.home;
  for (std::size_t i = 0; i < module.parameters.size(); ++i) {
    const StudyParameter& parameter = module.parameters[i];
    if (parameter.coordinate < 0) continue;
    home[static_cast<std::size_t>(parameter.coordinate)] =
        ValueOf(parameter, block.levels[i], 0, block.module, static_cast<int>(i), sizes);
  }
  return home;
}

}  // namespace kompono::synthesis
