// SPDX-License-Identifier: Apache-2.0
#include "opening.hpp"

#include "bulk.hpp"
#include "failure.hpp"
#include "schema.hpp"
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>

#include <sqlite3.h>

namespace kompono::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic{"SQLite format 3\0", 16};

struct Header {
  enum class Kind { kMissing, kEmpty, kCatalog } kind = Kind::kMissing;
  int version = 0;
};

std::int32_t BigEndian(const std::array<char, 100>& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i)
    value = value << 8U | static_cast<std::uint8_t>(bytes.at(i));
  return static_cast<std::int32_t>(value);
}

fs::path WithSuffix(fs::path path, std::string_view suffix) {
  return path += suffix;
}

/// SQLite's file format, section 1.3: magic at 0, user version at 60, application id at 68.
Parsed<Header> ReadHeader(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return Header{};
  if (error) return Refuse("E0502", name, fmt::format("cannot be read: {}", error.message()));
  if (!fs::is_regular_file(status)) return Refuse("E0502", name, "is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return Refuse(
        "E0502", name, fmt::format("cannot be read: {}", std::generic_category().message(errno)));
  std::array<char, 100> bytes{};
  file.read(bytes.data(), bytes.size());
  const std::streamsize size = file.gcount();
  if (size == 0) return Header{.kind = Header::Kind::kEmpty};
  if (size < static_cast<std::streamsize>(bytes.size()) ||
      std::string_view(bytes.data(), kMagic.size()) != kMagic) {
    return Refuse("E0503",
                  name,
                  "this is not an SQLite database",
                  "a catalog is made by 'kompono catalog add'");
  }
  if (BigEndian(bytes, 68) != kApplicationId) {
    return Refuse("E0504",
                  name,
                  "this SQLite database is not a kompono catalog",
                  "give another file name; it was left as it is");
  }
  return Header{.kind = Header::Kind::kCatalog, .version = BigEndian(bytes, 60)};
}

/// Who wrote a file that is too new for us; empty if it does not say.
std::string WriterOf(const fs::path& path) {
  const bool quiet = !fs::exists(WithSuffix(path, "-wal"));
  try {
    SQLite::Database db(UriOf(path, quiet), SQLite::OPEN_READONLY | SQLite::OPEN_URI);
    return db.execAndGet("SELECT program_version FROM schema_history ORDER BY version DESC LIMIT 1")
        .getString();
  } catch (const SQLite::Exception&) {
    return "";
  }
}

tl::unexpected<Diagnostics> TooNew(const fs::path& path, int version) {
  const std::string writer = WriterOf(path);
  return Refuse(
      "E0505",
      path.string(),
      fmt::format(
          "the catalog has schema {}, newer than this program's {}", version, NewestVersion()),
      writer.empty() ? fmt::format("use a kompono newer than {}", KOMPONO_PROGRAM_VERSION)
                     : fmt::format("use kompono {} or newer", writer));
}

/// Removed at the end of the scope, whatever happens.
class Draft {
 public:
  explicit Draft(const fs::path& path) {
    static std::atomic<int> count = 0;
    path_ = WithSuffix(path, fmt::format(".{}.{}.part", ::getpid(), count++));
    Remove();
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  Draft(Draft&&) = delete;
  Draft& operator=(Draft&&) = delete;
  ~Draft() { Remove(); }

  [[nodiscard]] const fs::path& Path() const { return path_; }

 private:
  void Remove() const {
    std::error_code ignored;
    fs::remove(path_, ignored);
    fs::remove(WithSuffix(path_, "-journal"), ignored);
  }
  fs::path path_;
};

/// A draft needs no journal on the disk: if making it fails it is thrown away.
void Fill(const fs::path& path, bool draft) {
  SQLite::Database db(
      UriOf(path, false), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE | SQLite::OPEN_URI, 5000);
  Configure(db);
  if (draft) db.exec("PRAGMA journal_mode = MEMORY");
  CreateSchema(db);
}

/// Made aside and put in place complete, so that no program ever sees half a catalog; two creating
/// at once agree on the first one's file. Empty: done.
Diagnostics Create(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return {Complaint(
        "E0502", path.string(), fmt::format("the folder '{}' does not exist", folder.string()))};
  }
  const Draft draft(path);
  Fill(draft.Path(), true);
  fs::create_hard_link(draft.Path(), path, error);
  if (!error || error == std::errc::file_exists) return {};
  fs::rename(draft.Path(), path, error);  // a file system without hard links
  if (!error) return {};
  return {Complaint("E0502", path.string(), fmt::format("cannot be created: {}", error.message()))};
}

/// A Store serves one thread at a time, so SQLite need not lock its connection at every call.
std::unique_ptr<SQLite::Database> Connect(const std::string& uri,
                                          int flags,
                                          std::chrono::milliseconds timeout) {
  auto db = std::make_unique<SQLite::Database>(
      uri, flags | SQLite::OPEN_URI | SQLite::OPEN_NOMUTEX, static_cast<int>(timeout.count()));
  sqlite3_extended_result_codes(db->getHandle(), 1);
  return db;
}

/// Reading needs a writable connection where there may be one: only the last of those tidies up the
/// log's files.
Opened OpenForReading(const fs::path& path, std::chrono::milliseconds timeout) {
  Opened opened;
  const bool writable = ::access(path.c_str(), W_OK) == 0;
  try {
    opened.db = Connect(
        UriOf(path, false), writable ? SQLite::OPEN_READWRITE : SQLite::OPEN_READONLY, timeout);
    Configure(*opened.db);
    static_cast<void>(
        VersionOf(*opened.db));  // the first access, which finds out whether the folder will do
  } catch (const SQLite::Exception& e) {
    const int code = e.getErrorCode() & 0xFF;
    const bool no_log = !fs::exists(WithSuffix(path, "-wal"));
    if ((code != SQLITE_CANTOPEN && code != SQLITE_READONLY) || !no_log) throw;
    opened.db = Connect(UriOf(path, true), SQLite::OPEN_READONLY, timeout);
    Configure(*opened.db);
    opened.immutable = true;
  }
  opened.db->exec("PRAGMA query_only = ON");
  return opened;
}

Parsed<Opened> OpenForWriting(const fs::path& path, std::chrono::milliseconds timeout) {
  if (::access(path.c_str(), W_OK) != 0) {
    return Refuse("E0502",
                  path.string(),
                  fmt::format("cannot be written: {}", std::generic_category().message(errno)));
  }
  Opened opened;
  opened.db = Connect(UriOf(path, false), SQLite::OPEN_READWRITE, timeout);
  Configure(*opened.db);
  const int version = VersionOf(*opened.db);
  if (version > NewestVersion()) return TooNew(path, version);
  if (version < NewestVersion()) {
    Parsed<Diagnostics> notes = Upgrade(*opened.db, path);
    if (!notes) return tl::make_unexpected(notes.error());
    opened.notes = *std::move(notes);
  }
  opened.db->exec("PRAGMA journal_mode = WAL");
  opened.db->exec(fmt::format("PRAGMA cache_size = {}", -kWriterCacheKib));
  // Many pages are written again and again: move the log into the file less often.
  opened.db->exec("PRAGMA wal_autocheckpoint = 16384");
  if (BulkLoading(*opened.db)) {
    EndBulk(*opened.db);
    opened.notes.push_back({.severity = Severity::kNote,
                            .code = "N0502",
                            .file = path.string(),
                            .message = "the indexes were made that a load left out",
                            .help = ""});
  }
  return opened;
}

}  // namespace

Parsed<Opened> OpenCatalog(const fs::path& path, const OpenOptions& options) {
  return Guarded(path.string(), [&]() -> Parsed<Opened> {
    Parsed<Header> header = ReadHeader(path);
    if (!header) return tl::make_unexpected(header.error());
    if (header->kind != Header::Kind::kCatalog) {
      if (options.mode != OpenMode::kCreate) {
        return header->kind == Header::Kind::kMissing
                   ? Refuse("E0501",
                            path.string(),
                            "no such catalog",
                            "it is made by 'kompono catalog add'")
                   : Refuse("E0503", path.string(), "the file is empty");
      }
      if (header->kind == Header::Kind::kEmpty) {
        Fill(path, false);
      } else if (Diagnostics trouble = Create(path); !trouble.empty()) {
        return tl::make_unexpected(std::move(trouble));
      }
    }
    if (header->version > NewestVersion()) return TooNew(path, header->version);
    if (options.mode != OpenMode::kReadOnly) return OpenForWriting(path, options.busy_timeout);
    Opened opened = OpenForReading(path, options.busy_timeout);
    const int version = VersionOf(*opened.db);
    if (version > NewestVersion()) return TooNew(path, version);
    if (version < NewestVersion()) {
      return Refuse(
          "E0506",
          path.string(),
          fmt::format(
              "the catalog has schema {}, older than this program's {}", version, NewestVersion()),
          "a command that writes, such as 'kompono catalog add', brings it up to date after making "
          "a copy");
    }
    return opened;
  });
}

}  // namespace kompono::catalog
