// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_KLIPPER_DELTA_HPP_
#define KOMPONO_CALIBRATION_KLIPPER_DELTA_HPP_

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// Calibration runs of linear deltas as Klipper keeps them, and its way of naming the geometry.
///
/// Tower i stands at `delta_radius` in direction `angle_i`; with its carriage s_i below the
/// end-stop the carriage is at height endstop_i + sqrt(arm_i² - delta_radius²) - s_i. In a kompono
/// layout that is a `linear_delta` with radius = delta_radius, azimuth = angles, strut = arms,
/// readings s_i counted downwards (direction "-") and drive zeros endstop_i + sqrt(arm_i² -
/// radius²).
namespace kompono::calibration {

struct KlipperGeometry {
  double delta_radius = 0.0;          ///< mm
  std::array<double, 3> angle_deg{};  ///< towers a, b, c
  std::array<double, 3> arm{};        ///< mm
  std::array<double, 3> endstop{};    ///< mm
};

/// The .json beside a run's .csv.
struct KlipperRun {
  std::string name, source, commit, licence, machine;
  int heights = 0, distances = 0;
  KlipperGeometry nominal, published_fit;
};

/// E042x for what is missing or of the wrong type.
[[nodiscard]] Parsed<KlipperRun> ReadKlipperRun(const std::filesystem::path& json_file);

/// `kind,value_mm,s1_a_mm,…`
[[nodiscard]] bool IsKlipperDelta(std::string_view text);

/// A layout of the machine; its block is called "delta".
[[nodiscard]] std::string KlipperLayout(const KlipperGeometry& geometry,
                                        std::string_view name,
                                        std::string_view description);

/// Back to Klipper's numbers. The machine must have a linear delta (or pyramid_by_angle) with three
/// drives; E0425 if not.
[[nodiscard]] Parsed<KlipperGeometry> KlipperGeometryOf(const kinematics::Machine& machine,
                                                        const Eigen::VectorXd& theta);
/// The machine's θ with Klipper's numbers in it.
[[nodiscard]] Parsed<Eigen::VectorXd> ThetaOfKlipper(const kinematics::Machine& machine,
                                                     const KlipperGeometry& geometry);

/// A table of the three geometries: nominal, identified, published.
[[nodiscard]] std::string CompareKlipper(const KlipperGeometry& nominal,
                                         const KlipperGeometry& identified,
                                         const KlipperGeometry& published);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_KLIPPER_DELTA_HPP_
