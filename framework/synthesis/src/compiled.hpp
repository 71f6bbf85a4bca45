// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_COMPILED_HPP_
#define KOMPONO_SYNTHESIS_COMPILED_HPP_

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kompono/synthesis/space.hpp"

/// A space as bits. Every feature has a field of as many bits as it has alternatives and a guard
/// bit above them, several fields to a word, in the order of the features. A state holds for every
/// feature the alternatives that still go with what was chosen; choosing one takes the intersection
/// with its row. Adding ones to all fields carries into the guards of those that are not empty, so
/// that a whole word of features is tested at once. Features with more than 63 alternatives have
/// words of their own.
namespace kompono::synthesis {

using Word = std::uint64_t;

/// What of the rules counts.
struct Judgement {
  std::vector<bool> off;                            ///< by rule
  std::optional<std::pair<Choice, Choice>> lifted;  ///< a pair (or one alternative) that is allowed
};

class Compiled {
 public:
  Compiled(const Space& space, const Fixing& fixed, const Judgement& judgement);

  [[nodiscard]] std::size_t features() const { return fields_.size(); }
  [[nodiscard]] std::size_t words() const { return words_; }
  /// The first word that a state at this depth (features before it chosen) still needs.
  [[nodiscard]] std::size_t FirstWord(std::size_t depth) const {
    return depth < fields_.size() ? fields_[depth].word : words_;
  }
  [[nodiscard]] std::span<const Word> start() const { return start_; }
  /// Whether the start leaves every feature an alternative.
  [[nodiscard]] bool possible() const { return possible_; }

  /// to = from and what goes with `alternative` of the feature at `depth`; false if some later
  /// feature has nothing left. Words before FirstWord(depth + 1) are not written.
  [[nodiscard]] bool Choose(std::size_t depth,
                            std::size_t alternative,
                            const Word* from,
                            Word* to) const {
    const Word* row = rows_.data() + (fields_[depth].first_row + alternative) * words_;
    std::size_t i = FirstWord(depth + 1);
    for (; i < words_; ++i) {
      to[i] = from[i] & row[i];
      if (((to[i] + full_[i]) & guards_[i]) != guards_[i]) return false;
    }
    return wide_.empty() || WideAlive(depth, to);
  }

  /// Bits of earlier features set, so that states that allow the same from here on are equal.
  void Forget(std::size_t depth, Word* state) const {
    if (depth > 0 && depth < fields_.size()) state[fields_[depth].word] |= past_[depth];
  }

  [[nodiscard]] std::size_t AlternativesLeft(std::size_t depth, const Word* state) const {
    const Field& field = fields_[depth];
    std::size_t count = 0;
    for (std::size_t i = 0; i < field.words; ++i) {
      count += static_cast<std::size_t>(std::popcount((state[field.word + i] & field.mask[i])));
    }
    return count;
  }

  /// Calls `visit(alternative)` in ascending order until it returns false; whether it never did.
  template <class Visit>
  bool EachAlternative(std::size_t depth, const Word* state, const Visit& visit) const {
    const Field& field = fields_[depth];
    for (std::size_t i = 0; i < field.words; ++i) {
      Word bits = (state[field.word + i] & field.mask[i]) >> field.shift;
      while (bits != 0) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(bits));
        bits &= bits - 1;
        if (!visit(i * kBits + bit)) return false;
      }
    }
    return true;
  }
  [[nodiscard]] bool Allows(std::size_t depth, const Word* state, std::size_t alternative) const {
    const Field& field = fields_[depth];
    return alternative < field.alternatives &&
           (state[field.word + alternative / kBits] >> (field.shift + alternative % kBits) & 1U) !=
               0;
  }

  /// Candidates below a state, depth-first. `scratch` has room for words() words for each feature.
  [[nodiscard]] Count CountBelow(std::size_t depth, const Word* state, Word* scratch) const;
  [[nodiscard]] std::vector<Word> Scratch() const {
    return std::vector<Word>(words_ * (fields_.size() + 1));
  }

 private:
  static constexpr std::size_t kBits = 64;

  struct Field {
    std::size_t alternatives = 0;
    std::size_t first_row = 0;
    std::size_t word = 0;
    std::size_t words = 1;
    std::size_t shift = 0;
    std::vector<Word> mask = {};  ///< of the field's bits in each of its words
  };

  void Pack(const Space& space);
  void Clear(Word* row, Choice choice) const;
  [[nodiscard]] bool WideAlive(std::size_t depth, const Word* state) const;
  [[nodiscard]] std::uint64_t CountHere(std::size_t depth, const Word* state, Word* scratch) const;

  std::vector<Field> fields_;
  std::size_t words_ = 0;
  std::vector<Word> full_, guards_;  ///< 0 for words of wide features
  std::vector<Word> past_;           ///< by depth: bits of earlier features in its word
  std::vector<std::size_t> wide_;    ///< features with words of their own
  std::vector<Word> rows_;
  std::vector<Word> start_;
  bool possible_ = true;
};

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_COMPILED_HPP_
