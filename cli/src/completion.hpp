// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_COMPLETION_HPP_
#define KOMPONO_CLI_COMPLETION_HPP_

#include "session.hpp"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

/// What the shells are told about the command line, taken from the parser's own tree, so that a new
/// option needs no second list.
namespace kompono::cli {

struct CompletionOption {
  std::vector<std::string> names;  ///< with dashes
  std::string text;
  bool takes_value = false;
  ValueHint hint;
};

struct CompletionCommand {
  std::string path;  ///< "kompono catalog add"
  std::string text;
  std::vector<std::string> commands, command_texts;
  std::vector<CompletionOption> options;  ///< with those of every command
  ValueHint arguments;  ///< of the last positional; earlier ones are files as well
};

/// All commands, those above before those below.
[[nodiscard]] std::vector<CompletionCommand> CompletionTree(const CLI::App& root,
                                                            const Session& session);

[[nodiscard]] std::string BashCompletion(const std::vector<CompletionCommand>& tree);
[[nodiscard]] std::string ZshCompletion(const std::vector<CompletionCommand>& tree);
[[nodiscard]] std::string FishCompletion(const std::vector<CompletionCommand>& tree);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_COMPLETION_HPP_
