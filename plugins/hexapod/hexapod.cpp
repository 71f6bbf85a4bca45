// SPDX-License-Identifier: Apache-2.0
// Six pods carry the platform in all six coordinates (GIP, HEX). Two modules share one geometry:
// explicit joint points, and radius with half angle for symmetric machines. Equations: README.md.
#include <kompono/sdk/legs.hpp>
#include <kompono/sdk/mechanism.hpp>

#include <array>

namespace {

using kompono::Pose;
using kompono::Vector3;

constexpr std::size_t kLegs = 6;

template <class T>
struct Joints {
  std::array<Vector3<T>, kLegs> base;      ///< in the mechanism's base
  std::array<Vector3<T>, kLegs> platform;  ///< in the platform
};

/// What both modules do once the joints are known; `Derived::JointsOf` gives them.
template <class Derived>
class HexapodGeometry : public kompono::sdk::AutodiffMechanism<Derived> {
 public:
  template <class T>
  using In = kompono::sdk::Arguments<T>;

  template <class T>
  [[nodiscard]] Pose<T> Platform(const In<T>& in) const {
    Pose<T> X_BP;
    X_BP.R = kompono::RotationXYZ(in.x[3], in.x[4], in.x[5]);
    X_BP.p = {in.x[0], in.x[1], in.x[2]};
    return X_BP;
  }

  template <class T>
  void Drives(const In<T>& in, kompono::sdk::DriveValues<T> out) const {
    const Pose<T> X_BP = Platform(in);
    const Joints<T> joints = Derived::JointsOf(in);
    for (std::size_t i = 0; i < kLegs; ++i) {
      const auto leg = kompono::sdk::PodLength<T>(joints.base[i], X_BP * joints.platform[i]);
      out.q[i] = leg.position;
      out.reach[i] = leg.reach;
    }
  }

  template <class T>
  void Closure(const In<T>& in, std::span<T> g) const {
    const Pose<T> X_BP = Platform(in);
    const Joints<T> joints = Derived::JointsOf(in);
    for (std::size_t i = 0; i < kLegs; ++i) {
      g[i] = kompono::sdk::PodClosure<T>(joints.base[i], in.q[i], X_BP * joints.platform[i]);
    }
  }

  /// Written out for the sake of forward kinematics: with r = R b and the leg l = p + r - a,
  /// dg = 2 l·(dp + ω × r) = 2 l·dp + 2 (r × l)·ω, where ω = e_x dA + R_x e_y dB + R e_z dC.
  template <class T>
  void Linearise(const In<T>& in, std::span<T> g, std::span<T> A) const {
    using std::cos;
    using std::sin;
    const Pose<T> X_BP = Platform(in);
    const T ca = cos(in.x[3]);
    const T sa = sin(in.x[3]);
    const Vector3<T> axis_c = X_BP.R.col(2);
    const Joints<T> joints = Derived::JointsOf(in);
    for (std::size_t i = 0; i < kLegs; ++i) {
      const Vector3<T> r = X_BP.R * joints.platform[i];
      const Vector3<T> leg = X_BP.p + r - joints.base[i];
      const Vector3<T> twice = leg + leg;
      const Vector3<T> moment = r.cross(twice);
      g[i] = leg.dot(leg) - in.q[i] * in.q[i];
      const std::span<T> row = A.subspan(6 * i, 6);
      for (int j = 0; j < 3; ++j) row[static_cast<std::size_t>(j)] = twice[j];
      row[3] = moment[0];
      row[4] = ca * moment[1] + sa * moment[2];
      row[5] = axis_c.dot(moment);
    }
  }

  /// Over the middle of the base joints, as high as the mean distance of the base joints from it.
  template <class T>
  void Home(const In<T>& in, std::span<T> x) const {
    using std::sqrt;
    const Joints<T> joints = Derived::JointsOf(in);
    Vector3<T> middle = Vector3<T>::Zero();
    for (const Vector3<T>& joint : joints.base) middle += joint / T(6.0);
    T height(0.0);
    for (const Vector3<T>& joint : joints.base) {
      const Vector3<T> arm = joint - middle;
      height += sqrt(arm.dot(arm)) / T(6.0);
    }
    for (int i = 0; i < 3; ++i) x[static_cast<std::size_t>(i)] = middle[i];
    x[2] += height;
    for (std::size_t i = 3; i < 6; ++i) x[i] = T(0.0);
  }

  template <class T>
  void Skeleton(const In<T>& in, std::span<Vector3<T>> point) const {
    const Pose<T> X_BP = Platform(in);
    const Joints<T> joints = Derived::JointsOf(in);
    for (std::size_t i = 0; i < kLegs; ++i) {
      point[i] = joints.base[i];
      point[kLegs + i] = X_BP * joints.platform[i];
    }
    point[2 * kLegs] = X_BP.p;
  }
};

class Hexapod final : public HexapodGeometry<Hexapod> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{.letters = "XYZABC",
                                                     .drives = 6,
                                                     .parameters = 36,
                                                     .modes = 0,
                                                     .closures = 6,
                                                     .points = 13,
                                                     .separable = true};

  template <class T>
  [[nodiscard]] static Joints<T> JointsOf(const In<T>& in) {
    Joints<T> joints;
    for (std::size_t i = 0; i < kLegs; ++i) {
      joints.base[i] = in.Point(3 * i);
      joints.platform[i] = in.Point(18 + 3 * i);
    }
    return joints;
  }
};

/// Base joints in pairs at 0°, 120°, 240° ± the base half angle; platform joints in pairs at 60°,
/// 180°, 300° ± theirs. Strut 2k+1 leads from the lower base joint of pair k down to the platform
/// pair before it, strut 2k+2 to the next.
class SymmetricHexapod final : public HexapodGeometry<SymmetricHexapod> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{.letters = "XYZABC",
                                                     .drives = 6,
                                                     .parameters = 4,
                                                     .modes = 0,
                                                     .closures = 6,
                                                     .points = 13,
                                                     .separable = true};

  template <class T>
  [[nodiscard]] static Joints<T> JointsOf(const In<T>& in) {
    using std::cos;
    using std::sin;
    constexpr double kThird = 2.0943951023931954923;  // 120° in rad
    Joints<T> joints;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t end = 0; end < 2; ++end) {
        const double sign = end == 0 ? -1.0 : 1.0;
        const T base_azimuth =
            T(kThird * static_cast<double>(k)) + in.parameter[kBaseHalfAngle] * T(sign);
        const T platform_azimuth = T(kThird * (static_cast<double>(k) + 0.5 * sign)) -
                                   in.parameter[kPlatformHalfAngle] * T(sign);
        joints.base[2 * k + end] = OnCircle(in.parameter[kBaseRadius], base_azimuth);
        joints.platform[2 * k + end] = OnCircle(in.parameter[kPlatformRadius], platform_azimuth);
      }
    }
    return joints;
  }

 private:
  enum Parameter : std::size_t { kBaseRadius, kBaseHalfAngle, kPlatformRadius, kPlatformHalfAngle };

  template <class T>
  [[nodiscard]] static Vector3<T> OnCircle(const T& radius, const T& azimuth) {
    using std::cos;
    using std::sin;
    return {radius * cos(azimuth), radius * sin(azimuth), T(0.0)};
  }
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.hexapod",
               "0.1.0",
               KOMPONO_MODULE("hexapod", Hexapod),
               KOMPONO_MODULE("hexapod_symmetric", SymmetricHexapod))
