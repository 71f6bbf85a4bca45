// SPDX-License-Identifier: Apache-2.0
#include "reader.hpp"

#include "keys.hpp"
#include "shape.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::layout {
namespace {

void Visit(formula::Chain& chain, const std::function<void(formula::Item&)>& visit) {
  for (formula::Item& item : chain) {
    if (auto* fork = std::get_if<formula::Fork>(&item)) {
      for (formula::Chain& branch : fork->branches) Visit(branch, visit);
    } else {
      visit(item);
    }
  }
}

}  // namespace

void ForEachItem(formula::Formula& formula, const std::function<void(formula::Item&)>& visit) {
  Visit(formula.left, visit);
  Visit(formula.right, visit);
}

LayoutReader::LayoutReader(std::string_view text,
                           std::string_view file,
                           const plugin::Registry& registry)
    : text_(text), registry_(registry), complaints_(text, file) {}

Parsed<Layout> LayoutReader::Read(Diagnostics* notes) {
  if (!ParseToml()) return tl::unexpected(complaints_.Take());
  JudgeShape(root_, FileRule(), "", complaints_);
  layout_.text = std::string(text_);
  layout_.file = std::string(complaints_.file());
  layout_.name = TextAt(root_, "name").value_or(layout_.file.stem().string());
  layout_.description = TextAt(root_, "description").value_or("");
  ReadUnits();
  ReadFormula();
  ReadBlocks();
  for (const BlockDraft& draft : drafts_) layout_.blocks.push_back(draft.block);
  ReadAxes();
  ReadOpenBase();
  ReadEnds();
  JudgeBlockNames();
  ReadCalibration();
  if (complaints_.HasErrors()) return tl::unexpected(complaints_.Take());
  if (notes != nullptr) {
    for (Diagnostic& note : complaints_.Take()) notes->push_back(std::move(note));
  }
  return std::move(layout_);
}

bool LayoutReader::ParseToml() {
  try {
    root_ = toml::parse(text_, complaints_.file());
    return true;
  } catch (const toml::parse_error& error) {
    std::string_view what = error.description();
    constexpr std::string_view kPrefix = "Error ";
    if (what.substr(0, kPrefix.size()) == kPrefix) what.remove_prefix(kPrefix.size());
    const auto says = [what](std::string_view words) {
      return what.find(words) != std::string_view::npos;
    };
    complaints_.Error(codes::kNotToml,
                      complaints_.Span(error.source()),
                      fmt::format("this is not TOML: {}", what),
                      says("redefine")             ? "a key or table may stand only once"
                      : says("control characters") ? "a string in quotes ends on its own line"
                                                   : "");
    return false;
  }
}

void LayoutReader::ReadUnits() {
  units_ = UnitsOf(root_);
  if (const toml::table* pose = TableAt(root_, "pose")) {
    layout_.rotation_order =
        TextAt(*pose, "rotation") == "zyx" ? RotationOrder::kZYX : RotationOrder::kXYZ;
  }
}

void LayoutReader::ReadFormula() {
  const auto text = TextAt(root_, "formula");
  if (!text) return;
  formula_place_ = std::make_unique<FormulaPlace>(text_, root_.get("formula")->source(), *text);
  Diagnostics notes;
  auto formula = formula::ParseFormula(*text, complaints_.file(), &notes);
  if (!formula) notes.insert(notes.end(), formula.error().begin(), formula.error().end());
  for (Diagnostic& said : notes) {
    said.span = formula_place_->InFile(said.span);
    complaints_.Add(std::move(said));
  }
  if (!formula) return;
  layout_.formula = std::move(*formula);
  formula_good_ = true;
}

Placement LayoutReader::ReadPlacement(const toml::table* table) const {
  Placement placement;
  if (table == nullptr) return placement;
  const auto position = TripleAt(*table, "position").value_or(std::array<double, 3>{});
  const auto rotation = TripleAt(*table, "rotation").value_or(std::array<double, 3>{});
  for (std::size_t i = 0; i < 3; ++i) {
    placement.position_mm[i] = position[i] * units_.length;
    placement.rotation_rad[i] = rotation[i] * units_.angle;
  }
  return placement;
}

void LayoutReader::ReadAxes() {
  if (!formula_good_) return;
  std::vector<formula::Axis> plain;
  ForEachItem(layout_.formula, [&plain](formula::Item& item) {
    const auto* axis = std::get_if<formula::Axis>(&item);
    if (axis == nullptr || !axis->block.empty()) return;
    const bool seen = std::any_of(plain.begin(), plain.end(), [axis](const auto& other) {
      return other.Name() == axis->Name();
    });
    if (!seen) plain.push_back(*axis);
  });
  const toml::table* tables = TableAt(root_, "axis");
  for (const formula::Axis& item : plain)
    layout_.axes.push_back(
        ReadAxis(item, tables == nullptr ? nullptr : TableAt(*tables, item.Name())));
  JudgeAxisTables(plain);
}

Axis LayoutReader::ReadAxis(const formula::Axis& item, const toml::table* table) {
  const bool spindle = item.orientation != formula::Orientation::kNone;
  Axis axis;
  axis.name = item.Name();
  axis.letter = item.letter;
  axis.main_motion = spindle;
  if (table == nullptr) return axis;
  const double unit = units_.Of(item.rotary());
  axis.frame = ReadPlacement(table);
  axis.drive = ReadDrive(*table, item.rotary(), units_);
  if (const toml::node* positioning = table->get("positioning")) {
    axis.main_motion = spindle && !positioning->value_exact<bool>().value_or(false);
    if (!spindle) {
      complaints_.Warning(
          codes::kNoSpindle,
          complaints_.Span(table->find("positioning")->first.source()),
          fmt::format("'{}' is no main-motion spindle; it is positioned anyway", axis.name));
    }
  }
  const auto coordinate = [&axis](double reading) {
    return axis.drive.zero + axis.drive.sign * reading;
  };
  double lower = -HUGE_VAL;
  double upper = HUGE_VAL;
  if (axis.drive.lower && axis.drive.upper) {
    lower = std::min(coordinate(*axis.drive.lower), coordinate(*axis.drive.upper));
    upper = std::max(coordinate(*axis.drive.lower), coordinate(*axis.drive.upper));
  }
  const auto home = NumberAt(*table, "home");
  axis.home = home ? *home * unit : std::clamp(0.0, lower, upper);
  if (home && (axis.home < lower || axis.home > upper)) {
    complaints_.Warning(
        codes::kHomeOutside,
        complaints_.Span(*table->get("home")),
        fmt::format("home of '{}' lies outside its range", axis.name),
        fmt::format("the axis can go from {:.12g} to {:.12g}", lower / unit, upper / unit));
  }
  return axis;
}

void LayoutReader::JudgeAxisTables(const std::vector<formula::Axis>& plain) {
  const toml::table* tables = TableAt(root_, "axis");
  if (tables == nullptr) return;
  std::vector<std::string> names;
  names.reserve(plain.size());
  for (const formula::Axis& axis : plain) names.push_back(axis.Name());
  for (const auto& [key, node] : *tables) {
    if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
    const Block* block = nullptr;
    for (const Block& candidate : layout_.blocks) {
      for (const Block::LetterMap& letter : candidate.letters) {
        if (letter.axis == key.str()) block = &candidate;
      }
    }
    complaints_.Error(
        codes::kUnknownAxis,
        complaints_.Span(key.source()),
        block != nullptr
            ? fmt::format(
                  "'{}' is no plain axis: the block '{}' realises it", key.str(), block->name)
            : fmt::format("the formula has no axis '{}'", key.str()),
        block != nullptr ? fmt::format("limits of its drives stand in [block.{}.drive.<drive>], "
                                       "those of its coordinates in its 'range'",
                                       block->name)
                         : DidYouMean(key.str(), names));
  }
}

/// Numbers are called "Z.zero" and "tool.length": one name must not mean two things.
void LayoutReader::JudgeBlockNames() {
  for (const BlockDraft& draft : drafts_) {
    const std::string& name = draft.block.name;
    const End* end = layout_.FindEnd(name);
    if (layout_.FindAxis(name) == nullptr && end == nullptr && name != "open_base") continue;
    complaints_.Error(codes::kNameTaken,
                      complaints_.Span(*draft.table),
                      fmt::format("the block's name '{}' is that of {}",
                                  name,
                                  end != nullptr        ? "an end of the machine"
                                  : name == "open_base" ? "the open base"
                                                        : "an axis"),
                      "give the block another name, here and in the formula");
  }
}

void LayoutReader::ReadOpenBase() {
  const auto found = root_.find("open_base");
  if (found == root_.end()) return;
  layout_.open_base = ReadPlacement(found->second.as_table());
  if (!formula_good_ || layout_.formula.open_base) return;
  complaints_.Error(codes::kNoOpenBase,
                    complaints_.Span(found->first.source()),
                    "'open_base' means nothing for a machine with one base",
                    "two foundations that are coupled only electronically are written O|O in the "
                    "formula");
}

}  // namespace kompono::layout
