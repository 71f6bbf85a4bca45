// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_PROGRESS_HPP_
#define KOMPONO_SYNTHESIS_PROGRESS_HPP_

#include <cstdint>
#include <string>

/// How far a run is, how fast it goes and how long it will take.
namespace kompono::synthesis {

struct Progress {
  std::uint64_t done = 0, all = 0;    ///< candidates of this run
  double seconds = 0.0;               ///< since its start
  [[nodiscard]] double Rate() const;  ///< candidates per second; 0 before the first
  /// By the rate so far; not a number before the first.
  [[nodiscard]] double RemainingSeconds() const;
};

/// "12,345 of 79,900 (15 %), 214/s, 5 min 15 s left".
[[nodiscard]] std::string ProgressText(const Progress& progress);

/// "4.2 s", "5 min 15 s", "2 h 3 min".
[[nodiscard]] std::string DurationText(double seconds);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_PROGRESS_HPP_
