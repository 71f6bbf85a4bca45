// SPDX-License-Identifier: Apache-2.0
#include "space_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

#include "kompono/layout/letters.hpp"

namespace kompono::synthesis {
namespace {

constexpr std::size_t kMostGroupings = 4096;
constexpr std::size_t kMostMotions = 12;
constexpr std::string_view kLetterOrder = "XYZABCUVWPQRDE";

bool Disjoint(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::none_of(a.begin(), a.end(), [&b](const std::string& name) {
    return std::find(b.begin(), b.end(), name) != b.end();
  });
}

std::string Joined(const std::vector<std::string>& words, std::string_view separator = "") {
  return fmt::format("{}", fmt::join(words, separator));
}

}  // namespace

StudySpaceBuilder::StudySpaceBuilder(Study study, const plugin::Registry& registry)
    : registry_(registry) {
  made_.study_ = std::move(study);
  made_.registry_ = &registry;
}

Parsed<StudySpace> StudySpaceBuilder::Build(Diagnostics* notes) {
  MakeItems();
  JudgeItems();
  if (!HasErrors(said_)) MakeGroupings();
  if (!HasErrors(said_)) {
    AddEnds();
    AddBase();
    AddPlaces();
    AddModuleFeatures();
    ForbidStructure();
    ForbidByStudy();
  }
  if (!HasErrors(said_)) JudgeLayouts();
  if (!HasErrors(said_)) JudgeReference();
  if (HasErrors(said_)) return tl::unexpected(std::move(said_));
  if (notes != nullptr) notes->insert(notes->end(), said_.begin(), said_.end());
  return std::move(made_);
}

void StudySpaceBuilder::Say(Severity severity,
                            const CodeTitle& code,
                            const SourceSpan& place,
                            std::string message,
                            std::string help) {
  said_.push_back({severity,
                   std::string(code.code),
                   study().file.string(),
                   place,
                   std::move(message),
                   std::move(help)});
}

std::vector<formula::Axis> StudySpaceBuilder::AxesOf(const Motions& motions) const {
  std::vector<formula::Axis> axes;
  for (const int motion : motions) {
    axes.push_back(study().motions[static_cast<std::size_t>(motion)].axis);
  }
  return axes;
}

bool StudySpaceBuilder::Uses(const StudySpace::Grouping& grouping, int module) const {
  return std::any_of(grouping.items.begin(), grouping.items.end(), [&](int item) {
    return made_.items_[static_cast<std::size_t>(item)].module == module;
  });
}

Sides StudySpaceBuilder::SidesOf(const Item& item) const {
  Sides sides;
  if (item.module >= 0) sides = study().modules[static_cast<std::size_t>(item.module)].sides;
  for (const int motion : item.motions) {
    const Sides& theirs = study().motions[static_cast<std::size_t>(motion)].sides;
    sides.part = sides.part && theirs.part;
    sides.tool = sides.tool && theirs.tool;
  }
  return sides;
}

void StudySpaceBuilder::MakeItems() {
  const std::size_t count = study().motions.size();
  if (count > kMostMotions) {
    Say(Severity::kError,
        codes::kTooManyGroupings,
        {},
        fmt::format("{} motions are more than {}", count, kMostMotions));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Motion& motion = study().motions[i];
    if (!motion.plain) continue;
    made_.items_.push_back({.text = formula::ItemText(motion.axis),
                            .motions = {static_cast<int>(i)},
                            .module = -1,
                            .translates = !motion.axis.rotary()});
  }
  for (std::size_t m = 0; m < study().modules.size(); ++m) MakeGroups(static_cast<int>(m));
}

/// Every set of motions that the module realises under one of its mounts.
void StudySpaceBuilder::MakeGroups(int module) {
  const StudyModule& allowed = study().modules[static_cast<std::size_t>(module)];
  const std::size_t size = registry_.Find(allowed.module)->letters.size();
  const std::size_t before = made_.items_.size();
  const auto by_letter = [this](int a, int b) {
    const formula::Axis& first = study().motions[static_cast<std::size_t>(a)].axis;
    const formula::Axis& second = study().motions[static_cast<std::size_t>(b)].axis;
    return std::pair(kLetterOrder.find(first.letter), first.number) <
           std::pair(kLetterOrder.find(second.letter), second.number);
  };
  for (unsigned subset = 0; subset < 1U << study().motions.size(); ++subset) {
    if (static_cast<std::size_t>(std::popcount(subset)) != size) continue;
    Motions motions;
    for (std::size_t i = 0; i < study().motions.size(); ++i) {
      if ((subset >> i & 1U) != 0) motions.push_back(static_cast<int>(i));
    }
    std::sort(motions.begin(), motions.end(), by_letter);
    AddGroup(module, motions);
  }
  if (made_.items_.size() > before) return;
  Say(Severity::kError,
      codes::kNothingRealised,
      allowed.place,
      fmt::format("'{}' realises none of the required motions", allowed.name),
      fmt::format("its letters are {}; 'letters' and 'mounts' must fit the motions",
                  registry_.Find(allowed.module)->letters));
}

void StudySpaceBuilder::AddGroup(int module, const Motions& motions) {
  const StudyModule& allowed = study().modules[static_cast<std::size_t>(module)];
  std::vector<std::string> names;
  Item item{.text = "", .motions = motions, .module = module};
  formula::Group group{.axes = AxesOf(motions), .block = allowed.name};
  for (const formula::Axis& axis : group.axes) {
    names.push_back(axis.Name());
    item.translates = item.translates && !axis.rotary();
  }
  std::sort(names.begin(), names.end());
  const auto same = [&names](const std::string& letters) {
    std::vector<std::string> asked;
    for (std::size_t i = 0; i < letters.size();) {
      std::size_t end = i + 1;
      while (end < letters.size() && letters[end] >= '0' && letters[end] <= '9') ++end;
      asked.push_back(letters.substr(i, end - i));
      i = end;
    }
    std::sort(asked.begin(), asked.end());
    return asked == names;
  };
  if (!allowed.letters.empty() &&
      std::none_of(allowed.letters.begin(), allowed.letters.end(), same)) {
    return;
  }
  item.text = formula::ItemText(group);
  for (std::size_t mount = 0; mount < allowed.mounts.size(); ++mount) {
    if (!Realises(item, static_cast<int>(mount))) continue;
    made_.items_.push_back(std::move(item));
    return;
  }
}

bool StudySpaceBuilder::Realises(const Item& item, int mount) const {
  const StudyModule& module = study().modules[static_cast<std::size_t>(item.module)];
  return layout::FitLetters(registry_.Find(module.module)->letters,
                            module.mounts[static_cast<std::size_t>(mount)].placement,
                            AxesOf(item.motions))
      .ok();
}

void StudySpaceBuilder::JudgeItems() {
  for (std::size_t i = 0; i < study().motions.size(); ++i) {
    const Motion& motion = study().motions[i];
    const auto has = [i](const Item& item) {
      return std::find(item.motions.begin(), item.motions.end(), static_cast<int>(i)) !=
             item.motions.end();
    };
    const auto realises = [&motion](const EndChoice& end) {
      return std::find(end.realises.begin(), end.realises.end(), motion.name) != end.realises.end();
    };
    if (std::any_of(made_.items_.begin(), made_.items_.end(), has) ||
        std::any_of(study().ends.begin(), study().ends.end(), realises)) {
      continue;
    }
    Say(Severity::kError,
        codes::kMotionWithoutItem,
        motion.place,
        fmt::format("nothing realises '{}'", motion.name),
        "let it be a plain axis (plain = true), or name a module that realises it");
  }
}

/// For every combination of ends the ways to realise the motions that they leave.
void StudySpaceBuilder::MakeGroupings() {
  std::set<std::vector<std::string>> by_part;
  std::set<std::vector<std::string>> by_tool;
  for (const EndChoice& end : study().ends) (end.part ? by_part : by_tool).insert(end.realises);
  for (const auto& part : by_part) {
    for (const auto& tool : by_tool) {
      if (!Disjoint(part, tool)) continue;
      Motions left;
      for (std::size_t i = 0; i < study().motions.size(); ++i) {
        const std::string& name = study().motions[i].name;
        const bool done = std::find(part.begin(), part.end(), name) != part.end() ||
                          std::find(tool.begin(), tool.end(), name) != tool.end();
        if (!done) left.push_back(static_cast<int>(i));
      }
      StudySpace::Grouping grouping{.items = {}, .part_end = part, .tool_end = tool};
      std::set<int> modules;
      Cover(left, grouping, modules);
    }
  }
  if (made_.groupings_.empty()) {
    Say(Severity::kError,
        codes::kEmptySpace,
        {},
        "no combination of axes and modules realises all motions",
        "allow plain axes, or more sets of 'letters' for the modules");
  } else if (made_.groupings_.size() > kMostGroupings) {
    Say(Severity::kError,
        codes::kTooManyGroupings,
        {},
        fmt::format("the motions can be realised in more than {} ways", kMostGroupings),
        "name the sets of 'letters' that each module may realise");
  } else {
    AddGroupingFeature();
  }
}

/// The first motion left is realised by each item that fits, the others in turn.
void StudySpaceBuilder::Cover(const Motions& left,
                              StudySpace::Grouping& grouping,
                              std::set<int>& modules) {
  if (made_.groupings_.size() > kMostGroupings) return;
  if (left.empty()) {
    made_.groupings_.push_back(grouping);
    return;
  }
  for (std::size_t i = 0; i < made_.items_.size(); ++i) {
    const Item& item = made_.items_[i];
    const Motions wanted = [&item] {
      Motions sorted = item.motions;
      std::sort(sorted.begin(), sorted.end());
      return sorted;
    }();
    if (wanted.front() != left.front() || modules.contains(item.module)) continue;
    if (!std::includes(left.begin(), left.end(), wanted.begin(), wanted.end())) continue;
    Motions rest;
    std::set_difference(
        left.begin(), left.end(), wanted.begin(), wanted.end(), std::back_inserter(rest));
    grouping.items.push_back(static_cast<int>(i));
    if (item.module >= 0) modules.insert(item.module);
    Cover(rest, grouping, modules);
    if (item.module >= 0) modules.erase(item.module);
    grouping.items.pop_back();
  }
}

void StudySpaceBuilder::AddGroupingFeature() {
  Feature feature{.name = "grouping"};
  for (const StudySpace::Grouping& grouping : made_.groupings_) {
    feature.alternatives.push_back(AlternativeOf(grouping));
  }
  made_.grouping_feature_ = made_.space_.Add(std::move(feature));
}

Alternative StudySpaceBuilder::AlternativeOf(const StudySpace::Grouping& grouping) const {
  Alternative alternative;
  std::vector<std::string> texts;
  for (const int i : grouping.items) {
    const Item& item = made_.items_[static_cast<std::size_t>(i)];
    texts.push_back(item.text);
    alternative.tags.push_back("item:" + item.text);
    if (item.module < 0) {
      alternative.tags.push_back("plain:" +
                                 study().motions[static_cast<std::size_t>(item.motions[0])].name);
      continue;
    }
    const StudyModule& module = study().modules[static_cast<std::size_t>(item.module)];
    alternative.tags.push_back("block:" + module.name);
    alternative.tags.push_back("module:" + module.module);
  }
  const auto by_end = [&](const std::vector<std::string>& motions, std::string_view side) {
    if (motions.empty()) return;
    texts.push_back(fmt::format("{} by the {} end", Joined(motions), side));
  };
  by_end(grouping.part_end, "part");
  by_end(grouping.tool_end, "tool");
  alternative.name = Joined(texts, "+");
  return alternative;
}

void StudySpaceBuilder::AddEnds() {
  for (const bool part : {true, false}) {
    Feature feature{.name = part ? "part_end" : "tool_end"};
    std::vector<int>& meaning = part ? made_.part_ends_ : made_.tool_ends_;
    for (std::size_t i = 0; i < study().ends.size(); ++i) {
      const EndChoice& end = study().ends[i];
      if (end.part != part) continue;
      meaning.push_back(static_cast<int>(i));
      Alternative alternative{.name = end.name, .tags = {"end:" + end.name}};
      for (const std::string& unit : end.units) alternative.tags.push_back("unit:" + unit);
      feature.alternatives.push_back(std::move(alternative));
    }
    (part ? made_.part_end_feature_ : made_.tool_end_feature_) =
        made_.space_.Add(std::move(feature));
  }
}

void StudySpaceBuilder::AddBase() {
  Feature feature{.name = "base"};
  for (const bool open : study().open_bases) {
    const std::string name = open ? "open" : "closed";
    feature.alternatives.push_back({.name = name, .tags = {"base:" + name}});
  }
  made_.base_feature_ = made_.space_.Add(std::move(feature));
}

void StudySpaceBuilder::AddPlaces() {
  std::vector<Alternative> alternatives{{.name = "O"}};
  made_.places_ = {{.kind = StudySpace::PlaceMeaning::Kind::kBase}};
  for (std::size_t i = 0; i < made_.items_.size(); ++i) {
    const Item& item = made_.items_[i];
    const Sides sides = SidesOf(item);
    for (const bool part : {true, false}) {
      if (part ? !sides.part : !sides.tool) continue;
      const std::string side = part ? "part" : "tool";
      Alternative alternative{.name = fmt::format("{}.{}", item.text, side),
                              .tags = {"side:" + side}};
      for (const int motion : item.motions) {
        const std::string& name = study().motions[static_cast<std::size_t>(motion)].name;
        alternative.tags.push_back(fmt::format("{}:{}", side, name));
        alternative.tags.push_back("motion:" + name);
      }
      alternative.tags.push_back(side + (item.translates ? ":translation" : ":rotation"));
      if (item.module >= 0) {
        const std::string& block = study().modules[static_cast<std::size_t>(item.module)].name;
        alternative.tags.push_back(fmt::format("{}:{}", side, block));
      }
      alternatives.push_back(std::move(alternative));
      made_.places_.push_back({.kind = StudySpace::PlaceMeaning::Kind::kItem,
                               .item = static_cast<int>(i),
                               .part_side = part});
    }
  }
  alternatives.push_back({.name = "-"});
  made_.places_.push_back({.kind = StudySpace::PlaceMeaning::Kind::kEmpty});
  std::size_t most = 0;
  for (const auto& grouping : made_.groupings_) most = std::max(most, grouping.items.size());
  made_.place_count_ = static_cast<int>(most) + 1;
  for (int place = 0; place < made_.place_count_; ++place) {
    Feature feature{.name = fmt::format("p{}", place + 1), .alternatives = alternatives};
    for (std::size_t i = 1; i + 1 < alternatives.size(); ++i) {
      feature.alternatives[i].tags.push_back(fmt::format("place:{}", place + 1));
    }
    const int number = made_.space_.Add(std::move(feature));
    if (place == 0) made_.first_place_ = number;
  }
}

void StudySpaceBuilder::AddModuleFeature(int module, Feature feature, int& number) {
  if (feature.alternatives.size() < 2) return;
  feature.name = study().modules[static_cast<std::size_t>(module)].name + "." + feature.name;
  feature.alternatives.insert(feature.alternatives.begin(), Alternative{.name = "none"});
  number = made_.space_.Add(std::move(feature));
}

void StudySpaceBuilder::AddModuleFeatures() {
  for (std::size_t m = 0; m < study().modules.size(); ++m) {
    const StudyModule& module = study().modules[m];
    StudySpace::ModuleFeatures features;
    Feature mounts{.name = "mount"};
    for (const MountChoice& mount : module.mounts) {
      mounts.alternatives.push_back(
          {.name = mount.name, .tags = {fmt::format("mount:{}={}", module.name, mount.name)}});
    }
    AddModuleFeature(static_cast<int>(m), std::move(mounts), features.mount);
    Feature modes{.name = "mode"};
    for (const ModeChoice& mode : module.modes) {
      modes.alternatives.push_back(
          {.name = mode.name, .tags = {fmt::format("mode:{}={}", module.name, mode.name)}});
    }
    AddModuleFeature(static_cast<int>(m), std::move(modes), features.mode);
    for (const StudyParameter& parameter : module.parameters) {
      Feature levels{.name = parameter.name};
      for (const Level& level : parameter.levels) {
        levels.alternatives.push_back(
            {.name = level.name,
             .tags = {fmt::format("level:{}.{}={}", module.name, parameter.name, level.name)}});
      }
      features.parameters.push_back(-1);
      AddModuleFeature(static_cast<int>(m), std::move(levels), features.parameters.back());
    }
    made_.module_features_.push_back(std::move(features));
  }
}

}  // namespace kompono::synthesis
