// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_SPACE_BUILDER_HPP_
#define KOMPONO_SYNTHESIS_SPACE_BUILDER_HPP_

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/synthesis/candidate.hpp"
#include "kompono/synthesis/codes.hpp"

namespace kompono::synthesis {

/// Makes the space of a study: items and groupings, features, what excludes what.
class StudySpaceBuilder {
 public:
  StudySpaceBuilder(Study study, const plugin::Registry& registry);
  [[nodiscard]] Parsed<StudySpace> Build(Diagnostics* notes);

 private:
  using Motions = std::vector<int>;

  // space_builder.cpp: items and features
  void MakeItems();
  void MakeGroups(int module);
  void AddGroup(int module, const Motions& motions);
  void JudgeItems();
  void MakeGroupings();
  void Cover(const Motions& left, StudySpace::Grouping& grouping, std::set<int>& modules);
  [[nodiscard]] Alternative AlternativeOf(const StudySpace::Grouping& grouping) const;
  void AddGroupingFeature();
  void AddEnds();
  void AddBase();
  void AddPlaces();
  void AddModuleFeatures();
  void AddModuleFeature(int module, Feature feature, int& number);

  // space_rules.cpp: what excludes what
  void ForbidStructure();
  void ForbidPlacesByGrouping(int rule);
  void ForbidTwice(int rule);
  void ForbidMerged(int rule);
  void ForbidEnds(int rule);
  void ForbidModules(int rule);
  void ForbidMounts(int module, int feature, int rule);
  void ForbidByStudy();
  void ForbidByRule(const StudyRule& rule, int number);
  /// Alternatives that meet the term; complains of tags that no alternative has.
  [[nodiscard]] std::optional<std::vector<Choice>> Meeting(const Term& term, const StudyRule& rule);
  [[nodiscard]] bool MaySwap(const Choice& a, const Choice& b) const;
  void JudgeBlur(const StudyRule& rule, bool merges);
  void JudgeLayouts();
  [[nodiscard]] SourceSpan PlaceOf(const Choice& choice, const Candidate& candidate) const;
  void JudgeReference();

  void Say(Severity severity,
           const CodeTitle& code,
           const SourceSpan& place,
           std::string message,
           std::string help = {});
  [[nodiscard]] const Study& study() const { return made_.study_; }
  [[nodiscard]] bool Realises(const Item& item, int mount) const;
  [[nodiscard]] std::vector<formula::Axis> AxesOf(const Motions& motions) const;
  /// Whether the alternative of `grouping` uses the module.
  [[nodiscard]] bool Uses(const StudySpace::Grouping& grouping, int module) const;
  [[nodiscard]] Sides SidesOf(const Item& item) const;

  StudySpace made_;
  const plugin::Registry& registry_;
  Diagnostics said_;
};

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_SPACE_BUILDER_HPP_
