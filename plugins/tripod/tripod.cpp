// SPDX-License-Identifier: Apache-2.0
// Three pods that meet in one point; the feet stand anywhere. Equations: README.md.
#include <kompono/sdk/legs.hpp>
#include <kompono/sdk/mechanism.hpp>
#include <kompono/sdk/trilateration.hpp>

#include <array>

namespace {

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

}  // namespace

KOMPONO_PLUGIN("org.kompono.tripod", "0.1.0", KOMPONO_MODULE("tripod", Tripod))
