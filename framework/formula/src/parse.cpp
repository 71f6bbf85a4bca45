// SPDX-License-Identifier: Apache-2.0
#include "glyphs.hpp"
#include "judge.hpp"
#include "reader.hpp"
#include "report.hpp"
#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

/// A text that cannot be a formula is not looked into, and only its beginning is kept in the
/// complaint.
Diagnostics TooLong(std::string_view text, std::string_view file) {
  std::size_t last = kMaxTextBytes - 1;
  while (last > 0 && !DecodeAt(text, last).valid && kMaxTextBytes - last < 4) --last;
  const std::string_view beginning = text.substr(0, kMaxTextBytes);
  Report report(beginning, file);
  report.Error(codes::kTooLong,
               {last, beginning.size()},
               fmt::format("the text has {} bytes, more than {}", text.size(), kMaxTextBytes),
               "is this a file instead of a formula?");
  return report.TakeErrors();
}

}  // namespace

Parsed<Formula> ParseFormula(std::string_view text, std::string_view file, Diagnostics* notes) {
  if (text.size() > kMaxTextBytes) return tl::make_unexpected(TooLong(text, file));
  Report report(text, file);
  std::vector<Glyph> glyphs = ReadGlyphs(text, report);
  ReadIso(glyphs, report);
  Formula formula;
  if (!glyphs.empty()) {
    const Range whole{glyphs.front().where.begin, glyphs.back().where.end};
    formula = JudgeNodes(ReadNodes(glyphs, report), whole, report);
  } else if (report.error_count() == 0) {
    report.Error(codes::kEmptyText,
                 {0, text.size()},
                 "the formula is empty",
                 "a formula goes from the workpiece over the base O to the tool: X Y O Z C_v");
  }
  if (notes != nullptr) {
    Diagnostics taken = report.TakeNotes();
    notes->insert(
        notes->end(), std::make_move_iterator(taken.begin()), std::make_move_iterator(taken.end()));
  }
  if (report.error_count() != 0) return tl::make_unexpected(report.TakeErrors());
  return formula;
}

}  // namespace kompono::formula
