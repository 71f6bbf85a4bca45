// SPDX-License-Identifier: Apache-2.0
#include "catalog_fixture.hpp"

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class VerifyTest : public CatalogTest {
 protected:
  [[nodiscard]] std::string Findings() const {
    const Parsed<Store> store = Store::Open(File());
    if (!store) return Said(store.error());
    const Parsed<VerifyReport> report = store->Verify();
    return report ? Said(report->findings) : Said(report.error());
  }
};

TEST_F(VerifyTest, FindsNothingWrongWithAFreshCatalog) {
  const Parsed<VerifyReport> report = Filled().Verify();
  ASSERT_TRUE(report) << Said(report.error());
  EXPECT_EQ(Said(report->findings), "");
  EXPECT_TRUE(report->Ok());
  EXPECT_EQ(report->layouts, 3);
  EXPECT_EQ(report->calibrations, 1);
}

TEST_F(VerifyTest, NoticesEveryChangeOfWhatALayoutStates) {
  static_cast<void>(Filled());
  const struct {
    const char* change;
    const char* undo;
  } changes[] = {
      {"UPDATE layout SET name = 'x' WHERE id = 2",
       "UPDATE layout SET name = 'Knee mill' WHERE id = 2"},
      {"UPDATE layout_text SET toml = toml || ' ' WHERE layout_id = 2",
       "UPDATE layout_text SET toml = rtrim(toml, ' ') WHERE layout_id = 2"},
      {"UPDATE layout_text SET content = 'x' WHERE layout_id = 2",
       "UPDATE layout_text SET content = NULL"},
      {"UPDATE parameter SET value = value + 1e-9 WHERE layout_id = 2",
       "UPDATE parameter SET value = 300 WHERE layout_id = 2"},
      {"UPDATE layout_block SET name = 'x' WHERE layout_id = 2",
       "UPDATE layout_block SET name = 'spindle' WHERE layout_id = 2"},
  };
  for (const auto& [change, undo] : changes) {
    Tamper(change);
    EXPECT_THAT(
        Findings(),
        AllOf(HasSubstr("layout 2 '"),
              HasSubstr("is not what its hash says: it was changed after it was added [E0532]"),
              HasSubstr("1 error\n")))
        << change;
    Tamper(undo);
    EXPECT_EQ(Findings(), "") << undo;
  }
  Tamper("UPDATE formula SET text = text || ' ' WHERE id = 3");
  EXPECT_THAT(Findings(), HasSubstr("layout 3 'Hexapod' is not what its hash says"));
}

TEST_F(VerifyTest, NoticesAChangedCalibration) {
  static_cast<void>(Filled());
  Tamper("UPDATE calibration SET rms_after_um = 1.0");
  EXPECT_THAT(
      Findings(),
      HasSubstr("the calibration of layout 1 with 'lambda.csv' is not what its hash says [E0533]"));
}

TEST_F(VerifyTest, NoticesResidualsThatAreNotTheNewest) {
  static_cast<void>(Filled());
  Tamper(
      "UPDATE layout SET rms_after_um = 1.0 WHERE id = 1; UPDATE layout SET rms_after_um = 1.0 "
      "WHERE id = 2");
  EXPECT_THAT(Findings(),
              AllOf(HasSubstr("the residuals of layout 1 are not"),
                    HasSubstr("the residuals of layout 2 are not"),
                    HasSubstr("2 errors")));
}

TEST_F(VerifyTest, NoticesLostRows) {
  static_cast<void>(Filled());
  Tamper(
      "PRAGMA foreign_keys = OFF; DELETE FROM layout_text WHERE layout_id = 1; DELETE FROM "
      "quantity WHERE name LIKE 'spindle%'");
  EXPECT_THAT(
      Findings(),
      AllOf(HasSubstr("layout 1 'Lambda water-jet' has lost its text or formula [E0532]"),
            HasSubstr("a row of table 'parameter' refers to a missing row of 'quantity' [E0531]")));
}

TEST_F(VerifyTest, NoticesAForeignSchema) {
  static_cast<void>(Filled());
  Tamper(
      "CREATE TABLE notes(x); DROP INDEX layout_by_name; DROP VIEW motions; CREATE VIEW motions AS "
      "SELECT 1 AS layout_id");
  EXPECT_THAT(Findings(),
              AllOf(HasSubstr("table notes does not belong to the catalog [E0534]"),
                    HasSubstr("index layout_by_name is missing [E0534]"),
                    HasSubstr("view motions is not as this program made it [E0534]")));
}

TEST_F(VerifyTest, NoticesAFlippedByte) {
  static_cast<void>(Filled());
  std::string bytes = Bytes(File());
  const std::size_t at = bytes.find("Knee mill\"");
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 'k';
  WriteBytes(File(), bytes);
  EXPECT_THAT(Findings(), HasSubstr("layout 2 'Knee mill' is not what its hash says"));
}

TEST_F(VerifyTest, NoticesWhereverANameIsOverwritten) {
  static_cast<void>(Filled());
  const std::string good = Bytes(File());
  std::string seen;
  int places = 0;
  for (std::size_t at = good.find("Hexapod"); at != std::string::npos;
       at = good.find("Hexapod", at + 1)) {
    std::string bytes = good;
    bytes[at] = 'h';
    WriteBytes(File(), bytes);
    const std::string findings = Findings();
    EXPECT_THAT(findings, HasSubstr("error")) << "at " << at;
    seen += findings;
    ++places;
  }
  EXPECT_EQ(places, 5) << "row, index, text, and twice in the words to search for";
  EXPECT_THAT(
      seen,
      AllOf(HasSubstr("row 3 missing from index layout_by_name [E0530]"), HasSubstr("[E0532]")));
}

}  // namespace
}  // namespace kompono::catalog
