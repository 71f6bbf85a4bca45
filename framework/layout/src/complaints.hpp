// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_COMPLAINTS_HPP_
#define KOMPONO_LAYOUT_COMPLAINTS_HPP_

#include <string>
#include <string_view>
#include <utility>

#include <toml++/toml.h>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/layout/codes.hpp"

namespace kompono::layout {

/// The text being judged and what was said about it.
class Complaints {
 public:
  Complaints(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  /// A value over several lines is marked to the end of its first line.
  [[nodiscard]] SourceSpan Span(const toml::source_region& region) const;
  [[nodiscard]] SourceSpan Span(const toml::node& node) const { return Span(node.source()); }

  void Error(const CodeTitle& code, SourceSpan span, std::string message, std::string help = {}) {
    Say(Severity::kError, code, std::move(span), std::move(message), std::move(help));
  }
  void Warning(const CodeTitle& code, SourceSpan span, std::string message, std::string help = {}) {
    Say(Severity::kWarning, code, std::move(span), std::move(message), std::move(help));
  }
  void Note(const CodeTitle& code, SourceSpan span, std::string message, std::string help = {}) {
    Say(Severity::kNote, code, std::move(span), std::move(message), std::move(help));
  }
  void Add(Diagnostic diagnostic) { list_.push_back(std::move(diagnostic)); }

  [[nodiscard]] bool HasErrors() const { return kompono::HasErrors(list_); }
  [[nodiscard]] Diagnostics Take() { return std::exchange(list_, {}); }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::string_view file() const { return file_; }

 private:
  void Say(Severity severity,
           const CodeTitle& code,
           SourceSpan span,
           std::string message,
           std::string help);

  std::string_view text_;
  std::string_view file_;
  Diagnostics list_;
};

/// What to say of a word with letters that are not Latin, such as the Cyrillic ones that look it;
/// else `otherwise`.
[[nodiscard]] std::string ForeignLetters(std::string_view word, std::string otherwise);

/// "a string", "a list", …: what stands in the file, for people.
[[nodiscard]] std::string_view TypeName(const toml::node& node);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_COMPLAINTS_HPP_
