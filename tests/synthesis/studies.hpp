// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_SYNTHESIS_STUDIES_HPP_
#define KOMPONO_TESTS_SYNTHESIS_STUDIES_HPP_

#include <optional>
#include <string>

#include "kompono/plugin/registry.hpp"
#include "kompono/synthesis/candidate.hpp"

namespace kompono::synthesis {

/// The plugins of this build tree.
[[nodiscard]] const plugin::Registry& BuiltRegistry();

/// ParseStudy and StudySpace::Build; the rendered complaints in its place if one fails.
struct Outcome {
  std::optional<StudySpace> space;
  Diagnostics notes;
  std::string complaints;
};
[[nodiscard]] Outcome BuildStudy(const std::string& text, const std::string& file = "study.toml");

/// Plain axes with the equivalence: "XYZC" or, with numbers, "XYZX2".
[[nodiscard]] std::string PlainStudy(const std::string& letters, const std::string& equivalence);

/// A random space of the kind that synthesis.md measured: each pair of alternatives of features at
/// most `window` apart is forbidden with probability `density`.
[[nodiscard]] Space RandomSpace(
    int features, int alternatives, double density, int window, unsigned seed);

[[nodiscard]] std::string SourceText(const std::string& file);

}  // namespace kompono::synthesis

#endif  // KOMPONO_TESTS_SYNTHESIS_STUDIES_HPP_
