// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_UNIT_HPP_
#define KOMPONO_SDK_UNIT_HPP_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kompono/geometry/pose.hpp"
#include "kompono/plugin/interfaces.hpp"
#include "kompono/scalar/jet.hpp"
#include "kompono/sdk/plugin.hpp"

/// The base of a unit plugin (spindle, turret, jet head, holder): the author writes where its
/// stations are.
///
///     class Tool final : public kompono::sdk::AutodiffUnit<Tool> {
///      public:
///       static constexpr kompono::sdk::UnitSpec kSpec{.parameters = 1, .stations = 1, .states =
///       1}; template <class T> kompono::Pose<T> Station(int station, int state, std::span<const T>
///       parameter) const;
///     };
namespace kompono::sdk {

struct UnitSpec {
  int parameters = 0;
  int stations = 1;
  int states = 1;
};

template <class Derived>
class AutodiffUnit : public plugin::Unit {
 public:
  [[nodiscard]] plugin::UnitShape Shape() const noexcept final {
    return {.parameters = Derived::kSpec.parameters,
            .stations = Derived::kSpec.stations,
            .states = Derived::kSpec.states};
  }

  [[nodiscard]] plugin::Status StationPose(
      std::int32_t station,
      std::int32_t state,
      std::span<const double> parameters,
      std::span<double> pose,
      std::span<double> pose_by_parameters) const noexcept final {
    constexpr auto kParameters = static_cast<std::size_t>(Derived::kSpec.parameters);
    if (parameters.size() != kParameters || pose.size() != 12 || station < 0 ||
        station >= Derived::kSpec.stations || state < 0 || state >= Derived::kSpec.states ||
        (!pose_by_parameters.empty() && pose_by_parameters.size() != 12 * kParameters)) {
      return plugin::Status::kBadSize;
    }
    try {
      const auto& unit = static_cast<const Derived&>(*this);
      unit.Station(station, state, parameters).Write(pose);
      if (!pose_by_parameters.empty()) {
        Differentiate(unit, station, state, parameters, pose_by_parameters);
      }
      return plugin::Status::kOk;
    } catch (...) {
      return plugin::Status::kException;
    }
  }

 private:
  static constexpr std::size_t kChunk = 6;

  static void Differentiate(const Derived& unit,
                            int station,
                            int state,
                            std::span<const double> parameters,
                            std::span<double> table) {
    using J = Jet<double, static_cast<int>(kChunk)>;
    constexpr auto kParameters = static_cast<std::size_t>(Derived::kSpec.parameters);
    for (std::size_t first = 0; first < kParameters; first += kChunk) {
      const std::size_t count = std::min(kChunk, kParameters - first);
      std::array<J, kParameters + 1> theta{};
      for (std::size_t i = 0; i < kParameters; ++i) theta[i] = J(parameters[i]);
      for (std::size_t i = 0; i < count; ++i) theta[first + i].v[static_cast<int>(i)] = 1.0;
      std::array<J, 12> rows{};
      unit.Station(station, state, std::span<const J>(theta.data(), kParameters))
          .Write(std::span<J>(rows));
      for (std::size_t row = 0; row < 12; ++row) {
        for (std::size_t i = 0; i < count; ++i) {
          table[row * kParameters + first + i] = rows[row].v[static_cast<int>(i)];
        }
      }
    }
  }
};

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_UNIT_HPP_
