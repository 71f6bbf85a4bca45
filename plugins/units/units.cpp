// SPDX-License-Identifier: Apache-2.0
// Units that close a chain: workpiece, spindle, tool and jet head. Equations: README.md.
#include <kompono/sdk/unit.hpp>

namespace {

using kompono::Pose;

template <class T>
Pose<T> Shift(const T& x, const T& y, const T& z) {
  Pose<T> X;
  X.p = {x, y, z};
  return X;
}

class Workpiece final : public kompono::sdk::AutodiffUnit<Workpiece> {
 public:
  static constexpr kompono::sdk::UnitSpec kSpec{.parameters = 3};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    return Shift<T>(parameter[0], parameter[1], parameter[2]);
  }
};

class Spindle final : public kompono::sdk::AutodiffUnit<Spindle> {
 public:
  static constexpr kompono::sdk::UnitSpec kSpec{.parameters = 1};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    return Shift<T>(T(0.0), T(0.0), -parameter[0]);
  }
};

class Tool final : public kompono::sdk::AutodiffUnit<Tool> {
 public:
  static constexpr kompono::sdk::UnitSpec kSpec{.parameters = 3};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    return Shift<T>(parameter[1], parameter[2], -parameter[0]);
  }
};

/// SO fig. 4: nozzle -> mixing chamber -> calibrating tube -> jet, each joint with a small shift,
/// the tube with a tilt.
class JetHead final : public kompono::sdk::AutodiffUnit<JetHead> {
 public:
  static constexpr kompono::sdk::UnitSpec kSpec{.parameters = 12};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    const Pose<T> X_HC =
        Shift<T>(parameter[kChamberOffset], parameter[kChamberOffset + 1], -parameter[kNozzle]);
    const Pose<T> X_CT =
        Shift<T>(parameter[kTubeOffset], parameter[kTubeOffset + 1], -parameter[kChamber]);
    Pose<T> tilt;
    tilt.R = kompono::RotationXYZ(parameter[kTubeTilt], parameter[kTubeTilt + 1], T(0.0));
    const Pose<T> X_TJ = Shift<T>(parameter[kEdgeOffset],
                                  parameter[kEdgeOffset + 1],
                                  -(parameter[kTube] + parameter[kStandOff]));
    return X_HC * X_CT * tilt * X_TJ;
  }

 private:
  enum Parameter : std::size_t {
    kNozzle = 0,
    kChamber = 1,
    kTube = 2,
    kStandOff = 3,
    kChamberOffset = 4,
    kTubeOffset = 6,
    kTubeTilt = 8,
    kEdgeOffset = 10,
  };
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.units",
               "0.1.0",
               KOMPONO_MODULE("workpiece", Workpiece),
               KOMPONO_MODULE("spindle", Spindle),
               KOMPONO_MODULE("tool", Tool),
               KOMPONO_MODULE("jet_head", JetHead))
