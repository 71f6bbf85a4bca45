// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include "codes.hpp"
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace kompono::cli {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { static_cast<void>(Close()); }

  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool Close() {
    const bool ok = number_ <= STDERR_FILENO || ::close(number_) == 0;
    number_ = -1;
    return ok;
  }

 private:
  int number_;
};

Diagnostic Failure(const CodeTitle& code,
                   const std::string& file,
                   std::string_view what,
                   int error) {
  return {.code = std::string(code.code),
          .file = file,
          .message = fmt::format("{}: {}", what, std::strerror(error))};
}

Diagnostic Exists(const std::string& file) {
  return {.code = std::string(codes::kFileExists.code),
          .file = file,
          .message = "exists already and is not overwritten",
          .help = "name another file, or give --force"};
}

bool WriteText(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Permissions as a newly created file would have, or those of the file that is replaced.
mode_t ModeFor(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) return status.st_mode & 07777U;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666U & ~mask;
}

/// rename() that fails with EEXIST where a file has come into being since the first look.
bool RenameIntoNothing(const char* from, const char* to) {
  if (::renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // The file system cannot do it in one step.
  if (::access(to, F_OK) != 0) return ::rename(from, to) == 0;
  errno = EEXIST;
  return false;
}

std::optional<Diagnostic> WriteDirectly(const std::string& file, std::string_view text) {
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (out.number() < 0 || !WriteText(out.number(), text) || !out.Close()) {
    return Failure(codes::kCannotWrite, file, "cannot be written", errno);
  }
  return std::nullopt;
}

}  // namespace

Parsed<std::string> ReadWhole(const std::string& file) {
  const int number =
      file == "-" ? STDIN_FILENO : ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (number < 0) {
    return tl::unexpected(Diagnostics{Failure(codes::kCannotRead, file, "cannot be read", errno)});
  }
  const Descriptor in(number);
  std::string text;
  std::array<char, 1U << 15U> piece{};
  while (true) {
    const ssize_t count = ::read(in.number(), piece.data(), piece.size());
    if (count == 0) return text;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return tl::unexpected(
          Diagnostics{Failure(codes::kCannotRead, file, "cannot be read", errno)});
    }
    text.append(piece.data(), static_cast<std::size_t>(count));
  }
}

std::optional<Diagnostic> RefuseToOverwrite(const std::string& file, bool force) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (force || !std::filesystem::is_regular_file(status)) return std::nullopt;
  return Exists(file);
}

std::optional<Diagnostic> WriteFileAside(const std::string& file,
                                         std::string_view text,
                                         bool force) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_directory(status)) {
    return Failure(codes::kCannotWrite, file, "cannot be written", EISDIR);
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return WriteDirectly(file, text);
  }
  // A link is followed: its target is replaced, not the link.
  const std::filesystem::path target = std::filesystem::is_symlink(file, ignored)
                                           ? std::filesystem::weakly_canonical(file, ignored)
                                           : std::filesystem::path(file);
  std::string aside = target.string() + ".XXXXXX";
  Descriptor out(::mkstemp(aside.data()));
  if (out.number() < 0) return Failure(codes::kCannotWrite, file, "cannot be written", errno);
  bool ok = WriteText(out.number(), text) && ::fchmod(out.number(), ModeFor(target)) == 0 &&
            ::fsync(out.number()) == 0 && out.Close();
  ok = ok && (force ? ::rename(aside.c_str(), target.c_str()) == 0
                    : RenameIntoNothing(aside.c_str(), target.c_str()));
  const int error = errno;
  if (!ok) ::unlink(aside.c_str());
  if (ok) return std::nullopt;
  if (error == EEXIST) return Exists(file);
  return Failure(codes::kCannotWrite, file, "cannot be written", error);
}

}  // namespace kompono::cli
