// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_FORWARD_HPP_
#define KOMPONO_SDK_FORWARD_HPP_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "kompono/geometry/pose.hpp"
#include "kompono/plugin/interfaces.hpp"
#include "kompono/scalar/select.hpp"
#include "kompono/sdk/fold.hpp"
#include "kompono/sdk/linear_system.hpp"
#include "kompono/sdk/step_scale.hpp"

/// Forward kinematics that never lies: from a start pose on the wanted assembly mode to the pose
/// with given drives, or a refusal.
///
/// A Newton step is believed only when the simplified Newton correction that follows it, with the
/// same matrix, is at most a quarter of it (the affine covariant monotonicity test of Deuflhard's
/// Newton Methods for Nonlinear Problems, 2.1 and 5.1), and det A keeps its sign from the start on.
/// What does not pass in one go is followed along the straight way between the drives of the start
/// and the wanted ones, in steps that pass.
namespace kompono::sdk {

/// `Equations` gives, for T = double and T = Pack,
///   Closure(x, q, g)       loop residuals,
///   Linearise(x, q, g, A)  and their derivatives by x, row-major,
///   Drives(x, q)           the inverse kinematics,
/// all on std::array, N coordinates and N loops, and the constants kLetters, kDrives, kWorkingModes
/// (there are assembly modes to confirm) and kSeparable (A does not depend on q).
template <class Equations>
class ForwardSolver {
 public:
  static constexpr std::size_t kSize = Equations::kLetters.size();
  static constexpr std::size_t kDrives = Equations::kDrives;
  template <class T>
  using Vector = std::array<T, kSize>;
  template <class T>
  using DriveVector = std::array<T, kDrives>;

  explicit ForwardSolver(const Equations& equations) : equations_(equations) {}

  /// What an attempt says of itself. det A must not change its sign.
  template <class T>
  struct Trace {
    T first_det{0.0};
    T last_det{0.0};
    int iterations = 0;      ///< matrices factored
    bool mode_left = false;  ///< on the way a leg went over to its other side
  };

  /// One attempt from a point of the mechanism: `x` with its drives `q_start`, to `q`. Writes x
  /// where the answer is proven and leaves it elsewhere.
  template <class T>
  auto Step(Vector<T>& x,
            const DriveVector<T>& q_start,
            const DriveVector<T>& q,
            Trace<T>& trace) const {
    using Condition = typename LinearSystem<T, kSize>::Condition;
    std::array<T, kSize * kSize> A{};
    Vector<T> g{};
    if constexpr (Equations::kSeparable) {
      equations_.Linearise(x, q, g, A);
    } else {
      equations_.Linearise(x, q_start, g, A);
      equations_.Closure(x, q, g);
    }
    const StepScale<T, Equations> scale(A, x, q);
    Vector<T> at = x;
    T length(0.0);
    Condition proven = Less(T(1.0), T(0.0));
    Condition open = !proven;  // neither proven nor refused
    for (int round = 0; round < kRounds; ++round) {
      if (round > 0) equations_.Linearise(at, q, g, A);
      const LinearSystem<T, kSize> lu(A);
      trace.last_det = lu.Determinant();
      if (round == 0) trace.first_det = trace.last_det;
      ++trace.iterations;
      open = open && Less(T(0.0), T(trace.first_det * trace.last_det));
      Vector<T> step = lu.Solve(g);
      const T newton = scale.Length(step);
      if (round > 0) open = open && (Less(newton, length) || scale.IsRounding(g));
      length = newton;
      Subtract(at, step);
      Condition chord = open;
      for (int again = 0; again < kChords && AnyOf(chord); ++again) {
        equations_.Closure(at, q, g);
        step = lu.Solve(g);
        const T next = scale.Length(step);
        const Condition rounding = scale.IsRounding(g);
        open = open && (Less(T(next * 4.0), length) || rounding);
        Subtract(at, step);
        // The error left is about next * (next / length).
        const Condition closed = rounding || Less(T(next * next), T(scale.size * length * 1e-15));
        proven = proven || (open && closed);
        open = open && !closed;
        chord = open && Less(T(next * 32.0), length);
        length = next;
      }
      if (!AnyOf(open)) break;
    }
    for (std::size_t i = 0; i < kSize; ++i) x[i] = Select(proven, at[i], x[i]);
    return proven;
  }

  /// The whole way for one pose; `x` holds the start and receives the answer. `reached` is the part
  /// of the way that was proven, 1 for all of it.
  plugin::ForwardOutcome Follow(Vector<double>& x,
                                const DriveVector<double>& q,
                                const CoordinateLimits& limits,
                                double& reached,
                                int& iterations) const {
    reached = 0.0;
    if (!Finite(q)) return plugin::ForwardOutcome::kBlocked;
    const Vector<double> x_start = x;
    Trace<double> trace;
    DriveVector<double> start{};
    if constexpr (Equations::kSeparable) {  // in one go, without the drives of the start
      if (Step(x, start, q, trace)) reached = 1.0;
    }
    if (reached < 1.0) {
      equations_.Drives(x, start);
      if (!Finite(start)) return plugin::ForwardOutcome::kStartOutOfReach;
      reached = Creep(x, start, q, Equations::kSeparable ? 0.25 : 1.0, trace);
      if (reached < 1.0 && trace.first_det == 0.0) trace.first_det = DetA(x_start, start);
      if (reached < 1.0 && Guess(x_start, q, trace, x)) reached = 1.0;
    }
    iterations = trace.iterations;
    if (reached < 1.0) {
      return trace.mode_left ? plugin::ForwardOutcome::kOtherMode
                             : plugin::ForwardOutcome::kBlocked;
    }
    return Confirm(x_start, x, q, trace.first_det, limits);
  }

  /// What remains to be asked of a proven step or way. Ambiguous is what has another pose beyond a
  /// near singularity, within the limits and nearer to x than the start was: then the start does
  /// not tell the two apart.
  [[nodiscard]] plugin::ForwardOutcome Confirm(const Vector<double>& x_start,
                                               const Vector<double>& x,
                                               const DriveVector<double>& q,
                                               double first_det,
                                               const CoordinateLimits& limits) const {
    if (Equations::kWorkingModes && !OnWorkingMode(x, q)) {
      return plugin::ForwardOutcome::kOtherMode;
    }
    if (IsShort(x_start, x, q)) return plugin::ForwardOutcome::kProven;
    const Fold<Equations> fold(equations_, x, q);
    const double gone = fold.Distance(x_start, x);
    Vector<double> other{};
    if (std::abs(fold.Determinant()) < kNearSingular * std::abs(first_det) &&
        fold.Cross(x, other) && fold.Distance(x, other) < gone &&
        (limits.lower.empty() ? fold.Distance(x_start, other) < kAsFar * gone
                              : limits.Hold(other))) {
      return plugin::ForwardOutcome::kAmbiguous;
    }
    return plugin::ForwardOutcome::kProven;
  }

 private:
  /// A step so small that a second pose on the way is out of the question.
  [[nodiscard]] static bool IsShort(const Vector<double>& from,
                                    const Vector<double>& to,
                                    const DriveVector<double>& q) {
    double size = 0.0;
    for (const double drive : q) size = std::max(size, std::abs(drive));
    for (std::size_t i = 0; i < kSize; ++i) {
      const double limit = kShort * (IsRotaryLetter(Equations::kLetters[i]) ? 1.0 : size);
      if (std::abs(to[i] - from[i]) > limit) return false;
    }
    return true;
  }

  /// Closure does not tell the working modes apart (the two carriages a strut reaches from one
  /// joint), the inverse kinematics does.
  [[nodiscard]] bool OnWorkingMode(const Vector<double>& x, const DriveVector<double>& q) const {
    DriveVector<double> back{};
    equations_.Drives(x, back);
    double size = 0.0;
    for (std::size_t i = 0; i < kDrives; ++i) size = std::max(size, std::abs(q[i]));
    for (const double coordinate : x) size = std::max(size, std::abs(coordinate));
    for (std::size_t i = 0; i < kDrives; ++i) {
      // Where the two modes meet the root of a rounding error is left, and it is not a number when
      // the error is negative.
      if (std::isfinite(back[i]) && std::abs(back[i] - q[i]) > kModesMeet * size) {
        return false;
      }
    }
    return true;
  }

  static constexpr int kRounds = 8;
  static constexpr int kChords = 4;
  static constexpr int kSteps = 400;
  static constexpr double kSmallestPart = 1e-5;
  static constexpr double kModesMeet = 1e-6;
  /// det A at the answer over det A at the start: below this, the pose on the other side of the
  /// singularity that has the same drives is looked for.
  static constexpr double kNearSingular = 0.3;
  static constexpr int kWayPoints = 32;
  static constexpr int kDescents = 40;
  static constexpr double kAround = 0.2;  ///< of the size, or rad: how far round the start
  /// Without limits: the other pose counts if it is hardly farther from the start.
  static constexpr double kAsFar = 1.05;
  static constexpr double kShort = 0.02;  ///< a way of this part of the size needs no such doubt

  /// Along the straight way of the drives, in steps that pass, the first of them `part` of it;
  /// returns how much of it was done, with x there. The way ends where a leg goes over to its other
  /// side, although it may come back later: what lies beyond is another branch.
  double Creep(Vector<double>& x,
               const DriveVector<double>& start,
               const DriveVector<double>& q,
               double part,
               Trace<double>& trace) const {
    double done = 0.0;
    DriveVector<double> here = start;
    for (int count = 0; count < kSteps && done < 1.0; ++count) {
      const double next = std::min(1.0, done + part);
      DriveVector<double> there = q;
      for (std::size_t i = 0; next < 1.0 && i < kDrives; ++i) {
        there[i] = start[i] + next * (q[i] - start[i]);
      }
      Trace<double> attempt;
      Vector<double> trial = x;
      const bool passed = Step(trial, here, there, attempt);
      trace.iterations += attempt.iterations;
      if (passed && (done == 0.0 || attempt.first_det * trace.first_det > 0.0)) {
        if (Equations::kWorkingModes && !OnWorkingMode(trial, there)) {
          trace.mode_left = true;
          if (done == 0.0) trace.first_det = attempt.first_det;
          break;
        }
        if (done == 0.0) trace.first_det = attempt.first_det;
        x = trial;
        here = there;
        done = next;
        part *= 2.0;
      } else {
        part *= 0.25;
        if (part < kSmallestPart) break;
      }
    }
    return done;
  }

  [[nodiscard]] std::array<double, kSize * kSize> At(const Vector<double>& x,
                                                     const DriveVector<double>& q) const {
    std::array<double, kSize * kSize> A{};
    Vector<double> g{};
    equations_.Linearise(x, q, g, A);
    return A;
  }
  [[nodiscard]] double DetA(const Vector<double>& x, const DriveVector<double>& q) const {
    return LinearSystem<double, kSize>(At(x, q)).Determinant();
  }

  /// Where the straight way of the drives leads nowhere: Newton's method with halved steps from
  /// here and from around the start, whatever way it takes, and then the proof along the straight
  /// way of the poses, on which the inverse kinematics knows the drives: det A must keep its sign
  /// there.
  bool Guess(const Vector<double>& x_start,
             const DriveVector<double>& q,
             Trace<double>& trace,
             Vector<double>& x) const {
    const StepScale<double, Equations> scale(At(x_start, q), x_start, q);
    for (std::size_t seed = 0; seed < 2 * kSize + 2; ++seed) {
      Vector<double> at = seed == 0 ? x : x_start;
      if (seed > 1) {
        const std::size_t i = (seed - 2) / 2;
        const double far = kAround * (IsRotaryLetter(Equations::kLetters[i]) ? 1.0 : scale.size);
        at[i] += seed % 2 == 0 ? far : -far;
      }
      if (Descend(q, trace, at) && SameSide(x_start, at, trace.first_det)) {
        x = at;
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool SameSide(const Vector<double>& from,
                              const Vector<double>& to,
                              double side) const {
    for (int part = 1; part <= kWayPoints; ++part) {
      const double share = static_cast<double>(part) / kWayPoints;
      Vector<double> between = to;
      for (std::size_t i = 0; i < kSize; ++i) between[i] = from[i] + share * (to[i] - from[i]);
      DriveVector<double> drives{};
      equations_.Drives(between, drives);
      if (!Finite(drives) || !(DetA(between, drives) * side > 0.0)) return false;
    }
    return true;
  }

  bool Descend(const DriveVector<double>& q, Trace<double>& trace, Vector<double>& x) const {
    std::array<double, kSize * kSize> A{};
    Vector<double> g{};
    equations_.Linearise(x, q, g, A);
    const StepScale<double, Equations> scale(A, x, q);
    for (int count = 0; count < kDescents; ++count, ++trace.iterations) {
      if (scale.IsRounding(g)) return true;
      Vector<double> step = LinearSystem<double, kSize>(A).Solve(g);
      const double before = Squares(g);
      bool better = false;
      for (int halving = 0; halving < 8 && !better; ++halving) {
        Vector<double> trial = x;
        Subtract(trial, step);
        equations_.Closure(trial, q, g);
        better = Squares(g) < before;
        if (better) x = trial;
        for (double& number : step) number *= 0.5;
      }
      if (!better) return scale.Length(step) < 1e-9 * scale.size;
      equations_.Linearise(x, q, g, A);
    }
    return false;
  }

  [[nodiscard]] static double Squares(const Vector<double>& g) {
    double sum = 0.0;
    for (const double number : g) sum += number * number;
    return sum;
  }

  [[nodiscard]] static bool Finite(const DriveVector<double>& q) {
    return std::all_of(q.begin(), q.end(), [](double drive) { return std::isfinite(drive); });
  }

  template <class T>
  static void Subtract(Vector<T>& from, const Vector<T>& what) {
    for (std::size_t i = 0; i < kSize; ++i) from[i] -= what[i];
  }
  static bool AnyOf(bool condition) { return condition; }
  static bool AnyOf(const PackMask& condition) { return condition.Any(); }

  const Equations& equations_;
};

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_FORWARD_HPP_
