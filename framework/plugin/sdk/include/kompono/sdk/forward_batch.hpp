// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_FORWARD_BATCH_HPP_
#define KOMPONO_SDK_FORWARD_BATCH_HPP_

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>

#include "kompono/plugin/interfaces.hpp"
#include "kompono/scalar/jet.hpp"
#include "kompono/scalar/pack.hpp"
#include "kompono/sdk/arguments.hpp"
#include "kompono/sdk/forward.hpp"

/// From the author's templates to the batches of the contract.
namespace kompono::sdk {

template <class Derived>
inline constexpr bool kHasLinearise = requires(const Derived& derived,
                                               const Arguments<double>& in,
                                               std::span<double> out) {
  derived.Linearise(in, out, out);
};

/// The loop equations of a mechanism with one geometry, for doubles and packs.
template <class Derived>
class MechanismEquations {
 public:
  static constexpr std::string_view kLetters = Derived::kSpec.letters;
  static constexpr std::size_t kDrives = static_cast<std::size_t>(Derived::kSpec.drives);
  static constexpr bool kWorkingModes = Derived::kSpec.modes > 0;
  static constexpr bool kSeparable = Derived::kSpec.separable;

  MechanismEquations(const Derived& derived,
                     std::span<const double> parameters,
                     std::span<const double> modes)
      : derived_(derived), parameters_(parameters), modes_(modes) {
    Fill(numbers_);
  }
  /// Before packs are used.
  void FillPacks() { Fill(packs_.emplace()); }

  template <class T, std::size_t N>
  void Closure(const std::array<T, N>& x,
               const std::array<T, kDrives>& q,
               std::array<T, N>& g) const {
    derived_.Closure(In<T>(x, q), std::span<T>(g));
  }

  template <class T, std::size_t N>
  void Drives(const std::array<T, N>& x, std::array<T, kDrives>& q) const {
    std::array<T, kDrives> reach{};
    derived_.Drives(In<T>(x, q), DriveValues<T>{q, reach});
  }

  template <class T, std::size_t N>
  void Linearise(const std::array<T, N>& x,
                 const std::array<T, kDrives>& q,
                 std::array<T, N>& g,
                 std::array<T, N * N>& A) const {
    if constexpr (kHasLinearise<Derived>) {
      derived_.Linearise(In<T>(x, q), std::span<T>(g), std::span<T>(A));
    } else {
      using J = Jet<T, static_cast<int>(N)>;
      std::array<J, N> x_jet;
      std::array<J, kDrives> q_jet;
      std::array<J, N> g_jet;
      for (std::size_t i = 0; i < N; ++i) x_jet[i] = J(x[i], static_cast<int>(i));
      for (std::size_t i = 0; i < kDrives; ++i) q_jet[i] = J(q[i]);
      derived_.Closure(In<J>(x_jet, q_jet), std::span<J>(g_jet));
      for (std::size_t i = 0; i < N; ++i) {
        g[i] = g_jet[i].a;
        for (std::size_t j = 0; j < N; ++j) A[i * N + j] = g_jet[i].v[static_cast<int>(j)];
      }
    }
  }

 private:
  static constexpr auto kParameters = static_cast<std::size_t>(Derived::kSpec.parameters);
  static constexpr auto kModes = static_cast<std::size_t>(Derived::kSpec.modes);
  template <class T>
  using Jets = Jet<T, static_cast<int>(kLetters.size())>;
  struct Nothing {};

  /// Parameters, then modes, once as plain numbers and once with their derivatives, which are zero.
  template <class T>
  struct Geometry {
    std::array<T, kParameters + kModes> plain{};
    std::conditional_t<kHasLinearise<Derived>, Nothing, std::array<Jets<T>, kParameters + kModes>>
        jets{};
  };

  template <class T>
  void Fill(Geometry<T>& geometry) const {
    for (std::size_t i = 0; i < kParameters + kModes; ++i) {
      const double number = i < kParameters ? parameters_[i] : modes_[i - kParameters];
      geometry.plain[i] = T(number);
      if constexpr (!kHasLinearise<Derived>) geometry.jets[i] = Jets<T>(T(number));
    }
  }

  template <class T, class X, class Q>
  [[nodiscard]] Arguments<T> In(const X& x, const Q& q) const {
    const std::span<const T> all = All<T>();
    return {.x = x, .q = q, .parameter = all.first(kParameters), .mode = all.last(kModes)};
  }
  template <class T>
  [[nodiscard]] std::span<const T> All() const {
    if constexpr (std::is_same_v<T, double>) {
      return numbers_.plain;
    } else if constexpr (std::is_same_v<T, Pack>) {
      return packs_->plain;
    } else if constexpr (std::is_same_v<T, Jets<double>>) {
      return numbers_.jets;
    } else {
      return packs_->jets;
    }
  }

  const Derived& derived_;
  std::span<const double> parameters_;
  std::span<const double> modes_;
  Geometry<double> numbers_;
  std::optional<Geometry<Pack>> packs_;  ///< large: only where there are packs
};

/// kompono.mechanism/1 Forward. Eight poses go at once; those that do not pass in one go are
/// followed one by one.
template <class Derived>
[[nodiscard]] plugin::Status ForwardBatch(const Derived& derived,
                                          const plugin::MechanismForward& batch) {
  using Equations = MechanismEquations<Derived>;
  using Solver = ForwardSolver<Equations>;
  constexpr std::size_t kSize = Solver::kSize;
  constexpr std::size_t kDrives = Equations::kDrives;
  if (batch.parameters.size() != static_cast<std::size_t>(Derived::kSpec.parameters) ||
      batch.modes.size() != static_cast<std::size_t>(Derived::kSpec.modes) ||
      batch.drives == nullptr || batch.coordinates == nullptr || batch.outcomes == nullptr ||
      (batch.starts == nullptr && batch.start.size() != kSize) ||
      batch.lower.size() != batch.upper.size() ||
      (!batch.lower.empty() && batch.lower.size() != kSize)) {
    return plugin::Status::kBadSize;
  }
  Equations equations(derived, batch.parameters, batch.modes);
  const Solver solver(equations);
  const CoordinateLimits limits{.lower = batch.lower, .upper = batch.upper};
  const auto start_of = [&batch](std::size_t i, std::size_t k) {
    return batch.starts == nullptr ? batch.start[i] : batch.starts[i][k];
  };
  const auto finish = [&](std::size_t k,
                          const typename Solver::template Vector<double>& x,
                          plugin::ForwardOutcome outcome,
                          double reached,
                          int iterations) {
    const bool proven = outcome == plugin::ForwardOutcome::kProven;
    for (std::size_t i = 0; i < kSize; ++i) {
      batch.coordinates[i][k] = proven ? x[i] : std::numeric_limits<double>::quiet_NaN();
    }
    batch.outcomes[k] = outcome;
    if (batch.reached != nullptr) batch.reached[k] = reached;
    if (batch.iterations != nullptr) batch.iterations[k] = iterations;
  };
  const auto one = [&](std::size_t k, typename Solver::template Vector<double> x) {
    typename Solver::template DriveVector<double> q;
    for (std::size_t i = 0; i < kDrives; ++i) q[i] = batch.drives[i][k];
    double reached = 0.0;
    int iterations = 0;
    const plugin::ForwardOutcome outcome = solver.Follow(x, q, limits, reached, iterations);
    finish(k, x, outcome, reached, iterations);
  };

  std::size_t begin = 0;
  if (batch.count >= kPackLanes) equations.FillPacks();
  for (; begin + kPackLanes <= batch.count; begin += kPackLanes) {
    typename Solver::template Vector<Pack> x;
    typename Solver::template DriveVector<Pack> q;
    typename Solver::template DriveVector<Pack> q_start;
    for (std::size_t i = 0; i < kSize; ++i) {
      x[i] = batch.starts == nullptr ? Pack(batch.start[i]) : Pack::Load(batch.starts[i] + begin);
    }
    for (std::size_t i = 0; i < kDrives; ++i) q[i] = Pack::Load(batch.drives[i] + begin);
    if constexpr (!Equations::kSeparable) equations.Drives(x, q_start);
    typename Solver::template Trace<Pack> trace;
    const auto start = x;
    const PackMask proven = solver.Step(x, q_start, q, trace);
    for (std::size_t lane = 0; lane < kPackLanes; ++lane) {
      typename Solver::template Vector<double> from;
      for (std::size_t i = 0; i < kSize; ++i) from[i] = start[i][lane];
      if (!proven[lane]) {
        one(begin + lane, from);
        continue;
      }
      typename Solver::template Vector<double> at;
      typename Solver::template DriveVector<double> q_lane;
      for (std::size_t i = 0; i < kSize; ++i) at[i] = x[i][lane];
      for (std::size_t i = 0; i < kDrives; ++i) q_lane[i] = q[i][lane];
      const auto outcome = solver.Confirm(from, at, q_lane, trace.first_det[lane], limits);
      finish(begin + lane, at, outcome, 1.0, trace.iterations);
    }
  }
  for (std::size_t k = begin; k < batch.count; ++k) {
    typename Solver::template Vector<double> x;
    for (std::size_t i = 0; i < kSize; ++i) x[i] = start_of(i, k);
    one(k, x);
  }
  return plugin::Status::kOk;
}

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_FORWARD_BATCH_HPP_
