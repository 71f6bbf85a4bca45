// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_BOUND_HPP_
#define KOMPONO_SDK_BOUND_HPP_

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

#include "kompono/plugin/bound_mechanism.hpp"
#include "kompono/sdk/arguments.hpp"
#include "kompono/sdk/plugin.hpp"

/// kompono.bound_mechanism/1 from a mechanism's templates:
///
///     KOMPONO_PLUGIN("org.example.delta", "1.0.0",
///                    KOMPONO_MODULE("delta", Delta), KOMPONO_BOUND_MODULE("delta", Delta))
///
/// An author who adds `Geometry<T> Prepare(in) const`, which reads parameters and modes only, and
/// `Coordinates(in, geometry, span<T> x)` or `Drives(in, geometry, DriveValues<T>)`, has them
/// called with the prepared geometry.
namespace kompono::sdk {

template <class Derived>
class Bound final : public plugin::BoundMechanism {
 public:
  [[nodiscard]] plugin::Status Bind(std::span<const double> parameters,
                                    std::span<const double> modes) noexcept override {
    if (parameters.size() != kParameters || modes.size() != kModes) {
      return plugin::Status::kBadSize;
    }
    std::copy(parameters.begin(), parameters.end(), number_.begin());
    std::copy(modes.begin(), modes.end(), number_.begin() + kParameters);
    return Guarded([this] {
      if constexpr (kPrepares) geometry_ = derived_.Prepare(In({}, {}));
      return plugin::Status::kOk;
    });
  }

  [[nodiscard]] plugin::Status Coordinates(std::span<const double> drives,
                                           std::span<double> coordinates) const noexcept override {
    if (drives.size() != kDrives || coordinates.size() != kCoordinates) {
      return plugin::Status::kBadSize;
    }
    const Arguments<double> in = In({}, drives);
    return Guarded([&] {
      if constexpr (requires { derived_.Coordinates(in, geometry_, coordinates); }) {
        derived_.Coordinates(in, geometry_, coordinates);
      } else if constexpr (requires { derived_.Coordinates(in, coordinates); }) {
        derived_.Coordinates(in, coordinates);
      } else {
        return plugin::Status::kUnsupported;
      }
      return plugin::Status::kOk;
    });
  }

  [[nodiscard]] plugin::Status Drives(std::span<const double> coordinates,
                                      std::span<double> drives) const noexcept override {
    if (drives.size() != kDrives || coordinates.size() != kCoordinates) {
      return plugin::Status::kBadSize;
    }
    std::array<double, kDrives> reach{};
    const DriveValues<double> out{drives, reach};
    const Arguments<double> in = In(coordinates, {});
    return Guarded([&] {
      if constexpr (requires { derived_.Drives(in, geometry_, out); }) {
        derived_.Drives(in, geometry_, out);
      } else {
        derived_.Drives(in, out);
      }
      return plugin::Status::kOk;
    });
  }

 private:
  static constexpr std::size_t kCoordinates = Derived::kSpec.letters.size();
  static constexpr auto kDrives = static_cast<std::size_t>(Derived::kSpec.drives);
  static constexpr auto kParameters = static_cast<std::size_t>(Derived::kSpec.parameters);
  static constexpr auto kModes = static_cast<std::size_t>(Derived::kSpec.modes);
  struct Nothing {};

  template <class Module>
  static auto GeometryOf(const Module& module) {
    if constexpr (requires(const Arguments<double>& in) { module.Prepare(in); }) {
      return std::type_identity<decltype(module.Prepare(Arguments<double>{}))>{};
    } else {
      return std::type_identity<Nothing>{};
    }
  }
  using Geometry = typename decltype(GeometryOf(std::declval<const Derived&>()))::type;
  static constexpr bool kPrepares = !std::is_same_v<Geometry, Nothing>;

  [[nodiscard]] Arguments<double> In(std::span<const double> x, std::span<const double> q) const {
    const std::span<const double> all(number_);
    return {.x = x, .q = q, .parameter = all.first(kParameters), .mode = all.last(kModes)};
  }
  template <class Body>
  [[nodiscard]] static plugin::Status Guarded(const Body& body) {
    try {
      return body();
    } catch (...) {
      return plugin::Status::kException;
    }
  }

  Derived derived_;
  std::array<double, kParameters + kModes> number_{};
  Geometry geometry_{};
};

template <class Derived>
constexpr KomponoModule BoundEntry(const char* id) noexcept {
  return {id,
          KOMPONO_BOUND_MECHANISM_INTERFACE,
          &CreateObject<Bound<Derived>, plugin::BoundMechanism>,
          &DestroyObject<plugin::BoundMechanism>};
}

}  // namespace kompono::sdk

/// A further entry for a module that KOMPONO_MODULE registers.
#define KOMPONO_BOUND_MODULE(module_id, Class) ::kompono::sdk::BoundEntry<Class>(module_id)

#endif  // KOMPONO_SDK_BOUND_HPP_
