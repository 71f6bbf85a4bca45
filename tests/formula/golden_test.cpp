// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "kompono/formula/codes.hpp"
#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

const std::filesystem::path& Folder() {
  static const std::filesystem::path folder =
      std::filesystem::path(KOMPONO_SOURCE_DIR) / "tests/formula/golden";
  return folder;
}

std::string Contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, '\t');) cells.push_back(cell);
  return cells;
}

/// The codes in the order of their places, "-" for none.
std::string CodesOf(Diagnostics notes) {
  std::stable_sort(notes.begin(), notes.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return a.span.column < b.span.column;
  });
  std::string codes;
  for (const Diagnostic& note : notes) codes += (codes.empty() ? "" : " ") + note.code;
  return codes.empty() ? "-" : codes;
}

struct BrokenFormula {
  std::string name;
  std::string text;
  std::string expected;
};

/// The formula, a line of four dashes, and what is printed.
std::vector<BrokenFormula> BrokenFormulas() {
  constexpr std::string_view kRule = "\n----\n";
  std::vector<BrokenFormula> cases;
  for (const auto& entry : std::filesystem::directory_iterator(Folder() / "broken")) {
    const std::string contents = Contents(entry.path());
    const std::size_t rule = contents.find(kRule);
    EXPECT_NE(rule, std::string::npos) << entry.path();
    if (rule == std::string::npos) continue;
    cases.push_back({entry.path().stem().string(),
                     contents.substr(0, rule),
                     contents.substr(rule + kRule.size())});
  }
  return cases;
}

TEST(GoldenFormulas, GiveTheirCanonicalTextAndNotes) {
  std::ifstream stream(Folder() / "formulas.tsv");
  int count = 0;
  std::set<std::string> sayings;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line.front() == '#') continue;
    SCOPED_TRACE(line);
    const std::vector<std::string> cells = Cells(line);
    ASSERT_EQ(cells.size(), 4U);
    Diagnostics notes;
    const auto formula = ParseFormula(cells[0], "formula", &notes);
    ASSERT_TRUE(formula) << RenderAll(formula.error(), {});
    EXPECT_EQ(Canonical(*formula), cells[1]);
    EXPECT_EQ(CodesOf(notes), cells[2]);
    for (const Diagnostic& note : notes) sayings.insert(note.code);
    ++count;
  }
  EXPECT_GE(count, 30);
  for (const CodeTitle& code : kCodes) {
    if (code.code.front() != 'N') continue;
    EXPECT_EQ(sayings.count(std::string(code.code)), 1U) << code.code;
  }
}

TEST(BrokenFormulas, ArePrintedAsExpected) {
  const std::vector<BrokenFormula> cases = BrokenFormulas();
  EXPECT_GE(cases.size(), 20U);
  for (const BrokenFormula& broken : cases) {
    const auto formula = ParseFormula(broken.text);
    ASSERT_FALSE(formula) << broken.name;
    EXPECT_EQ(RenderAll(formula.error(), {}), broken.expected) << broken.name;
  }
}

TEST(BrokenFormulas, ShowEveryErrorOnceAtLeast) {
  std::set<std::string> shown;
  for (const BrokenFormula& broken : BrokenFormulas()) {
    for (const CodeTitle& code : kCodes) {
      if (broken.expected.find("[" + std::string(code.code) + "]") != std::string::npos) {
        shown.emplace(code.code);
      }
    }
  }
  for (const CodeTitle& code : kCodes) {
    if (code.code.front() != 'E') continue;
    EXPECT_EQ(shown.count(std::string(code.code)), 1U) << code.code;
  }
}

/// The texts between backticks of a row of a Markdown table.
std::vector<std::string> CodeSpans(const std::string& row) {
  std::vector<std::string> spans;
  for (std::size_t at = row.find('`'); at != std::string::npos; at = row.find('`', at + 1)) {
    const std::size_t end = row.find('`', at + 1);
    if (end == std::string::npos) break;
    std::string span = row.substr(at + 1, end - at - 1);
    for (std::size_t bar = 0; (bar = span.find("\\|", bar)) != std::string::npos;)
      span.erase(bar, 1);
    spans.push_back(span);
    at = end;
  }
  return spans;
}

/// The rows of the page below `heading`, up to the next heading.
std::vector<std::string> RowsBelow(const std::string& heading) {
  std::istringstream page(Contents(Folder() / "../../../docs/formula.md"));
  std::vector<std::string> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("## ", 0) == 0) inside = line == "## " + heading;
    if (inside && line.rfind("| ", 0) == 0) rows.push_back(line);
  }
  return rows;
}

TEST(Documentation, ShowsMachinesInCanonicalForm) {
  int count = 0;
  for (const std::string& row : RowsBelow("Examples")) {
    for (const std::string& text : CodeSpans(row)) {
      const auto formula = ParseFormula(text);
      ASSERT_TRUE(formula) << RenderAll(formula.error(), {});
      EXPECT_EQ(Canonical(*formula), text);
      ++count;
    }
  }
  EXPECT_GE(count, 12);
}

TEST(Documentation, ShowsErrorsThatAreReportedAsItSays) {
  int count = 0;
  for (const std::string& row : RowsBelow("Codes")) {
    for (const std::string& text : CodeSpans(row)) {
      const std::string code = row.substr(2, 5);
      const auto formula = ParseFormula(text);
      ASSERT_FALSE(formula) << text;
      EXPECT_TRUE(std::any_of(formula.error().begin(),
                              formula.error().end(),
                              [&code](const Diagnostic& said) { return said.code == code; }))
          << row << "\n"
          << RenderAll(formula.error(), {});
      ++count;
    }
  }
  EXPECT_GE(count, 35);
}

TEST(Codes, AscendAndAreExplainedInTheDocumentation) {
  const std::string page = Contents(Folder() / "../../../docs/formula.md");
  for (std::size_t i = 0; i < kCodes.size(); ++i) {
    EXPECT_TRUE(i == 0 || kCodes[i].code.front() != kCodes[i - 1].code.front() ||
                kCodes[i - 1].code < kCodes[i].code)
        << kCodes[i].code;
    const std::string row =
        "| " + std::string(kCodes[i].code) + " | " + std::string(kCodes[i].title) + " |";
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace kompono::formula
