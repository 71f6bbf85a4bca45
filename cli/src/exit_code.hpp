// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_EXIT_CODE_HPP_
#define KOMPONO_CLI_EXIT_CODE_HPP_

#include <array>
#include <string_view>

#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::cli {

/// What the shell gets. The numbers keep their meaning between versions.
enum class ExitCode : int {
  kOk = 0,
  kNegative = 1,
  kUsage = 2,
  kBadInput = 3,
  kNoSolution = 4,
  kInputOutput = 5,
  kInternal = 70,
};

struct ExitCodeMeaning {
  ExitCode code;
  std::string_view meaning;
};

inline constexpr std::array<ExitCodeMeaning, 7> kExitCodes{{
    {ExitCode::kOk, "done"},
    {ExitCode::kNegative, "the answer is no: check failed, out of reach, nothing found"},
    {ExitCode::kUsage, "wrong command line"},
    {ExitCode::kBadInput, "wrong content of an input file or formula"},
    {ExitCode::kNoSolution, "no convergence, or singular"},
    {ExitCode::kInputOutput, "a file cannot be read or written"},
    {ExitCode::kInternal, "error of the program itself"},
}};

/// With what to leave because of these: of several errors the highest number counts.
[[nodiscard]] ExitCode ExitCodeOf(const Diagnostics& diagnostics);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_EXIT_CODE_HPP_
