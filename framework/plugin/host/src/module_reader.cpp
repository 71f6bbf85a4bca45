// SPDX-License-Identifier: Apache-2.0
#include "module_reader.hpp"

#include "parameter_reader.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/plugin/capability_words.hpp"

namespace kompono::plugin {
namespace {

/// ISO 841's letters of motion; which way each moves is fixed in kompono/geometry/pose.hpp.
constexpr std::string_view kLetters = "XYZUVWPQRABCDE";
constexpr std::string_view kPairs = "RPCUS";

bool IsLower(char c) {
  return c >= 'a' && c <= 'z';
}
bool IsUpper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Reads a name and sees that it is one and that it was not given before.
std::string ReadName(TableReader& table, std::string_view key, std::set<std::string>& taken) {
  std::string name = table.String(key, Need::kRequired).value_or("");
  if (!table.IsString(key)) return name;
  if (!IsName(name)) {
    table.Complain("E0224",
                   key,
                   fmt::format("'{}' is no name", name),
                   "a name is letters, digits and '_', and begins with a letter");
  } else if (!taken.insert(name).second) {
    table.Complain("E0225", key, fmt::format("'{}' is given twice", name));
  }
  return name;
}

std::vector<std::string> PlainStrings(TableReader& table, std::string_view key) {
  std::vector<std::string> values;
  for (Placed<std::string>& string : table.Strings(key)) values.push_back(std::move(string.value));
  return values;
}

/// Words of the vocabulary, or a plugin's own, which have a dot.
std::vector<std::string> ReadCapabilities(TableReader& table) {
  std::vector<std::string> known;
  known.reserve(std::size(kCapabilityWords));
  for (const CapabilityWord& word : kCapabilityWords) known.emplace_back(word.word);
  std::vector<std::string> out;
  for (Placed<std::string>& word : table.Strings("capabilities")) {
    const bool listed = std::find(known.begin(), known.end(), word.value) != known.end();
    if (!listed && word.value.find('.') == std::string::npos) {
      table.complaints().Add(
          "E0224",
          word.span,
          fmt::format("'{}' is no word for a capability", word.value),
          DidYouMean(word.value, known) + " (a word of your own has a dot: \"example.milling\")");
    } else if (std::find(out.begin(), out.end(), word.value) != out.end()) {
      table.complaints().Add("E0225", word.span, fmt::format("'{}' is given twice", word.value));
    } else {
      out.push_back(std::move(word.value));
    }
  }
  return out;
}

std::vector<std::string> ReadNames(TableReader& table,
                                   std::string_view key,
                                   Complaints& complaints) {
  std::vector<std::string> names;
  for (Placed<std::string>& name : table.Strings(key)) {
    if (!IsName(name.value)) {
      complaints.Add("E0224",
                     name.span,
                     fmt::format("'{}' is no name", name.value),
                     "a name is letters, digits and '_', and begins with a letter");
    } else if (std::find(names.begin(), names.end(), name.value) != names.end()) {
      complaints.Add("E0225", name.span, fmt::format("'{}' is given twice", name.value));
    } else {
      names.push_back(std::move(name.value));
    }
  }
  return names;
}

std::string ReadLetters(TableReader& table) {
  std::string letters = table.String("letters", Need::kRequired).value_or("");
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (kLetters.find(letters[i]) == std::string_view::npos) {
      table.Complain("E0224",
                     "letters",
                     fmt::format("'{}' is no letter of motion", letters[i]),
                     fmt::format("letters are {}", kLetters));
    } else if (letters.find(letters[i]) < i) {
      table.Complain("E0225", "letters", fmt::format("letter {} is given twice", letters[i]));
    }
  }
  if (letters.empty() && table.Has("letters"))
    table.Complain("E0224", "letters", "a mechanism has at least one letter");
  return letters;
}

std::vector<DriveDescription> ReadDrives(TableReader& table) {
  std::vector<DriveDescription> drives;
  std::set<std::string> taken;
  for (TableReader& entry : table.Tables("drives")) {
    entry.Rename("a drive");
    DriveDescription drive;
    drive.name = ReadName(entry, "name", taken);
    const auto kind = ReadWord(entry, "kind", Need::kRequired, {"linear", "rotary"});
    drive.rotary = kind == "rotary";
    entry.RefuseUnknownKeys();
    drives.push_back(std::move(drive));
  }
  if (!table.Has("drives")) {
    table.Complain("E0222", "drives", fmt::format("{} has no 'drives'", table.name()));
  } else if (drives.empty() && table.IsArray("drives")) {
    table.Complain("E0224", "drives", "a mechanism has at least one drive");
  }
  return drives;
}

std::vector<ModeDescription> ReadModes(TableReader& table) {
  std::vector<ModeDescription> modes;
  std::set<std::string> taken;
  for (TableReader& entry : table.Tables("modes")) {
    entry.Rename("a mode");
    ModeDescription mode;
    mode.name = ReadName(entry, "name", taken);
    const auto sign = ReadWord(entry, "default", Need::kOptional, {"+", "-"});
    mode.default_sign = sign == "-" ? -1 : 1;
    mode.meaning = entry.String("meaning", Need::kOptional).value_or("");
    entry.RefuseUnknownKeys();
    modes.push_back(std::move(mode));
  }
  return modes;
}

std::vector<LinkDescription> ReadLinks(TableReader& table, const std::vector<std::string>& points) {
  std::vector<LinkDescription> links;
  for (TableReader& entry : table.Tables("links")) {
    entry.Rename("a link");
    LinkDescription link;
    const auto end = [&entry, &points](std::string_view key) {
      std::string name = entry.String(key, Need::kRequired).value_or("");
      if (entry.IsString(key) && std::find(points.begin(), points.end(), name) == points.end()) {
        entry.Complain("E0226",
                       key,
                       fmt::format("'{}' is not one of this module's points", name),
                       DidYouMean(name, points));
      }
      return name;
    };
    link.from = end("from");
    link.to = end("to");
    link.kind = ReadWord(entry, "kind", Need::kRequired, {"strut", "rail", "platform", "base"});
    entry.RefuseUnknownKeys();
    links.push_back(std::move(link));
  }
  return links;
}

std::optional<StructureDescription> ReadStructure(TableReader& table) {
  std::optional<TableReader> entry = table.Table("structure");
  if (!entry) return std::nullopt;
  StructureDescription structure;
  structure.links = entry->Integer("links", Need::kRequired).value_or(0);
  if (entry->Has("links") && structure.links < 2)
    entry->Complain("E0224", "links", "a structure has at least two links, base and platform");
  if (std::optional<TableReader> pairs = entry->Table("pairs")) {
    pairs->Rename("'pairs'");
    for (const char letter : kPairs) {
      const std::string key(1, letter);
      const std::optional<int> count = pairs->Integer(key, Need::kOptional);
      if (!count) continue;
      if (*count < 1) pairs->Complain("E0224", key, "a number of pairs is at least 1");
      structure.pairs[key] = *count;
    }
    pairs->RefuseUnknownKeys();
  } else if (!entry->Has("pairs")) {
    entry->Complain("E0222", "pairs", "'structure' has no 'pairs'");
  }
  structure.planar = entry->Bool("planar").value_or(false);
  entry->RefuseUnknownKeys();
  return structure;
}

std::vector<ParameterDescription> ReadParameters(TableReader& table) {
  std::vector<ParameterDescription> parameters;
  std::set<std::string> taken;
  int offset = 0;
  for (TableReader& entry : table.Tables("parameter")) {
    entry.Rename("a parameter");
    const std::string name = ReadName(entry, "name", taken);
    if (!name.empty()) entry.Rename(fmt::format("parameter '{}'", name));
    ParameterDescription parameter = ReadParameter(entry);
    parameter.name = name;
    parameter.offset = offset;
    offset += parameter.Numbers();
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

std::string ReadModuleId(TableReader& table, std::string_view what) {
  std::string id = table.String("id", Need::kRequired).value_or("");
  if (!table.IsString("id")) return id;
  table.Rename(fmt::format("{} '{}'", what, id));
  if (!IsModuleId(id)) {
    table.Complain("E0224",
                   "id",
                   fmt::format("'{}' is no id of a module", id),
                   "an id is lower-case letters, digits and '_', and begins with a letter");
  }
  return id;
}

/// The discrete positions of a unit and the parameter that counts them.
void ReadStates(TableReader& table, ModuleDescription& module) {
  module.states = table.Integer("states", Need::kOptional).value_or(1);
  if (module.states < 1) {
    table.Complain("E0224", "states", "a unit has at least one state");
    module.states = 1;
  }
  module.counted_by = table.String("counted_by", Need::kOptional).value_or("");
}

/// `counted_by` must name a plain number without unit.
void JudgeCounter(TableReader& table, const ModuleDescription& module) {
  if (module.counted_by.empty()) return;
  std::vector<std::string> names;
  for (const ParameterDescription& parameter : module.parameters) {
    if (parameter.unit == "1" && parameter.shape == ParameterShape::kNumber)
      names.push_back(parameter.name);
  }
  if (std::find(names.begin(), names.end(), module.counted_by) != names.end()) return;
  table.Complain(
      "E0226",
      "counted_by",
      fmt::format("'{}' is no parameter that counts: a number in unit \"1\"", module.counted_by),
      DidYouMean(module.counted_by, names));
}

/// A wrong or missing kind must not bring a row of complaints about the rest with it.
ModuleKind ReadKind(TableReader& table) {
  const std::string kind = ReadWord(table, "kind", Need::kRequired, {"mechanism", "unit"});
  if (!kind.empty()) return kind == "unit" ? ModuleKind::kUnit : ModuleKind::kMechanism;
  return table.Has("stations") ? ModuleKind::kUnit : ModuleKind::kMechanism;
}

}  // namespace

bool IsModuleId(std::string_view word) {
  return !word.empty() && IsLower(word.front()) &&
         std::all_of(
             word.begin(), word.end(), [](char c) { return IsLower(c) || IsDigit(c) || c == '_'; });
}

bool IsName(std::string_view word) {
  return !word.empty() && (IsLower(word.front()) || IsUpper(word.front())) &&
         std::all_of(word.begin(), word.end(), [](char c) {
           return IsLower(c) || IsUpper(c) || IsDigit(c) || c == '_';
         });
}

ModuleDescription ReadModule(TableReader& table) {
  table.Rename("a module");
  ModuleDescription module;
  module.id = ReadModuleId(table, "module");
  module.implementation = module.id;
  module.kind = ReadKind(table);
  module.title = table.String("title", Need::kRequired).value_or("");
  module.summary = table.String("summary", Need::kOptional).value_or("");
  if (module.kind == ModuleKind::kMechanism) {
    module.letters = ReadLetters(table);
    module.drives = ReadDrives(table);
    module.modes = ReadModes(table);
    module.points = ReadNames(table, "points", table.complaints());
    module.links = ReadLinks(table, module.points);
    module.structure = ReadStructure(table);
  } else {
    module.stations = ReadNames(table, "stations", table.complaints());
    if (!table.Has("stations"))
      table.Complain("E0222", "stations", fmt::format("{} has no 'stations'", table.name()));
    else if (module.stations.empty() && table.IsArray("stations"))
      table.Complain("E0224", "stations", "a unit has at least one station");
    ReadStates(table, module);
  }
  module.capabilities = ReadCapabilities(table);
  module.sources = PlainStrings(table, "sources");
  module.parameters = ReadParameters(table);
  JudgeCounter(table, module);
  table.RefuseUnknownKeys();
  return module;
}

PresetDescription ReadPreset(TableReader& table) {
  table.Rename("a preset");
  PresetDescription preset;
  preset.own.id = ReadModuleId(table, "preset");
  preset.own.implementation = table.String("of", Need::kRequired).value_or("");
  preset.places["of"] = table.At("of");
  preset.own.title = table.String("title", Need::kRequired).value_or("");
  preset.own.summary = table.String("summary", Need::kOptional).value_or("");
  const auto numbers = [&table, &preset](std::string_view key, auto& into) {
    std::optional<TableReader> entry = table.Table(key);
    if (!entry) return;
    for (const std::string& name : entry->Keys()) {
      if (auto values = entry->FlatNumbers(name)) into[name] = std::move(*values);
      preset.places[fmt::format("{}.{}", key, name)] = entry->At(name);
    }
  };
  numbers("fixed", preset.fixed);
  numbers("defaults", preset.defaults);
  if (std::optional<TableReader> entry = table.Table("modes")) {
    for (const std::string& name : entry->Keys()) {
      const std::string sign = ReadWord(*entry, name, Need::kOptional, {"+", "-"});
      if (!sign.empty()) preset.mode_defaults[name] = sign == "-" ? -1 : 1;
      preset.places["modes." + name] = entry->At(name);
    }
  }
  for (const auto& [name, values] : preset.fixed) {
    if (preset.defaults.contains(name)) {
      table.Complain(
          "E0225", "defaults", fmt::format("'{}' stands in 'fixed' and in 'defaults'", name));
    }
  }
  preset.own.capabilities = ReadCapabilities(table);
  preset.own.sources = PlainStrings(table, "sources");
  table.RefuseUnknownKeys();
  return preset;
}

}  // namespace kompono::plugin
