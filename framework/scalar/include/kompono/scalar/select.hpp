// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SCALAR_SELECT_HPP_
#define KOMPONO_SCALAR_SELECT_HPP_

#include "kompono/scalar/jet.hpp"
#include "kompono/scalar/pack.hpp"
#include "kompono/scalar/symbol.hpp"

/// Choice without a branch: packs hold eight answers at once and recorded formulas have none yet,
/// so a template over the scalar writes `Select(a < b, x, y)` where ordinary code would write `a <
/// b ? x : y`. Both sides are evaluated. (For Symbol the overload stands in symbol.hpp.)
namespace kompono {

[[nodiscard]] inline double Select(bool condition, double yes, double no) {
  return condition ? yes : no;
}

[[nodiscard]] inline Pack Select(const PackMask& condition, const Pack& yes, const Pack& no) {
  return Pack::Choose(condition, yes, no);
}

Symbol Select(const SymbolCondition& condition,
              const Symbol& yes,
              const Symbol& no);  // in symbol.hpp

/// Jets compare by value, so over double the condition is a bool.
template <int N>
[[nodiscard]] ceres::Jet<double, N> Select(bool condition,
                                           const ceres::Jet<double, N>& yes,
                                           const ceres::Jet<double, N>& no) {
  return condition ? yes : no;
}

template <int N>
[[nodiscard]] ceres::Jet<Pack, N> Select(const PackMask& condition,
                                         const ceres::Jet<Pack, N>& yes,
                                         const ceres::Jet<Pack, N>& no) {
  ceres::Jet<Pack, N> chosen;
  chosen.a = Select(condition, yes.a, no.a);
  for (int i = 0; i < N; ++i) chosen.v[i] = Select(condition, yes.v[i], no.v[i]);
  return chosen;
}

template <int N>
[[nodiscard]] ceres::Jet<Symbol, N> Select(const SymbolCondition& condition,
                                           const ceres::Jet<Symbol, N>& yes,
                                           const ceres::Jet<Symbol, N>& no) {
  ceres::Jet<Symbol, N> chosen;
  chosen.a = Select(condition, yes.a, no.a);
  for (int i = 0; i < N; ++i) chosen.v[i] = Select(condition, yes.v[i], no.v[i]);
  return chosen;
}

/// a < b for every scalar a template may be given: bool, a pack's mask, or a recorded condition.
/// (Ceres' own comparison of Jets insists on bool.)
template <class T>
[[nodiscard]] auto Less(const T& a, const T& b) {
  return a < b;
}
template <class T, int N>
[[nodiscard]] auto Less(const ceres::Jet<T, N>& a, const ceres::Jet<T, N>& b) {
  return a.a < b.a;
}

}  // namespace kompono

#endif  // KOMPONO_SCALAR_SELECT_HPP_
