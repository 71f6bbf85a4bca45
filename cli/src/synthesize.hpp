// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_SYNTHESIZE_HPP_
#define KOMPONO_CLI_SYNTHESIZE_HPP_

#include "session.hpp"

#include <optional>
#include <string>
#include <vector>

#include "kompono/synthesis/candidate.hpp"

/// What the two halves of `kompono synthesize` share: synthesize.cpp looks at the space of a study,
/// synthesize_run.cpp evaluates it.
namespace kompono::cli {

/// Which part of which study's space.
struct StudyChoice {
  std::string file;
  std::vector<std::string> fix;      ///< "feature=alternative"
  std::string formula;               ///< only layouts with this formula
  std::vector<std::string> without;  ///< names of rules to switch off
};

struct OpenedStudy {
  synthesis::StudySpace space;
  synthesis::Fixing fixed;
};

/// Adds the argument STUDY and the options that narrow its space.
void AddStudyChoice(CLI::App& command, Session& session, StudyChoice& choice);

/// Reads the study and builds its space, complaints reported; nothing if it is not usable, `code`
/// then says why.
[[nodiscard]] std::optional<OpenedStudy> OpenStudy(Session& session,
                                                   const StudyChoice& choice,
                                                   ExitCode& code);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_SYNTHESIZE_HPP_
