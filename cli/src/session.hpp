// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_SESSION_HPP_
#define KOMPONO_CLI_SESSION_HPP_

#include "console.hpp"
#include "exit_code.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kompono/kinematics/machine.hpp"
#include "kompono/layout/layout.hpp"
#include "kompono/plugin/registry.hpp"

/// What the subcommands share.
namespace kompono::cli {

/// What may stand in an argument, for the shells' completion.
struct ValueHint {
  enum class Kind { kAny, kFile, kFolder, kWords, kModule } kind = Kind::kAny;
  std::vector<std::string> words;
};

class Session {
 public:
  using Run = std::function<ExitCode()>;

  Console console;
  std::vector<std::string> plugin_dirs;  ///< --plugin-dir
  bool json = false;
  std::string color = "auto";

  /// A subcommand: what it is for in a line, examples for its help, what runs.
  CLI::App* Command(CLI::App& parent,
                    const std::string& name,
                    const std::string& title,
                    const std::string& examples);
  void OnRun(const CLI::App* command, Run run) { runs_[command] = std::move(run); }
  [[nodiscard]] const Run* RunOf(const CLI::App* command) const;

  void Hint(const CLI::Option* option, ValueHint::Kind kind) { hints_[option].kind = kind; }
  /// The option takes one of `words`, which are checked when parsing.
  void Choices(CLI::Option* option, std::vector<std::string> words);
  [[nodiscard]] ValueHint HintOf(const CLI::Option* option) const;

  /// The plugins found; searched for once.
  plugin::Registry& registry();

  /// The layout of `file`, notes and complaints reported; nothing if it is not usable, `code` then
  /// says why.
  [[nodiscard]] std::optional<layout::Layout> ReadLayout(const std::string& file, ExitCode& code);
  /// The machine of `file` likewise.
  [[nodiscard]] std::optional<kinematics::Machine> ReadMachine(const std::string& file,
                                                               ExitCode& code);

  /// Reports them and says with what to leave.
  ExitCode Refuse(const Diagnostics& diagnostics);
  ExitCode Refuse(const Diagnostic& diagnostic) { return Refuse(Diagnostics{diagnostic}); }

 private:
  std::map<const CLI::App*, Run> runs_;
  std::map<const CLI::Option*, ValueHint> hints_;
  std::optional<plugin::Registry> registry_;
};

/// Each adds one subcommand, see the file of that name.
void AddPlugins(CLI::App& root, Session& session);
void AddFormula(CLI::App& root, Session& session);
void AddCheck(CLI::App& root, Session& session);
void AddSchema(CLI::App& root, Session& session);
void AddDescribe(CLI::App& root, Session& session);
void AddSolve(CLI::App& root, Session& session);
void AddAnalyze(CLI::App& root, Session& session);
void AddSynthesize(CLI::App& root, Session& session);
void AddMeasure(CLI::App& root, Session& session);
void AddCalibrate(CLI::App& root, Session& session);
/// A subcommand of calibrate.
void AddCalibratePlan(CLI::App& calibrate, Session& session);
void AddErrorBudget(CLI::App& root, Session& session);
void AddCompensate(CLI::App& root, Session& session);
void AddCatalog(CLI::App& root, Session& session);
void AddExport(CLI::App& root, Session& session);
void AddImport(CLI::App& root, Session& session);
/// Subcommands of import.
void AddImportKlipperConfig(CLI::App& import, Session& session);
void AddImportTracker(CLI::App& import, Session& session);
void AddCompletion(CLI::App& root, Session& session);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_SESSION_HPP_
