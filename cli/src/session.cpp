// SPDX-License-Identifier: Apache-2.0
#include "session.hpp"

#include <filesystem>
#include <utility>

namespace kompono::cli {

CLI::App* Session::Command(CLI::App& parent,
                           const std::string& name,
                           const std::string& title,
                           const std::string& examples) {
  CLI::App* command = parent.add_subcommand(name, title);
  command->footer(examples);  // the help formatter puts it on top
  return command;
}

const Session::Run* Session::RunOf(const CLI::App* command) const {
  const auto found = runs_.find(command);
  return found == runs_.end() ? nullptr : &found->second;
}

void Session::Choices(CLI::Option* option, std::vector<std::string> words) {
  option->check(CLI::Validator(
      [words](std::string& value) {
        for (const std::string& word : words) {
          if (value == word) return std::string();
        }
        std::string known;
        for (const std::string& word : words) known += (known.empty() ? "" : ", ") + word;
        return "'" + value + "' is none of " + known;
      },
      ""));
  hints_[option] = {.kind = ValueHint::Kind::kWords, .words = std::move(words)};
}

ValueHint Session::HintOf(const CLI::Option* option) const {
  const auto found = hints_.find(option);
  return found == hints_.end() ? ValueHint{} : found->second;
}

plugin::Registry& Session::registry() {
  if (!registry_) {
    const std::vector<std::filesystem::path> given(plugin_dirs.begin(), plugin_dirs.end());
    registry_ = plugin::Registry::Discover(plugin::PluginFolders(given));
  }
  return *registry_;
}

std::optional<layout::Layout> Session::ReadLayout(const std::string& file, ExitCode& code) {
  Diagnostics notes;
  Parsed<layout::Layout> layout = layout::ReadLayout(file, registry(), &notes);
  if (!layout) {
    notes.insert(notes.end(), layout.error().begin(), layout.error().end());
    code = Refuse(notes);
    return std::nullopt;
  }
  console.Report(notes);
  return std::move(*layout);
}

std::optional<kinematics::Machine> Session::ReadMachine(const std::string& file, ExitCode& code) {
  std::optional<layout::Layout> layout = ReadLayout(file, code);
  if (!layout) return std::nullopt;
  Parsed<kinematics::Machine> machine = kinematics::Machine::Build(*std::move(layout), registry());
  if (!machine) {
    code = Refuse(machine.error());
    return std::nullopt;
  }
  return std::move(*machine);
}

ExitCode Session::Refuse(const Diagnostics& diagnostics) {
  console.Report(diagnostics);
  return ExitCodeOf(diagnostics);
}

}  // namespace kompono::cli
