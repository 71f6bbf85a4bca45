// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_DESCRIPTION_HPP_
#define KOMPONO_PLUGIN_DESCRIPTION_HPP_

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

/// What a sidecar `plugin.toml` says. Listing, checking and editing layouts need only this: no
/// plugin code runs.
namespace kompono::plugin {

enum class ModuleKind { kMechanism, kUnit };

/// "number", "numbers[3]", "point" or "points[6]".
enum class ParameterShape { kNumber, kNumbers, kPoint, kPoints };

struct ParameterDescription {
  std::string name;
  ParameterShape shape = ParameterShape::kNumber;
  int count = 1;        ///< how many numbers or points
  std::string unit;     ///< "mm", "deg" or "1": the unit of default, range and tolerance below
  std::string meaning;  ///< one sentence for people
  std::vector<double> default_value;  ///< flat, in `unit`; empty: the layout must give it
  std::optional<double> lower;        ///< of every single number, in `unit`
  std::optional<double> upper;
  std::optional<double> tolerance;  ///< manufacturing tolerance (one standard deviation), in `unit`
  bool identifiable = true;
  bool fixed = false;  ///< set by a preset: a layout may not give it
  int offset = 0;      ///< first number in the module's parameter vector

  [[nodiscard]] int Numbers() const;  ///< scalars in all: a point counts three
  [[nodiscard]] bool angle() const { return unit == "deg"; }
  /// Factor from `unit` to millimetres or radians.
  [[nodiscard]] double ToInternal() const;
  /// Names of the single numbers: "L1"; "arm[2]" (counted from 1); "foot.x"; "base[3].z".
  [[nodiscard]] std::vector<std::string> NumberNames() const;
};

struct DriveDescription {
  std::string name;
  bool rotary = false;
};

struct ModeDescription {
  std::string name;
  int default_sign = 1;  ///< +1 or -1
  std::string meaning;
};

/// A line between two named points of the skeleton, for drawing, clearances and strut tables.
struct LinkDescription {
  std::string from, to;
  std::string kind;  ///< "strut", "rail", "platform", "base"
};

/// Links and kinematic pairs for mobility (KDD eq. 1); pairs by their letters: R P C U S.
struct StructureDescription {
  int links = 0;  ///< base and platform count once each
  std::map<std::string, int> pairs;
  bool planar = false;  ///< moves in one plane: a link has 3 freedoms, not 6
};

struct ModuleDescription {
  std::string id;  ///< "pyramid"
  ModuleKind kind = ModuleKind::kMechanism;
  std::string title;
  std::string summary;
  std::string letters;  ///< local coordinates in order, "XYZ"; empty for units
  std::vector<DriveDescription> drives;
  std::vector<ParameterDescription> parameters;
  std::vector<ModeDescription> modes;
  std::vector<std::string> points;  ///< names of the skeleton's points
  std::vector<LinkDescription> links;
  std::optional<StructureDescription> structure;
  std::vector<std::string> stations;  ///< of a unit
  int states = 1;                     ///< of a unit: discrete positions; 1 if it does not move
  /// Of a unit: the parameter that says how many of its stations "front1", "front2", … and how many
  /// of its states there are; empty if all of them always are.
  std::string counted_by;
  std::vector<std::string> capabilities;
  std::vector<std::string> sources;
  std::string implementation;  ///< the module whose code runs: itself, or what a preset stands on
  std::string plugin_id;
  std::string plugin_version;

  [[nodiscard]] int ParameterNumbers() const;
  [[nodiscard]] const ParameterDescription* FindParameter(std::string_view name) const;
};

/// One plugin.toml.
struct PluginDescription {
  std::string id;
  std::string version;
  int contract_major = 0;
  int contract_minor = 0;
  std::string library;  ///< file beside the sidecar; empty for a plugin of presets
  std::filesystem::path sidecar;
  std::vector<ModuleDescription> modules;
};

/// Reads and judges one sidecar. Presets stay unresolved: their `implementation` names the other
/// module and only what they say themselves is filled in.
struct PresetDescription {
  ModuleDescription own;  ///< id, title, summary and what overrides the base
  std::map<std::string, std::vector<double>>
      fixed;  ///< parameter -> numbers a layout may not change
  std::map<std::string, std::vector<double>>
      defaults;  ///< parameter -> numbers a layout may change
  std::map<std::string, int> mode_defaults;
  std::map<std::string, SourceSpan>
      places;  ///< where "of", "fixed.<name>", "defaults.<name>" and "modes.<name>" stand
};

struct Sidecar {
  PluginDescription plugin;
  std::vector<PresetDescription> presets;
};

[[nodiscard]] Parsed<Sidecar> ReadSidecar(const std::filesystem::path& file);
[[nodiscard]] Parsed<Sidecar> ParseSidecar(std::string_view text, std::string_view file);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_DESCRIPTION_HPP_
