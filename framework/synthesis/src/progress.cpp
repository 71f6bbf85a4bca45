// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/progress.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "kompono/synthesis/space.hpp"

namespace kompono::synthesis {

double Progress::Rate() const {
  return seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
}

double Progress::RemainingSeconds() const {
  const double rate = Rate();
  return rate > 0.0 ? static_cast<double>(all - done) / rate
                    : std::numeric_limits<double>::quiet_NaN();
}

std::string DurationText(double seconds) {
  if (!(seconds >= 0.0)) return "unknown time";
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::string ProgressText(const Progress& progress) {
  const double percent = progress.all == 0 ? 100.0
                                           : 100.0 * static_cast<double>(progress.done) /
                                                 static_cast<double>(progress.all);
  std::string out = fmt::format("{} of {} ({:.0f} %)",
                                GroupedText(progress.done),
                                GroupedText(progress.all),
                                std::floor(percent));
  if (progress.done == 0) return out;
  return out + fmt::format(", {:.0f}/s, {} left",
                           progress.Rate(),
                           DurationText(progress.RemainingSeconds()));
}

}  // namespace kompono::synthesis
