// SPDX-License-Identifier: Apache-2.0
#include "usage.hpp"

#include "codes.hpp"
#include "help.hpp"
#include <fmt/format.h>

#include <string>
#include <vector>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::cli {
namespace {

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  return names;
}

/// Options of `app` and of those above it, with their dashes.
std::vector<std::string> OptionNames(const CLI::App* app) {
  std::vector<std::string> names;
  for (; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options()) {
      // --help stands on every level.
      if (option == app->get_help_ptr() && app->get_parent() != nullptr) continue;
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
  }
  return names;
}

Diagnostic Problem(const CodeTitle& code, std::string message, std::string help) {
  return {.code = std::string(code.code), .message = std::move(message), .help = std::move(help)};
}

Diagnostic LeftOver(const std::string& word, const CLI::App& app) {
  const std::vector<std::string> commands = CommandNames(app);
  if (word.size() > 1 && word.front() == '-') {
    const std::string name = word.substr(0, word.find('='));
    return Problem(codes::kUnknownOption,
                   fmt::format("unknown option '{}'", name),
                   DidYouMean(name, OptionNames(&app), 40));
  }
  if (!commands.empty()) {
    return Problem(codes::kUnknownCommand,
                   fmt::format("unknown command '{}'", word),
                   DidYouMean(word, commands, 20));
  }
  return Problem(codes::kUsage,
                 fmt::format("'{}' is one argument too many", word),
                 "put arguments with blanks in quotes");
}

}  // namespace

const CLI::App* DeepestCommand(const CLI::App& root) {
  const CLI::App* app = &root;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().back();
  return app;
}

Diagnostics UsageProblems(const CLI::App& root, const CLI::ParseError* error) {
  const CLI::App* command = DeepestCommand(root);
  Diagnostics out;
  for (const std::string& word : root.remaining(true)) {
    out.push_back(LeftOver(word, *command));
    // What follows an unknown command or option was meant for it.
    break;
  }
  if (out.empty() && error != nullptr) {
    std::string message = error->what();
    // CLI11 says "--pose: 1 required NAME=.., missing".
    if (dynamic_cast<const CLI::ArgumentMismatch*>(error) != nullptr)
      message = message.substr(0, message.find(':')) + " needs a value";
    out.push_back(Problem(codes::kUsage, message, ""));
  }
  if (out.empty() && !CommandNames(*command).empty()) {
    out.push_back(Problem(codes::kUsage,
                          fmt::format("{} needs a command", FullName(command)),
                          DidYouMean("", CommandNames(*command), 20)));
  }
  for (Diagnostic& problem : out) {
    if (!problem.help.empty()) problem.help += "; ";
    problem.help += fmt::format("see {} --help", FullName(command));
  }
  return out;
}

}  // namespace kompono::cli
