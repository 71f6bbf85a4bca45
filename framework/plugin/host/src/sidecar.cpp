// SPDX-License-Identifier: Apache-2.0
#include "manifest.hpp"
#include "module_reader.hpp"
#include "sidecar_reading.hpp"
#include "toml_table.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <system_error>
#include <tuple>

#include "kompono/plugin/abi.h"

namespace kompono::plugin {
namespace {

constexpr int kSidecarFormat = 1;

/// Splits "1.0" or "0.1.0-rc1" at its dots; false unless there are `count` whole numbers.
bool ParseNumbers(std::string_view text, int count, int* numbers) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && (at == end || *at++ != '.')) return false;
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc() || numbers[i] < 0) return false;
    at = next;
  }
  return at == end || (count == 3 && *at == '-' && at + 1 != end);
}

bool IsPluginId(std::string_view id) {
  bool dotted = false;
  char before = '.';
  for (const char c : id) {
    const bool word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!word && (c != '.' || before == '.')) return false;
    dotted = dotted || c == '.';
    before = c;
  }
  return dotted && before != '.';
}

void ReadIdentity(TableReader& table, PluginDescription& plugin) {
  plugin.id = table.String("id", Need::kRequired).value_or("");
  if (table.IsString("id") && !IsPluginId(plugin.id)) {
    table.Complain("E0224",
                   "id",
                   fmt::format("'{}' is no id of a plugin", plugin.id),
                   "an id is lower-case words joined by dots, as in org.example.crane");
  }
  plugin.version = table.String("version", Need::kRequired).value_or("");
  int numbers[3] = {};
  if (table.IsString("version") && !ParseNumbers(plugin.version, 3, numbers)) {
    table.Complain("E0224",
                   "version",
                   fmt::format("'{}' is no version", plugin.version),
                   "a version is three numbers, as in 0.1.0");
  }
}

/// False if the sidecar was written for another kompono, when nothing else can be held against it.
bool ReadContract(TableReader& table, PluginDescription& plugin) {
  const std::optional<int> format = table.Integer("kompono", Need::kRequired);
  const std::string contract = table.String("contract", Need::kRequired).value_or("");
  int numbers[2] = {};
  if (format && *format != kSidecarFormat) {
    table.Complain(
        *format > kSidecarFormat ? "E0203" : "E0224",
        "kompono",
        fmt::format(
            "this sidecar has format {}, this kompono reads format {}", *format, kSidecarFormat),
        *format > kSidecarFormat ? "install a newer kompono" : "");
    return false;
  }
  if (!table.IsString("contract")) return true;
  if (!ParseNumbers(contract, 2, numbers)) {
    table.Complain(
        "E0224",
        "contract",
        fmt::format("'{}' is no contract version", contract),
        fmt::format(
            "this kompono offers contract {}.{}", KOMPONO_CONTRACT_MAJOR, KOMPONO_CONTRACT_MINOR));
    return true;
  }
  std::tie(plugin.contract_major, plugin.contract_minor) = std::tie(numbers[0], numbers[1]);
  if (auto refusal = JudgeContract(numbers[0], numbers[1])) {
    table.Complain(refusal->code, "contract", refusal->message, refusal->help);
    return false;
  }
  return true;
}

void ReadLibrary(TableReader& table, PluginDescription& plugin) {
  plugin.library = table.String("library", Need::kOptional).value_or("");
  const std::string& name = plugin.library;
  if (!table.IsString("library")) return;
  if (name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos ||
      name.find('\0') != std::string::npos) {
    table.Complain("E0224",
                   "library",
                   fmt::format("'{}' is not the plain name of a file", name),
                   "the library stands beside its plugin.toml; paths are not followed");
    plugin.library.clear();
  }
}

void ReadModules(TableReader& table, Sidecar& sidecar) {
  std::map<std::string, int> taken;
  const auto refuse_second = [&taken](TableReader& entry, const std::string& id) {
    if (!id.empty() && taken[id]++ > 0)
      entry.Complain("E0225", "id", fmt::format("'{}' is given twice", id));
  };
  for (TableReader& entry : table.Tables("module")) {
    ModuleDescription module = ReadModule(entry);
    refuse_second(entry, module.id);
    module.plugin_id = sidecar.plugin.id;
    module.plugin_version = sidecar.plugin.version;
    sidecar.plugin.modules.push_back(std::move(module));
  }
  for (TableReader& entry : table.Tables("preset")) {
    PresetDescription preset = ReadPreset(entry);
    refuse_second(entry, preset.own.id);
    preset.own.plugin_id = sidecar.plugin.id;
    preset.own.plugin_version = sidecar.plugin.version;
    sidecar.presets.push_back(std::move(preset));
  }
  if (!sidecar.plugin.modules.empty() && !table.Has("library")) {
    table.Complain("E0222",
                   "library",
                   "'library' is missing",
                   "modules need the library that holds their code; only presets do without");
  }
  if (sidecar.plugin.modules.empty() && table.Has("library"))
    table.Complain("E0222", "module", "there is a library but no [[module]]");
  if (!table.Has("module") && !table.Has("preset") && !table.Has("library"))
    table.Complain("E0222", "module", "there is neither a [[module]] nor a [[preset]]");
}

void ReadTable(const toml::table& root, Complaints& complaints, Sidecar& sidecar) {
  TableReader table(root, "", complaints);
  ReadIdentity(table, sidecar.plugin);
  if (!ReadContract(table, sidecar.plugin)) return;
  ReadLibrary(table, sidecar.plugin);
  ReadModules(table, sidecar);
  table.RefuseUnknownKeys();
}

Diagnostics InOrderOfPlaces(Diagnostics problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.span.line, a.span.column) < std::tie(b.span.line, b.span.column);
  });
  return problems;
}

}  // namespace

SidecarReading ReadLeniently(std::string_view text, std::string_view file) {
  SidecarReading reading;
  reading.sidecar.plugin.sidecar = std::filesystem::path(file);
  Complaints complaints(text, file);
  try {
    const toml::table root = toml::parse(text);
    ReadTable(root, complaints, reading.sidecar);
  } catch (const toml::parse_error& error) {
    complaints.Add("E0220",
                   complaints.Span(error.source()),
                   fmt::format("this is not TOML: {}", error.description()));
  }
  reading.problems = InOrderOfPlaces(complaints.Take());
  return reading;
}

SidecarReading ReadFileLeniently(const std::filesystem::path& file) {
  const auto unreadable = [&file](std::string_view why) {
    SidecarReading reading;
    reading.sidecar.plugin.sidecar = file;
    reading.problems.push_back({.code = "E0220",
                                .file = file.string(),
                                .message = fmt::format("this file cannot be read: {}", why)});
    return reading;
  };
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    return unreadable("it is not a file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return unreadable(std::strerror(errno));
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  return ReadLeniently(text, file.string());
}

Parsed<Sidecar> ParseSidecar(std::string_view text, std::string_view file) {
  SidecarReading reading = ReadLeniently(text, file);
  if (HasErrors(reading.problems)) return tl::unexpected(std::move(reading.problems));
  return std::move(reading.sidecar);
}

Parsed<Sidecar> ReadSidecar(const std::filesystem::path& file) {
  SidecarReading reading = ReadFileLeniently(file);
  if (HasErrors(reading.problems)) return tl::unexpected(std::move(reading.problems));
  return std::move(reading.sidecar);
}

}  // namespace kompono::plugin
