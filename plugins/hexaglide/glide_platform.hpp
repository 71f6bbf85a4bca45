// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGINS_GLIDE_PLATFORM_HPP_
#define KOMPONO_PLUGINS_GLIDE_PLATFORM_HPP_

#include <kompono/sdk/legs.hpp>
#include <kompono/sdk/mechanism.hpp>

#include <span>

/// A platform on glides: what the hexaglide and the lathes of KDD's figures 5 and 7 share. The
/// module gives its pose and its legs.
namespace kompono::plugins {

template <class T>
struct GlideLeg {
  Vector3<T> start;      ///< A, where the drive reads 0
  Vector3<T> direction;  ///< u, unit vector along the rail
  Vector3<T> joint;      ///< in the platform
  T strut;
};

/// `Derived` has `Pose<T> Platform(in)`, `GlideLeg<T> Leg(in, i)` and one assembly mode per leg,
/// the first ones. Points: starts, carriages, joints, tool.
template <class Derived>
class GlidePlatform : public sdk::AutodiffMechanism<Derived> {
 public:
  template <class T>
  using In = sdk::Arguments<T>;

  template <class T>
  void Drives(const In<T>& in, sdk::DriveValues<T> out) const {
    const Pose<T> X_BP = derived().Platform(in);
    for (std::size_t i = 0; i < Legs(); ++i) {
      const GlideLeg<T> leg = Derived::Leg(in, i);
      const auto drive =
          sdk::GlidePosition<T>(leg.start, leg.direction, leg.strut, in.mode[i], X_BP * leg.joint);
      out.q[i] = drive.position;
      out.reach[i] = drive.reach;
    }
  }

  template <class T>
  void Closure(const In<T>& in, std::span<T> g) const {
    const Pose<T> X_BP = derived().Platform(in);
    for (std::size_t i = 0; i < Legs(); ++i) {
      const GlideLeg<T> leg = Derived::Leg(in, i);
      g[i] = sdk::GlideClosure<T>(leg.start, leg.direction, leg.strut, in.q[i], X_BP * leg.joint);
    }
  }

  template <class T>
  void Skeleton(const In<T>& in, std::span<Vector3<T>> point) const {
    const Pose<T> X_BP = derived().Platform(in);
    for (std::size_t i = 0; i < Legs(); ++i) {
      const GlideLeg<T> leg = Derived::Leg(in, i);
      point[i] = leg.start;
      point[Legs() + i] = leg.start + leg.direction * in.q[i];
      point[2 * Legs() + i] = X_BP * leg.joint;
    }
    point[3 * Legs()] = X_BP.p;
  }

 private:
  [[nodiscard]] static constexpr std::size_t Legs() {
    return static_cast<std::size_t>(Derived::kSpec.drives);
  }
  [[nodiscard]] const Derived& derived() const { return static_cast<const Derived&>(*this); }
};

}  // namespace kompono::plugins

#endif  // KOMPONO_PLUGINS_GLIDE_PLATFORM_HPP_
