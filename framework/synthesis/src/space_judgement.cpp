// SPDX-License-Identifier: Apache-2.0
// Whether anything is left, and whether layouts of every alternative can be read.
#include "space_builder.hpp"
#include <fmt/format.h>

#include <algorithm>

#include "kompono/layout/layout.hpp"

namespace kompono::synthesis {
namespace {

/// What to do about an empty space: the rule, or the forbidden pair, that alone empties it.
std::string WhyEmpty(const Space& space) {
  const Effects effects = Explain(space, {}, 1);
  if (effects.structural == 0) {
    return "no rule of the study is to blame: sides, ends and modules contradict one another";
  }
  if (!effects.rules.empty() && effects.rules.front().gained > 0) {
    const RuleEffect& effect = effects.rules.front();
    return fmt::format("without the rule '{}' there would be {}",
                       space.rules()[static_cast<std::size_t>(effect.rule)].name,
                       GroupedText(effect.gained));
  }
  return "no single rule is to blame; 'off = true' switches one off for a trial";
}

}  // namespace

void StudySpaceBuilder::JudgeLayouts() {
  const Space& space = made_.space_;
  if (Enumeration(space).count() == 0) {
    Say(Severity::kError, codes::kEmptySpace, {}, "no layout is left", WhyEmpty(space));
    return;
  }
  std::set<std::string> told;
  for (std::size_t f = 0; f < space.features().size(); ++f) {
    const Feature& feature = space.features()[f];
    for (std::size_t a = 0; a < feature.alternatives.size(); ++a) {
      const Choice choice{static_cast<int>(f), static_cast<int>(a)};
      const Enumeration with(space, {choice});
      if (with.count() == 0) continue;
      const Candidate candidate = made_.At(with.Unrank(0));
      const auto layout =
          layout::ParseLayout(LayoutText(made_, candidate), "layout", registry_, nullptr);
      if (layout) continue;
      for (const Diagnostic& said : layout.error()) {
        if (!told.insert(said.code + said.message).second) continue;
        Say(Severity::kError,
            codes::kBadLayout,
            PlaceOf(choice, candidate),
            fmt::format("layouts with {} = {} cannot be read: {} [{}]",
                        feature.name,
                        feature.alternatives[a].name,
                        said.message,
                        said.code),
            said.help);
      }
    }
  }
}

/// Where the study says what the choice is about; for the others where the candidate's end stands.
SourceSpan StudySpaceBuilder::PlaceOf(const Choice& choice, const Candidate& candidate) const {
  for (std::size_t m = 0; m < study().modules.size(); ++m) {
    const StudySpace::ModuleFeatures& features = made_.module_features_[m];
    const bool mine =
        choice.feature == features.mount || choice.feature == features.mode ||
        std::find(features.parameters.begin(), features.parameters.end(), choice.feature) !=
            features.parameters.end();
    if (mine) return study().modules[m].place;
  }
  const int end =
      choice.feature == made_.part_end_feature_ ? candidate.part_end : candidate.tool_end;
  return study().ends[static_cast<std::size_t>(end)].place;
}

}  // namespace kompono::synthesis
