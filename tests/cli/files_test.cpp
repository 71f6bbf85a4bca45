// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Files : public testing::Test {
 protected:
  Files() {
    std::string name = (fs::temp_directory_path() / "kompono-files-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  [[nodiscard]] std::string Path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string Text(const std::string& name) const {
    std::ifstream in(Path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::size_t Count() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(Files, ANewFileIsWrittenWithUsualPermissions) {
  EXPECT_EQ(WriteFileAside(Path("a"), "text\n", false), std::nullopt);
  EXPECT_EQ(Text("a"), "text\n");
  const mode_t mask = ::umask(0);
  ::umask(mask);
  struct stat status {};
  ASSERT_EQ(::stat(Path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0666U & ~mask);
  EXPECT_EQ(Count(), 1U);
}

TEST_F(Files, AnExistingFileIsKeptUnlessForced) {
  ASSERT_EQ(WriteFileAside(Path("a"), "old", false), std::nullopt);
  fs::permissions(Path("a"), fs::perms::owner_read | fs::perms::owner_write);
  const auto refused = WriteFileAside(Path("a"), "new", false);
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->code, "E0615");
  EXPECT_EQ(Text("a"), "old");
  EXPECT_EQ(WriteFileAside(Path("a"), "new", true), std::nullopt);
  EXPECT_EQ(Text("a"), "new");
  EXPECT_EQ(fs::status(Path("a")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(Count(), 1U);
}

TEST_F(Files, RefusingBeforehandLooksAtFilesOnly) {
  ASSERT_EQ(WriteFileAside(Path("a"), "old", false), std::nullopt);
  EXPECT_TRUE(RefuseToOverwrite(Path("a"), false).has_value());
  EXPECT_FALSE(RefuseToOverwrite(Path("a"), true).has_value());
  EXPECT_FALSE(RefuseToOverwrite(Path("b"), false).has_value());
  EXPECT_FALSE(RefuseToOverwrite("", false).has_value());
  EXPECT_FALSE(RefuseToOverwrite("/dev/null", false).has_value());
}

TEST_F(Files, FailuresLeaveNothingBehind) {
  const auto nowhere = WriteFileAside(Path("no/such/folder/a"), "text", false);
  ASSERT_TRUE(nowhere.has_value());
  EXPECT_EQ(nowhere->code, "E0614");
  EXPECT_THAT(nowhere->message, HasSubstr("No such file or directory"));
  const auto folder = WriteFileAside(folder_, "text", true);
  ASSERT_TRUE(folder.has_value());
  EXPECT_EQ(folder->code, "E0614");
  EXPECT_EQ(Count(), 0U);
}

TEST_F(Files, DevicesAreWrittenDirectlyAndTheirErrorsNoticed) {
  EXPECT_EQ(WriteFileAside("/dev/null", "text", false), std::nullopt);
  const auto full = WriteFileAside("/dev/full", "text", false);
  ASSERT_TRUE(full.has_value());
  EXPECT_THAT(full->message, HasSubstr("No space left"));
}

TEST_F(Files, LinksStayLinks) {
  ASSERT_EQ(WriteFileAside(Path("a"), "old", false), std::nullopt);
  fs::create_symlink("a", Path("link"));
  EXPECT_EQ(WriteFileAside(Path("link"), "new", true), std::nullopt);
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(Text("a"), "new");
}

TEST_F(Files, ReadingTellsWhyNot) {
  ASSERT_EQ(WriteFileAside(Path("a"), std::string("b\0c", 3), false), std::nullopt);
  EXPECT_EQ(ReadWhole(Path("a")).value(), std::string("b\0c", 3));
  const auto missing = ReadWhole(Path("b"));
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().front().code, "E0613");
  EXPECT_THAT(ReadWhole(folder_).error().front().message, HasSubstr("Is a directory"));
}

}  // namespace
}  // namespace kompono::cli
