// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"

#include "exit_code.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace kompono::cli {
namespace {

constexpr std::size_t kColumn = 26;
constexpr std::size_t kWidth = 100;

/// `left` and `text` side by side; the text wraps inside its column.
std::string Entry(const std::string& left, const std::string& text) {
  std::string out = "  " + left;
  std::size_t column = out.size();
  const auto go_on_below = [&] {
    out += '\n' + std::string(kColumn, ' ');
    column = kColumn;
  };
  if (column + 2 > kColumn) {
    go_on_below();
  } else {
    out.append(kColumn - column, ' ');
    column = kColumn;
  }
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > kColumn && column + 1 + word.size() > kWidth) go_on_below();
    if (column > kColumn) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out + '\n';
}

std::string OptionName(const CLI::Option* option) {
  std::string name = option->get_name(false, true);
  std::replace(name.begin(), name.end(), ',', ' ');
  if (option->get_items_expected_max() == 0) return name;  // a flag
  const std::string value = option->get_type_name();
  return fmt::format("{} {}", name, value.empty() ? "TEXT" : value);
}

std::string Usage(const CLI::App* app) {
  std::string usage = "Usage: " + FullName(app);
  for (const CLI::Option* option : app->get_options()) {
    if (!option->get_positional()) continue;
    std::string word = option->get_name(true);
    if (option->get_items_expected_max() > 1) word += "...";
    usage += option->get_required() ? " " + word : " [" + word + "]";
  }
  const auto commands = app->get_subcommands([](const CLI::App*) { return true; });
  if (!commands.empty()) usage += " COMMAND ...";
  return usage + " [options]\n";
}

std::string Options(const CLI::App* app, bool positional, bool with_help) {
  std::string out;
  for (const CLI::Option* option : app->get_options()) {
    if (option->get_positional() != positional || option->get_group().empty()) continue;
    if (option == app->get_help_ptr() && !with_help) continue;
    out += positional ? Entry(option->get_name(true), option->get_description())
                      : Entry(OptionName(option), option->get_description());
  }
  return out;
}

std::string Commands(const CLI::App* app) {
  std::string out;
  for (const CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty())
      out += Entry(command->get_name(), command->get_description());
  }
  return out;
}

std::string Block(std::string_view title, const std::string& entries) {
  return entries.empty() ? "" : fmt::format("\n{}:\n{}", title, entries);
}

std::string ExitCodes() {
  std::string out;
  for (const ExitCodeMeaning& entry : kExitCodes) {
    out += Entry(std::to_string(static_cast<int>(entry.code)), std::string(entry.meaning));
  }
  return out;
}

}  // namespace

std::string FullName(const CLI::App* app) {
  const CLI::App* parent = app->get_parent();
  return parent == nullptr ? app->get_name() : FullName(parent) + " " + app->get_name();
}

std::string HelpFormatter::make_help(const CLI::App* app,
                                     std::string /*name*/,
                                     CLI::AppFormatMode /*mode*/) const {
  const CLI::App* root = app;
  while (root->get_parent() != nullptr) root = root->get_parent();
  std::string out = "Examples:\n" + app->get_footer() + "\n\n";
  out += app->get_description() + "\n\n" + Usage(app);
  out += Block("Commands", Commands(app));
  out += Block("Arguments", Options(app, true, false));
  out += Block("Options", Options(app, false, root == app));
  if (root != app) {
    out += Block("Options of every command", Options(root, false, true));
  }
  out += Block("Exit status", ExitCodes());
  return out;
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return Entry(is_positional ? option->get_name(true) : OptionName(option),
               option->get_description());
}

std::string ShortHelp(const CLI::App& root) {
  return "Examples:\n" + root.get_footer() + "\n\n" + Usage(&root) +
         Block("Commands", Commands(&root)) + "\nkompono COMMAND --help tells more.\n";
}

}  // namespace kompono::cli
