// SPDX-License-Identifier: Apache-2.0
#include "machine_sheet.hpp"

#include "text.hpp"
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kompono::cli {

using nlohmann::ordered_json;

ordered_json PoseJson(const kinematics::PoseNumbers& pose) {
  ordered_json out = ordered_json::object();
  for (std::size_t k = 0; k < 6; ++k) {
    out[std::string(1, kPoseLetters[k])] = Outward(pose.value[k], IsAngle(k));
  }
  return out;
}

std::string PoseText(const kinematics::PoseNumbers& pose) {
  TextTable table({{""}, {"", true}, {""}});
  for (std::size_t k = 0; k < 6; ++k) {
    table.Row({std::string(1, kPoseLetters[k]),
               Fixed(Outward(pose.value[k], IsAngle(k))),
               std::string(UnitOf(IsAngle(k)))});
  }
  return table.Render();
}

ordered_json RangeJson(const std::optional<double>& lower,
                       const std::optional<double>& upper,
                       bool angle) {
  ordered_json out = ordered_json::array({nullptr, nullptr});
  if (lower) out[0] = Outward(*lower, angle);
  if (upper) out[1] = Outward(*upper, angle);
  return out;
}

SingularitySummary Summary(const std::vector<kinematics::Singularity>& mechanisms) {
  SingularitySummary out;
  for (const kinematics::Singularity& mechanism : mechanisms) {
    out.type |= mechanism.type;  // 1 and 2 together are 3
    out.margin = std::min(out.margin, mechanism.margin);
  }
  return out;
}

std::string_view SingularityName(int type) {
  switch (type) {
    case 0:
      return "regular";
    case 1:
      return "type 1: a drive stands at the end of its reach, motions are lost";
    case 2:
      return "type 2: the drives do not hold the platform";
    default:
      return "type 3: motions are lost and the drives do not hold the platform";
  }
}

std::vector<Strut> Struts(const kinematics::Machine::SkeletonView& skeleton) {
  const auto point = [&skeleton](const std::string& name) -> const Eigen::Vector3d* {
    for (const auto& candidate : skeleton.points) {
      if (candidate.name == name) return &candidate.p_M;
    }
    return nullptr;
  };
  std::vector<Strut> out;
  for (const auto& link : skeleton.links) {
    if (link.kind != "strut") continue;
    const Eigen::Vector3d* from = point(link.from);
    const Eigen::Vector3d* to = point(link.to);
    if (from == nullptr || to == nullptr) continue;
    Strut strut{.from = link.from, .to = link.to, .length_mm = (*to - *from).norm()};
    if (strut.length_mm > 0.0) strut.direction = (*to - *from) / strut.length_mm;
    out.push_back(strut);
  }
  return out;
}

layout::RotationOrder OrderOf(const std::string& word, const layout::Layout& layout) {
  if (word == "xyz") return layout::RotationOrder::kXYZ;
  if (word == "zyx") return layout::RotationOrder::kZYX;
  return layout.rotation_order;
}

std::string_view OrderName(layout::RotationOrder order) {
  return order == layout::RotationOrder::kXYZ ? "Rx(A) Ry(B) Rz(C)" : "Rz(C) Ry(B) Rx(A)";
}

}  // namespace kompono::cli
