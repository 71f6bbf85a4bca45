// SPDX-License-Identifier: Apache-2.0
#include "completion.hpp"
#include "text.hpp"
#include <fmt/format.h>

namespace kompono::cli {
namespace {

/// In single quotes, as all three shells read them; `quote` is how the shell writes one inside.
std::string Quoted(std::string_view text, std::string_view quote) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += quote;
    } else {
      out += c;
    }
  }
  return out + "'";
}
std::string PosixQuoted(std::string_view text) {
  return Quoted(text, R"('\'')");
}
std::string FishQuoted(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') escaped += '\\';
    escaped += c;
  }
  return Quoted(escaped, R"(\')");
}

std::vector<std::string> OptionNames(const CompletionCommand& command) {
  std::vector<std::string> names;
  for (const CompletionOption& option : command.options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// `    "kompono solve:--poses"|"kompono solve:-p")`
std::string CasePattern(const CompletionCommand& command, const CompletionOption& option) {
  std::vector<std::string> patterns;
  for (const std::string& name : option.names)
    patterns.push_back(fmt::format("\"{}:{}\"", command.path, name));
  return "    " + Joined(patterns, "|") + ")";
}

/// Every step from a command to one below it.
std::string DescentPatterns(const std::vector<CompletionCommand>& tree) {
  std::vector<std::string> patterns;
  for (std::size_t i = 1; i < tree.size(); ++i) patterns.push_back('"' + tree[i].path + '"');
  return Joined(patterns, "|");
}

std::string BashValues(const ValueHint& hint) {
  switch (hint.kind) {
    case ValueHint::Kind::kFile:
      return "_kompono_files -f";
    case ValueHint::Kind::kFolder:
      return "_kompono_files -d";
    case ValueHint::Kind::kWords:
      return fmt::format("_kompono_words {}", PosixQuoted(Joined(hint.words, " ")));
    case ValueHint::Kind::kModule:
      return "_kompono_words \"$(\"${COMP_WORDS[0]}\" plugins --names 2>/dev/null)\"";
    case ValueHint::Kind::kAny:
      break;
  }
  return ":";
}

std::string ZshValues(const ValueHint& hint) {
  switch (hint.kind) {
    case ValueHint::Kind::kFile:
      return "_files";
    case ValueHint::Kind::kFolder:
      return "_files -/";
    case ValueHint::Kind::kWords:
      return "compadd -- " + Joined(hint.words, " ");
    case ValueHint::Kind::kModule:
      return "compadd -- ${(f)\"$(\"${words[1]}\" plugins --names 2>/dev/null)\"}";
    case ValueHint::Kind::kAny:
      break;
  }
  return ":";
}

std::string FishValues(const ValueHint& hint) {
  switch (hint.kind) {
    case ValueHint::Kind::kFile:
      return " -F";
    case ValueHint::Kind::kFolder:
      return " -f -a '(__fish_complete_directories)'";
    case ValueHint::Kind::kWords:
      return " -f -a " + FishQuoted(Joined(hint.words, " "));
    case ValueHint::Kind::kModule:
      return " -f -a '(kompono plugins --names 2>/dev/null)'";
    case ValueHint::Kind::kAny:
      break;
  }
  return " -f";
}

/// "name:text" for zsh's _describe.
std::string ZshDescribed(std::string_view name, std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == ':' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return PosixQuoted(fmt::format("{}:{}", name, escaped));
}

std::string ValueCases(const std::vector<CompletionCommand>& tree,
                       std::string (*values)(const ValueHint&)) {
  std::string out;
  for (const CompletionCommand& command : tree) {
    for (const CompletionOption& option : command.options) {
      if (option.takes_value)
        out += fmt::format("{} {}; return;;\n", CasePattern(command, option), values(option.hint));
    }
  }
  return out;
}

}  // namespace

std::string BashCompletion(const std::vector<CompletionCommand>& tree) {
  std::string options;
  std::string arguments;
  for (const CompletionCommand& command : tree) {
    options += fmt::format("      \"{}\") _kompono_words {};;\n",
                           command.path,
                           PosixQuoted(Joined(OptionNames(command), " ")));
    arguments += fmt::format(
        "    \"{}\") {};;\n",
        command.path,
        command.commands.empty()
            ? BashValues(command.arguments)
            : fmt::format("_kompono_words {}", PosixQuoted(Joined(command.commands, " "))));
  }
  return fmt::format(R"(# Completes kompono in bash: source <(kompono completion bash)
_kompono_words() {{
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "${{COMP_WORDS[COMP_CWORD]}}")
}}
_kompono_files() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "$1" -- "${{COMP_WORDS[COMP_CWORD]}}")
}}
_kompono() {{
  local at=kompono before="${{COMP_WORDS[COMP_CWORD-1]}}" i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$at ${{COMP_WORDS[i]}}" in
      {}) at="$at ${{COMP_WORDS[i]}}";;
    esac
  done
  case "$at:$before" in
{}  esac
  if [[ "${{COMP_WORDS[COMP_CWORD]}}" == -* ]]; then
    case "$at" in
{}    esac
    return
  fi
  case "$at" in
{}  esac
}}
complete -F _kompono kompono
)",
                     DescentPatterns(tree),
                     ValueCases(tree, BashValues),
                     options,
                     arguments);
}

std::string ZshCompletion(const std::vector<CompletionCommand>& tree) {
  std::string options;
  std::string arguments;
  for (const CompletionCommand& command : tree) {
    std::vector<std::string> described;
    for (const CompletionOption& option : command.options) {
      for (const std::string& name : option.names)
        described.push_back(ZshDescribed(name, option.text));
    }
    options += fmt::format("      \"{}\") found=({}); _describe -o option found;;\n",
                           command.path,
                           Joined(described, " "));
    described.clear();
    for (std::size_t i = 0; i < command.commands.size(); ++i)
      described.push_back(ZshDescribed(command.commands[i], command.command_texts[i]));
    arguments += fmt::format(
        "    \"{}\") {};;\n",
        command.path,
        command.commands.empty()
            ? ZshValues(command.arguments)
            : fmt::format("found=({}); _describe command found", Joined(described, " ")));
  }
  return fmt::format(R"(#compdef kompono
# Completes kompono in zsh: kompono completion zsh > a folder of fpath/_kompono
_kompono() {{
  local at=kompono before="${{words[CURRENT-1]}}" i
  local -a found
  for ((i = 2; i < CURRENT; i++)); do
    case "$at ${{words[i]}}" in
      {}) at="$at ${{words[i]}}";;
    esac
  done
  case "$at:$before" in
{}  esac
  if [[ "${{words[CURRENT]}}" == -* ]]; then
    case "$at" in
{}    esac
    return
  fi
  case "$at" in
{}  esac
}}
_kompono "$@"
)",
                     DescentPatterns(tree),
                     ValueCases(tree, ZshValues),
                     options,
                     arguments);
}

std::string FishCompletion(const std::vector<CompletionCommand>& tree) {
  std::vector<std::string> paths;
  for (std::size_t i = 1; i < tree.size(); ++i) paths.push_back(FishQuoted(tree[i].path));
  std::string out = fmt::format(R"(# Completes kompono in fish
function __kompono_at
  set -l at kompono
  for word in (commandline -opc)[2..-1]
    if contains -- "$at $word" {}
      set at "$at $word"
    end
  end
  test "$at" = "$argv[1]"
end
complete -c kompono -f
)",
                                Joined(paths, " "));
  for (const CompletionCommand& command : tree) {
    const std::string at =
        fmt::format("complete -c kompono -n \"__kompono_at '{}'\"", command.path);
    for (std::size_t i = 0; i < command.commands.size(); ++i) {
      out += fmt::format(
          "{} -f -a {} -d {}\n", at, command.commands[i], FishQuoted(command.command_texts[i]));
    }
    for (const CompletionOption& option : command.options) {
      out += at;
      for (const std::string& name : option.names) {
        out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (option.takes_value) out += " -r" + FishValues(option.hint);
      out += " -d " + FishQuoted(option.text) + "\n";
    }
    if (command.commands.empty()) out += at + FishValues(command.arguments) + "\n";
  }
  return out;
}

}  // namespace kompono::cli
