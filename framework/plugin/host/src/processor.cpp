// SPDX-License-Identifier: Apache-2.0
#include "processor.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace kompono::plugin {
namespace {

/// 4 for AVX-512, 3 for AVX2 with FMA, else 1; the levels of the x86-64 psABI as far as they matter
/// to code made by a compiler.
int LevelOfProcessor() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
      !__builtin_cpu_supports("bmi") || !__builtin_cpu_supports("bmi2")) {
    return 1;
  }
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
  return wide ? 4 : 3;
#else
  return 1;
#endif
}

int LevelAllowed() {
  const char* const wish = std::getenv("KOMPONO_X86_LEVEL");
  if (wish == nullptr) return 4;
  const std::string_view level(wish);
  return level == "x86-64-v4" ? 4 : level == "x86-64-v3" ? 3 : 1;
}

}  // namespace

std::filesystem::path BestForThisProcessor(const std::filesystem::path& folder,
                                           const std::string& library) {
  static const int processor = LevelOfProcessor();
  const int level = std::min(processor, LevelAllowed());
  std::error_code error;
  for (int candidate = level; candidate >= 3; --candidate) {
    std::filesystem::path file = folder / ("x86-64-v" + std::to_string(candidate)) / library;
    if (std::filesystem::is_regular_file(file, error)) return file;
  }
  return folder / library;
}

}  // namespace kompono::plugin
