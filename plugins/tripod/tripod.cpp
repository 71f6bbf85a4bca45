// SPDX-License-Identifier: Apache-2.0
// Three pods to one point, three pods with a guide tube, and three pods on hinges (3-RPS).
// Equations: README.md.
#include <kompono/sdk/bound.hpp>
#include <kompono/sdk/legs.hpp>
#include <kompono/sdk/mechanism.hpp>
#include <kompono/sdk/trilateration.hpp>

#include <array>

namespace {

using kompono::Pose;
using kompono::Vector3;

class Tripod final : public kompono::sdk::AutodiffMechanism<Tripod> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XYZ", .drives = 3, .parameters = 9, .modes = 1, .closures = 3, .points = 4};

  template <class T>
  void Drives(const Arguments<T>& in, DriveValues<T> out) const {
    const Vector3<T> p(in.x[0], in.x[1], in.x[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto leg = kompono::sdk::PodLength<T>(in.Point(3 * i), p);
      out.q[i] = leg.position;
      out.reach[i] = leg.reach;
    }
  }

  template <class T>
  void Closure(const Arguments<T>& in, std::span<T> g) const {
    const Vector3<T> p(in.x[0], in.x[1], in.x[2]);
    for (std::size_t i = 0; i < 3; ++i)
      g[i] = kompono::sdk::PodClosure<T>(in.Point(3 * i), in.q[i], p);
  }

  template <class T>
  void Coordinates(const Arguments<T>& in, std::span<T> x) const {
    const std::array<Vector3<T>, 3> foot{in.Point(0), in.Point(3), in.Point(6)};
    const Vector3<T> p =
        kompono::sdk::Trilaterate<T>(foot, {in.q[0], in.q[1], in.q[2]}, in.mode[0]);
    for (int i = 0; i < 3; ++i) x[static_cast<std::size_t>(i)] = p[i];
  }

  /// Over the middle of the feet, as high as the first foot is away from it.
  template <class T>
  void Home(const Arguments<T>& in, std::span<T> x) const {
    using std::sqrt;
    const Vector3<T> middle = (in.Point(0) + in.Point(3) + in.Point(6)) / T(3.0);
    const Vector3<T> arm = in.Point(0) - middle;
    const Vector3<T> normal = (in.Point(3) - in.Point(0)).cross(in.Point(6) - in.Point(0));
    const T height = in.mode[0] * sqrt(arm.dot(arm) / normal.dot(normal));
    for (int i = 0; i < 3; ++i) x[static_cast<std::size_t>(i)] = middle[i] + normal[i] * height;
  }

  template <class T>
  void Skeleton(const Arguments<T>& in, std::span<Vector3<T>> point) const {
    for (std::size_t i = 0; i < 3; ++i) point[i] = in.Point(3 * i);
    point[3] = {in.x[0], in.x[1], in.x[2]};
  }
};

/// A tube that is one piece with the platform slides and swings in a cardan joint on the base and
/// lets the platform neither turn about it nor move aside: the platform's place gives its tilt.
class GuidedTripod final : public kompono::sdk::AutodiffMechanism<GuidedTripod> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XYZ", .drives = 3, .parameters = 21, .modes = 1, .closures = 3, .points = 8};

  /// R = Rx(α) Ry(β), the turns of the cardan joint, with the third column along the tube.
  template <class T>
  [[nodiscard]] Pose<T> Platform(const Arguments<T>& in) const {
    using std::sqrt;
    const Vector3<T> p(in.x[0], in.x[1], in.x[2]);
    const Vector3<T> tube = (in.Point(kGuide) - p) * in.mode[0];
    const T across = sqrt(tube[1] * tube[1] + tube[2] * tube[2]);
    const T length = sqrt(tube.dot(tube));
    const T ca = tube[2] / across;
    const T sa = -(tube[1] / across);
    const T cb = across / length;
    const T sb = tube[0] / length;
    Pose<T> X_BP;
    X_BP.R << cb, T(0.0), sb, sa * sb, ca, -(sa * cb), -(ca * sb), sa, ca * cb;
    X_BP.p = p;
    return X_BP;
  }

  template <class T>
  void Drives(const Arguments<T>& in, DriveValues<T> out) const {
    const Pose<T> X_BP = Platform(in);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto leg = kompono::sdk::PodLength<T>(in.Point(3 * i), X_BP * in.Point(kJoint + 3 * i));
      out.q[i] = leg.position;
      out.reach[i] = leg.reach;
    }
  }

  template <class T>
  void Closure(const Arguments<T>& in, std::span<T> g) const {
    const Pose<T> X_BP = Platform(in);
    for (std::size_t i = 0; i < 3; ++i) {
      g[i] = kompono::sdk::PodClosure<T>(in.Point(3 * i), in.q[i], X_BP * in.Point(kJoint + 3 * i));
    }
  }

  /// Straight below the cardan joint (or above it), one and a half times as far as the feet are
  /// from it on average.
  template <class T>
  void Home(const Arguments<T>& in, std::span<T> x) const {
    using std::sqrt;
    const Vector3<T> guide = in.Point(kGuide);
    T away(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3<T> arm = in.Point(3 * i) - guide;
      away += sqrt(arm.dot(arm)) / T(2.0);
    }
    x[0] = guide[0];
    x[1] = guide[1];
    x[2] = guide[2] - in.mode[0] * away;
  }

  template <class T>
  void Skeleton(const Arguments<T>& in, std::span<Vector3<T>> point) const {
    const Pose<T> X_BP = Platform(in);
    for (std::size_t i = 0; i < 3; ++i) {
      point[i] = in.Point(3 * i);
      point[3 + i] = X_BP * in.Point(kJoint + 3 * i);
    }
    point[6] = in.Point(kGuide);
    point[7] = X_BP.p;
  }

 private:
  enum Parameter : std::size_t { kJoint = 9, kGuide = 18 };
};

/// Hinges on the base keep each pod in its upright plane through the axis, so the platform has Z, A
/// and B; its x, y and C follow from them.
class HingedTripod final : public kompono::sdk::AutodiffMechanism<HingedTripod> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "ZAB", .drives = 3, .parameters = 2, .modes = 0, .closures = 3, .points = 7};

  template <class T>
  [[nodiscard]] Pose<T> Platform(const Arguments<T>& in) const {
    using std::atan2;
    using std::cos;
    using std::sin;
    const T a = in.x[1];
    const T b = in.x[2];
    const T turn = atan2(-(sin(a) * sin(b)), cos(a) + cos(b));
    Pose<T> X_BP;
    X_BP.R = kompono::RotationXYZ(a, b, turn);
    const T radius = in.parameter[kPlatformRadius];
    X_BP.p = {radius * (X_BP.R(0, 0) - X_BP.R(1, 1)) / T(2.0), -(radius * X_BP.R(1, 0)), in.x[0]};
    return X_BP;
  }

  template <class T>
  void Drives(const Arguments<T>& in, DriveValues<T> out) const {
    const Pose<T> X_BP = Platform(in);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto leg =
          kompono::sdk::PodLength<T>(OnCircle(in.parameter[kBaseRadius], i),
                                     X_BP * OnCircle(in.parameter[kPlatformRadius], i));
      out.q[i] = leg.position;
      out.reach[i] = leg.reach;
    }
  }

  template <class T>
  void Closure(const Arguments<T>& in, std::span<T> g) const {
    const Pose<T> X_BP = Platform(in);
    for (std::size_t i = 0; i < 3; ++i) {
      g[i] = kompono::sdk::PodClosure<T>(OnCircle(in.parameter[kBaseRadius], i),
                                         in.q[i],
                                         X_BP * OnCircle(in.parameter[kPlatformRadius], i));
    }
  }

  /// Level, as high as the base is wide from its middle.
  template <class T>
  void Home(const Arguments<T>& in, std::span<T> x) const {
    x[0] = in.parameter[kBaseRadius];
    x[1] = T(0.0);
    x[2] = T(0.0);
  }

  template <class T>
  void Skeleton(const Arguments<T>& in, std::span<Vector3<T>> point) const {
    const Pose<T> X_BP = Platform(in);
    for (std::size_t i = 0; i < 3; ++i) {
      point[i] = OnCircle(in.parameter[kBaseRadius], i);
      point[3 + i] = X_BP * OnCircle(in.parameter[kPlatformRadius], i);
    }
    point[6] = X_BP.p;
  }

 private:
  enum Parameter : std::size_t { kBaseRadius, kPlatformRadius };

  /// At 0°, 120° and 240°.
  template <class T>
  [[nodiscard]] static Vector3<T> OnCircle(const T& radius, std::size_t i) {
    constexpr double kHalfRoot3 = 0.86602540378443864676;
    constexpr std::array<double, 3> kCos{1.0, -0.5, -0.5};
    constexpr std::array<double, 3> kSin{0.0, kHalfRoot3, -kHalfRoot3};
    return {radius * T(kCos[i]), radius * T(kSin[i]), T(0.0)};
  }
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.tripod",
               "0.1.0",
               KOMPONO_MODULE("tripod", Tripod),
               KOMPONO_MODULE("tripod_guided", GuidedTripod),
               KOMPONO_MODULE("tripod_3rps", HingedTripod),
               KOMPONO_BOUND_MODULE("tripod", Tripod))
