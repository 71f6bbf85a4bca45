// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_SHARED_RESULTS_HPP_
#define KOMPONO_SYNTHESIS_SHARED_RESULTS_HPP_

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

namespace kompono::synthesis {

/// What many candidates have in common, by a key that says everything the value depends on. Two
/// threads may compute the same value; the first one stays, and both are equal.
template <class Value>
class SharedResults {
 public:
  [[nodiscard]] std::shared_ptr<const Value> Find(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = values_.find(key);
    if (found == values_.end()) return nullptr;
    ++found_;
    return found->second;
  }
  std::shared_ptr<const Value> Put(const std::string& key, Value value) {
    auto made = std::make_shared<const Value>(std::move(value));
    const std::lock_guard lock(mutex_);
    ++computed_;
    return values_.emplace(key, std::move(made)).first->second;
  }
  [[nodiscard]] std::uint64_t computed() const { return computed_; }
  [[nodiscard]] std::uint64_t found() const { return found_; }

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::string, std::shared_ptr<const Value>> values_;
  mutable std::atomic<std::uint64_t> found_{0};
  std::atomic<std::uint64_t> computed_{0};
};

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_SHARED_RESULTS_HPP_
