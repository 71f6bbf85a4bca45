// SPDX-License-Identifier: Apache-2.0
// Five pods that end on rings round the spindle (LinuxCNC's pentakins). Equations: README.md.
#include <kompono/sdk/mechanism.hpp>

namespace {

using kompono::Pose;
using kompono::Vector3;

constexpr std::size_t kLegs = 5;

class Pentapod final : public kompono::sdk::AutodiffMechanism<Pentapod> {
 public:
  /// B before A: the platform's rotation is Ry(B) Rx(A), which leaves no turn about z to the
  /// controllers that write Rz(C) Ry(B) Rx(A).
  static constexpr kompono::sdk::MechanismSpec kSpec{.letters = "XYZBA",
                                                     .drives = 5,
                                                     .parameters = 25,
                                                     .modes = 0,
                                                     .closures = 5,
                                                     .points = 16,
                                                     .separable = true};

  template <class T>
  void Drives(const Arguments<T>& in, DriveValues<T> out) const {
    using std::sqrt;
    const Pose<T> X_PB = Platform(in).Inverse();
    for (std::size_t i = 0; i < kLegs; ++i) {
      out.reach[i] = LengthSquared(in, i, X_PB * in.Point(3 * i));
      out.q[i] = sqrt(out.reach[i]);
    }
  }

  template <class T>
  void Closure(const Arguments<T>& in, std::span<T> g) const {
    const Pose<T> X_PB = Platform(in).Inverse();
    for (std::size_t i = 0; i < kLegs; ++i) {
      g[i] = LengthSquared(in, i, X_PB * in.Point(3 * i)) - in.q[i] * in.q[i];
    }
  }

  template <class T>
  void Skeleton(const Arguments<T>& in, std::span<Vector3<T>> point) const {
    const Pose<T> X_BP = Platform(in);
    const Pose<T> X_PB = X_BP.Inverse();
    for (std::size_t i = 0; i < kLegs; ++i) {
      const Vector3<T> e = X_PB * in.Point(3 * i);
      const T share = in.parameter[kRadius + i] / FromAxis(e);
      const T height = in.parameter[kHeight + i];
      point[i] = in.Point(3 * i);
      point[kLegs + i] = X_BP * Vector3<T>(e[0] * share, e[1] * share, height);
      point[2 * kLegs + i] = X_BP * Vector3<T>(T(0.0), T(0.0), height);
    }
    point[3 * kLegs] = X_BP.p;
  }

 private:
  enum Parameter : std::size_t { kBase = 0, kRadius = 15, kHeight = 20 };

  template <class T>
  [[nodiscard]] static T FromAxis(const Vector3<T>& e) {
    using std::sqrt;
    return sqrt(e[0] * e[0] + e[1] * e[1]);
  }

  /// Squared strut from the base joint at `e` in the platform to the nearest point of its ring.
  template <class T>
  [[nodiscard]] static T LengthSquared(const Arguments<T>& in,
                                       std::size_t leg,
                                       const Vector3<T>& e) {
    const T along = e[2] - in.parameter[kHeight + leg];
    const T across = FromAxis(e) - in.parameter[kRadius + leg];
    return along * along + across * across;
  }
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.pentapod", "0.1.0", KOMPONO_MODULE("pentapod", Pentapod))
