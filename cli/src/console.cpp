// SPDX-License-Identifier: Apache-2.0
#include "console.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace kompono::cli {
namespace {

constexpr std::size_t kFlushBytes = 1U << 16U;

bool TerminalWantsColor(int descriptor) {
  const char* no_color = std::getenv("NO_COLOR");
  if (no_color != nullptr && *no_color != '\0') return false;
  const char* term = std::getenv("TERM");
  return ::isatty(descriptor) != 0 && (term == nullptr || std::string_view(term) != "dumb");
}

/// errno, or 0 when everything was written.
int WriteAll(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

std::string_view Escape(Hue hue) {
  switch (hue) {
    case Hue::kPlain:
      return "";
    case Hue::kBold:
      return "1";
    case Hue::kDim:
      return "2";
    case Hue::kGreen:
      return "32";
    case Hue::kYellow:
      return "33";
    case Hue::kRed:
      return "1;31";
  }
  return "";
}

}  // namespace

void Console::Configure(ColorChoice color, bool json) {
  json_ = json;
  stderr_is_terminal_ = ::isatty(STDERR_FILENO) != 0;
  color_out_ = color == ColorChoice::kAlways ||
               (color == ColorChoice::kAuto && TerminalWantsColor(STDOUT_FILENO));
  color_err_ = color == ColorChoice::kAlways ||
               (color == ColorChoice::kAuto && TerminalWantsColor(STDERR_FILENO));
}

void Console::Out(std::string_view text) {
  waiting_ += text;
  if (waiting_.size() > kFlushBytes) Flush();
}

void Console::Say(std::string_view text) {
  if (json_ || text.empty()) return;
  Progress("");
  // Data and talk may share a terminal: keep them in the order in which they were given.
  Flush();
  std::string line(text);
  if (line.back() != '\n') line += '\n';
  static_cast<void>(WriteAll(STDERR_FILENO, line));
}

void Console::Report(const Diagnostics& diagnostics) {
  if (diagnostics.empty()) return;
  if (json_) {
    told_.insert(told_.end(), diagnostics.begin(), diagnostics.end());
  } else {
    Say(RenderAll(diagnostics, {.color = color_err_}));
  }
}

void Console::Json(nlohmann::ordered_json document) {
  if (!told_.empty()) {
    nlohmann::ordered_json& list = document["diagnostics"];
    for (const nlohmann::json& diagnostic : ToJson(told_))
      list.push_back(nlohmann::ordered_json(diagnostic));
    told_.clear();
  }
  // Texts from files may hold bytes that are no UTF-8; a replacement mark is better than no answer.
  Out(document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  document_printed_ = true;
}

std::string Console::Paint(std::string_view text, Hue hue) const {
  if (!color_out_ || hue == Hue::kPlain) return std::string(text);
  return fmt::format("\x1b[{}m{}\x1b[0m", Escape(hue), text);
}

void Console::Progress(std::string_view line) {
  if (json_ || !stderr_is_terminal_ || (line.empty() && !progress_shown_)) return;
  static_cast<void>(WriteAll(STDERR_FILENO, fmt::format("\r\x1b[K{}", line)));
  progress_shown_ = !line.empty();
}

void Console::Flush() {
  if (write_error_ == 0) write_error_ = WriteAll(STDOUT_FILENO, waiting_);
  waiting_.clear();
}

ExitCode Console::Finish(ExitCode code) {
  Progress("");
  if (json_ && !document_printed_ && !told_.empty()) Json(nlohmann::ordered_json::object());
  Flush();
  if (write_error_ == 0 || write_error_ == EPIPE) return code;
  static_cast<void>(WriteAll(STDERR_FILENO,
                             fmt::format("error: cannot write to standard output: {} [E0614]\n",
                                         std::strerror(write_error_))));
  return ExitCode::kInputOutput;
}

}  // namespace kompono::cli
