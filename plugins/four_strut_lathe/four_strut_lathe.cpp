// SPDX-License-Identifier: Apache-2.0
// Four glides on rails parallel to Z move the tool platform of a lathe in four coordinates, two are
// held passively (KDD fig. 5-6). Equations: README.md.
#include "../hexaglide/glide_platform.hpp"

namespace {

using kompono::Pose;
using kompono::Vector3;

class FourStrutLathe final : public kompono::plugins::GlidePlatform<FourStrutLathe> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "YZBC", .drives = 4, .parameters = 30, .modes = 4, .closures = 4, .points = 13};

  /// x and the turn about x stay as the passive guide holds them.
  template <class T>
  [[nodiscard]] Pose<T> Platform(const In<T>& in) const {
    return {kompono::RotationXYZ(in.parameter[kHeldA], in.x[2], in.x[3]),
            {in.parameter[kHeldX], in.x[0], in.x[1]}};
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
  enum Parameter : std::size_t { kJoint = 12, kStrut = 24, kHeldX = 28, kHeldA = 29 };
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.four_strut_lathe",
               "0.1.0",
               KOMPONO_MODULE("four_strut_lathe", FourStrutLathe))
