// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_HELP_HPP_
#define KOMPONO_CLI_HELP_HPP_

#include <string>

#include <CLI/CLI.hpp>

namespace kompono::cli {

/// Help that begins with examples: they stand in App::footer and are what most people look for.
class HelpFormatter final : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_help(const CLI::App* app,
                                      std::string name,
                                      CLI::AppFormatMode mode) const override;
  [[nodiscard]] std::string make_option(const CLI::Option* option,
                                        bool is_positional) const override;
};

/// "kompono catalog query"
[[nodiscard]] std::string FullName(const CLI::App* app);

/// A dozen lines for those who gave no arguments.
[[nodiscard]] std::string ShortHelp(const CLI::App& root);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_HELP_HPP_
