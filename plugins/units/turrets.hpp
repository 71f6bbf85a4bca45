// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_UNITS_TURRETS_HPP_
#define KOMPONO_UNITS_TURRETS_HPP_

#include "frames.hpp"

#include <cmath>
#include <numbers>

/// Units with many tools that index about an axis, z of the turret. The working position lies
/// towards x. State 0: the station that is asked for stands there; state s > 0: pocket s stands
/// there and the others where the indexing leaves them. mm, rad.
namespace kompono::units {

inline constexpr int kMaxPockets = 12;

/// One disc of pockets.
template <class T>
struct Disc {
  T radius;       ///< from the turret's axis to the pocket's gauge plane
  T pockets;      ///< how many; the pitch is a full turn divided by it
  T angle;        ///< between tool and turret's axis: 90° radial, 0 along the axis
  T index_error;  ///< by which all pockets stand off
};

/// Pose of the tip in pocket `pocket` (from 0), `overhang` beyond the gauge plane, the tool along
/// -z of the station. Axial tools point along -z of the disc, or along +z if it looks `back`. Not a
/// number for a pocket or state that the disc does not have.
template <class T>
[[nodiscard]] Pose<T> PocketPose(
    const Disc<T>& disc, int pocket, int state, const T& overhang, bool back) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const T error = disc.index_error;
  T index = error;
  if (state > 0) index = T(kTurn * (pocket - (state - 1))) / disc.pockets + error;
  const T tilt = back ? disc.angle - T(std::numbers::pi) : -disc.angle;
  const bool exists = !(disc.pockets < T(pocket + 1)) && !(disc.pockets < T(state));
  const T reach = exists ? disc.radius : T(std::nan(""));
  return Turn<T>(RotationZ(index)) * Shift<T>(reach, T(0.0), T(0.0)) * Turn<T>(RotationY(tilt)) *
         Shift<T>(T(0.0), T(0.0), -overhang);
}

/// A turret that swivels about y of its base (B), such as the head of a lathe's tool platform.
class Turret final : public sdk::AutodiffUnit<Turret> {
 public:
  static constexpr sdk::UnitSpec kSpec{
      .parameters = 11 + kMaxPockets, .stations = kMaxPockets, .states = kMaxPockets + 1};
  template <class T>
  [[nodiscard]] Pose<T> Station(int station, int state, std::span<const T> parameter) const {
    const Pose<T> X_BS = Shift<T>(parameter[kPivot], parameter[kPivot + 1], parameter[kPivot + 2]) *
                         Turn<T>(RotationY(parameter[kSwivel]));
    const Pose<T> X_ST = Shift<T>(parameter[kArm], parameter[kArm + 1], parameter[kArm + 2]);
    const Disc<T> disc{
        parameter[kRadius], parameter[kPockets], parameter[kAngle], parameter[kIndexError]};
    const T& overhang = parameter[kOverhang + static_cast<std::size_t>(station)];
    return X_BS * X_ST * PocketPose(disc, station, state, overhang, false);
  }

 private:
  enum Parameter : std::size_t {
    kPockets = 0,
    kRadius = 1,
    kAngle = 2,
    kPivot = 3,
    kSwivel = 6,
    kArm = 7,
    kIndexError = 10,
    kOverhang = 11,
  };
};

/// Two coaxial turrets on one platform (KDD table 1): the front one towards -z, the back one
/// towards +z, their discs `distance` apart, each indexing by itself. The state is that of the
/// turret whose station is asked for.
class TwinTurret final : public sdk::AutodiffUnit<TwinTurret> {
 public:
  static constexpr sdk::UnitSpec kSpec{
      .parameters = 6 + 2 * kMaxPockets, .stations = 2 * kMaxPockets, .states = kMaxPockets + 1};
  template <class T>
  [[nodiscard]] Pose<T> Station(int station, int state, std::span<const T> parameter) const {
    const bool back = station >= kMaxPockets;
    const Disc<T> disc{parameter[kRadius],
                       parameter[kPockets],
                       parameter[kAngle],
                       parameter[back ? kIndexError + 1 : kIndexError]};
    const T half = parameter[kDistance] / T(2.0);
    const T& overhang = parameter[kOverhang + static_cast<std::size_t>(station)];
    return Shift<T>(T(0.0), T(0.0), back ? half : -half) *
           PocketPose(disc, station % kMaxPockets, state, overhang, back);
  }

 private:
  enum Parameter : std::size_t {
    kPockets = 0,
    kRadius = 1,
    kAngle = 2,
    kDistance = 3,
    kIndexError = 4,
    kOverhang = 6,
  };
};

}  // namespace kompono::units

#endif  // KOMPONO_UNITS_TURRETS_HPP_
