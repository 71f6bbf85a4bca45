// SPDX-License-Identifier: Apache-2.0
// Six glides on arbitrary straight rails carry the platform in all six coordinates (KDD eq. 5).
// Equations: README.md.
#include "glide_platform.hpp"

namespace {

using kompono::Pose;
using kompono::Vector3;

class Hexaglide final : public kompono::plugins::GlidePlatform<Hexaglide> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XYZABC", .drives = 6, .parameters = 60, .modes = 6, .closures = 6, .points = 19};

  template <class T>
  [[nodiscard]] Pose<T> Platform(const In<T>& in) const {
    return {kompono::RotationXYZ(in.x[3], in.x[4], in.x[5]), {in.x[0], in.x[1], in.x[2]}};
  }

  /// u = (D - A) / |D - A| (KSM).
  template <class T>
  [[nodiscard]] static kompono::plugins::GlideLeg<T> Leg(const In<T>& in, std::size_t i) {
    using std::sqrt;
    const Vector3<T> start = in.Point(3 * i);
    const Vector3<T> along = in.Point(kEnd + 3 * i) - start;
    return {
        start, along / sqrt(along.dot(along)), in.Point(kJoint + 3 * i), in.parameter[kStrut + i]};
  }

 private:
  enum Parameter : std::size_t { kEnd = 18, kJoint = 36, kStrut = 54 };
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.hexaglide", "0.1.0", KOMPONO_MODULE("hexaglide", Hexaglide))
