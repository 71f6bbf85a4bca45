// SPDX-License-Identifier: Apache-2.0
// [modules.<name>]: what the registry's sidecars say of them and what the study lets be chosen.
#include "study_reader.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <map>
#include <set>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/layout/letters.hpp"

namespace kompono::synthesis {
namespace {

constexpr std::size_t kMostModes = 256;

bool IsWord(std::string_view name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_';
         });
}

template <class List>
std::vector<std::string> NamesOf(const List& list) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

/// Whether one of the module's sets of letters consists of these motions; any will do if it has
/// none.
bool Asks(const StudyModule& module, const std::vector<formula::Axis>& motions) {
  if (module.letters.empty()) return true;
  return std::any_of(module.letters.begin(), module.letters.end(), [&](const std::string& set) {
    std::size_t length = 0;
    for (const formula::Axis& axis : motions) {
      if (set.find(axis.Name()) == std::string::npos) return false;
      length += axis.Name().size();
    }
    return length == set.size();
  });
}

std::optional<int> SignOf(const toml::node& node) {
  const auto text = node.value_exact<std::string>();
  if (text == "+") return 1;
  if (text == "-") return -1;
  const auto number = node.value_exact<std::int64_t>();
  if (number && (*number == 1 || *number == -1)) return static_cast<int>(*number);
  return std::nullopt;
}

void AddMode(std::vector<int> signs, StudyModule& module) {
  ModeChoice mode{.name = "", .signs = std::move(signs)};
  for (const int sign : mode.signs) mode.name += sign > 0 ? '+' : '-';
  if (mode.name.empty()) mode.name = "one";
  const bool known = std::any_of(module.modes.begin(),
                                 module.modes.end(),
                                 [&](const ModeChoice& other) { return other.name == mode.name; });
  if (!known) module.modes.push_back(std::move(mode));
}

std::vector<int> DefaultMode(const plugin::ModuleDescription& description) {
  std::vector<int> signs;
  for (const plugin::ModeDescription& mode : description.modes) signs.push_back(mode.default_sign);
  return signs;
}

}  // namespace

void StudyReader::ReadModules() {
  for (const NamedTable& named : TablesAt(root_, "modules")) ReadModule(named);
}

void StudyReader::ReadModule(const NamedTable& named) {
  const auto id = TextAt(*named.table, "module");
  if (!id) return;
  const toml::node& place = *named.table->get("module");
  const bool taken = std::any_of(study_.motions.begin(), study_.motions.end(), [&](const auto& m) {
    return m.name == named.name;
  });
  if (taken || !IsWord(named.name) || named.name == "part" || named.name == "tool") {
    complaints_.Error(codes::kNameTaken,
                      complaints_.Span(named.place),
                      fmt::format("'{}' cannot be the name of a block", named.name),
                      "a word that is neither a motion nor an end: \"drive\", \"struts\"");
    return;
  }
  const plugin::ModuleDescription* description = registry_.Find(*id);
  if (description == nullptr) {
    const Diagnostic said = registry_.UnknownModule(*id);
    complaints_.Error(codes::kUnknownModule, complaints_.Span(place), said.message, said.help);
    return;
  }
  if (description->kind != plugin::ModuleKind::kMechanism) {
    complaints_.Error(codes::kNoMechanism,
                      complaints_.Span(place),
                      fmt::format("'{}' is a unit and realises no motions", *id),
                      "units stand in the tables of [ends]");
    return;
  }
  StudyModule module{.name = named.name, .module = *id};
  module.place = complaints_.Span(named.place);
  module.sides = ReadSides(*named.table);
  ReadLetters(*named.table, module);
  ReadMounts(*named.table, *description, module);
  ReadModes(*named.table, *description, module);
  ReadParameters(*named.table, *description, module);
  ReadHome(*named.table, *description, module);
  ReadDrives(*named.table, *description, module);
  study_.modules.push_back(std::move(module));
}

/// "XY" or, for motions with numbers, "XY2": each must be required.
void StudyReader::ReadLetters(const toml::table& table, StudyModule& module) {
  module.letters = TextsAt(table, "letters");
  const std::vector<std::string> known = NamesOf(study_.motions);
  for (const std::string& letters : module.letters) {
    for (std::size_t i = 0; i < letters.size();) {
      std::size_t end = i + 1;
      while (end < letters.size() && std::isdigit(static_cast<unsigned char>(letters[end])) != 0) {
        ++end;
      }
      const std::string name = letters.substr(i, end - i);
      i = end;
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      complaints_.Error(codes::kUnknownLetters,
                        complaints_.Span(*table.get("letters")),
                        fmt::format("'{}' of '{}' is no required motion", name, letters),
                        fmt::format("required are: {}", fmt::join(known, ", ")));
    }
  }
}

void StudyReader::ReadMounts(const toml::table& table,
                             const plugin::ModuleDescription& description,
                             StudyModule& module) {
  for (const NamedTable& named : TablesAt(table, "mounts")) {
    MountChoice mount{.name = named.name, .placement = {}};
    mount.placement.position_mm =
        TripleAt(*named.table, "position").value_or(std::array<double, 3>{});
    const auto rotation = TripleAt(*named.table, "rotation").value_or(std::array<double, 3>{});
    for (std::size_t i = 0; i < 3; ++i) mount.placement.rotation_rad[i] = rotation[i] * kRadPerDeg;
    module.mounts.push_back(std::move(mount));
  }
  if (module.mounts.empty()) FindMounts(description, module);
}

/// For every set of required motions with as many letters as the module has the simplest turn by
/// right angles under which it realises them.
void StudyReader::FindMounts(const plugin::ModuleDescription& description, StudyModule& module) {
  const std::size_t size = description.letters.size();
  const std::size_t motions = study_.motions.size();
  std::set<std::array<int, 3>> turns;
  if (size <= motions && motions <= 16) {
    for (unsigned subset = 0; subset < 1U << motions; ++subset) {
      if (static_cast<std::size_t>(std::popcount(subset)) != size) continue;
      std::vector<formula::Axis> wanted;
      for (std::size_t i = 0; i < motions; ++i) {
        if ((subset >> i & 1U) != 0) wanted.push_back(study_.motions[i].axis);
      }
      if (!Asks(module, wanted)) continue;
      // As it stands is best: a mechanism of all three letters of a kind may count along its own.
      if (layout::FitLetters(description.letters, {}, wanted).ok()) {
        turns.insert({0, 0, 0});
      } else if (const auto turn = layout::RotationThatFits(description.letters, wanted)) {
        turns.insert(*turn);
      }
    }
  }
  if (turns.empty()) turns.insert({0, 0, 0});
  for (const std::array<int, 3>& turn : turns) {
    MountChoice mount{.name = turn == std::array<int, 3>{}
                                  ? "level"
                                  : fmt::format("{},{},{}", turn[0], turn[1], turn[2]),
                      .placement = {}};
    for (std::size_t i = 0; i < 3; ++i) mount.placement.rotation_rad[i] = turn[i] * kRadPerDeg;
    module.mounts.push_back(std::move(mount));
  }
}

void StudyReader::ReadModes(const toml::table& table,
                            const plugin::ModuleDescription& description,
                            StudyModule& module) {
  const toml::node* node = table.get("modes");
  if (node == nullptr) return AddMode(DefaultMode(description), module);
  if (node->value_exact<std::string>() == "all") {
    const std::size_t count = description.modes.size();
    if (count > 8) {
      complaints_.Error(codes::kOutOfRange,
                        complaints_.Span(*node),
                        fmt::format("{} modes have more than {} assemblies", count, kMostModes),
                        "list those that matter: modes = [{ q1 = \"+\" }, …]");
      return;
    }
    for (unsigned bits = 0; bits < 1U << count; ++bits) {
      std::vector<int> signs;
      for (std::size_t i = 0; i < count; ++i) signs.push_back((bits >> i & 1U) != 0 ? -1 : 1);
      AddMode(std::move(signs), module);
    }
    return;
  }
  const toml::array* list = node->as_array();
  if (list == nullptr || list->empty()) {
    complaints_.Error(codes::kWrongType,
                      complaints_.Span(*node),
                      "'modes' must be \"all\" or a list of tables",
                      "write modes = [{ q1 = \"+\", q2 = \"-\" }]");
    return;
  }
  for (const toml::node& element : *list) ReadMode(element, description, module);
}

void StudyReader::ReadMode(const toml::node& node,
                           const plugin::ModuleDescription& description,
                           StudyModule& module) {
  const toml::table* table = node.as_table();
  if (table == nullptr) {
    complaints_.Error(codes::kWrongType,
                      complaints_.Span(node),
                      fmt::format("each entry of 'modes' must be a table, not {}", TypeName(node)));
    return;
  }
  std::vector<int> signs = DefaultMode(description);
  const std::vector<std::string> names = NamesOf(description.modes);
  for (const auto& [name, value] : *table) {
    const auto known = std::find(names.begin(), names.end(), name.str());
    const auto sign = SignOf(value);
    if (known == names.end()) {
      complaints_.Error(codes::kUnknownMode,
                        complaints_.Span(name.source()),
                        fmt::format("'{}' has no mode '{}'", description.id, name.str()),
                        DidYouMean(name.str(), names));
    } else if (!sign) {
      complaints_.Error(codes::kWrongType,
                        complaints_.Span(value),
                        fmt::format("'{}' must be \"+\" or \"-\"", name.str()));
    } else {
      signs[static_cast<std::size_t>(known - names.begin())] = *sign;
    }
  }
  AddMode(std::move(signs), module);
}

void StudyReader::ReadDrives(const toml::table& table,
                             const plugin::ModuleDescription& description,
                             StudyModule& module) {
  module.drives.resize(description.drives.size());
  const std::vector<std::string> names = NamesOf(description.drives);
  for (const NamedTable& named : TablesAt(table, "drive")) {
    const auto known = std::find(names.begin(), names.end(), named.name);
    if (known == names.end()) {
      complaints_.Error(codes::kUnknownDrive,
                        complaints_.Span(named.place),
                        fmt::format("'{}' has no drive '{}'", description.id, named.name),
                        DidYouMean(named.name, names));
      continue;
    }
    const auto i = static_cast<std::size_t>(known - names.begin());
    module.drives[i] = ReadDriveTable(*named.table, description.drives[i].rotary);
  }
}

}  // namespace kompono::synthesis
