// SPDX-License-Identifier: Apache-2.0
#include "study_reader.hpp"

#include "end_tables.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::synthesis {
namespace {

constexpr double kSecondsPerMinute = 60.0;
constexpr double kStiffnessFactor = 1000.0;  // N/µm to N/mm, N·m/rad to N·mm/rad

/// The one axis that `name` means, or nothing.
std::optional<formula::Axis> AxisOf(const std::string& name) {
  const auto parsed = formula::ParseFormula("O " + name, "motion");
  if (!parsed || parsed->right.size() != 2) return std::nullopt;
  const auto* axis = std::get_if<formula::Axis>(&parsed->right.front());
  if (axis == nullptr || axis->orientation != formula::Orientation::kNone) return std::nullopt;
  if (!axis->block.empty() || axis->Name() != name) return std::nullopt;
  return *axis;
}

void CollectLeafTables(const toml::table& tables, std::vector<std::string>& units) {
  for (const auto& [key, node] : tables) {
    const toml::table* table = node.as_table();
    if (table == nullptr || key.str() == "axis" || key.str() == "block") continue;
    if (auto module = TextAt(*table, "module")) units.push_back(std::move(*module));
  }
  std::sort(units.begin(), units.end());
}

}  // namespace

layout::Drive ReadDriveTable(const toml::table& table, bool rotary) {
  const double unit = rotary ? kRadPerDeg : 1.0;
  const auto scaled = [&table](std::string_view key, double factor) -> std::optional<double> {
    const auto value = NumberAt(table, key);
    return value ? std::optional(*value * factor) : std::nullopt;
  };
  layout::Drive drive;
  if (const auto range = IntervalOf(table.get("range"))) {
    drive.lower = (*range)[0] * unit;
    drive.upper = (*range)[1] * unit;
  }
  drive.speed = scaled("speed", unit / kSecondsPerMinute);
  drive.acceleration = scaled("acceleration", unit);
  drive.stiffness = scaled("stiffness", kStiffnessFactor);
  return drive;
}

Sides ReadSides(const toml::table& table) {
  if (!table.contains("sides")) return {};
  const std::vector<std::string> words = TextsAt(table, "sides");
  const auto has = [&words](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  return {.part = has("part"), .tool = has("tool")};
}

StudyReader::StudyReader(std::string_view text,
                         std::string_view file,
                         const plugin::Registry& registry,
                         std::span<const std::string> metrics)
    : text_(text), registry_(registry), metrics_(metrics), complaints_(text, file) {}

Parsed<Study> StudyReader::Read(Diagnostics* notes) {
  if (!ParseToml()) return tl::unexpected(complaints_.Take());
  JudgeShape(root_, StudyRuleOfFile(), "", complaints_);
  study_.text = std::string(text_);
  study_.file = std::string(complaints_.file());
  ReadHead();
  ReadMotions();
  ReadEnds();
  ReadModules();
  ReadRules();
  ReadGoals();
  ReadReference();
  if (complaints_.HasErrors()) return tl::unexpected(complaints_.Take());
  if (notes != nullptr) {
    for (Diagnostic& note : complaints_.Take()) notes->push_back(std::move(note));
  }
  return std::move(study_);
}

bool StudyReader::ParseToml() {
  try {
    root_ = toml::parse(text_, complaints_.file());
    return true;
  } catch (const toml::parse_error& error) {
    std::string_view what = error.description();
    constexpr std::string_view kPrefix = "Error ";
    if (what.substr(0, kPrefix.size()) == kPrefix) what.remove_prefix(kPrefix.size());
    complaints_.Error(codes::kNotToml,
                      complaints_.Span(error.source()),
                      fmt::format("this is not TOML: {}", what));
    return false;
  }
}

void StudyReader::ReadHead() {
  study_.name = TextAt(root_, "study").value_or("");
  study_.description = TextAt(root_, "description").value_or("");
  const std::string equivalence = TextAt(root_, "equivalence").value_or("distribution");
  study_.equivalence = equivalence == "string"            ? Equivalence::kString
                       : equivalence == "relative_motion" ? Equivalence::kRelativeMotion
                                                          : Equivalence::kDistribution;
  if (root_.contains("base")) {
    study_.open_bases.clear();
    for (const std::string& word : TextsAt(root_, "base")) {
      study_.open_bases.push_back(word == "open");
    }
  }
  const std::string direction = TextAt(root_, "process").value_or("z");
  study_.process_direction = direction.size() == 1 ? direction[0] : 'z';
  if (const toml::table* part = TableAt(root_, "part")) {
    study_.part_size_mm = TripleAt(*part, "size").value_or(std::array<double, 3>{});
    study_.part_mass_kg = NumberAt(*part, "mass").value_or(0.0);
    const auto& size = study_.part_size_mm;
    if (study_.part_mass_kg < 0.0 || *std::min_element(size.begin(), size.end()) < 0.0) {
      complaints_.Error(codes::kOutOfRange,
                        complaints_.Span(*part),
                        "size and mass of the part cannot be negative");
    }
  }
}

void StudyReader::ReadMotions() {
  for (const NamedTable& named : TablesAt(root_, "motions")) ReadMotion(named);
  const toml::table* table = TableAt(root_, "motions");
  if (table != nullptr && table->empty()) {
    complaints_.Error(codes::kWrongCount,
                      complaints_.Span(*table),
                      "a study needs at least one motion",
                      "write [motions.X] with its range");
  }
}

void StudyReader::ReadMotion(const NamedTable& named) {
  const auto axis = AxisOf(named.name);
  if (!axis) {
    complaints_.Error(codes::kBadMotion,
                      complaints_.Span(named.place),
                      fmt::format("'{}' is not the name of a motion", named.name),
                      "a letter X Y Z A B C U V W P Q R D E, small for a setting motion, perhaps "
                      "with a number; main-motion spindles stand in the chains of [ends]");
    return;
  }
  Motion motion{.axis = *axis, .name = named.name};
  const double unit = axis->rotary() ? kRadPerDeg : 1.0;
  if (const auto range = IntervalOf(named.table->get("range"))) {
    motion.range = {(*range)[0] * unit, (*range)[1] * unit};
  }
  motion.sides = ReadSides(*named.table);
  const toml::node* plain = named.table->get("plain");
  motion.plain = plain == nullptr || plain->value_exact<bool>().value_or(true);
  motion.part_pivot_mm = TripleAt(*named.table, "part_pivot").value_or(std::array<double, 3>{});
  motion.tool_pivot_mm = TripleAt(*named.table, "tool_pivot").value_or(std::array<double, 3>{});
  motion.drive = ReadDriveTable(*named.table, axis->rotary());
  motion.drive.lower.reset();
  motion.drive.upper.reset();
  motion.place = complaints_.Span(named.place);
  study_.motions.push_back(std::move(motion));
}

void StudyReader::ReadEnds() {
  for (const NamedTable& named : TablesAt(root_, "ends")) ReadEnd(named);
  for (const bool part : {true, false}) {
    const auto on_side = [part](const EndChoice& end) { return end.part == part; };
    if (std::none_of(study_.ends.begin(), study_.ends.end(), on_side)) AddBareEnd(part);
  }
}

void StudyReader::AddBareEnd(bool part) {
  EndChoice end{.name = part ? "part" : "tool", .part = part};
  end.chain_text = end.name;
  end.chain = {formula::Leaf{.kind = part ? formula::LeafKind::kPart : formula::LeafKind::kTool}};
  study_.ends.push_back(std::move(end));
}

void StudyReader::ReadEnd(const NamedTable& named) {
  const auto side = TextAt(*named.table, "side");
  const auto text = TextAt(*named.table, "chain");
  if (!side || !text) return;
  EndChoice end{.name = named.name, .part = *side == "part", .chain_text = *text};
  end.place = complaints_.Span(named.place);
  const auto parsed = formula::ParseFormula(end.part ? *text + " O" : "O " + *text, "chain");
  const toml::node& node = *named.table->get("chain");
  if (!parsed) {
    for (const Diagnostic& said : parsed.error()) {
      complaints_.Say(Severity::kError,
                      said.code,
                      complaints_.Span(node),
                      fmt::format("in the chain '{}': {}", *text, said.message),
                      said.help);
    }
    return;
  }
  const formula::Chain& other = end.part ? parsed->right : parsed->left;
  if (parsed->open_base || other.size() != 1) {
    complaints_.Error(codes::kBadChain,
                      complaints_.Span(node),
                      "a chain has no base",
                      "write only what lies between the motions and the end: \"C_v tool\"");
    return;
  }
  end.chain = end.part ? parsed->left : parsed->right;
  for (const formula::Axis& axis : formula::AxesOf(*parsed)) {
    if (axis.orientation != formula::Orientation::kNone) continue;
    const std::string name = axis.Name();
    const bool wanted = std::any_of(study_.motions.begin(),
                                    study_.motions.end(),
                                    [&name](const Motion& motion) { return motion.name == name; });
    if (wanted) end.realises.push_back(name);
  }
  std::sort(end.realises.begin(), end.realises.end());
  end.realises.erase(std::unique(end.realises.begin(), end.realises.end()), end.realises.end());
  if (const toml::node* tables = named.table->get("layout")) {
    if (const toml::table* table = tables->as_table()) {
      CollectLeafTables(*table, end.units);
      end.tables = TablesText(*table);
    } else {
      complaints_.Error(codes::kWrongType,
                        complaints_.Span(*tables),
                        fmt::format("'layout' must be a table, not {}", TypeName(*tables)));
    }
  }
  study_.ends.push_back(std::move(end));
}

void StudyReader::JudgeMetric(std::string_view name, const toml::source_region& place) {
  if (metrics_.empty()) return;
  if (std::find(metrics_.begin(), metrics_.end(), name) != metrics_.end()) return;
  complaints_.Error(codes::kUnknownMetric,
                    complaints_.Span(place),
                    fmt::format("unknown metric '{}'", name),
                    DidYouMean(name, metrics_, 30));
}

void StudyReader::ReadGoals() {
  if (const toml::table* objectives = TableAt(root_, "objectives")) {
    std::vector<std::pair<toml::source_region, Objective>> placed;
    for (const auto& [name, node] : *objectives) {
      JudgeMetric(name.str(), name.source());
      placed.emplace_back(name.source(),
                          Objective{std::string(name.str()),
                                    node.value_exact<std::string>().value_or("") == "max"});
    }
    std::stable_sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
      return std::pair(a.first.begin.line, a.first.begin.column) <
             std::pair(b.first.begin.line, b.first.begin.column);
    });
    for (auto& [place, objective] : placed) study_.objectives.push_back(std::move(objective));
  }
  for (const NamedTable& named : TablesAt(root_, "limits")) {
    JudgeMetric(named.name, named.place);
    Limit limit{named.name, NumberAt(*named.table, "min"), NumberAt(*named.table, "max")};
    if (limit.lower && limit.upper && *limit.lower > *limit.upper) {
      complaints_.Error(codes::kReversedRange,
                        complaints_.Span(*named.table),
                        fmt::format("'min' of '{}' is above its 'max'", named.name));
    } else if (!limit.lower && !limit.upper) {
      complaints_.Error(codes::kMissingKey,
                        complaints_.Span(*named.table),
                        fmt::format("the limit of '{}' has neither 'min' nor 'max'", named.name));
    }
    study_.limits.push_back(std::move(limit));
  }
}

void StudyReader::ReadReference() {
  const toml::table* table = TableAt(root_, "reference");
  if (table == nullptr) return;
  study_.reference = TextAt(*table, "formula").value_or("");
  if (const toml::table* choices = TableAt(*table, "choices")) {
    for (const auto& [name, node] : *choices) {
      if (auto text = node.value_exact<std::string>()) {
        study_.reference_fix[std::string(name.str())] = std::move(*text);
      }
    }
  }
  const auto parsed = formula::ParseFormula(study_.reference, "formula");
  if (parsed || !table->contains("formula")) return;
  for (const Diagnostic& said : parsed.error()) {
    complaints_.Say(Severity::kError,
                    said.code,
                    complaints_.Span(*table->get("formula")),
                    fmt::format("in the reference: {}", said.message),
                    said.help);
  }
}

Parsed<Study> ParseStudy(std::string_view text,
                         std::string_view file,
                         const plugin::Registry& registry,
                         std::span<const std::string> metrics,
                         Diagnostics* notes) {
  return StudyReader(text, file, registry, metrics).Read(notes);
}

Parsed<Study> ReadStudy(const std::filesystem::path& file,
                        const plugin::Registry& registry,
                        std::span<const std::string> metrics,
                        Diagnostics* notes) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) {
    return tl::unexpected(Diagnostics{{.code = std::string(codes::kCannotRead.code),
                                       .file = file.string(),
                                       .span = {},
                                       .message = "the file cannot be read",
                                       .help = ""}});
  }
  return ParseStudy(text, file.string(), registry, metrics, notes);
}

bool LooksLikeStudy(std::string_view text) {
  try {
    return toml::parse(text).contains("study");
  } catch (const toml::parse_error&) {
    return text.starts_with("study") || text.find("\nstudy") != std::string_view::npos;
  }
}

}  // namespace kompono::synthesis
