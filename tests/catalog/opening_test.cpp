// SPDX-License-Identifier: Apache-2.0
#include "catalog_fixture.hpp"
#include <sys/types.h>

#include <fstream>

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class OpeningTest : public CatalogTest {
 protected:
  /// Opening must fail with `code` in every mode and leave the file's bytes and its folder alone.
  void ExpectRefused(const std::string& code) const {
    const std::string before = std::filesystem::is_regular_file(File()) ? Bytes(File()) : "";
    const std::vector<std::string> files = FilesInFolder();
    for (const OpenMode mode : {OpenMode::kReadOnly, OpenMode::kReadWrite, OpenMode::kCreate}) {
      EXPECT_EQ(CodeOf(Store::Open(File(), {.mode = mode})), code)
          << "mode " << static_cast<int>(mode);
    }
    if (std::filesystem::is_regular_file(File())) {
      EXPECT_TRUE(Bytes(File()) == before) << "the file was touched";
    }
    EXPECT_EQ(FilesInFolder(), files);
  }
};

/// Root may write everywhere, so tests about permissions act as somebody else meanwhile.
class AsNobody {
 public:
  AsNobody() : own_(::geteuid()) {
    if (own_ == 0 && ::seteuid(65534) != 0) throw std::runtime_error("seteuid");
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;
  AsNobody(AsNobody&&) = delete;
  AsNobody& operator=(AsNobody&&) = delete;
  ~AsNobody() {
    if (own_ == 0) static_cast<void>(::seteuid(0));
  }

 private:
  uid_t own_;
};

TEST_F(OpeningTest, MakesACatalogOnlyWhenAskedTo) {
  EXPECT_EQ(CodeOf(Store::Open(File())), "E0501");
  EXPECT_EQ(CodeOf(Store::Open(File(), {.mode = OpenMode::kReadWrite})), "E0501");
  EXPECT_THAT(FilesInFolder(), ElementsAre());
  EXPECT_TRUE(Store::Open(File(), {.mode = OpenMode::kCreate}));
  EXPECT_THAT(FilesInFolder(), ElementsAre("machines.db"))
      << "nothing is left beside the file after closing";
  EXPECT_TRUE(Store::Open(File()));
}

TEST_F(OpeningTest, LeavesNothingBesideTheFileAfterReading) {
  static_cast<void>(Filled());
  {
    Parsed<Store> store = Store::Open(File());
    ASSERT_TRUE(store) << Said(store.error());
    EXPECT_TRUE(store->Query({}));
  }
  EXPECT_THAT(FilesInFolder(), ElementsAre("machines.db"));
}

TEST_F(OpeningTest, TakesAnEmptyFileForANewCatalog) {
  WriteBytes(File(), "");
  EXPECT_EQ(CodeOf(Store::Open(File(), {.mode = OpenMode::kReadWrite})), "E0503");
  Parsed<Store> store = Store::Open(File(), {.mode = OpenMode::kCreate});
  ASSERT_TRUE(store) << Said(store.error());
  EXPECT_TRUE(store->Add(KneeMill()));
}

TEST_F(OpeningTest, NamesWithSpecialCharactersAreJustNames) {
  for (const std::string name :
       {"a b.db", "50%.db", "what?.db", "a#b.db", "mode=ro&x.db", "Фреза.db"}) {
    EXPECT_TRUE(Create(name).Add(KneeMill())) << name;
    EXPECT_TRUE(std::filesystem::exists(File(name))) << name;
    EXPECT_TRUE(Store::Open(File(name))->Query({})) << name;
  }
}

TEST_F(OpeningTest, RefusesAFileThatIsNoDatabase) {
  WriteBytes(File(), "name = \"a layout, not a catalog\"\n");
  ExpectRefused("E0503");
  WriteBytes(File(), std::string(5000, 'x'));
  ExpectRefused("E0503");
  WriteBytes(File(), "SQLite format 3");
  ExpectRefused("E0503");
}

TEST_F(OpeningTest, RefusesAForeignDatabase) {
  SQLite::Database(File().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE layout(x)");
  ExpectRefused("E0504");
}

TEST_F(OpeningTest, RefusesAFolder) {
  std::filesystem::create_directory(File());
  ExpectRefused("E0502");
}

TEST_F(OpeningTest, RefusesAMissingFolder) {
  const auto opened = Store::Open(folder_ / "no" / "machines.db", {.mode = OpenMode::kCreate});
  EXPECT_EQ(CodeOf(opened), "E0502");
  EXPECT_THAT(Said(opened.error()), HasSubstr("does not exist"));
}

TEST_F(OpeningTest, RefusesANewerSchemaAndSaysWhichProgramReadsIt) {
  static_cast<void>(Filled());
  Tamper(
      "PRAGMA user_version = 99;"
      "INSERT INTO schema_history VALUES(99, 'future', '7.8.9', '2031-01-01T00:00:00Z')");
  ExpectRefused("E0505");
  const auto opened = Store::Open(File());
  EXPECT_THAT(Said(opened.error()),
              HasSubstr("the catalog has schema 99, newer than this program's 3 [E0505]"));
  EXPECT_THAT(Said(opened.error()), HasSubstr("help: use kompono 7.8.9 or newer"));
}

TEST_F(OpeningTest, RefusesANewerSchemaThatTellsNothingElse) {
  static_cast<void>(Filled());
  Tamper("PRAGMA user_version = 99; DROP TABLE schema_history");
  ExpectRefused("E0505");
}

TEST_F(OpeningTest, RefusesATruncatedCatalog) {
  static_cast<void>(Filled());
  std::filesystem::resize_file(File(), std::filesystem::file_size(File()) / 2);
  ExpectRefused("E0508");
}

TEST_F(OpeningTest, RefusesAnOverwrittenFirstPage) {
  static_cast<void>(Filled());
  std::string bytes = Bytes(File());
  bytes.replace(100, 3000, std::string(3000, '\xee'));
  WriteBytes(File(), bytes);
  ExpectRefused("E0508");
}

TEST_F(OpeningTest, ReportsAFileThatMayNotBeRead) {
  static_cast<void>(Filled());
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  std::filesystem::permissions(File(), std::filesystem::perms::none);
  const AsNobody nobody;
  const auto opened = Store::Open(File());
  EXPECT_EQ(CodeOf(opened), "E0502");
  EXPECT_THAT(Said(opened.error()), HasSubstr("Permission denied"));
}

TEST_F(OpeningTest, ReadsButDoesNotWriteInAReadOnlyFolder) {
  using std::filesystem::perms;
  static_cast<void>(Filled());
  const std::string before = Bytes(File());
  std::filesystem::permissions(File(), perms::owner_read | perms::group_read | perms::others_read);
  std::filesystem::permissions(
      folder_, perms::all & ~(perms::owner_write | perms::group_write | perms::others_write));
  {
    const AsNobody nobody;
    EXPECT_EQ(CodeOf(Store::Open(File(), {.mode = OpenMode::kReadWrite})), "E0502");
    EXPECT_EQ(CodeOf(Store::Open(File("new.db"), {.mode = OpenMode::kCreate})), "E0502");
    Parsed<Store> store = Store::Open(File());
    ASSERT_TRUE(store) << Said(store.error());
    const Parsed<Table> table = store->Query({.where = "rms_after_um < 100"});
    ASSERT_TRUE(table) << Said(table.error());
    EXPECT_EQ(table->rows.size(), 1U);
    EXPECT_TRUE(store->Verify()->Ok());
  }
  std::filesystem::permissions(folder_, perms::owner_all);
  EXPECT_TRUE(Bytes(File()) == before);
  EXPECT_THAT(FilesInFolder(), ElementsAre("machines.db"));
}

TEST_F(OpeningTest, ReadsWhatAnotherProgramWroteButNotYetMovedIntoTheFile) {
  Store writer = Filled();
  ASSERT_TRUE(std::filesystem::exists(File("machines.db-wal"))) << "the case under test";
  Parsed<Store> reader = Store::Open(File());
  ASSERT_TRUE(reader) << Said(reader.error());
  EXPECT_EQ(reader->Query({})->rows.size(), 3U);
}

}  // namespace
}  // namespace kompono::catalog
