// SPDX-License-Identifier: Apache-2.0
// kompono synthesize killed at any moment of its run: the catalog is sound, and the next run
// completes it to the same contents. KOMPONO_KILLS says how often (few if not said), KOMPONO_SEED
// repeats a run.
#include "program.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

namespace kompono::cli_test {
namespace {

using testing::HasSubstr;

unsigned long Setting(const char* name, unsigned long otherwise) {
  const char* given = std::getenv(name);
  return given == nullptr ? otherwise : std::strtoul(given, nullptr, 10);
}

#ifdef __SANITIZE_ADDRESS__
constexpr unsigned long kKills = 2;  // each run takes twenty times as long
#else
constexpr unsigned long kKills = 10;
#endif

class SynthesizeKill : public Program {
 protected:
  SynthesizeKill() { Set("STUDY", Source("layouts/studies/so_waterjet.toml")); }

  /// Everything that the catalog holds, in its fixed order.
  [[nodiscard]] std::string Everything() const {
    const Outcome outcome =
        Run({"catalog", "export", "run.db", "--as", "json", "--out", "all.json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Read("all.json");
  }

  /// Rows that lie in the catalog, after it was found sound; nothing yet is sound, too.
  [[nodiscard]] std::uint64_t SoundRows() const {
    if (!std::filesystem::exists(folder() / "work" / "run.db")) return 0;
    const Outcome verified = Run({"catalog", "verify", "run.db"});
    EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
    const Outcome done = Shell("\"$K\" synthesize \"$STUDY\" --catalog run.db --limit 1 --json");
    EXPECT_EQ(done.code, 0) << done.err;
    return nlohmann::json::parse(done.out)["evaluated"].get<std::uint64_t>() == 0 ? 1 : 0;
  }

  void Remove() const { static_cast<void>(Shell("rm -f run.db run.db-wal run.db-shm all.json")); }
};

TEST_F(SynthesizeKill, WhatIsCommittedStaysAndTheRestIsMadeUp) {
  const unsigned long kills = Setting("KOMPONO_KILLS", kKills);
  const unsigned long seed = Setting("KOMPONO_SEED", std::random_device{}());
  std::printf("KOMPONO_SEED=%lu\n", seed);
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);

  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(Shell("\"$K\" synthesize \"$STUDY\" --catalog run.db").code, 0);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
  const std::string expected = Everything();
  ASSERT_THAT(expected, HasSubstr("(XY):drive O|O Z P_z"));
  Remove();

  std::uniform_real_distribution<double> moment(0.0, 0.8 * whole.count());
  unsigned long killed = 0;
  unsigned long with_rows = 0;
  for (unsigned long run = 0; run < kills; ++run) {
    const double after = run == 0 ? 0.3 * whole.count() : moment(random);
    Set("AFTER", std::to_string(after));
    const Outcome cut = Shell(
        "\"$K\" synthesize \"$STUDY\" --catalog run.db > /dev/null 2>&1 & sleep $AFTER; "
        "kill -9 $! 2> /dev/null; wait $! 2> /dev/null");
    ASSERT_TRUE(cut.code == 137 || cut.code == 0) << "it ended by itself with " << cut.code;
    killed += cut.code == 137 ? 1 : 0;
    with_rows += cut.code == 137 ? SoundRows() : 0;
    const Outcome rest = Shell("\"$K\" synthesize \"$STUDY\" --catalog run.db");
    ASSERT_EQ(rest.code, 0) << rest.err;
    ASSERT_TRUE(Everything() == expected) << "run " << run;
    Remove();
  }
  std::printf("%lu runs of %.2f s: %lu killed inside, %lu of them with rows committed\n",
              kills,
              whole.count(),
              killed,
              with_rows);
  EXPECT_GT(killed, 0U) << "kills came too late to be of use";
}

}  // namespace
}  // namespace kompono::cli_test
