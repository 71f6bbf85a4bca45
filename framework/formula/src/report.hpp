// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_FORMULA_SRC_REPORT_HPP_
#define KOMPONO_FORMULA_SRC_REPORT_HPP_

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/formula/codes.hpp"

namespace kompono::formula {

/// text[begin, end) in bytes.
struct Range {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Collects what is said about one text.
class Report {
 public:
  Report(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  void Error(const CodeTitle& code, Range where, std::string message, std::string help = "");
  void Note(const CodeTitle& code, Range where, std::string message, std::string help = "");

  /// The text itself, fit for a message: bytes that are no text as \xNN, cut when long.
  [[nodiscard]] std::string Quote(Range where) const;

  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::size_t error_count() const { return errors_.size(); }
  [[nodiscard]] bool Has(const CodeTitle& code) const;
  [[nodiscard]] Diagnostics TakeErrors() { return std::move(errors_); }
  [[nodiscard]] Diagnostics TakeNotes() { return std::move(notes_); }

 private:
  std::string_view text_;
  std::string_view file_;
  Diagnostics errors_;
  Diagnostics notes_;
};

}  // namespace kompono::formula

#endif  // KOMPONO_FORMULA_SRC_REPORT_HPP_
