// SPDX-License-Identifier: Apache-2.0
// What excludes what: the meaning of the features, the equivalence, the study's own rules.
#include "space_builder.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::synthesis {
namespace {

/// Whether the chain has an axis of its own, outside groups, with this name.
bool HasPlainAxis(const formula::Chain& chain, std::string_view name) {
  return std::any_of(chain.begin(), chain.end(), [name](const formula::Item& item) {
    if (const auto* axis = std::get_if<formula::Axis>(&item)) return axis->Name() == name;
    const auto* fork = std::get_if<formula::Fork>(&item);
    return fork != nullptr &&
           std::any_of(fork->branches.begin(), fork->branches.end(), [name](const auto& branch) {
             return HasPlainAxis(branch, name);
           });
  });
}

bool Meets(const Alternative& alternative, const std::string& tag) {
  return tag.starts_with('!') ? !alternative.Has(std::string_view(tag).substr(1))
                              : alternative.Has(tag);
}

}  // namespace

void StudySpaceBuilder::ForbidStructure() {
  const auto structural = [this](std::string name, std::string reason) {
    return made_.space_.Add(RuleTitle{.name = std::move(name),
                                      .kind = RuleKind::kLogical,
                                      .reason = std::move(reason),
                                      .author = "kompono",
                                      .structural = true});
  };
  const int order =
      structural("places", "every item of the grouping has one place, O between the sides");
  ForbidPlacesByGrouping(order);
  ForbidTwice(order);
  ForbidMerged(structural("equivalence", "one member of each class of equal layouts"));
  ForbidEnds(structural("ends", "ends realise the motions that the grouping leaves to them"));
  ForbidModules(structural("modules", "only what is used has a mount, a mode and sizes"));
}

/// Place k is filled exactly if the grouping has k items or more before it, with its own items.
void StudySpaceBuilder::ForbidPlacesByGrouping(int rule) {
  using Meaning = StudySpace::PlaceMeaning::Kind;
  for (std::size_t g = 0; g < made_.groupings_.size(); ++g) {
    const std::vector<int>& items = made_.groupings_[g].items;
    const Choice grouping{made_.grouping_feature_, static_cast<int>(g)};
    for (int place = 0; place < made_.place_count_; ++place) {
      const bool filled = static_cast<std::size_t>(place) <= items.size();
      for (std::size_t a = 0; a < made_.places_.size(); ++a) {
        const auto& meaning = made_.places_[a];
        const bool allowed =
            meaning.kind == Meaning::kEmpty ? !filled
            : meaning.kind == Meaning::kBase
                ? filled
                : filled && std::find(items.begin(), items.end(), meaning.item) != items.end();
        if (allowed) continue;
        made_.space_.Forbid(grouping, {made_.first_place_ + place, static_cast<int>(a)}, rule);
      }
    }
  }
}

/// No item and no O twice; nothing of the tool's side before O, nothing of the part's behind it.
void StudySpaceBuilder::ForbidTwice(int rule) {
  using Meaning = StudySpace::PlaceMeaning::Kind;
  for (int i = 0; i < made_.place_count_; ++i) {
    for (int j = i + 1; j < made_.place_count_; ++j) {
      for (std::size_t a = 0; a < made_.places_.size(); ++a) {
        for (std::size_t b = 0; b < made_.places_.size(); ++b) {
          const auto& before = made_.places_[a];
          const auto& behind = made_.places_[b];
          const bool both_items = before.kind == Meaning::kItem && behind.kind == Meaning::kItem;
          const bool twice = (both_items && before.item == behind.item) ||
                             (before.kind == Meaning::kBase && behind.kind == Meaning::kBase);
          const bool wrong_side = (before.kind == Meaning::kItem && !before.part_side &&
                                   behind.kind == Meaning::kBase) ||
                                  (before.kind == Meaning::kBase && behind.kind == Meaning::kItem &&
                                   behind.part_side) ||
                                  (both_items && !before.part_side && behind.part_side);
          if (!twice && !wrong_side) continue;
          made_.space_.Forbid({made_.first_place_ + i, static_cast<int>(a)},
                              {made_.first_place_ + j, static_cast<int>(b)},
                              rule);
        }
      }
    }
  }
}

/// Neighbouring translations of one side in the order of their texts; for relative motions all
/// items behind O. Of every class of formula::DistributionKey or RelativeMotionKey this leaves one.
void StudySpaceBuilder::ForbidMerged(int rule) {
  using Meaning = StudySpace::PlaceMeaning::Kind;
  if (study().equivalence == Equivalence::kString) return;
  for (int i = 0; i + 1 < made_.place_count_; ++i) {
    for (std::size_t a = 0; a < made_.places_.size(); ++a) {
      for (std::size_t b = 0; b < made_.places_.size(); ++b) {
        const auto& first = made_.places_[a];
        const auto& second = made_.places_[b];
        if (first.kind != Meaning::kItem || second.kind != Meaning::kItem) continue;
        if (first.part_side != second.part_side || first.item == second.item) continue;
        const Item& one = made_.items_[static_cast<std::size_t>(first.item)];
        const Item& other = made_.items_[static_cast<std::size_t>(second.item)];
        if (!one.translates || !other.translates || one.text <= other.text) continue;
        made_.space_.Forbid({made_.first_place_ + i, static_cast<int>(a)},
                            {made_.first_place_ + i + 1, static_cast<int>(b)},
                            rule);
      }
    }
  }
  if (study().equivalence != Equivalence::kRelativeMotion) return;
  for (std::size_t a = 0; a < made_.places_.size(); ++a) {
    if (made_.places_[a].kind == Meaning::kBase) continue;
    made_.space_.Forbid({made_.first_place_, static_cast<int>(a)}, rule);
  }
}

void StudySpaceBuilder::ForbidEnds(int rule) {
  for (std::size_t g = 0; g < made_.groupings_.size(); ++g) {
    const StudySpace::Grouping& grouping = made_.groupings_[g];
    for (const bool part : {true, false}) {
      const std::vector<int>& ends = part ? made_.part_ends_ : made_.tool_ends_;
      const int feature = part ? made_.part_end_feature_ : made_.tool_end_feature_;
      for (std::size_t e = 0; e < ends.size(); ++e) {
        const EndChoice& end = study().ends[static_cast<std::size_t>(ends[e])];
        // An end may have an axis of its own with the name of a plain axis: "C_h" beside "C".
        const bool named_twice =
            std::any_of(grouping.items.begin(), grouping.items.end(), [&](int i) {
              const Item& item = made_.items_[static_cast<std::size_t>(i)];
              return item.module < 0 && HasPlainAxis(end.chain, item.text);
            });
        if (end.realises == (part ? grouping.part_end : grouping.tool_end) && !named_twice) {
          continue;
        }
        made_.space_.Forbid(
            {made_.grouping_feature_, static_cast<int>(g)}, {feature, static_cast<int>(e)}, rule);
      }
    }
  }
}

void StudySpaceBuilder::ForbidModules(int rule) {
  for (std::size_t m = 0; m < study().modules.size(); ++m) {
    const StudySpace::ModuleFeatures& features = made_.module_features_[m];
    std::vector<int> all{features.mount, features.mode};
    all.insert(all.end(), features.parameters.begin(), features.parameters.end());
    for (const int feature : all) {
      if (feature < 0) continue;
      const std::size_t alternatives =
          made_.space_.features()[static_cast<std::size_t>(feature)].alternatives.size();
      for (std::size_t g = 0; g < made_.groupings_.size(); ++g) {
        const bool used = Uses(made_.groupings_[g], static_cast<int>(m));
        for (std::size_t a = 0; a < alternatives; ++a) {
          if (used == (a > 0)) continue;
          made_.space_.Forbid(
              {made_.grouping_feature_, static_cast<int>(g)}, {feature, static_cast<int>(a)}, rule);
        }
      }
    }
    ForbidMounts(static_cast<int>(m), features.mount, rule);
  }
}

/// Mounts under which the module does not realise its group. A turned mechanism hands its turn on,
/// which a second mechanism on it could not take back: they do not go together.
void StudySpaceBuilder::ForbidMounts(int module, int feature, int rule) {
  const std::vector<MountChoice>& mounts = study().modules[static_cast<std::size_t>(module)].mounts;
  for (std::size_t g = 0; g < made_.groupings_.size(); ++g) {
    const Choice grouping{made_.grouping_feature_, static_cast<int>(g)};
    std::size_t mechanisms = 0;
    for (const int i : made_.groupings_[g].items) {
      mechanisms += made_.items_[static_cast<std::size_t>(i)].module >= 0 ? 1U : 0U;
    }
    for (const int i : made_.groupings_[g].items) {
      const Item& item = made_.items_[static_cast<std::size_t>(i)];
      if (item.module != module) continue;
      for (std::size_t mount = 0; mount < mounts.size(); ++mount) {
        const bool turned = mounts[mount].placement.rotation_rad != std::array<double, 3>{};
        if (Realises(item, static_cast<int>(mount)) && !(turned && mechanisms > 1)) continue;
        if (feature < 0) {
          made_.space_.Forbid(grouping, rule);
        } else {
          made_.space_.Forbid(grouping, {feature, static_cast<int>(mount) + 1}, rule);
        }
      }
    }
  }
}

void StudySpaceBuilder::ForbidByStudy() {
  for (const StudyRule& rule : study().rules) {
    const int number = made_.space_.Add(rule.title);
    ForbidByRule(rule, number);
    if (rule.off) made_.space_.SwitchOff(number);
  }
}

std::optional<std::vector<Choice>> StudySpaceBuilder::Meeting(const Term& term,
                                                              const StudyRule& rule) {
  std::set<std::string> known;
  for (const Feature& feature : made_.space_.features()) {
    for (const Alternative& alternative : feature.alternatives) {
      known.insert(alternative.tags.begin(), alternative.tags.end());
    }
  }
  const std::vector<std::string> names(known.begin(), known.end());
  for (const std::string& tag : term) {
    const std::string name = tag.starts_with('!') ? tag.substr(1) : tag;
    if (known.contains(name)) continue;
    Say(Severity::kError,
        codes::kUnknownTag,
        rule.place,
        fmt::format("no alternative has the tag '{}' of the rule '{}'", name, rule.title.name),
        DidYouMean(name, names, 24));
    return std::nullopt;
  }
  std::vector<Choice> choices;
  for (std::size_t f = 0; f < made_.space_.features().size(); ++f) {
    const Feature& feature = made_.space_.features()[f];
    // A tag's opposite is asked for only where the tag can be met.
    const bool concerned = std::all_of(term.begin(), term.end(), [&](const std::string& tag) {
      const std::string_view name = std::string_view(tag).substr(tag.starts_with('!') ? 1 : 0);
      return std::any_of(feature.alternatives.begin(),
                         feature.alternatives.end(),
                         [name](const Alternative& alternative) { return alternative.Has(name); });
    });
    if (!concerned) continue;
    for (std::size_t a = 0; a < feature.alternatives.size(); ++a) {
      const bool meets = std::all_of(term.begin(), term.end(), [&](const std::string& tag) {
        return Meets(feature.alternatives[a], tag);
      });
      if (meets) choices.push_back({static_cast<int>(f), static_cast<int>(a)});
    }
  }
  return choices;
}

void StudySpaceBuilder::ForbidByRule(const StudyRule& rule, int number) {
  const auto first = Meeting(rule.forbid.front(), rule);
  const auto second = rule.forbid.size() == 1 ? first : Meeting(rule.forbid.back(), rule);
  if (!first || !second) return;
  bool merges = false;
  std::size_t forbidden = 0;
  const auto is_place = [this](const Choice& choice) {
    return choice.feature >= made_.first_place_ &&
           choice.feature < made_.first_place_ + made_.place_count_;
  };
  for (const Choice& a : *first) {
    for (const Choice& b : *second) {
      if (rule.ordered) {
        if (!is_place(a) || !is_place(b) || a.feature >= b.feature) continue;
        made_.space_.Forbid(a, b, number);
        merges = merges || MaySwap(a, b);
      } else if (a == b) {
        made_.space_.Forbid(a, number);
      } else if (rule.forbid.size() == 2 && a.feature != b.feature) {
        made_.space_.Forbid(a, b, number);
      } else {
        continue;
      }
      ++forbidden;
    }
  }
  JudgeBlur(rule, merges);
  if (forbidden > 0) return;
  Say(Severity::kWarning,
      codes::kIdleRule,
      rule.place,
      fmt::format("the rule '{}' forbids nothing", rule.title.name),
      "its terms are never met by alternatives of different features");
}

/// Whether the equivalence takes both orders of these neighbours for the same.
bool StudySpaceBuilder::MaySwap(const Choice& a, const Choice& b) const {
  const auto& first = made_.places_[static_cast<std::size_t>(a.alternative)];
  const auto& second = made_.places_[static_cast<std::size_t>(b.alternative)];
  return first.part_side == second.part_side && first.item != second.item &&
         made_.items_[static_cast<std::size_t>(first.item)].translates &&
         made_.items_[static_cast<std::size_t>(second.item)].translates;
}

/// Rules that ask for more than the equivalence keeps apart.
void StudySpaceBuilder::JudgeBlur(const StudyRule& rule, bool merges) {
  const auto asks = [&rule](std::string_view prefix) {
    return std::any_of(rule.forbid.begin(), rule.forbid.end(), [prefix](const Term& term) {
      return std::any_of(term.begin(), term.end(), [prefix](const std::string& tag) {
        return std::string_view(tag).substr(tag.starts_with('!') ? 1 : 0).starts_with(prefix);
      });
    });
  };
  const bool sides = asks("part:") || asks("tool:") || asks("side:") || asks("base:");
  if (study().equivalence == Equivalence::kRelativeMotion && sides) {
    Say(Severity::kWarning,
        codes::kBlurredRule,
        rule.place,
        fmt::format("the rule '{}' asks for a side, and layouts that differ in sides count as one",
                    rule.title.name),
        "every motion of a layout that stands for its class lies on the tool's side: with "
        "equivalence = \"distribution\" the sides are kept apart");
    return;
  }
  if (study().equivalence == Equivalence::kString || !(merges || asks("place:"))) return;
  Say(Severity::kWarning,
      codes::kBlurredRule,
      rule.place,
      fmt::format("the rule '{}' looks at what layouts that count as one may differ in",
                  rule.title.name),
      "it judges the one member that stands for its class; a finer 'equivalence' keeps them apart");
}

void StudySpaceBuilder::JudgeReference() {
  if (study().reference.empty()) return;
  const auto fail = [this](std::string message, std::string help) {
    Say(Severity::kError, codes::kBadReference, {}, std::move(message), std::move(help));
  };
  const auto formula = formula::ParseFormula(study().reference);
  auto fixing = formula ? made_.FixFormula(*formula) : std::nullopt;
  if (!fixing) {
    return fail(fmt::format("the reference '{}' is no layout of this study", study().reference),
                "its items must be those that motions, modules and ends make; kompono synthesize "
                "STUDY --list 20 shows some");
  }
  for (const auto& [feature, alternative] : study().reference_fix) {
    const auto choice = made_.ParseChoice(fmt::format("{}={}", feature, alternative));
    if (!choice) return fail("in the reference: " + choice.error().message, choice.error().help);
    fixing->push_back(*choice);
  }
  if (Enumeration(made_.space_, *fixing).count() > 0) return;
  fail(fmt::format("the rules leave no layout with the reference '{}'", study().reference),
       "kompono synthesize STUDY --explain tells which rule it is");
}

}  // namespace kompono::synthesis
