// SPDX-License-Identifier: Apache-2.0
#include "report.hpp"

#include "glyphs.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace kompono::formula {
namespace {

constexpr std::size_t kQuotedCodePoints = 32;

Diagnostic Make(Severity severity,
                const CodeTitle& code,
                std::string_view file,
                SourceSpan span,
                std::string message,
                std::string help) {
  return {.severity = severity,
          .code = std::string(code.code),
          .file = std::string(file),
          .span = std::move(span),
          .message = std::move(message),
          .help = std::move(help)};
}

}  // namespace

void Report::Error(const CodeTitle& code, Range where, std::string message, std::string help) {
  errors_.push_back(Make(Severity::kError,
                         code,
                         file_,
                         SpanOf(text_, where.begin, where.end),
                         std::move(message),
                         std::move(help)));
}

void Report::Note(const CodeTitle& code, Range where, std::string message, std::string help) {
  notes_.push_back(Make(Severity::kNote,
                        code,
                        file_,
                        SpanOf(text_, where.begin, where.end),
                        std::move(message),
                        std::move(help)));
}

bool Report::Has(const CodeTitle& code) const {
  const auto same = [&code](const Diagnostic& said) { return said.code == code.code; };
  return std::any_of(errors_.begin(), errors_.end(), same) ||
         std::any_of(notes_.begin(), notes_.end(), same);
}

std::string Report::Quote(Range where) const {
  std::string quoted;
  std::size_t count = 0;
  for (std::size_t at = where.begin; at < where.end; ++count) {
    if (count == kQuotedCodePoints) return quoted + "…";
    const CodePoint point = DecodeAt(text_, at);
    if (!point.valid) {
      quoted += fmt::format("\\x{:02X}", static_cast<unsigned char>(text_[at]));
    } else if (point.code < U' ' || (point.code >= 0x7F && point.code < 0xA0)) {
      quoted += fmt::format("U+{:04X}", static_cast<unsigned>(point.code));
    } else {
      quoted += text_.substr(at, point.size);
    }
    at += point.size;
  }
  return quoted;
}

}  // namespace kompono::formula
