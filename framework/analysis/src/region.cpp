// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/region.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace kompono::analysis {

double Region::Content() const {
  double content = 1.0;
  for (std::size_t i = 0; i < varied.size(); ++i) content *= Extent(i);
  return content;
}

VectorXd Region::At(std::span<const double> at) const {
  VectorXd out = z;
  for (std::size_t i = 0; i < varied.size(); ++i) out[varied[i]] = at[i];
  return out;
}

unsigned RunControl::Threads() const {
  return threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

std::uint64_t ForEachTask(std::uint64_t tasks,
                          const RunControl& control,
                          const std::function<void(std::uint64_t task, unsigned worker)>& work) {
  using Clock = std::chrono::steady_clock;
  std::atomic<std::uint64_t> next{0};
  const auto loop = [&](unsigned worker) {
    Clock::time_point told = Clock::now();
    while (!control.Stopped()) {
      const std::uint64_t task = next.fetch_add(1, std::memory_order_relaxed);
      if (task >= tasks) break;
      work(task, worker);
      if (worker != 0 || !control.progress) continue;
      const Clock::time_point now = Clock::now();
      if (now - told < std::chrono::milliseconds(100)) continue;
      told = now;
      control.progress(task + 1, tasks);
    }
  };
  const auto wanted = static_cast<unsigned>(
      std::clamp<std::uint64_t>(tasks, 1, static_cast<std::uint64_t>(control.Threads())));
  std::vector<std::thread> others;
  others.reserve(wanted - 1);
  for (unsigned worker = 1; worker < wanted; ++worker) others.emplace_back(loop, worker);
  loop(0);
  for (std::thread& other : others) other.join();
  return std::min<std::uint64_t>(next.load(), tasks);
}

}  // namespace kompono::analysis
