// SPDX-License-Identifier: Apache-2.0
#include "compiled.hpp"

#include <algorithm>
#include <utility>

#include "kompono/diagnostics/expects.hpp"

namespace kompono::synthesis {
namespace {

/// The lowest `bits` bits.
Word Ones(std::size_t bits) {
  return bits >= 64 ? ~Word{0} : (Word{1} << bits) - 1;
}

bool Lifts(const Judgement& judgement, const Space::Conflict& conflict) {
  return judgement.lifted && judgement.lifted->first == conflict.first &&
         judgement.lifted->second == conflict.second;
}

}  // namespace

Compiled::Compiled(const Space& space, const Fixing& fixed, const Judgement& judgement) {
  Pack(space);
  start_.assign(words_, 0);
  for (const Field& field : fields_) {
    for (std::size_t i = 0; i < field.words; ++i) start_[field.word + i] |= field.mask[i];
  }
  std::size_t rows = 0;
  for (const Field& field : fields_) rows += field.alternatives;
  rows_.resize(rows * words_);
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy(start_.begin(), start_.end(), rows_.begin() + static_cast<long>(row * words_));
  }
  for (const Space::Conflict& conflict : space.conflicts()) {
    if (judgement.off[static_cast<std::size_t>(conflict.rule)] || Lifts(judgement, conflict)) {
      continue;
    }
    if (conflict.first == conflict.second) {
      Clear(start_.data(), conflict.first);
      continue;
    }
    // Rows act on later features only.
    const Field& field = fields_[static_cast<std::size_t>(conflict.first.feature)];
    const std::size_t row = field.first_row + static_cast<std::size_t>(conflict.first.alternative);
    Clear(rows_.data() + row * words_, conflict.second);
  }
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const auto of_feature = [f](const Choice& choice) {
      return static_cast<std::size_t>(choice.feature) == f;
    };
    if (std::none_of(fixed.begin(), fixed.end(), of_feature)) continue;
    for (std::size_t a = 0; a < fields_[f].alternatives; ++a) {
      const Choice choice{static_cast<int>(f), static_cast<int>(a)};
      if (std::find(fixed.begin(), fixed.end(), choice) == fixed.end()) {
        Clear(start_.data(), choice);
      }
    }
  }
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    possible_ = possible_ && AlternativesLeft(f, start_.data()) > 0;
  }
}

void Compiled::Pack(const Space& space) {
  std::size_t used = kBits;  // of the last word
  std::size_t row = 0;
  for (const Feature& feature : space.features()) {
    const std::size_t bits = feature.alternatives.size();
    Field field{.alternatives = bits, .first_row = row};
    row += bits;
    const bool wide = bits >= kBits;
    if (wide || used + bits + 1 > kBits) {
      field.word = words_;
      field.words = wide ? (bits + kBits - 1) / kBits : 1;
      words_ += field.words;
      full_.resize(words_, 0);
      guards_.resize(words_, 0);
      used = 0;
    } else {
      field.word = words_ - 1;
    }
    past_.push_back(wide ? 0 : full_[field.word]);
    if (wide) {
      wide_.push_back(fields_.size());
      for (std::size_t left = bits; left > 0; left -= std::min(left, kBits)) {
        field.mask.push_back(Ones(left));
      }
      used = kBits;
    } else {
      field.shift = used;
      field.mask = {Ones(bits) << used};
      full_[field.word] |= field.mask[0];
      guards_[field.word] |= Word{1} << (used + bits);
      used += bits + 1;
    }
    fields_.push_back(std::move(field));
  }
}

void Compiled::Clear(Word* row, Choice choice) const {
  const Field& field = fields_[static_cast<std::size_t>(choice.feature)];
  const auto alternative = static_cast<std::size_t>(choice.alternative);
  row[field.word + alternative / kBits] &= ~(Word{1} << (field.shift + alternative % kBits));
}

bool Compiled::WideAlive(std::size_t depth, const Word* state) const {
  return std::all_of(wide_.begin(), wide_.end(), [&](std::size_t feature) {
    return feature <= depth || AlternativesLeft(feature, state) > 0;
  });
}

std::uint64_t Compiled::CountHere(std::size_t depth, const Word* state, Word* scratch) const {
  if (depth + 1 == fields_.size()) return AlternativesLeft(depth, state);
  std::uint64_t count = 0;
  EachAlternative(depth, state, [&](std::size_t alternative) {
    if (Choose(depth, alternative, state, scratch)) {
      count += CountHere(depth + 1, scratch, scratch + words_);
    }
    return true;
  });
  return count;
}

Count Compiled::CountBelow(std::size_t depth, const Word* state, Word* scratch) const {
  KOMPONO_EXPECTS(depth <= fields_.size());
  return depth == fields_.size() ? 1 : CountHere(depth, state, scratch);
}

}  // namespace kompono::synthesis
