// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_CALIBRATION_MACHINES_HPP_
#define KOMPONO_TESTS_CALIBRATION_MACHINES_HPP_

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"
#include "kompono/layout/layout.hpp"
#include "kompono/plugin/registry.hpp"

/// Machines for the calibration's tests, from the plugins of this build.
namespace kompono::calibration::testing {

inline const std::filesystem::path kSource = KOMPONO_SOURCE_DIR;
inline const std::filesystem::path kData = kSource / "tests/calibration/data";
inline const std::filesystem::path kMeasurements = kSource / "layouts/measurements";

inline const plugin::Registry& Plugins() {
  static const plugin::Registry registry = [] {
    const std::filesystem::path folder =
        std::filesystem::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins";
    return plugin::Registry::Discover(std::span(&folder, 1));
  }();
  return registry;
}

/// The value, or an exception with the whole complaint as its text.
template <class T>
T Good(Parsed<T> parsed) {
  if (!parsed) throw std::runtime_error(RenderAll(parsed.error(), {}));
  return std::move(*parsed);
}

inline kinematics::Machine MachineFrom(std::string_view layout_text) {
  return Good(kinematics::Machine::Build(
      Good(layout::ParseLayout(layout_text, "machine.toml", Plugins())), Plugins()));
}

inline kinematics::Machine MachineOf(const std::filesystem::path& below_layouts) {
  return Good(kinematics::Machine::Build(
      Good(layout::ReadLayout(kSource / "layouts" / below_layouts, Plugins())), Plugins()));
}

}  // namespace kompono::calibration::testing

#endif  // KOMPONO_TESTS_CALIBRATION_MACHINES_HPP_
