// SPDX-License-Identifier: Apache-2.0
// Two glides on one rail along x carry the tool point in the plane xy (KDD eq. 2-4, SO). Equations:
// README.md.
#include <kompono/sdk/mechanism.hpp>

namespace {

using kompono::Vector3;

class BiGlide final : public kompono::sdk::AutodiffMechanism<BiGlide> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XY", .drives = 2, .parameters = 3, .modes = 3, .closures = 2, .points = 5};

  template <class T>
  void Drives(const Arguments<T>& in, DriveValues<T> out) const {
    using std::sqrt;
    const T half = in.parameter[kWidth] / T(2.0);
    for (std::size_t i = 0; i < 2; ++i) {
      const T joint_x = in.x[0] + (i == 0 ? -half : half);
      out.reach[i] = in.parameter[i] * in.parameter[i] - in.x[1] * in.x[1];
      out.q[i] = joint_x + in.mode[i] * sqrt(out.reach[i]);
    }
  }

  template <class T>
  void Closure(const Arguments<T>& in, std::span<T> g) const {
    const T half = in.parameter[kWidth] / T(2.0);
    for (std::size_t i = 0; i < 2; ++i) {
      const T across = in.x[0] + (i == 0 ? -half : half) - in.q[i];
      g[i] = across * across + in.x[1] * in.x[1] - in.parameter[i] * in.parameter[i];
    }
  }

  /// The platform keeps its direction, so both struts act as if they met in one point, each rail
  /// shifted by half a width.
  template <class T>
  void Coordinates(const Arguments<T>& in, std::span<T> x) const {
    using std::sqrt;
    const T half = in.parameter[kWidth] / T(2.0);
    const T c1 = in.q[0] + half;
    const T c2 = in.q[1] - half;
    const T l1 = in.parameter[kL1];
    const T l2 = in.parameter[kL2];
    const T along = (c2 - c1) / T(2.0) + (l1 * l1 - l2 * l2) / (T(2.0) * (c2 - c1));
    x[0] = c1 + along;
    x[1] = in.mode[kSide] * sqrt(l1 * l1 - along * along);
  }

  template <class T>
  void Home(const Arguments<T>& in, std::span<T> x) const {
    const T shorter = kompono::Select(
        kompono::Less(in.parameter[kL1], in.parameter[kL2]), in.parameter[kL1], in.parameter[kL2]);
    x[0] = T(0.0);
    x[1] = in.mode[kSide] * shorter * T(0.6);
  }

  template <class T>
  void Skeleton(const Arguments<T>& in, std::span<Vector3<T>> point) const {
    const T half = in.parameter[kWidth] / T(2.0);
    point[0] = {in.q[0], T(0.0), T(0.0)};
    point[1] = {in.q[1], T(0.0), T(0.0)};
    point[2] = {in.x[0] - half, in.x[1], T(0.0)};
    point[3] = {in.x[0] + half, in.x[1], T(0.0)};
    point[4] = {in.x[0], in.x[1], T(0.0)};
  }

 private:
  enum Parameter : std::size_t { kL1, kL2, kWidth };
  static constexpr std::size_t kSide = 2;
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.biglide", "0.1.0", KOMPONO_MODULE("biglide", BiGlide))
