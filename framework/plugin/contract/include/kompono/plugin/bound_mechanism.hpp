// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_BOUND_MECHANISM_HPP_
#define KOMPONO_PLUGIN_BOUND_MECHANISM_HPP_

#include <span>

#include "kompono/plugin/interfaces.hpp"

/// A second interface that a module may offer beside `kompono.mechanism/1`: the mechanism with its
/// geometry fixed, for who asks for one pose at a time, as a control does.
namespace kompono::plugin {

/// "kompono.bound_mechanism/1". What depends on the geometry alone is worked out once, by Bind.
/// Afterwards the object does not change: it may be asked from several threads.
class KOMPONO_CONTRACT_API BoundMechanism {
 public:
  BoundMechanism() = default;
  BoundMechanism(const BoundMechanism&) = delete;
  BoundMechanism& operator=(const BoundMechanism&) = delete;
  virtual ~BoundMechanism();

  /// Comes first; the numbers are copied.
  [[nodiscard]] virtual Status Bind(std::span<const double> parameters,
                                    std::span<const double> modes) noexcept = 0;
  /// q -> x in closed form; not a number where the legs do not meet. kUnsupported without one.
  [[nodiscard]] virtual Status Coordinates(std::span<const double> drives,
                                           std::span<double> coordinates) const noexcept = 0;
  /// x -> q; not a number where a drive cannot reach.
  [[nodiscard]] virtual Status Drives(std::span<const double> coordinates,
                                      std::span<double> drives) const noexcept = 0;
};

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_BOUND_MECHANISM_HPP_
