// SPDX-License-Identifier: Apache-2.0
// Three glides with parallelogram struts: pyramid (KSM), linear delta, tri-glide. Two modules share
// one geometry: rails by their end points, and rails by angles. Equations: README.md.
#include <kompono/sdk/bound.hpp>
#include <kompono/sdk/legs.hpp>
#include <kompono/sdk/mechanism.hpp>
#include <kompono/sdk/trilateration.hpp>

#include <array>

namespace {

using kompono::Vector3;

constexpr std::size_t kLegs = 3;
constexpr std::size_t kSide = 3;  ///< number of the mode

template <class T>
struct Rails {
  std::array<Vector3<T>, kLegs> start;      ///< A, where the drive reads 0
  std::array<Vector3<T>, kLegs> direction;  ///< u, unit vectors
  std::array<Vector3<T>, kLegs> joint;      ///< in the platform
  std::array<T, kLegs> strut{};
};

/// What both modules do once rails, joints and struts are known; `Derived::RailsOf` gives them.
template <class Derived>
class PyramidGeometry : public kompono::sdk::AutodiffMechanism<Derived> {
 public:
  template <class T>
  using In = kompono::sdk::Arguments<T>;

  template <class T>
  void Drives(const In<T>& in, kompono::sdk::DriveValues<T> out) const {
    Drives(in, Prepare(in), out);
  }
  template <class T>
  void Drives(const In<T>& in, const Rails<T>& rails, kompono::sdk::DriveValues<T> out) const {
    const Vector3<T> p(in.x[0], in.x[1], in.x[2]);
    for (std::size_t i = 0; i < kLegs; ++i) {
      const auto leg = kompono::sdk::GlidePosition<T>(
          rails.start[i], rails.direction[i], rails.strut[i], in.mode[i], p + rails.joint[i]);
      out.q[i] = leg.position;
      out.reach[i] = leg.reach;
    }
  }

  template <class T>
  void Closure(const In<T>& in, std::span<T> g) const {
    const Rails<T> rails = Derived::RailsOf(in);
    const Vector3<T> p(in.x[0], in.x[1], in.x[2]);
    for (std::size_t i = 0; i < kLegs; ++i) {
      g[i] = kompono::sdk::GlideClosure<T>(
          rails.start[i], rails.direction[i], rails.strut[i], in.q[i], p + rails.joint[i]);
    }
  }

  template <class T>
  [[nodiscard]] Rails<T> Prepare(const In<T>& in) const {
    return Derived::RailsOf(in);
  }
  template <class T>
  void Coordinates(const In<T>& in, std::span<T> x) const {
    Coordinates(in, Prepare(in), x);
  }
  template <class T>
  void Coordinates(const In<T>& in, const Rails<T>& rails, std::span<T> x) const {
    std::array<Vector3<T>, kLegs> centre;
    for (std::size_t i = 0; i < kLegs; ++i) {
      centre[i] = rails.start[i] + rails.direction[i] * in.q[i] - rails.joint[i];
    }
    const Vector3<T> p = kompono::sdk::Trilaterate<T>(centre, rails.strut, in.mode[kSide]);
    for (int i = 0; i < 3; ++i) x[static_cast<std::size_t>(i)] = p[i];
  }

  template <class T>
  void Skeleton(const In<T>& in, std::span<Vector3<T>> point) const {
    const Rails<T> rails = Derived::RailsOf(in);
    const Vector3<T> p(in.x[0], in.x[1], in.x[2]);
    for (std::size_t i = 0; i < kLegs; ++i) {
      point[i] = rails.start[i];
      point[kLegs + i] = rails.start[i] + rails.direction[i] * in.q[i];
      point[2 * kLegs + i] = p + rails.joint[i];
    }
    point[3 * kLegs] = p;
  }
};

/// u = (D - A) / |D - A| (KSM).
class Pyramid final : public PyramidGeometry<Pyramid> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XYZ", .drives = 3, .parameters = 30, .modes = 4, .closures = 3, .points = 10};

  template <class T>
  [[nodiscard]] static Rails<T> RailsOf(const In<T>& in) {
    using std::sqrt;
    Rails<T> rails;
    for (std::size_t i = 0; i < kLegs; ++i) {
      rails.start[i] = in.Point(3 * i);
      const Vector3<T> along = in.Point(9 + 3 * i) - rails.start[i];
      rails.direction[i] = along / sqrt(along.dot(along));
      rails.joint[i] = in.Point(18 + 3 * i);
      rails.strut[i] = in.parameter[27 + i];
    }
    return rails;
  }
};

/// Foot at (R + r) in direction azimuth, u = (-cos β cos α, -cos β sin α, sin β): leaning inwards
/// going up.
class PyramidByAngle final : public PyramidGeometry<PyramidByAngle> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XYZ", .drives = 3, .parameters = 14, .modes = 4, .closures = 3, .points = 10};

  template <class T>
  [[nodiscard]] static Rails<T> RailsOf(const In<T>& in) {
    using std::cos;
    using std::sin;
    Rails<T> rails;
    for (std::size_t i = 0; i < kLegs; ++i) {
      const T ca = cos(in.parameter[kAzimuth + i]);
      const T sa = sin(in.parameter[kAzimuth + i]);
      const T cb = cos(in.parameter[kInclination + i]);
      const T sb = sin(in.parameter[kInclination + i]);
      const T inner = in.parameter[kJointRadius];
      const T outer = in.parameter[kRadius] + in.parameter[kRadiusOffset + i] + inner;
      rails.start[i] = {outer * ca, outer * sa, T(0.0)};
      rails.direction[i] = {-(cb * ca), -(cb * sa), sb};
      rails.joint[i] = {inner * ca, inner * sa, T(0.0)};
      rails.strut[i] = in.parameter[kStrut + i];
    }
    return rails;
  }

 private:
  enum Parameter : std::size_t {
    kRadius = 0,
    kRadiusOffset = 1,
    kAzimuth = 4,
    kInclination = 7,
    kStrut = 10,
    kJointRadius = 13,
  };
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.pyramid",
               "0.1.0",
               KOMPONO_MODULE("pyramid", Pyramid),
               KOMPONO_MODULE("pyramid_by_angle", PyramidByAngle),
               KOMPONO_BOUND_MODULE("pyramid", Pyramid),
               KOMPONO_BOUND_MODULE("pyramid_by_angle", PyramidByAngle))
