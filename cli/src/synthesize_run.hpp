// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_SYNTHESIZE_RUN_HPP_
#define KOMPONO_CLI_SYNTHESIZE_RUN_HPP_

#include "session.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "kompono/synthesis/run.hpp"

/// The running half of `kompono synthesize`: what is not counting, listing or explaining.
namespace kompono::cli {

struct SynthesizeRunOptions {
  std::string catalog;  ///< file that keeps the rows; empty: they are forgotten
  std::string shard;    ///< "k/N"
  unsigned threads = 0;
  std::uint64_t limit = 0;  ///< at most so many candidates now; 0: all
  std::size_t front = 20;   ///< rows of the front that are shown
  double epsilon = 0.0;     ///< share of the front's extent within which one layout stands for all
};

void AddRunOptions(CLI::App& command, Session& session, SynthesizeRunOptions& options);

/// `fixed`: choices that narrow the space; indices then count what is left.
[[nodiscard]] ExitCode RunSynthesis(Session& session,
                                    const synthesis::StudySpace& space,
                                    const synthesis::Fixing& fixed,
                                    const SynthesizeRunOptions& options);

/// Where rows are kept, so that the run itself knows no catalog.
struct RowStore {
  std::function<Parsed<std::vector<synthesis::IndexRange>>(const synthesis::IndexRange&)> missing;
  synthesis::Sink append;
  /// Every row of the range that is kept, ascending, metrics included.
  std::function<Diagnostics(const synthesis::IndexRange&,
                            const std::function<void(const synthesis::Evaluation&)>&)>
      rows;
};
/// Rows in memory, of this run only.
[[nodiscard]] RowStore MemoryStore();
/// Rows in a catalog file, made if there is none; `all` and `space` must live as long.
[[nodiscard]] Parsed<RowStore> CatalogStore(const std::string& file,
                                            const synthesis::StudySpace& space,
                                            const synthesis::Enumeration& all,
                                            const synthesis::Fixing& fixed,
                                            Diagnostics& notes);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_SYNTHESIZE_RUN_HPP_
