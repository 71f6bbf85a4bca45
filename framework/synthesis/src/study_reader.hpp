// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_STUDY_READER_HPP_
#define KOMPONO_SYNTHESIS_STUDY_READER_HPP_

#include "complaints.hpp"
#include "study_keys.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "kompono/synthesis/study.hpp"

namespace kompono::synthesis {

/// Reads one study; each step goes on after a complaint, so that all are found in one run.
class StudyReader {
 public:
  StudyReader(std::string_view text,
              std::string_view file,
              const plugin::Registry& registry,
              std::span<const std::string> metrics);

  [[nodiscard]] Parsed<Study> Read(Diagnostics* notes);

 private:
  // study_reader.cpp
  [[nodiscard]] bool ParseToml();
  void ReadHead();
  void ReadMotions();
  void ReadMotion(const NamedTable& named);
  void ReadEnds();
  void ReadEnd(const NamedTable& named);
  void AddBareEnd(bool part);
  void ReadReference();
  void ReadGoals();
  void JudgeMetric(std::string_view name, const toml::source_region& place);

  // study_modules.cpp
  void ReadModules();
  void ReadModule(const NamedTable& named);
  void ReadLetters(const toml::table& table, StudyModule& module);
  void ReadMounts(const toml::table& table,
                  const plugin::ModuleDescription& description,
                  StudyModule& module);
  void FindMounts(const plugin::ModuleDescription& description, StudyModule& module);
  void ReadModes(const toml::table& table,
                 const plugin::ModuleDescription& description,
                 StudyModule& module);
  void ReadMode(const toml::node& node,
                const plugin::ModuleDescription& description,
                StudyModule& module);
  void ReadDrives(const toml::table& table,
                  const plugin::ModuleDescription& description,
                  StudyModule& module);

  // study_parameters.cpp
  void ReadParameters(const toml::table& table,
                      const plugin::ModuleDescription& description,
                      StudyModule& module);
  void ReadHome(const toml::table& table,
                const plugin::ModuleDescription& description,
                StudyModule& module);
  /// Levels or range of one parameter; false after a complaint.
  bool ReadValues(const toml::node& node,
                  const plugin::ParameterDescription& description,
                  StudyParameter& parameter);
  [[nodiscard]] bool ReadChoices(const toml::table& table,
                                 const plugin::ParameterDescription& description,
                                 StudyParameter& parameter);
  [[nodiscard]] std::optional<Level> ReadLevel(const toml::node& node,
                                               const plugin::ParameterDescription& description);
  /// Numbers of lists in lists, all of them; false after a complaint.
  [[nodiscard]] bool Flatten(const toml::node& node,
                             const plugin::ParameterDescription& description,
                             std::vector<double>& numbers);

  // study_rules.cpp
  void ReadRules();
  void ReadRule(const toml::table& table);
  [[nodiscard]] std::vector<Term> ReadTerms(const toml::node& node, std::string_view key);

  std::string_view text_;
  const plugin::Registry& registry_;
  std::span<const std::string> metrics_;
  Complaints complaints_;
  toml::table root_;
  Study study_;
};

/// Speed, acceleration, stiffness and range of a drive's table.
[[nodiscard]] layout::Drive ReadDriveTable(const toml::table& table, bool rotary);

/// "part" and "tool" in a `sides` key; both if there is none.
[[nodiscard]] Sides ReadSides(const toml::table& table);

inline constexpr double kRadPerDeg = 0.017453292519943295769;

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_STUDY_READER_HPP_
