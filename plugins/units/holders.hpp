// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_UNITS_HOLDERS_HPP_
#define KOMPONO_UNITS_HOLDERS_HPP_

#include "frames.hpp"

/// Units that hold the workpiece. A spindle's axis is z of its base; the datum's z points out of
/// the held end of the part. mm, rad.
namespace kompono::units {

class Workpiece final : public sdk::AutodiffUnit<Workpiece> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 3};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    return Shift<T>(parameter[0], parameter[1], parameter[2]);
  }
};

/// The sheet on the platform of an open-base machine's drive: the clamps' zero on the platform, the
/// sheet's plane tilted and the sheet turned in it, its datum on the upper side (SO: the share Δb
/// of the positioning error).
class SheetDrive final : public sdk::AutodiffUnit<SheetDrive> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 9, .stations = 2};
  template <class T>
  [[nodiscard]] Pose<T> Station(int station, int /*state*/, std::span<const T> parameter) const {
    Pose<T> X_PC = Shift<T>(parameter[kClamp], parameter[kClamp + 1], parameter[kClamp + 2]) *
                   Tilt<T>(parameter, kTilt) * Turn<T>(RotationZ(parameter[kTurn]));
    if (station == kCorner) return X_PC;
    return X_PC * Shift<T>(parameter[kDatum], parameter[kDatum + 1], parameter[kThickness]);
  }

 private:
  static constexpr int kCorner = 1;  // station 0 is the datum
  enum Parameter : std::size_t { kClamp = 0, kTilt = 3, kTurn = 5, kDatum = 6, kThickness = 8 };
};

/// Where the stations of a spindle that holds a part are: the part's stop in the chuck, or the
/// bare nose.
enum SpindleStation : int { kPart = 0, kNose = 1 };

class Headstock final : public sdk::AutodiffUnit<Headstock> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 6, .stations = 2};
  template <class T>
  [[nodiscard]] Pose<T> Station(int station, int /*state*/, std::span<const T> parameter) const {
    Pose<T> X_HN = Shift<T>(T(0.0), T(0.0), parameter[kNoseLength]);
    if (station == kNose) return X_HN;
    return X_HN * Shift<T>(parameter[kOffset], parameter[kOffset + 1], parameter[kChuck]) *
           Tilt<T>(parameter, kTilt);
  }

 private:
  enum Parameter : std::size_t { kNoseLength = 0, kChuck = 1, kOffset = 2, kTilt = 4 };
};

/// The second spindle: its base's z is the first one's axis, and it looks along -z.
class CounterSpindle final : public sdk::AutodiffUnit<CounterSpindle> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 6, .stations = 2};
  template <class T>
  [[nodiscard]] Pose<T> Station(int station, int /*state*/, std::span<const T> parameter) const {
    const Pose<T> X_CN = Shift<T>(parameter[kOffset], parameter[kOffset + 1], T(0.0)) *
                         Tilt<T>(parameter, kTilt) *
                         Shift<T>(T(0.0), T(0.0), -parameter[kNoseLength]);
    if (station == kNose) return X_CN * FaceAbout<T>();
    return X_CN * Shift<T>(T(0.0), T(0.0), -parameter[kChuck]) * FaceAbout<T>();
  }

 private:
  enum Parameter : std::size_t { kNoseLength = 0, kChuck = 1, kOffset = 2, kTilt = 4 };
};

/// The point of the centre; the base's z is the spindle's axis, the centre points along -z.
class Tailstock final : public sdk::AutodiffUnit<Tailstock> {
 public:
  static constexpr sdk::UnitSpec kSpec{.parameters = 4};
  template <class T>
  [[nodiscard]] Pose<T> Station(int /*station*/,
                                int /*state*/,
                                std::span<const T> parameter) const {
    return Shift<T>(parameter[kOffset],
                    parameter[kOffset + 1],
                    -(parameter[kQuill] + parameter[kCentre])) *
           FaceAbout<T>();
  }

 private:
  enum Parameter : std::size_t { kQuill = 0, kCentre = 1, kOffset = 2 };
};

}  // namespace kompono::units

#endif  // KOMPONO_UNITS_HOLDERS_HPP_
