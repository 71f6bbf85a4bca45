// SPDX-License-Identifier: Apache-2.0
#include "kompono/layout/letters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "kompono/geometry/pose.hpp"

namespace kompono::layout {
namespace {

/// cos 10°: mounts that a calibration has turned a little still realise the same letters.
constexpr double kParallelCosine = 0.98480775301220806;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

Matrix3<double> RotationOf(const Placement& mount) {
  return RotationXYZ(mount.rotation_rad[0], mount.rotation_rad[1], mount.rotation_rad[2]);
}

/// Local letters of one kind against the wanted ones of that kind.
class KindFit {
 public:
  KindFit(bool rotary, std::string_view local, const std::vector<formula::Axis>& wanted)
      : local_(local), wanted_(wanted) {
    for (std::size_t i = 0; i < local.size(); ++i) {
      if (IsRotaryLetter(local[i]) == rotary) mine_.push_back(i);
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i].rotary() == rotary) theirs_.push_back(i);
    }
  }

  [[nodiscard]] bool CountsAgree() const { return mine_.size() == theirs_.size(); }

  /// Letter by letter; the same letter is preferred among parallel ones.
  [[nodiscard]] bool Match(const Matrix3<double>& R, std::vector<Block::LetterMap>& out) const {
    std::vector<bool> taken(wanted_.size(), false);
    for (const std::size_t i : mine_) {
      const int axis = AxisOfLetter(local_[i]);
      std::optional<std::size_t> best;
      for (const std::size_t k : theirs_) {
        const double cosine = R(AxisOfLetter(wanted_[k].letter), axis);
        if (taken[k] || std::abs(cosine) < kParallelCosine) continue;
        if (!best || wanted_[k].letter == local_[i]) best = k;
      }
      if (!best) return false;
      taken[*best] = true;
      out[i] = MapTo(wanted_[*best], R(AxisOfLetter(wanted_[*best].letter), axis) < 0.0 ? -1 : 1);
    }
    return true;
  }

  /// All three by their names.
  [[nodiscard]] bool TakeAsNamed(std::vector<Block::LetterMap>& out) const {
    if (mine_.size() != 3 || theirs_.size() != 3) return false;
    std::array<bool, 3> seen{};
    for (const std::size_t i : mine_) {
      for (const std::size_t k : theirs_) {
        if (AxisOfLetter(wanted_[k].letter) != AxisOfLetter(local_[i])) continue;
        out[i] = MapTo(wanted_[k], 1);
        seen[static_cast<std::size_t>(AxisOfLetter(local_[i]))] = true;
      }
    }
    return seen[0] && seen[1] && seen[2];
  }

 private:
  static Block::LetterMap MapTo(const formula::Axis& axis, int sign) {
    return {.formula_letter = axis.letter, .axis = axis.Name(), .sign = sign};
  }

  std::string_view local_;
  const std::vector<formula::Axis>& wanted_;
  std::vector<std::size_t> mine_, theirs_;
};

/// Few angles first, then few letters that count backwards, then small angles.
int Effort(const std::array<int, 3>& turn, const LetterFit& fit) {
  int effort = 0;
  for (const int angle : turn) effort += (angle != 0 ? 100000 : 0) + std::abs(angle);
  for (const Block::LetterMap& letter : fit.letters) effort += letter.sign < 0 ? 1000 : 0;
  return effort;
}

}  // namespace

LetterFit FitLetters(std::string_view local,
                     const Placement& mount,
                     const std::vector<formula::Axis>& wanted) {
  const Matrix3<double> R = RotationOf(mount);
  const KindFit linear(false, local, wanted);
  const KindFit rotary(true, local, wanted);
  LetterFit fit;
  if (!linear.CountsAgree() || !rotary.CountsAgree()) return fit;
  fit.letters.resize(local.size());
  fit.kind = LetterFit::Kind::kFits;
  for (const KindFit* kind : {&linear, &rotary}) {
    if (kind->Match(R, fit.letters)) continue;
    if (!kind->TakeAsNamed(fit.letters))
      return {.kind = LetterFit::Kind::kDirection, .letters = {}};
    fit.kind = LetterFit::Kind::kOwnAxes;
  }
  return fit;
}

std::string LettersUnderMount(std::string_view local, const Placement& mount) {
  const Matrix3<double> R = RotationOf(mount);
  std::string text;
  for (const char letter : local) {
    const int axis = AxisOfLetter(letter);
    if (!text.empty()) text += ' ';
    std::string seen = std::string("(") + letter + ")";
    for (int i = 0; i < 3; ++i) {
      if (std::abs(R(i, axis)) < kParallelCosine) continue;
      seen = (IsRotaryLetter(letter) ? "ABC" : "XYZ")[i];
    }
    text += seen;
  }
  return text;
}

std::optional<std::array<int, 3>> RotationThatFits(std::string_view local,
                                                   const std::vector<formula::Axis>& wanted) {
  std::optional<std::array<int, 3>> best;
  int least = 0;
  constexpr std::array<int, 4> kTurns{0, 90, -90, 180};
  for (const int a : kTurns) {
    for (const int b : kTurns) {
      for (const int c : kTurns) {
        const std::array<int, 3> turn{a, b, c};
        Placement mount;
        for (std::size_t i = 0; i < 3; ++i) mount.rotation_rad[i] = turn[i] * kRadPerDeg;
        const LetterFit fit = FitLetters(local, mount, wanted);
        if (fit.kind != LetterFit::Kind::kFits) continue;
        const int effort = Effort(turn, fit);
        if (!best || effort < least) {
          best = turn;
          least = effort;
        }
      }
    }
  }
  return best;
}

}  // namespace kompono::layout
