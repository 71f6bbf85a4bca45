// SPDX-License-Identifier: Apache-2.0
#include "kompono/diagnostics/diagnostic.hpp"

#include <nlohmann/json.hpp>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono {
namespace {

TEST(SpanOf, CountsCodePointsNotBytes) {
  const std::string text = "first\nОХ bad\n";
  const std::size_t at = text.find("bad");
  const SourceSpan span = SpanOf(text, at, at + 3);
  EXPECT_EQ(span.line, 2);
  EXPECT_EQ(span.column, 4);
  EXPECT_EQ(span.length, 3);
  EXPECT_EQ(span.line_text, "ОХ bad");
}

TEST(SpanOf, MovesPlacesBeyondTheEndToTheEnd) {
  const SourceSpan span = SpanOf("ab", 9, 12);
  EXPECT_EQ(span.line, 1);
  EXPECT_EQ(span.column, 3);
  EXPECT_EQ(span.length, 1);
}

TEST(SpanAt, FindsWhatSpanOfFinds) {
  const std::string text = "a\nbcd ef\n";
  const SourceSpan span = SpanAt(text, 2, 5, 2);
  EXPECT_EQ(span.column, 5);
  EXPECT_EQ(span.length, 2);
  EXPECT_EQ(span.line_text, "bcd ef");
}

TEST(Render, ShowsPlaceCodeCaretAndHelp) {
  const std::string text = "kompono = 1\nmodule = \"pyramyd\"\n";
  const std::size_t at = text.find("\"pyramyd");
  const Diagnostic diagnostic{.severity = Severity::kError,
                              .code = "E0304",
                              .file = "machine.toml",
                              .span = SpanOf(text, at, at + 9),
                              .message = "unknown module 'pyramyd'",
                              .help = "did you mean 'pyramid'?"};
  EXPECT_EQ(Render(diagnostic, {}),
            "machine.toml:2:10: error: unknown module 'pyramyd' [E0304]\n"
            " 2 | module = \"pyramyd\"\n"
            "   |          ^~~~~~~~~\n"
            "  help: did you mean 'pyramid'?\n");
}

TEST(RenderAll, SortsByPlaceAndCounts) {
  const std::string text = "one\ntwo\n";
  Diagnostics list{{.code = "E2", .file = "f", .span = SpanOf(text, 4, 7), .message = "later"},
                   {.severity = Severity::kWarning,
                    .code = "W1",
                    .file = "f",
                    .span = SpanOf(text, 0, 3),
                    .message = "sooner"}};
  const std::string rendered = RenderAll(list, {});
  EXPECT_LT(rendered.find("sooner"), rendered.find("later"));
  EXPECT_TRUE(rendered.ends_with("1 error, 1 warning\n"));
  EXPECT_TRUE(HasErrors(list));
  EXPECT_EQ(ToJson(list)[0]["line"], 2);
}

TEST(Suggestion, NamesTheNearestOrListsAll) {
  const std::vector<std::string> names{"pyramid", "lambda", "hexapod"};
  EXPECT_EQ(DidYouMean("pyramyd", names), "did you mean 'pyramid'?");
  EXPECT_EQ(DidYouMean("Lambda", names), "did you mean 'lambda'?");
  EXPECT_EQ(DidYouMean("lamdba", names), "did you mean 'lambda'?");
  EXPECT_EQ(DidYouMean("xyz", names), "known are: pyramid, lambda, hexapod");
  EXPECT_EQ(DidYouMean("xyz", {}), "");
}

}  // namespace
}  // namespace kompono
