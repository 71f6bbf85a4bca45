// SPDX-License-Identifier: Apache-2.0
#include "kompono/diagnostics/diagnostic.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <tuple>

namespace kompono {
namespace {

bool StartsCodePoint(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

int CodePoints(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), StartsCodePoint));
}

std::string_view SeverityName(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    case Severity::kNote:
      break;
  }
  return "note";
}

std::string_view LineAround(std::string_view text, std::size_t offset) {
  const std::size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  const std::size_t end = std::min(text.find('\n', offset), text.size());
  std::string_view line = text.substr(begin, end - begin);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string Plural(std::size_t count, std::string_view word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

/// Tabs in front of the caret are kept as tabs, so that it stays under its text at any tab width.
std::string Indentation(const SourceSpan& span) {
  std::string indentation;
  int column = 1;
  for (std::size_t i = 0; i < span.line_text.size() && column < span.column; ++i) {
    if (!StartsCodePoint(span.line_text[i])) continue;
    indentation += span.line_text[i] == '\t' ? '\t' : ' ';
    ++column;
  }
  return indentation;
}

}  // namespace

bool HasErrors(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& d) {
    return d.severity == Severity::kError;
  });
}

SourceSpan SpanOf(std::string_view text, std::size_t begin, std::size_t end) {
  begin = std::min(begin, text.size());
  end = std::clamp(end, begin, text.size());
  const std::string_view line = LineAround(text, begin);
  const auto line_begin = static_cast<std::size_t>(line.data() - text.data());
  SourceSpan span;
  span.line = 1 + static_cast<int>(std::count(
                      text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'));
  span.column = 1 + CodePoints(text.substr(line_begin, begin - line_begin));
  end = std::min(end, line_begin + line.size());
  span.length = end > begin ? std::max(1, CodePoints(text.substr(begin, end - begin))) : 1;
  span.line_text = std::string(line);
  return span;
}

SourceSpan SpanAt(std::string_view text, int line, int column, int length) {
  std::size_t begin = 0;
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) break;
    begin = end + 1;
  }
  const auto next_point = [text](std::size_t at) {
    do {
      ++at;
    } while (at < text.size() && !StartsCodePoint(text[at]));
    return at;
  };
  for (int i = 1; i < column && begin < text.size() && text[begin] != '\n'; ++i)
    begin = next_point(begin);
  std::size_t end = begin;
  for (int i = 0; i < length && end < text.size() && text[end] != '\n'; ++i) end = next_point(end);
  return SpanOf(text, begin, end);
}

std::string Render(const Diagnostic& diagnostic, const RenderOptions& options) {
  const auto paint = [&options](std::string_view escape, std::string_view text) {
    return options.color ? fmt::format("\x1b[{}m{}\x1b[0m", escape, text) : std::string(text);
  };
  const std::string_view hue = diagnostic.severity == Severity::kError     ? "1;31"
                               : diagnostic.severity == Severity::kWarning ? "1;33"
                                                                           : "1;36";
  const SourceSpan& span = diagnostic.span;
  std::string place;
  if (!diagnostic.file.empty()) {
    place = span.line > 0 ? fmt::format("{}:{}:{}: ", diagnostic.file, span.line, span.column)
                          : diagnostic.file + ": ";
  }
  std::string text = fmt::format("{}{}: {}",
                                 paint("1", place),
                                 paint(hue, SeverityName(diagnostic.severity)),
                                 diagnostic.message);
  if (!diagnostic.code.empty()) text += fmt::format(" [{}]", diagnostic.code);
  text += '\n';
  if (span.line > 0) {
    const std::string number = std::to_string(span.line);
    const std::string carets =
        "^" + std::string(static_cast<std::size_t>(std::max(0, span.length - 1)), '~');
    text += fmt::format(" {} | {}\n", number, span.line_text);
    text += fmt::format(
        " {} | {}{}\n", std::string(number.size(), ' '), Indentation(span), paint(hue, carets));
  }
  if (!diagnostic.help.empty()) text += fmt::format("  help: {}\n", diagnostic.help);
  return text;
}

std::string RenderAll(const Diagnostics& diagnostics, const RenderOptions& options) {
  std::vector<const Diagnostic*> order;
  order.reserve(diagnostics.size());
  for (const Diagnostic& diagnostic : diagnostics) order.push_back(&diagnostic);
  std::stable_sort(order.begin(), order.end(), [](const Diagnostic* a, const Diagnostic* b) {
    return std::tie(a->file, a->span.line, a->span.column) <
           std::tie(b->file, b->span.line, b->span.column);
  });
  std::string text;
  std::size_t errors = 0;
  std::size_t warnings = 0;
  for (const Diagnostic* diagnostic : order) {
    text += Render(*diagnostic, options);
    errors += diagnostic->severity == Severity::kError ? 1 : 0;
    warnings += diagnostic->severity == Severity::kWarning ? 1 : 0;
  }
  if (errors > 0 && warnings > 0)
    return text + Plural(errors, "error") + ", " + Plural(warnings, "warning") + "\n";
  if (errors > 0) return text + Plural(errors, "error") + "\n";
  if (warnings > 0) return text + Plural(warnings, "warning") + "\n";
  return text;
}

nlohmann::json ToJson(const Diagnostic& diagnostic) {
  nlohmann::json json{{"severity", SeverityName(diagnostic.severity)},
                      {"code", diagnostic.code},
                      {"file", diagnostic.file},
                      {"message", diagnostic.message},
                      {"help", diagnostic.help}};
  if (diagnostic.span.line > 0) {
    json["line"] = diagnostic.span.line;
    json["column"] = diagnostic.span.column;
    json["length"] = diagnostic.span.length;
  }
  return json;
}

nlohmann::json ToJson(const Diagnostics& diagnostics) {
  nlohmann::json list = nlohmann::json::array();
  for (const Diagnostic& diagnostic : diagnostics) list.push_back(ToJson(diagnostic));
  return list;
}

}  // namespace kompono
