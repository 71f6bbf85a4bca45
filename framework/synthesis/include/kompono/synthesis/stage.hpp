// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_STAGE_HPP_
#define KOMPONO_SYNTHESIS_STAGE_HPP_

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kompono/synthesis/candidate.hpp"
#include "kompono/synthesis/evaluation.hpp"

/// Candidates through the stages of evaluation.
///
///     const Evaluator evaluator(space, settings);
///     const Evaluation row = evaluator.Evaluate(space.At(all.Unrank(17), 17));
///
/// Immutable to the outside and usable by several threads; what many candidates share (freedoms of
/// a relative motion, sizes of a mechanism for the same zone) is computed once and kept. A row
/// depends on the study and the candidate only.
namespace kompono::synthesis {

class Evaluator {
 public:
  /// The space must live as long.
  Evaluator(const StudySpace& space, const EvaluationSettings& settings);
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;
  ~Evaluator();

  /// The first stage alone: numbers from candidate and sidecars, without formula text.
  [[nodiscard]] Evaluation Structure(const Candidate& candidate) const;

  /// All stages, until one rejects. Never throws for a candidate: what fails is a row that says so.
  [[nodiscard]] Evaluation Evaluate(const Candidate& candidate) const;

  /// The sized layout's file.
  [[nodiscard]] std::string LayoutFile(const Candidate& candidate) const;

  [[nodiscard]] const StudySpace& space() const;
  [[nodiscard]] const EvaluationSettings& settings() const;

  /// How often a stage's shared results were computed, and how often they were found.
  struct Sharing {
    std::uint64_t computed = 0, found = 0;
  };
  [[nodiscard]] Sharing mobility_sharing() const;
  [[nodiscard]] Sharing sizing_sharing() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Rows by what became of them.
struct StageCounts {
  std::uint64_t entered = 0, rejected = 0, failed = 0;
};
using Funnel = std::array<StageCounts, kStages>;
void Tally(const Evaluation& row, Funnel& funnel);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_STAGE_HPP_
