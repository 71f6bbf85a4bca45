// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_CONSOLE_HPP_
#define KOMPONO_CLI_CONSOLE_HPP_

#include "exit_code.hpp"
#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::cli {

enum class ColorChoice { kAuto, kAlways, kNever };

enum class Hue { kPlain, kBold, kDim, kGreen, kYellow, kRed };

/// The two ends of the program: stdout carries data, stderr talk.
///
/// With `--json` nothing is said on stderr; what there is to say becomes the member "diagnostics"
/// of the one document on stdout, which is left out when there is nothing.
class Console {
 public:
  /// Asks the terminal, NO_COLOR and TERM unless `color` says otherwise.
  void Configure(ColorChoice color, bool json);
  [[nodiscard]] bool json() const { return json_; }

  /// Data for stdout.
  void Out(std::string_view text);
  /// Talk for stderr, one line or several; nothing with --json.
  void Say(std::string_view text);
  /// Complaints, warnings and notes about the input.
  void Report(const Diagnostics& diagnostics);
  /// The document of a command under --json; once per run.
  void Json(nlohmann::ordered_json document);

  /// `text` in a colour if stdout shows colours.
  [[nodiscard]] std::string Paint(std::string_view text, Hue hue) const;
  [[nodiscard]] bool stderr_is_terminal() const { return stderr_is_terminal_; }

  /// A short line on stderr that overwrites the one before; only on a terminal. Empty: removes it.
  void Progress(std::string_view line);

  /// Writes what is left and turns `code` into kInputOutput when stdout could not take it. A reader
  /// that went away (`| head`) is no error.
  [[nodiscard]] ExitCode Finish(ExitCode code);

 private:
  void Flush();

  bool json_ = false;
  bool color_out_ = false;
  bool color_err_ = false;
  bool stderr_is_terminal_ = false;
  bool progress_shown_ = false;
  bool document_printed_ = false;
  int write_error_ = 0;  ///< errno of the first failed write
  std::string waiting_;  ///< for stdout
  Diagnostics told_;     ///< under --json, for the document
};

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_CONSOLE_HPP_
