// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_READER_HPP_
#define KOMPONO_LAYOUT_READER_HPP_

#include "complaints.hpp"
#include "formula_place.hpp"
#include "units.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "kompono/layout/layout.hpp"
#include "kompono/layout/letters.hpp"
#include "kompono/layout/numbers.hpp"

namespace kompono::layout {

/// One [block.<name>] while it is read.
struct BlockDraft {
  Block block;
  const toml::table* table = nullptr;
  const plugin::ModuleDescription* module = nullptr;  ///< null: it was refused
  bool claimed = false;                               ///< a group or axis of the formula uses it
  bool wanted = false;                                ///< one of several that might realise a group
};

/// Reads one layout; first every table by itself, then one against the other. Each step goes on
/// after a complaint, so that all are found in one run.
class LayoutReader {
 public:
  LayoutReader(std::string_view text, std::string_view file, const plugin::Registry& registry);

  [[nodiscard]] Parsed<Layout> Read(Diagnostics* notes);

 private:
  // reader.cpp
  [[nodiscard]] bool ParseToml();
  void ReadUnits();
  void ReadFormula();
  void ReadAxes();
  [[nodiscard]] Axis ReadAxis(const formula::Axis& item, const toml::table* table);
  void JudgeBlockNames();
  void JudgeAxisTables(const std::vector<formula::Axis>& plain);
  void ReadOpenBase();
  [[nodiscard]] Placement ReadPlacement(const toml::table* table) const;

  // blocks.cpp
  void ReadBlocks();
  [[nodiscard]] BlockDraft ReadBlock(std::string_view name, const toml::table& table);
  void ReadModes(BlockDraft& draft);
  void ReadBlockDrives(BlockDraft& draft);
  /// The module that stands in `table`, of the wanted kind; null after a complaint or without one.
  [[nodiscard]] const plugin::ModuleDescription* ReadModule(const toml::table& table,
                                                            plugin::ModuleKind kind);
  void ReadStrutLimits(BlockDraft& draft);
  void ConnectBlocks();
  void ConnectNamed(const std::string& block_name, const std::vector<formula::Axis>& axes);
  void ConnectUnnamed(formula::Group& group);
  void Fit(BlockDraft& draft, const std::vector<formula::Axis>& axes);
  void ReportMisfit(const BlockDraft& draft,
                    const LetterFit& fit,
                    const std::vector<formula::Axis>& axes);
  void ReadCoordinates(BlockDraft& draft);
  [[nodiscard]] std::optional<std::size_t> LocalOf(const BlockDraft& draft,
                                                   const toml::key& letter,
                                                   std::string_view key);

  // ends.cpp
  void ReadEnds();
  [[nodiscard]] End ReadEnd(const std::string& name, const toml::table* table);
  void ReadStation(const toml::table& table, const plugin::ModuleDescription& module, End& end);
  void JudgeStates(const toml::table& table,
                   const plugin::ModuleDescription& module,
                   const End& end);

  // calibration.cpp
  void ReadCalibration();
  void ReadPatterns(const toml::table& table,
                    std::string_view key,
                    std::vector<std::string>& patterns);
  /// None after a complaint.
  [[nodiscard]] std::vector<const Number*> NumbersOfPattern(std::string_view pattern,
                                                            const SourceSpan& place);
  [[nodiscard]] std::optional<double> FactorOfPattern(std::string_view pattern,
                                                      const SourceSpan& place);

  std::string_view text_;
  const plugin::Registry& registry_;
  Complaints complaints_;
  toml::table root_;
  Units units_;
  Layout layout_;
  bool formula_good_ = false;
  bool names_known_ = true;  ///< all blocks and modules were found, so that the numbers have names
  std::unique_ptr<FormulaPlace> formula_place_;  ///< null: there is no formula string
  std::vector<BlockDraft> drafts_;
  std::vector<Number> numbers_;  ///< of a layout that is good so far
};

/// Calls `visit` with every item of the formula that is no fork, forks entered.
void ForEachItem(formula::Formula& formula, const std::function<void(formula::Item&)>& visit);

/// The flat numbers of a module's parameters in mm and rad, or nothing after complaints. `owner` is
/// the table with `module` and perhaps `parameters`.
[[nodiscard]] std::optional<std::vector<double>> ReadParameters(
    const toml::table& owner,
    const plugin::ModuleDescription& module,
    const Units& units,
    Complaints& complaints);

/// What a drive's or axis' table says of the drive; judged before by JudgeShape.
[[nodiscard]] Drive ReadDrive(const toml::table& table, bool rotary, const Units& units);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_READER_HPP_
