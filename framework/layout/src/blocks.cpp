// SPDX-License-Identifier: Apache-2.0
// [block.<name>] and what the formula asks of it.
#include "reader.hpp"
#include "shape.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::layout {
namespace {

std::string NamesOf(const std::vector<formula::Axis>& axes) {
  std::vector<std::string> names;
  names.reserve(axes.size());
  for (const formula::Axis& axis : axes) names.push_back(axis.Name());
  return fmt::format("{}", fmt::join(names, " "));
}

std::string_view KindName(plugin::ModuleKind kind) {
  return kind == plugin::ModuleKind::kMechanism ? "mechanism" : "unit";
}

}  // namespace

void LayoutReader::ReadBlocks() {
  if (const toml::table* blocks = TableAt(root_, "block")) {
    for (const auto& [name, node] : *blocks) {
      if (const toml::table* table = node.as_table())
        drafts_.push_back(ReadBlock(name.str(), *table));
    }
  }
  ConnectBlocks();
}

const plugin::ModuleDescription* LayoutReader::ReadModule(const toml::table& table,
                                                          plugin::ModuleKind kind) {
  const auto id = TextAt(table, "module");
  if (!id) return nullptr;
  const SourceSpan place = complaints_.Span(*table.get("module"));
  const plugin::ModuleDescription* module = registry_.Find(*id);
  if (module == nullptr) {
    const Diagnostic unknown = registry_.UnknownModule(*id);
    complaints_.Error(
        codes::kUnknownModule, place, unknown.message, ForeignLetters(*id, unknown.help));
    return nullptr;
  }
  if (module->kind == kind) return module;
  complaints_.Error(
      codes::kWrongModuleKind,
      place,
      fmt::format("'{}' is a {}; a {} is needed here", *id, KindName(module->kind), KindName(kind)),
      fmt::format("'kompono plugins' lists every {}", KindName(kind)));
  return nullptr;
}

BlockDraft LayoutReader::ReadBlock(std::string_view name, const toml::table& table) {
  BlockDraft draft;
  draft.table = &table;
  draft.block.name = std::string(name);
  draft.block.mount = ReadPlacement(TableAt(table, "mount"));
  draft.module = ReadModule(table, plugin::ModuleKind::kMechanism);
  if (draft.module == nullptr) {
    names_known_ = false;
    return draft;
  }
  draft.block.module = draft.module->id;
  if (auto parameters = ReadParameters(table, *draft.module, units_, complaints_))
    draft.block.parameters = std::move(*parameters);
  ReadModes(draft);
  ReadBlockDrives(draft);
  ReadStrutLimits(draft);
  return draft;
}

void LayoutReader::ReadModes(BlockDraft& draft) {
  const auto& modes = draft.module->modes;
  const toml::table* given = TableAt(*draft.table, "mode");
  std::vector<std::string> names;
  for (const plugin::ModeDescription& mode : modes) {
    names.push_back(mode.name);
    const toml::node* node = given == nullptr ? nullptr : given->get(mode.name);
    draft.block.modes.push_back(SignOf(node).value_or(mode.default_sign));
  }
  if (given == nullptr) return;
  for (const auto& [key, node] : *given) {
    if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
    complaints_.Error(
        codes::kUnknownMode,
        complaints_.Span(key.source()),
        fmt::format("'{}' has no assembly mode '{}'", draft.module->id, key.str()),
        names.empty() ? "it can be assembled in one way only" : DidYouMean(key.str(), names));
  }
}

void LayoutReader::ReadBlockDrives(BlockDraft& draft) {
  const toml::table* given = TableAt(*draft.table, "drive");
  for (const plugin::DriveDescription& drive : draft.module->drives) {
    const toml::table* table = given == nullptr ? nullptr : TableAt(*given, drive.name);
    draft.block.drives.push_back(table == nullptr ? Drive{}
                                                  : ReadDrive(*table, drive.rotary, units_));
  }
  if (given == nullptr) return;
  std::vector<std::string> names;
  names.reserve(draft.module->drives.size());
  for (const plugin::DriveDescription& drive : draft.module->drives) names.push_back(drive.name);
  for (const auto& [key, node] : *given) {
    if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
    complaints_.Error(codes::kUnknownDrive,
                      complaints_.Span(key.source()),
                      fmt::format("'{}' has no drive '{}'", draft.module->id, key.str()),
                      DidYouMean(key.str(), names));
  }
}

void LayoutReader::ReadStrutLimits(BlockDraft& draft) {
  const auto length = [&](std::string_view key) -> std::optional<double> {
    const auto value = NumberAt(*draft.table, key);
    return value ? std::optional(*value * units_.length) : std::nullopt;
  };
  draft.block.strut_diameter = length("strut_diameter");
  draft.block.clearance = length("clearance");
  const toml::table* given = TableAt(*draft.table, "swing");
  if (given == nullptr) return;
  std::vector<std::string> joints;
  for (const plugin::LinkDescription& link : draft.module->links) {
    if (link.kind != "strut") continue;
    for (const std::string& end : {link.from, link.to}) {
      if (std::find(joints.begin(), joints.end(), end) == joints.end()) joints.push_back(end);
    }
  }
  for (const auto& [key, node] : *given) {
    const bool known = std::any_of(joints.begin(), joints.end(), [&key = key](const auto& joint) {
      return MatchesPattern(key.str(), joint);
    });
    if (!known) {
      complaints_.Error(
          codes::kUnknownJoint,
          complaints_.Span(key.source()),
          fmt::format("no strut of '{}' has a joint '{}'", draft.module->id, key.str()),
          joints.empty() ? "the module has no struts" : DidYouMean(key.str(), joints, 12));
    } else if (const auto swing = NumberOf(&node)) {
      draft.block.joints.push_back({std::string(key.str()), *swing * units_.angle});
    }
  }
}

void LayoutReader::ConnectBlocks() {
  if (!formula_good_) return;
  ForEachItem(layout_.formula, [this](formula::Item& item) {
    if (const auto* group = std::get_if<formula::Group>(&item)) {
      if (!group->block.empty()) ConnectNamed(group->block, group->axes);
    } else if (const auto* axis = std::get_if<formula::Axis>(&item)) {
      if (!axis->block.empty()) ConnectNamed(axis->block, {*axis});
    }
  });
  ForEachItem(layout_.formula, [this](formula::Item& item) {
    auto* group = std::get_if<formula::Group>(&item);
    if (group != nullptr && group->block.empty()) ConnectUnnamed(*group);
  });
  for (const BlockDraft& draft : drafts_) {
    if (draft.claimed || draft.wanted) continue;
    complaints_.Error(codes::kUnnamedBlock,
                      complaints_.Span(*draft.table),
                      fmt::format("the formula does not use the block '{}'", draft.block.name),
                      fmt::format("name it behind the bracket it realises, as in (XY):{}, or "
                                  "remove the table",
                                  draft.block.name));
  }
}

void LayoutReader::ConnectNamed(const std::string& block_name,
                                const std::vector<formula::Axis>& axes) {
  for (BlockDraft& draft : drafts_) {
    if (draft.block.name != block_name) continue;
    draft.claimed = true;
    if (draft.module != nullptr) Fit(draft, axes);
    return;
  }
  names_known_ = false;
  std::vector<std::string> names;
  names.reserve(drafts_.size());
  for (const BlockDraft& draft : drafts_) names.push_back(draft.block.name);
  const std::string near = Nearest(block_name, names);
  complaints_.Error(codes::kUndefinedBlock,
                    formula_place_->OfBlock(block_name),
                    fmt::format("the file does not define the block '{}'", block_name),
                    near.empty() ? fmt::format("add a table [block.{}] with its module", block_name)
                                 : fmt::format("did you mean '{}'?", near));
}

void LayoutReader::ConnectUnnamed(formula::Group& group) {
  std::vector<BlockDraft*> fitting;
  for (BlockDraft& draft : drafts_) {
    if (draft.claimed || draft.module == nullptr) continue;
    if (FitLetters(draft.module->letters, draft.block.mount, group.axes).ok())
      fitting.push_back(&draft);
  }
  const std::string wanted = formula::ItemText(group);
  if (fitting.size() == 1) {
    BlockDraft& draft = *fitting.front();
    draft.claimed = true;
    group.block = draft.block.name;
    complaints_.Note(codes::kBlockFound,
                     formula_place_->OfText(wanted),
                     fmt::format("{} is realised by the block '{}'", wanted, draft.block.name),
                     fmt::format("write {}:{}", wanted, draft.block.name));
    Fit(draft, group.axes);
    return;
  }
  std::vector<std::string> names;
  for (BlockDraft* draft : fitting) {
    names.push_back(draft->block.name);
    draft->wanted = true;
  }
  names_known_ = false;
  complaints_.Error(
      codes::kAmbiguousGroup,
      formula_place_->OfText(wanted),
      fitting.empty()
          ? fmt::format("no free block of the file realises {}", wanted)
          : fmt::format("{} may be realised by each of: {}", wanted, fmt::join(names, ", ")),
      fmt::format("name the block in the formula: {}:{}",
                  wanted,
                  names.empty() ? std::string("name") : names.front()));
}

void LayoutReader::Fit(BlockDraft& draft, const std::vector<formula::Axis>& axes) {
  LetterFit fit = FitLetters(draft.module->letters, draft.block.mount, axes);
  if (!fit.ok()) return ReportMisfit(draft, fit, axes);
  if (fit.kind == LetterFit::Kind::kOwnAxes) {
    complaints_.Note(
        codes::kOwnAxes,
        complaints_.Span(*draft.table),
        fmt::format("the axes of '{}' are oblique to the machine's; its coordinates {} "
                    "count along its own",
                    draft.block.name,
                    NamesOf(axes)));
  }
  draft.block.letters = std::move(fit.letters);
  ReadCoordinates(draft);
}

void LayoutReader::ReportMisfit(const BlockDraft& draft,
                                const LetterFit& fit,
                                const std::vector<formula::Axis>& axes) {
  const std::string realised = LettersUnderMount(draft.module->letters, draft.block.mount);
  if (fit.kind == LetterFit::Kind::kCount) {
    complaints_.Error(codes::kLetterCount,
                      complaints_.Span(*draft.table->get("module")),
                      fmt::format("'{}' realises {}, but the formula asks '{}' for {}",
                                  draft.module->id,
                                  realised,
                                  draft.block.name,
                                  NamesOf(axes)),
                      "choose another module, or another group in the formula");
    return;
  }
  const toml::table* mount = TableAt(*draft.table, "mount");
  const toml::node* place = mount == nullptr ? nullptr : mount->get("rotation");
  if (place == nullptr) place = draft.table->get("module");
  const auto turn = RotationThatFits(draft.module->letters, axes);
  std::string help = "no rotation of the mount changes that; choose another module";
  if (turn) {
    const auto in_file = [this](int degrees) {
      const double value = degrees * Units{}.angle / units_.angle;
      return fmt::format("{:.16g}", value);
    };
    help = fmt::format("mount.rotation = [{}, {}, {}] would turn them so",
                       in_file((*turn)[0]),
                       in_file((*turn)[1]),
                       in_file((*turn)[2]));
  }
  complaints_.Error(
      codes::kLetterDirection,
      complaints_.Span(*place),
      fmt::format("under its mount '{}' realises {}, but the formula asks '{}' for {}",
                  draft.module->id,
                  realised,
                  draft.block.name,
                  NamesOf(axes)),
      help);
}

std::optional<std::size_t> LayoutReader::LocalOf(const BlockDraft& draft,
                                                 const toml::key& letter,
                                                 std::string_view key) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < draft.block.letters.size(); ++i) {
    if (draft.block.letters[i].axis == letter.str()) return i;
    names.push_back(draft.block.letters[i].axis);
  }
  complaints_.Error(
      codes::kUnknownLetter,
      complaints_.Span(letter.source()),
      fmt::format("'{}' of '{}' has no letter '{}'", key, draft.block.name, letter.str()),
      DidYouMean(letter.str(), names));
  return std::nullopt;
}

/// `home` and `range` by the letters of the formula; both are kept in their sense.
void LayoutReader::ReadCoordinates(BlockDraft& draft) {
  Block& block = draft.block;
  block.home.assign(block.letters.size(), std::nullopt);
  block.lower = block.home;
  block.upper = block.home;
  const auto unit_of = [this, &block](std::size_t i) {
    return units_.Of(block.letters[i].formula_letter >= 'A' &&
                     block.letters[i].formula_letter <= 'E');
  };
  if (const toml::table* ranges = TableAt(*draft.table, "range")) {
    for (const auto& [letter, node] : *ranges) {
      const auto local = LocalOf(draft, letter, "range");
      const auto range = IntervalOf(&node);
      if (!local || !range) continue;
      block.lower[*local] = (*range)[0] * unit_of(*local);
      block.upper[*local] = (*range)[1] * unit_of(*local);
    }
  }
  if (const toml::table* homes = TableAt(*draft.table, "home")) {
    for (const auto& [letter, node] : *homes) {
      const auto local = LocalOf(draft, letter, "home");
      const auto home = NumberOf(&node);
      if (!local || !home) continue;
      block.home[*local] = *home * unit_of(*local);
      const auto& lower = block.lower[*local];
      const auto& upper = block.upper[*local];
      if ((!lower || *block.home[*local] >= *lower) && (!upper || *block.home[*local] <= *upper))
        continue;
      complaints_.Warning(
          codes::kHomeOutside,
          complaints_.Span(node),
          fmt::format("home of '{}.{}' lies outside its range", block.name, letter.str()),
          fmt::format("its range is [{:.12g}, {:.12g}]",
                      *lower / unit_of(*local),
                      *upper / unit_of(*local)));
    }
  }
}

}  // namespace kompono::layout
