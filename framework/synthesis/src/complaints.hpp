// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_COMPLAINTS_HPP_
#define KOMPONO_SYNTHESIS_COMPLAINTS_HPP_

#include <string>
#include <string_view>
#include <utility>

#include <toml++/toml.h>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/synthesis/codes.hpp"

namespace kompono::synthesis {

/// The text of a study being judged and what was said about it.
class Complaints {
 public:
  Complaints(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  /// A value over several lines is marked to the end of its first line.
  [[nodiscard]] SourceSpan Span(const toml::source_region& region) const;
  [[nodiscard]] SourceSpan Span(const toml::node& node) const { return Span(node.source()); }

  void Error(const CodeTitle& code, SourceSpan span, std::string message, std::string help = {}) {
    Say(Severity::kError, code.code, std::move(span), std::move(message), std::move(help));
  }
  void Warning(const CodeTitle& code, SourceSpan span, std::string message, std::string help = {}) {
    Say(Severity::kWarning, code.code, std::move(span), std::move(message), std::move(help));
  }
  void Say(Severity severity,
           std::string_view code,
           SourceSpan span,
           std::string message,
           std::string help);

  [[nodiscard]] bool HasErrors() const { return kompono::HasErrors(list_); }
  [[nodiscard]] Diagnostics Take() { return std::exchange(list_, {}); }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::string_view file() const { return file_; }

 private:
  std::string_view text_;
  std::string_view file_;
  Diagnostics list_;
};

/// "a string", "a list", …: what stands in the file, for people.
[[nodiscard]] std::string_view TypeName(const toml::node& node);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_COMPLAINTS_HPP_
