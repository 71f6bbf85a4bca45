// SPDX-License-Identifier: Apache-2.0
// kompono completion: scripts for the shells.
#include "completion.hpp"

#include "help.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace kompono::cli {
namespace {

constexpr const char* kExamples =
    "  source <(kompono completion bash)                            in ~/.bashrc\n"
    "  kompono completion zsh > ~/.zfunc/_kompono                   with ~/.zfunc in fpath\n"
    "  kompono completion fish > ~/.config/fish/completions/kompono.fish";

void AddOptions(const CLI::App* app, const Session& session, CompletionCommand& command) {
  for (const CLI::Option* option : app->get_options()) {
    if (option->get_positional() || option->get_group().empty()) continue;
    CompletionOption out{.text = option->get_description(),
                         .takes_value = option->get_items_expected_max() != 0,
                         .hint = session.HintOf(option)};
    for (const std::string& name : option->get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) out.names.push_back("--" + name);
    // --help stands on every level.
    const bool known = std::any_of(command.options.begin(),
                                   command.options.end(),
                                   [&](const auto& o) { return o.names == out.names; });
    if (known) continue;
    command.options.push_back(std::move(out));
  }
}

void Walk(const CLI::App* app,
          const CLI::App& root,
          const Session& session,
          std::vector<CompletionCommand>& tree) {
  CompletionCommand command{.path = FullName(app), .text = app->get_description()};
  const auto children = app->get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* child : children) {
    command.commands.push_back(child->get_name());
    command.command_texts.push_back(child->get_description());
  }
  AddOptions(app, session, command);
  if (app != &root) AddOptions(&root, session, command);
  for (const CLI::Option* option : app->get_options()) {
    if (option->get_positional()) command.arguments = session.HintOf(option);
  }
  tree.push_back(std::move(command));
  for (const CLI::App* child : children) Walk(child, root, session, tree);
}

}  // namespace

std::vector<CompletionCommand> CompletionTree(const CLI::App& root, const Session& session) {
  std::vector<CompletionCommand> tree;
  Walk(&root, root, session, tree);
  return tree;
}

void AddCompletion(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "completion", "Script that completes command lines in a shell", kExamples);
  const auto shell = std::make_shared<std::string>();
  session.Choices(command->add_option("SHELL", *shell, "bash, zsh or fish")->required(),
                  {"bash", "zsh", "fish"});
  session.OnRun(command, [&root, &session, shell] {
    const std::vector<CompletionCommand> tree = CompletionTree(root, session);
    const std::string script = *shell == "bash"  ? BashCompletion(tree)
                               : *shell == "zsh" ? ZshCompletion(tree)
                                                 : FishCompletion(tree);
    if (session.json) {
      session.console.Json({{"shell", *shell}, {"script", script}});
    } else {
      session.console.Out(script);
    }
    return ExitCode::kOk;
  });
}

}  // namespace kompono::cli
