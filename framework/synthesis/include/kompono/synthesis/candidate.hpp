// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_CANDIDATE_HPP_
#define KOMPONO_SYNTHESIS_CANDIDATE_HPP_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/formula/formula.hpp"
#include "kompono/plugin/registry.hpp"
#include "kompono/synthesis/space.hpp"
#include "kompono/synthesis/study.hpp"

/// From a study to its space, and from a selection of the space to a layout.
///
///     Parsed<StudySpace> space = StudySpace::Build(study, registry);
///     const Enumeration all(space->space());
///     const Candidate candidate = space->At(all.Unrank(17));
///     std::string toml = LayoutText(*space, candidate);
///
/// Features, in this order: `grouping` (which motions are plain axes, which modules realise the
/// others), `part_end`, `tool_end`, `base`, the places `p1`, `p2`, … from the workpiece to the tool
/// (an item on the part's side, O, an item on the tool's side, or "-" behind the last one), then
/// for each module `<name>.mount`, `<name>.mode` and `<name>.<parameter>` as far as there is
/// something to choose ("none" where the module is not used).
///
/// Tags for rules: `plain:X`, `block:drive`, `module:lambda`, `item:(XY):drive` on groupings;
/// `end:sheet`, `unit:jet_head` on ends; `base:open`; on items at their places `motion:X`,
/// `part:X`, `tool:X`, `part:drive`, `part:translation`, `tool:rotation` (at least one),
/// `side:part`, `place:1`; `mount:drive=flat`, `mode:drive=++-`, `level:drive.L2=820`.
namespace kompono::synthesis {

/// A plain axis or a group that a module realises.
struct Item {
  std::string text;          ///< as in the formula: "X", "(XY):drive"
  std::vector<int> motions;  ///< in Study::motions, in the formula's order
  int module = -1;           ///< in Study::modules; -1: a plain axis
  bool translates = true;    ///< only translations: commutes with a translation beside it
};

/// Light: numbers only. Names and texts come from the StudySpace.
struct Candidate {
  std::uint64_t index = 0;  ///< as the Enumeration counts; 0 if it was made by At
  struct Placed {
    int item = 0;  ///< in StudySpace::items
    bool part_side = false;
  };
  std::vector<Placed> chain;  ///< from workpiece to tool, the ends' own axes not included
  int part_end = 0;           ///< in Study::ends
  int tool_end = 0;
  bool open_base = false;
  struct Block {
    int module = 0;           ///< in Study::modules
    int item = 0;             ///< in StudySpace::items
    int mount = 0;            ///< in StudyModule::mounts
    int mode = 0;             ///< in StudyModule::modes
    std::vector<int> levels;  ///< for each StudyParameter; -1 for a continuous one
  };
  std::vector<Block> blocks;  ///< those that the grouping uses, in the order of Study::modules
};

/// A value that sizing has found for a continuous parameter.
struct Size {
  int module = 0;      ///< in Study::modules
  int parameter = 0;   ///< in StudyModule::parameters
  double value = 0.0;  ///< mm, rad or pure
};

/// Immutable; may be used by several threads. The registry must outlive it.
class StudySpace {
 public:
  /// E08xx when nothing is left, a module realises nothing, a tag or feature is unknown, or an
  /// alternative makes layouts that cannot be read.
  [[nodiscard]] static Parsed<StudySpace> Build(Study study,
                                                const plugin::Registry& registry,
                                                Diagnostics* notes = nullptr);

  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] const plugin::Registry& registry() const { return *registry_; }
  [[nodiscard]] const Space& space() const { return space_; }
  [[nodiscard]] Space& space() { return space_; }  ///< to switch rules off
  [[nodiscard]] const std::vector<Item>& items() const { return items_; }

  [[nodiscard]] Candidate At(const Selection& selection, std::uint64_t index = 0) const;
  [[nodiscard]] formula::Formula FormulaOf(const Candidate& candidate) const;

  /// The choices that leave only candidates with this formula (canonical texts equal); nothing if
  /// no selection has it.
  [[nodiscard]] std::optional<Fixing> FixFormula(const formula::Formula& formula) const;
  /// "drive.mount=flat": the choice, or why there is none (E08xx).
  [[nodiscard]] tl::expected<Choice, Diagnostic> ParseChoice(std::string_view text) const;

 private:
  friend class StudySpaceBuilder;
  StudySpace() = default;

  /// What an alternative of `grouping` means.
  struct Grouping {
    std::vector<int> items;                       ///< in items_
    std::vector<std::string> part_end, tool_end;  ///< motions that the ends realise
  };
  /// What an alternative of a place means.
  struct PlaceMeaning {
    enum class Kind { kEmpty, kBase, kItem } kind = Kind::kEmpty;
    int item = 0;
    bool part_side = false;
    bool operator==(const PlaceMeaning&) const = default;
  };
  /// Features of a module; -1 for one that has a single alternative.
  struct ModuleFeatures {
    int mount = -1;
    int mode = -1;
    std::vector<int> parameters;
  };

  [[nodiscard]] std::optional<Fixing> FixChains(const formula::Chain& left,
                                                const formula::Chain& right) const;
  void SortTranslations(std::vector<Candidate::Placed>& placed) const;

  Study study_;
  const plugin::Registry* registry_ = nullptr;
  Space space_;
  std::vector<Item> items_;
  std::vector<Grouping> groupings_;
  std::vector<PlaceMeaning> places_;        ///< alternatives of every place
  std::vector<int> part_ends_, tool_ends_;  ///< alternatives -> Study::ends
  int grouping_feature_ = 0;
  int part_end_feature_ = 0, tool_end_feature_ = 0, base_feature_ = 0;
  int first_place_ = 0, place_count_ = 0;
  std::vector<ModuleFeatures> module_features_;
};

/// An ordinary layout file, which kompono_layout reads without complaint. All coordinates count so
/// that the tool's pose in the part is the values of the motions; at the middle of the work zone
/// every mechanism stands at its home. `sizes`: values of continuous parameters; those that are not
/// given stand at their start.
[[nodiscard]] std::string LayoutText(const StudySpace& space,
                                     const Candidate& candidate,
                                     std::span<const Size> sizes = {});

/// The block's local coordinates in the middle of the work zone; mm, 0 for rotations.
[[nodiscard]] std::vector<double> HomeOf(const StudySpace& space,
                                         const Candidate::Block& block,
                                         std::span<const Size> sizes = {});

/// The block's flat parameter vector (mm, rad) with levels and sizes put in.
[[nodiscard]] std::vector<double> ParametersOf(const StudySpace& space,
                                               const Candidate::Block& block,
                                               std::span<const Size> sizes = {});

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_CANDIDATE_HPP_
