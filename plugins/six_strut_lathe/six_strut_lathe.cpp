// SPDX-License-Identifier: Apache-2.0
// Six glides on rails parallel to Z carry the tool platform of a lathe (KDD fig. 7). Equations:
// README.md.
#include "../hexaglide/glide_platform.hpp"

namespace {

using kompono::Pose;
using kompono::Vector3;

class SixStrutLathe final : public kompono::plugins::GlidePlatform<SixStrutLathe> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XYZABC", .drives = 6, .parameters = 42, .modes = 6, .closures = 6, .points = 19};

  template <class T>
  [[nodiscard]] Pose<T> Platform(const In<T>& in) const {
    return {kompono::RotationXYZ(in.x[3], in.x[4], in.x[5]), {in.x[0], in.x[1], in.x[2]}};
  }

  /// All rails run along Z.
  template <class T>
  [[nodiscard]] static kompono::plugins::GlideLeg<T> Leg(const In<T>& in, std::size_t i) {
    return {in.Point(3 * i),
            {T(0.0), T(0.0), T(1.0)},
            in.Point(kJoint + 3 * i),
            in.parameter[kStrut + i]};
  }

 private:
  enum Parameter : std::size_t { kJoint = 18, kStrut = 36 };
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.six_strut_lathe",
               "0.1.0",
               KOMPONO_MODULE("six_strut_lathe", SixStrutLathe))
