// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Reading {
  std::string canonical;           ///< or the rendered complaints
  std::vector<std::string> notes;  ///< "N0102@1+2 message": code, column and length
};

Reading Read(std::string_view text) {
  Diagnostics notes;
  const auto formula = ParseFormula(text, "formula", &notes);
  Reading reading{formula ? Canonical(*formula) : RenderAll(formula.error(), {}), {}};
  for (const Diagnostic& note : notes) {
    EXPECT_EQ(note.severity, Severity::kNote);
    reading.notes.push_back(note.code + "@" + std::to_string(note.span.column) + "+" +
                            std::to_string(note.span.length) + " " + note.message);
  }
  return reading;
}

TEST(Latex, IsReadAsPrintedByTheJournal) {
  const Reading reading = Read("$Z_{xy}\\,X\\;Y\\ O\\,P_z Z$");
  EXPECT_EQ(reading.canonical, "part_xy X Y O Z P_z");
  EXPECT_THAT(reading.notes,
              ElementsAre("N0101@1+1 LaTeX '$' left out (2 places)",
                          "N0101@4+1 LaTeX braces left out",
                          "N0101@8+2 LaTeX '\\,' read as a space (2 places)",
                          "N0101@11+2 LaTeX '\\;' read as a space",
                          "N0101@14+2 LaTeX '\\ ' read as a space",
                          "N0105@2+6 'Z_{xy}' read as the workpiece 'part_xy'",
                          "N0104@19+3 'P_z' moved behind 'Z': a process is last on its side"));
}

TEST(Latex, ReadsFontsDelimitersAndBars) {
  EXPECT_EQ(
      Read("\\(\\mathrm{part}_{xy}\\left(XY\\right)\\text{:drive\\_1} O\\mid O Z\\)").canonical,
      "part_xy (XY):drive_1 O|O Z tool");
  EXPECT_EQ(Read("X_4 O C_{2}_{h}").canonical, "part X4 O C2_h tool");
}

TEST(Latex, BracesEndAnIndexWithoutASpace) {
  const Reading reading = Read("Z_{xy}zOC_{v}w");
  EXPECT_EQ(reading.canonical, "part_xy z O C_v w tool");
  for (const std::string& note : reading.notes) EXPECT_NE(note.substr(0, 5), "N0109") << note;
}

TEST(Cyrillic, LookAlikesAreReadAsLatin) {
  const Reading reading = Read("ХУZОС_v");
  EXPECT_EQ(reading.canonical, "part X Y Z O C_v tool");
  EXPECT_THAT(reading.notes,
              ElementsAre("N0102@1+2 Cyrillic 'ХУ' read as Latin 'XY'",
                          "N0102@4+2 Cyrillic 'ОС' read as Latin 'OC'"));
  EXPECT_EQ(Read("рart_ху АВСЕ О Р Х а в с е р х у").canonical,
            "part_xy A B C E O P X a b c e p x y tool");
}

TEST(Cyrillic, OtherLettersAreErrors) {
  EXPECT_THAT(Read("Х О Ж").canonical, testing::HasSubstr("'Ж' means nothing here [E0129]"));
  EXPECT_THAT(Read("З О Х").canonical, testing::HasSubstr("write part for the workpiece"));
}

TEST(Zero, StandsForTheBaseWhereNoneIs) {
  const Reading reading = Read("XYZ0C_v");
  EXPECT_EQ(reading.canonical, "part X Y Z O C_v tool");
  EXPECT_THAT(reading.notes, ElementsAre("N0103@4+1 digit '0' read as the base 'O'"));
  EXPECT_EQ(Read("X 0(Y+Z)").canonical, "part X O (Y tool1 + Z tool2)");
  EXPECT_EQ(Read("X 0|O Z").canonical, "part X O|O Z tool");
  EXPECT_EQ(Read("(XY):a0 0").canonical, "part (XY):a0 O tool") << "in a block name it is a digit";
}

TEST(Leaf, IsMovedToTheEndOfItsSide) {
  const Reading reading = Read("X part Y O P_z Z W");
  EXPECT_EQ(reading.canonical, "part X Y O Z W P_z");
  EXPECT_THAT(
      reading.notes,
      ElementsAre("N0104@3+4 'part' moved in front of 'X': a workpiece is first on its side",
                  "N0104@12+3 'P_z' moved behind 'Z W': a process is last on its side"));
}

TEST(Iso230, IsReadWithTheSpindleAsAPlainAxis) {
  const Reading reading = Read("[w X' b Y Z (C) t]");
  EXPECT_EQ(reading.canonical, "part X O Y Z C tool");
  EXPECT_THAT(
      reading.notes,
      ElementsAre("N0106@1+18 structural code of ISO 230-1 read: w is part, b is O, t is tool",
                  "N0107@13+3 spindle '(C)' read as the plain axis 'C': ISO 230-1 does not tell "
                  "how it lies"));
}

TEST(Iso230, TellsTheSpindleFromARotaryTable) {
  EXPECT_EQ(Read("[w C' B' X' b Y Z (C) t]").canonical, "part C B X O Y Z C2 tool");
  EXPECT_EQ(Read("[w C2' C' b Z (C) t]").canonical, "part C2 C O Z C3 tool");
  EXPECT_EQ(Read("[w b (C) (C) t]").canonical, "part O C C2 tool");
}

TEST(Iso230, IsTurnedRoundWhenWrittenFromTheTool) {
  EXPECT_EQ(Read("[t-(C1)-Z-Y-b-X′-w]").canonical, "part X O Y Z C1 tool");
  EXPECT_EQ(Read("[t Z b X']").canonical, "part X O Z tool");
  EXPECT_EQ(Read("[Z b X' w]").canonical, "part X O Z tool");
  EXPECT_EQ(Read("[w (C') b Z X t]").canonical, "part C O Z X tool");
}

TEST(Index, EndsWhereTheNextMotionBegins) {
  const Reading reading = Read("part_xyw O C_vz P_zu");
  EXPECT_EQ(reading.canonical, "part_xy w O C_v z u P_z");
  EXPECT_THAT(reading.notes,
              ElementsAre("N0109@8+1 index '_xy' ends before 'w', read as a setting motion",
                          "N0109@15+1 index '_v' ends before 'z', read as a setting motion",
                          "N0109@20+1 index '_z' ends before 'u', read as a setting motion",
                          "N0104@17+3 'P_z' moved behind 'u': a process is last on its side"));
}

TEST(OurNotation, GivesNoNotes) {
  EXPECT_THAT(Read("part_xy (XY):drive O|O Z P_z").notes, IsEmpty());
  EXPECT_THAT(Read("COZXbwd").notes, IsEmpty());
}

}  // namespace
}  // namespace kompono::formula
