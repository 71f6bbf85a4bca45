// SPDX-License-Identifier: Apache-2.0
// A run that is killed at any moment: what it had committed is there, the file is sound, and the
// next run completes it to the same contents.
#include "catalog_fixture.hpp"
#include "study_fixture.hpp"
#include <sys/wait.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

namespace kompono::catalog {
namespace {

constexpr std::int64_t kCandidates = 3000;
constexpr std::int64_t kChunk = 40;
constexpr int kKills = 200;

/// Printed with every failure; KOMPONO_SEED repeats a run.
unsigned Seed() {
  const char* given = std::getenv("KOMPONO_SEED");
  return given == nullptr ? std::random_device{}()
                          : static_cast<unsigned>(std::strtoul(given, nullptr, 10));
}

class KillTest : public CatalogTest {
 protected:
  /// Runs the writer; kills it `after` that time, or lets it finish. What it said it had committed.
  [[nodiscard]] std::vector<IndexRange> Write(const std::string& name,
                                              bool bulk,
                                              std::chrono::microseconds after,
                                              bool& finished) const {
    const std::string program = fmt::format("{}/tests/chunk_writer", KOMPONO_BINARY_DIR);
    const std::string file = File(name).string();
    const std::string candidates = std::to_string(kCandidates);
    const std::string chunk = std::to_string(kChunk);
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) throw std::runtime_error("no pipe");
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(pipe[1], STDOUT_FILENO);
      ::close(pipe[0]);
      ::close(pipe[1]);
      ::execl(program.c_str(),
              program.c_str(),
              file.c_str(),
              candidates.c_str(),
              chunk.c_str(),
              bulk ? "bulk" : nullptr,
              nullptr);
      std::_Exit(127);
    }
    ::close(pipe[1]);
    if (after.count() > 0) {
      ::usleep(static_cast<useconds_t>(after.count()));
      ::kill(child, SIGKILL);
    }
    std::string said;
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = ::read(pipe[0], buffer.data(), buffer.size())) > 0;)
      said.append(buffer.data(), static_cast<std::size_t>(n));
    ::close(pipe[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    finished = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    EXPECT_TRUE(finished || (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL))
        << "the writer ended by itself with " << status;
    return Committed(said);
  }

  /// A last line that was cut off counts for nothing.
  static std::vector<IndexRange> Committed(const std::string& said) {
    std::vector<IndexRange> ranges;
    std::istringstream lines(said.substr(0, said.rfind('\n') + 1));
    for (IndexRange range; lines >> range.begin >> range.end;) ranges.push_back(range);
    return ranges;
  }

  [[nodiscard]] std::string Exported(const std::string& name) const {
    const Parsed<Store> store = Store::Open(File(name));
    if (!store) return Said(store.error());
    const auto written = store->ExportAll(ExportFormat::kJson, File("export.json"));
    return written ? Bytes(File("export.json")) : Said(written.error());
  }

  /// Sound, and with all that was committed.
  void Examine(const std::string& name, const std::vector<IndexRange>& committed) const {
    if (!std::filesystem::exists(File(name))) {
      EXPECT_TRUE(committed.empty());
      return;
    }
    const Parsed<Store> store = Store::Open(File(name));
    ASSERT_TRUE(store) << Said(store.error());
    const Parsed<VerifyReport> report = store->Verify();
    ASSERT_TRUE(report) << Said(report.error());
    EXPECT_EQ(Said(report->findings), "");
    const auto studies = store->Studies();
    if (studies->empty()) {
      EXPECT_TRUE(committed.empty());
      return;
    }
    for (const IndexRange& range : committed) {
      EXPECT_TRUE(store->MissingRanges(studies->front().id, range)->empty())
          << range.begin << " .. " << range.end << " was committed and is lost";
    }
  }
};

TEST_F(KillTest, TwoHundredKillsLoseNothing) {
  const unsigned seed = Seed();
  std::printf("KOMPONO_SEED=%u\n", seed);
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);

  bool finished = false;
  const auto begin = std::chrono::steady_clock::now();
  static_cast<void>(Write("whole.db", false, {}, finished));
  ASSERT_TRUE(finished);
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now() - begin);
  const std::string expected = Exported("whole.db");
  ASSERT_GT(expected.size(), 100'000U);

  int killed = 0;
  int completed = 0;
  std::size_t committed_chunks = 0;
  std::uniform_int_distribution<std::int64_t> moment(1000, whole.count() / 3);
  for (int file = 0; killed < kKills; ++file) {
    const std::string name = fmt::format("run{}.db", file);
    const bool bulk = file % 2 == 1;
    std::vector<IndexRange> committed;
    for (finished = false; !finished;) {
      const bool kill = killed < kKills;
      const std::chrono::microseconds after(kill ? moment(random) : 0);
      const std::vector<IndexRange> more = Write(name, bulk, after, finished);
      killed += finished ? 0 : 1;
      committed.insert(committed.end(), more.begin(), more.end());
      Examine(name, committed);
      if (HasFailure()) return;
    }
    committed_chunks += committed.size();
    ++completed;
    EXPECT_TRUE(Exported(name) == expected) << name << " is not what one run gives";
    for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(File(name + suffix));
  }
  std::printf("%d kills, %d catalogs completed, %zu chunks committed\n",
              killed,
              completed,
              committed_chunks);
  EXPECT_GE(completed, 2) << "kills came too early to be of use";
}

TEST_F(KillTest, ALostEvaluationWouldBeNoticed) {
  bool finished = false;
  const std::vector<IndexRange> committed = Write("machines.db", false, {}, finished);
  ASSERT_TRUE(finished);
  EXPECT_EQ(committed.size(), kCandidates / kChunk);
  Tamper("DELETE FROM evaluation WHERE candidate = 1234");
  const Parsed<Store> store = Store::Open(File());
  EXPECT_FALSE(store->Verify()->Ok());
}

}  // namespace
}  // namespace kompono::catalog
