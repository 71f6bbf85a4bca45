// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_UNITS_TOOLS_HPP_
#define KOMPONO_UNITS_TOOLS_HPP_

#include "frames.hpp"

/// Units that carry one tool or jet; they point along -z of their base (GIP: A3(-H)). mm, rad.
namespace kompono::units {

class Spindle final : public sdk::AutodiffUnit<Spindle> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 1};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    return Shift<T>(T(0.0), T(0.0), -parameter[0]);
  }
};

class Tool final : public sdk::AutodiffUnit<Tool> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 3};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    return Shift<T>(parameter[1], parameter[2], -parameter[0]);
  }
};

/// SO fig. 4: nozzle -> mixing chamber -> calibrating tube -> jet. Chamber and tube each stand
/// shifted and tilted on what carries them, and the jet leaves beside the tube's axis.
class JetHead final : public sdk::AutodiffUnit<JetHead> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 14};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    const Pose<T> X_HC =
        Shift<T>(parameter[kChamberOffset], parameter[kChamberOffset + 1], -parameter[kNozzle]) *
        Tilt<T>(parameter, kChamberTilt);
    const Pose<T> X_CT =
        Shift<T>(parameter[kTubeOffset], parameter[kTubeOffset + 1], -parameter[kChamber]) *
        Tilt<T>(parameter, kTubeTilt);
    const Pose<T> X_TJ = Shift<T>(parameter[kEdgeOffset],
                                  parameter[kEdgeOffset + 1],
                                  -(parameter[kTube] + parameter[kStandOff]));
    return X_HC * X_CT * X_TJ;
  }

 private:
  enum Parameter : std::size_t {
    kNozzle = 0,
    kChamber = 1,
    kTube = 2,
    kStandOff = 3,
    kChamberOffset = 4,
    kChamberTilt = 6,
    kTubeOffset = 8,
    kTubeTilt = 10,
    kEdgeOffset = 12,
  };
};

}  // namespace kompono::units

#endif  // KOMPONO_UNITS_TOOLS_HPP_
