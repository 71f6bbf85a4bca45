// SPDX-License-Identifier: Apache-2.0
// Three arms that turn about hips on a circle, parallelogram shins, a foot that only translates
// (LinuxCNC's rotarydeltakins). Equations: README.md.
#include <kompono/sdk/bound.hpp>
#include <kompono/sdk/mechanism.hpp>
#include <kompono/sdk/trilateration.hpp>

#include <array>

namespace {

using kompono::Vector3;

constexpr std::size_t kLegs = 3;
constexpr std::size_t kSide = 3;  ///< number of the mode

class RotaryDelta final : public kompono::sdk::AutodiffMechanism<RotaryDelta> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XYZ", .drives = 3, .parameters = 7, .modes = 4, .closures = 3, .points = 10};

  template <class T>
  using Hips = std::array<Vector3<T>, kLegs>;  ///< unit vectors from the axis to each hip

  template <class T>
  [[nodiscard]] Hips<T> Prepare(const Arguments<T>& in) const {
    return {Outwards(in, 0), Outwards(in, 1), Outwards(in, 2)};
  }

  /// a cos q - z sin q = k, solved without an inverse cosine: both cosine and sine of q are known
  /// up to the one root.
  template <class T>
  void Drives(const Arguments<T>& in, DriveValues<T> out) const {
    Drives(in, Prepare(in), out);
  }
  template <class T>
  void Drives(const Arguments<T>& in, const Hips<T>& hips, DriveValues<T> out) const {
    using std::atan2;
    using std::sqrt;
    const T thigh = in.parameter[kThigh];
    for (std::size_t i = 0; i < kLegs; ++i) {
      const Leg<T> leg = LegOf(in, hips[i]);
      const T plane = leg.a * leg.a + leg.z * leg.z;
      const T k = (plane + leg.Constant(in)) / (T(2.0) * thigh);
      out.reach[i] = plane - k * k;
      const T root = in.mode[i] * sqrt(out.reach[i]);
      out.q[i] = atan2(-(leg.z * k) - leg.a * root, leg.a * k - leg.z * root);
    }
  }

  template <class T>
  void Closure(const Arguments<T>& in, std::span<T> g) const {
    using std::cos;
    using std::sin;
    const T thigh = in.parameter[kThigh];
    for (std::size_t i = 0; i < kLegs; ++i) {
      const Leg<T> leg = LegOf(in, Outwards(in, i));
      g[i] = leg.a * leg.a + leg.z * leg.z + leg.Constant(in) -
             T(2.0) * thigh * (leg.a * cos(in.q[i]) - leg.z * sin(in.q[i]));
    }
  }

  template <class T>
  void Coordinates(const Arguments<T>& in, std::span<T> x) const {
    Coordinates(in, Prepare(in), x);
  }
  template <class T>
  void Coordinates(const Arguments<T>& in, const Hips<T>& hips, std::span<T> x) const {
    std::array<Vector3<T>, kLegs> centre;
    for (std::size_t i = 0; i < kLegs; ++i) {
      centre[i] = Knee(in, hips[i], i) - hips[i] * in.parameter[kFoot];
    }
    const T shin = in.parameter[kShin];
    const Vector3<T> p = kompono::sdk::Trilaterate<T>(centre, {shin, shin, shin}, in.mode[kSide]);
    for (int i = 0; i < 3; ++i) x[static_cast<std::size_t>(i)] = p[i];
  }

  /// On the axis, with all thighs 45° down (or up).
  template <class T>
  void Home(const Arguments<T>& in, std::span<T> x) const {
    using std::sqrt;
    const T slant = in.parameter[kThigh] * T(0.70710678118654752440);  // cos 45° = sin 45°
    const T across = in.parameter[kPlatform] + slant - in.parameter[kFoot];
    const T shin = in.parameter[kShin];
    x[0] = T(0.0);
    x[1] = T(0.0);
    x[2] = in.mode[kSide] * (slant + sqrt(shin * shin - across * across));
  }

  template <class T>
  void Skeleton(const Arguments<T>& in, std::span<Vector3<T>> point) const {
    const Vector3<T> p(in.x[0], in.x[1], in.x[2]);
    for (std::size_t i = 0; i < kLegs; ++i) {
      point[i] = Outwards(in, i) * in.parameter[kPlatform];
      point[kLegs + i] = Knee(in, Outwards(in, i), i);
      point[2 * kLegs + i] = p + Outwards(in, i) * in.parameter[kFoot];
    }
    point[3 * kLegs] = p;
  }

 private:
  enum Parameter : std::size_t { kPlatform, kThigh, kShin, kFoot, kAzimuth };

  /// The ankle seen from the hip: `a` outwards and `z` up in the plane of the arm, `beside` it.
  template <class T>
  struct Leg {
    T a, z, beside;

    /// What the loop's equation holds besides the arm's plane: beside² + thigh² - shin².
    [[nodiscard]] T Constant(const Arguments<T>& in) const {
      return beside * beside + in.parameter[kThigh] * in.parameter[kThigh] -
             in.parameter[kShin] * in.parameter[kShin];
    }
  };

  template <class T>
  [[nodiscard]] static Vector3<T> Outwards(const Arguments<T>& in, std::size_t leg) {
    using std::cos;
    using std::sin;
    return {cos(in.parameter[kAzimuth + leg]), sin(in.parameter[kAzimuth + leg]), T(0.0)};
  }

  template <class T>
  [[nodiscard]] static Leg<T> LegOf(const Arguments<T>& in, const Vector3<T>& out) {
    return {in.x[0] * out[0] + in.x[1] * out[1] + in.parameter[kFoot] - in.parameter[kPlatform],
            in.x[2],
            in.x[1] * out[0] - in.x[0] * out[1]};
  }

  template <class T>
  [[nodiscard]] static Vector3<T> Knee(const Arguments<T>& in,
                                       const Vector3<T>& out,
                                       std::size_t leg) {
    using std::cos;
    using std::sin;
    const T thigh = in.parameter[kThigh];
    Vector3<T> knee = out * (in.parameter[kPlatform] + thigh * cos(in.q[leg]));
    knee[2] = -(thigh * sin(in.q[leg]));
    return knee;
  }
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.rotary_delta",
               "0.1.0",
               KOMPONO_MODULE("rotary_delta", RotaryDelta),
               KOMPONO_BOUND_MODULE("rotary_delta", RotaryDelta))
