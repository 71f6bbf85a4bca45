// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_DIAGNOSTICS_DIAGNOSTIC_HPP_
#define KOMPONO_DIAGNOSTICS_DIAGNOSTIC_HPP_

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

/// How kompono speaks of data that came from outside.
///
/// Every reader (formula, layout, sidecar, measurements, study) judges its input completely and
/// returns either the value or all complaints at once:
///
///     Parsed<Formula> formula = ParseFormula("part X Q7 O tool");
///     if (!formula) std::cerr << RenderAll(formula.error(), {});
///
/// A complaint has a place, a code that stays the same between versions, a sentence, and where
/// possible a way out:
///
///     machine.toml:4:10: error: unknown module 'pyramyd' [E0304]
///      4 | module = "pyramyd"
///        |          ^~~~~~~~~
///       help: did you mean 'pyramid'?
///
/// Code ranges: E01 formula, E02 plugins, E03 layouts, E04 measurements and calibration, E05
/// catalog, E06 command line and poses, E07 kinematics. Warnings use W with the same ranges, notes
/// N. docs/codes.md lists them all.
namespace kompono {

enum class Severity { kNote, kWarning, kError };

/// A stretch of one line of some text. Columns count Unicode code points from 1, so that the caret
/// stands right under Cyrillic letters too; line 0 means "no place".
struct SourceSpan {
  int line = 0;
  int column = 0;
  int length = 1;         ///< code points under the caret line, at least 1
  std::string line_text;  ///< the whole line, without its end, so that rendering needs no file
};

struct Diagnostic {
  Severity severity = Severity::kError;
  std::string code;  ///< "E0304"
  std::string file;  ///< as the user named it; "formula" for text given on the command line
  SourceSpan span;
  std::string message;  ///< one sentence, lower case, no full stop
  std::string help;     ///< empty, or what to do about it
};

using Diagnostics = std::vector<Diagnostic>;

/// A value, or every complaint about the text it was to be made from.
template <class T>
using Parsed = tl::expected<T, Diagnostics>;

[[nodiscard]] bool HasErrors(const Diagnostics& diagnostics);

/// The span of `text[begin, end)`, byte offsets into the whole text; an empty range marks one
/// character. Offsets past the end are moved to the end.
[[nodiscard]] SourceSpan SpanOf(std::string_view text, std::size_t begin, std::size_t end);

/// The span at a 1-based line and column (code points) of `text`, `length` code points long; what
/// TOML and JSON parsers report. Places outside the text are moved to the nearest inside.
[[nodiscard]] SourceSpan SpanAt(std::string_view text, int line, int column, int length = 1);

struct RenderOptions {
  bool color = false;  ///< ANSI colours; the caller asks the terminal and NO_COLOR
};

/// One complaint as people read it, several lines, ends with a line feed.
[[nodiscard]] std::string Render(const Diagnostic& diagnostic, const RenderOptions& options);

/// All of them in the order of file, line and column, then "2 errors, 1 warning".
[[nodiscard]] std::string RenderAll(const Diagnostics& diagnostics, const RenderOptions& options);

/// {"severity", "code", "file", "line", "column", "length", "message", "help"}; place members only
/// if there is one.
[[nodiscard]] nlohmann::json ToJson(const Diagnostic& diagnostic);
[[nodiscard]] nlohmann::json ToJson(const Diagnostics& diagnostics);

}  // namespace kompono

#endif  // KOMPONO_DIAGNOSTICS_DIAGNOSTIC_HPP_
