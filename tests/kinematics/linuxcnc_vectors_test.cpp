// SPDX-License-Identifier: Apache-2.0
// Drives and poses of LinuxCNC's own modules (provenance: data/README.md).
#include "shipped_machines.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace kompono {
namespace {

using kinematics::VectorXd;

constexpr double kRadPerDeg = 0.017453292519943295769;

struct Row {
  std::array<double, 6> pose{};  ///< mm, rad
  std::vector<double> joints;
};

std::vector<Row> ReadVectors(const std::string& module) {
  const std::filesystem::path file =
      std::filesystem::path(KOMPONO_SOURCE_DIR) / "tests/kinematics/data" / (module + ".csv");
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::size_t joints = 0;
  for (std::size_t at = line.find(",q"); at != std::string::npos; at = line.find(",q", at + 1))
    ++joints;
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    Row row;
    for (std::size_t i = 0; i < 6 + joints && std::getline(cells, cell, ','); ++i) {
      const double number = std::stod(cell);
      if (i < 6) row.pose[i] = i < 3 ? number : number * kRadPerDeg;
      if (i >= 6) row.joints.push_back(number);
    }
    rows.push_back(row);
  }
  return rows;
}

void CompareWith(const std::string& module, const std::string& machine_name) {
  const kinematics::Machine machine = tests::LoadMachine(machine_name);
  const std::vector<Row> rows = ReadVectors(module);
  ASSERT_EQ(rows.size(), 25U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    ASSERT_EQ(row.joints.size(), machine.drives().size());
    const std::size_t components = machine.coordinates().size() == 3 ? 3 : 6;
    kinematics::PoseTarget target{.order = layout::RotationOrder::kZYX};
    for (std::size_t i = 0; i < components; ++i) target.component[i] = row.pose[i];
    const kinematics::Solution inverse = machine.Inverse(target);
    ASSERT_TRUE(inverse.ok()) << "row " << k + 1 << ": " << inverse.message;
    VectorXd joints(static_cast<Eigen::Index>(row.joints.size()));
    for (std::size_t i = 0; i < row.joints.size(); ++i) {
      joints[static_cast<Eigen::Index>(i)] = row.joints[i];
      EXPECT_NEAR(inverse.drives[static_cast<Eigen::Index>(i)],
                  row.joints[i],
                  1e-9 * std::abs(row.joints[i]))
          << module << " row " << k + 1 << " joint " << i;
    }
    const kinematics::Solution forward = machine.Forward(joints);
    ASSERT_TRUE(forward.ok()) << "row " << k + 1 << ": " << forward.message;
    const kinematics::PoseNumbers numbers =
        kinematics::NumbersFromPose(forward.X_WT, layout::RotationOrder::kZYX);
    for (std::size_t i = 0; i < components; ++i) {
      EXPECT_NEAR(numbers.value[i], row.pose[i], 1e-9)
          << module << " row " << k + 1 << " component " << i;
    }
  }
}

TEST(LinuxCncVectors, GenhexkinsDrivesAndPosesComeBack) {
  CompareWith("genhexkins", "linuxcnc_genhexkins");
}
TEST(LinuxCncVectors, LineardeltakinsDrivesAndPosesComeBack) {
  CompareWith("lineardeltakins", "linuxcnc_lineardelta");
}
TEST(LinuxCncVectors, TripodkinsDrivesAndPosesComeBack) {
  CompareWith("tripodkins", "linuxcnc_tripod");
}

}  // namespace
}  // namespace kompono
