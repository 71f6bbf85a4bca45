// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_MACHINE_SHEET_HPP_
#define KOMPONO_CLI_MACHINE_SHEET_HPP_

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/kinematics/machine.hpp"

/// What several commands say of a machine.
namespace kompono::cli {

inline constexpr std::array<char, 6> kPoseLetters{'X', 'Y', 'Z', 'A', 'B', 'C'};

/// Whether component k of a pose is an angle.
[[nodiscard]] constexpr bool IsAngle(std::size_t k) {
  return k > 2;
}

/// {"X": mm, ..., "A": deg, ...}
[[nodiscard]] nlohmann::ordered_json PoseJson(const kinematics::PoseNumbers& pose);
/// "X 10.000000 mm", six lines
[[nodiscard]] std::string PoseText(const kinematics::PoseNumbers& pose);

/// Lower and upper limit, open ends as null; mm or deg.
[[nodiscard]] nlohmann::ordered_json RangeJson(const std::optional<double>& lower,
                                               const std::optional<double>& upper,
                                               bool angle);

/// The worst over the mechanisms: type 3 if both 1 and 2 occur, the smallest margin. A machine
/// without mechanisms is regular with margin 1.
struct SingularitySummary {
  int type = 0;
  double margin = 1.0;
};
[[nodiscard]] SingularitySummary Summary(const std::vector<kinematics::Singularity>& mechanisms);
[[nodiscard]] std::string_view SingularityName(int type);

/// A link of kind "strut" at some pose.
struct Strut {
  std::string from, to;
  double length_mm = 0.0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit vector, in the base frame
};
[[nodiscard]] std::vector<Strut> Struts(const kinematics::Machine::SkeletonView& skeleton);

/// The rotation order called "xyz" or "zyx"; the layout's if `word` is empty.
[[nodiscard]] layout::RotationOrder OrderOf(const std::string& word, const layout::Layout& layout);
[[nodiscard]] std::string_view OrderName(layout::RotationOrder order);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_MACHINE_SHEET_HPP_
