// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_STUDY_HPP_
#define KOMPONO_SYNTHESIS_STUDY_HPP_

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/formula/formula.hpp"
#include "kompono/layout/layout.hpp"
#include "kompono/plugin/registry.hpp"
#include "kompono/synthesis/space.hpp"

/// A study as a value: what a `layouts/studies/<name>.toml` says, judged and converted to
/// millimetres, radians, seconds and newtons. File format: docs/study-file.md.
///
/// A study names the relative motions that a job needs, the modules that may realise them and the
/// rules that a designer would apply. StudySpace (candidate.hpp) makes a morphological space of it.
namespace kompono::synthesis {

/// Lower and upper end; mm or rad, or a pure number.
struct Interval {
  double lower = 0.0;
  double upper = 0.0;
  [[nodiscard]] double middle() const { return 0.5 * (lower + upper); }
  [[nodiscard]] double width() const { return upper - lower; }
  bool operator==(const Interval&) const = default;
};

/// Which layouts count as one. The coarser ones keep one member of each class: neighbouring
/// translations of one side stand in the order of their texts, and for relative motions all motions
/// stand on the tool side.
enum class Equivalence { kString, kDistribution, kRelativeMotion };

/// One side of the base, or both.
struct Sides {
  bool part = true;
  bool tool = true;
  bool operator==(const Sides&) const = default;
};

/// One required motion of the tool relative to the part.
struct Motion {
  formula::Axis axis;  ///< letter, number, working or setting; never a main-motion spindle
  std::string name;    ///< axis.Name(): "X", "z", "X4"
  Interval range;      ///< work zone: what the tool does as seen from the part; mm or rad
  Sides sides;         ///< where the motion may be
  bool plain = true;   ///< a plain axis may realise it
  /// A point on the plain axis in its carrier, for either side; matters for rotations. mm.
  std::array<double, 3> part_pivot_mm{};
  std::array<double, 3> tool_pivot_mm{};
  layout::Drive drive;  ///< speed, acceleration, stiffness of the plain axis; no limits
  SourceSpan place;
};

/// One value of a module's parameter, all its numbers.
struct Level {
  std::string name;             ///< "820" for a number, "1", "2", … for lists
  std::vector<double> numbers;  ///< mm, rad or pure, as many as the parameter has
};

/// A parameter of a study's module that the study says something of, or the place of the work
/// zone's middle along one of the module's own translations: "home.Y".
struct StudyParameter {
  std::string name;
  int coordinate = -1;  ///< of a home: the local coordinate; -1 for a parameter
  int offset = 0;       ///< first number in the module's parameter vector
  int count = 1;        ///< how many numbers
  bool angle = false;
  /// One: fixed. Several: a feature of the space. None: `range` is given.
  std::vector<Level> levels;
  /// Continuous: for sizing. All numbers of the parameter get the same value.
  std::optional<Interval> range;
  double start = 0.0;  ///< where sizing starts, inside `range`
};

struct MountChoice {
  std::string name;
  layout::Placement placement;  ///< rotation as it is; the position is added to the one that puts
                                ///< the platform's home into the middle of the work zone
};

struct ModeChoice {
  std::string name;        ///< "+-+", one sign for each mode of the module
  std::vector<int> signs;  ///< +1 / -1 in the order of the description
};

/// A mechanism that the study allows, under the name of its block: [modules.<name>].
struct StudyModule {
  std::string name;
  std::string module;                ///< id in the registry
  std::vector<std::string> letters;  ///< sets of motions it may realise, "XY"; empty: all it can
  Sides sides;
  std::vector<MountChoice> mounts;  ///< at least one
  std::vector<ModeChoice> modes;    ///< at least one
  std::vector<StudyParameter> parameters;
  /// Local coordinates in the middle of the work zone as far as one value is given for them, mm; 0
  /// for rotations, whose coordinates count as the motions do. See HomeOf.
  std::vector<double> home;
  std::vector<layout::Drive> drives;  ///< in the order of the module's description
  std::vector<double> defaults;  ///< flat parameter vector with defaults and single levels put in
  SourceSpan place;
};

/// How a chain may end: the leaf with its unit, spindles beside it, whole forks. [ends.<name>].
struct EndChoice {
  std::string name;
  bool part = true;  ///< on the workpiece side
  formula::Chain
      chain;  ///< as the formula has it: leaf first on the part's side, last on the tool's
  std::string chain_text;
  /// Names of required motions that the chain's own axes realise, sorted.
  std::vector<std::string> realises;
  std::vector<std::string> units;  ///< module ids of its leaves' units, sorted
  /// TOML of the tables a layout with this end has besides: [tool], [part1], [axis.Z2],
  /// [block.front]; ends with a line feed or is empty.
  std::string tables;
  SourceSpan place;
};

/// What a rule's side speaks of: alternatives that carry all these tags ("!tag": alternatives
/// without it of features where it occurs).
using Term = std::vector<std::string>;

/// [[rule]]: forbids every pair of alternatives of different features, one meeting each term; with
/// one term only, the alternatives themselves.
struct StudyRule {
  RuleTitle title;           ///< name, kind, reason, author
  std::vector<Term> forbid;  ///< one or two
  /// The first term's item stands nearer to the workpiece than the second's ("forbid_order").
  bool ordered = false;
  bool off = false;
  SourceSpan place;
};

struct Objective {
  std::string metric;
  bool maximise = false;
};

struct Limit {
  std::string metric;
  std::optional<double> lower, upper;
};

struct Study {
  std::string name;
  std::string description;
  Equivalence equivalence = Equivalence::kDistribution;
  std::vector<bool> open_bases{false};  ///< false: one base, true: O|O; one or both
  std::array<double, 3> part_size_mm{};
  double part_mass_kg = 0.0;
  char process_direction = 'z';  ///< of the process or the tool's axis: 'x', 'y' or 'z'
  std::vector<Motion> motions;   ///< in the order of the file
  std::vector<EndChoice> ends;   ///< at least one of each side; bare "part" and "tool" if none
                                 ///< is given
  std::vector<StudyModule> modules;
  std::vector<StudyRule> rules;
  std::vector<Objective> objectives;
  std::vector<Limit> limits;
  std::string reference;  ///< formula of the layout to compare with, or empty
  std::map<std::string, std::string> reference_fix;  ///< feature -> alternative of the reference
  std::filesystem::path file;
  std::string text;
};

/// Reads and judges a study; every problem of the file in one run (codes E08xx; E01xx for chains).
/// `metrics` are the names that objectives and limits may use; empty: they are not judged.
[[nodiscard]] Parsed<Study> ParseStudy(std::string_view text,
                                       std::string_view file,
                                       const plugin::Registry& registry,
                                       std::span<const std::string> metrics = {},
                                       Diagnostics* notes = nullptr);
[[nodiscard]] Parsed<Study> ReadStudy(const std::filesystem::path& file,
                                      const plugin::Registry& registry,
                                      std::span<const std::string> metrics = {},
                                      Diagnostics* notes = nullptr);

/// Whether a TOML text is meant as a study: it has the key `study`.
[[nodiscard]] bool LooksLikeStudy(std::string_view text);

/// JSON Schema (draft 2020-12) of study files for editors, built from the reader's own table of
/// keys.
[[nodiscard]] std::string StudySchema(const plugin::Registry& registry,
                                      std::span<const std::string> metrics = {});

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_STUDY_HPP_
