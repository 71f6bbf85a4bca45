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

/// Where the forward solution starts: at home, or where a control has the machine one cycle before.
enum class Start { kHome, kCycleBefore };

/// The machine of a row, all lengths multiplied by `scale`: the kinematics must not know the unit.
struct Scaled {
  const kinematics::Machine& machine;
  double scale = 1.0;

  [[nodiscard]] VectorXd Theta() const {
    VectorXd theta = machine.nominal();
    for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
      if (!machine.parameters()[i].angle) theta[static_cast<Eigen::Index>(i)] *= scale;
    }
    return theta;
  }
  [[nodiscard]] VectorXd Coordinates(const VectorXd& z) const {
    VectorXd scaled = z;
    for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
      if (!machine.coordinates()[i].rotary) scaled[static_cast<Eigen::Index>(i)] *= scale;
    }
    return scaled;
  }
};

void CompareRow(const Scaled& scaled, const Row& row, Start start, const std::string& where) {
  const kinematics::Machine& machine = scaled.machine;
  const VectorXd theta = scaled.Theta();
  const VectorXd home = scaled.Coordinates(machine.home());
  ASSERT_EQ(row.joints.size(), machine.drives().size());
  const std::size_t components = machine.coordinates().size() == 3 ? 3 : 6;
  std::array<double, 6> pose = row.pose;
  for (std::size_t i = 0; i < 3; ++i) pose[i] *= scaled.scale;
  kinematics::PoseTarget target{.order = layout::RotationOrder::kZYX};
  for (std::size_t i = 0; i < components; ++i) target.component[i] = pose[i];
  const kinematics::Solution inverse = machine.Inverse(target, theta, home);
  ASSERT_TRUE(inverse.ok()) << where << ": " << inverse.message;
  VectorXd joints(static_cast<Eigen::Index>(row.joints.size()));
  double size = 0.0;  // of the machine: what a pose near zero is measured against
  for (std::size_t i = 0; i < row.joints.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const bool rotary = machine.drives()[i].rotary;
    joints[k] = row.joints[i] * (rotary ? kRadPerDeg : scaled.scale);
    size = std::max(size, rotary ? scaled.scale : std::abs(joints[k]));
    EXPECT_NEAR(inverse.drives[k], joints[k], 1e-9 * std::abs(joints[k]))
        << where << " joint " << i;
  }
  VectorXd from = home;
  if (start == Start::kCycleBefore) {  // 0.1 mm and 1e-3 rad away in the machine's own unit
    from = inverse.coordinates + scaled.Coordinates(VectorXd::Constant(home.size(), 0.1));
    for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (machine.coordinates()[i].rotary) from[k] = inverse.coordinates[k] + 1e-3;
    }
  }
  const kinematics::Solution forward = machine.Forward(joints, theta, from);
  ASSERT_TRUE(forward.ok()) << where << ": " << forward.message;
  const kinematics::PoseNumbers numbers =
      kinematics::NumbersFromPose(forward.X_WT, layout::RotationOrder::kZYX);
  for (std::size_t i = 0; i < components; ++i) {
    EXPECT_NEAR(numbers.value[i], pose[i], 1e-9 * (i < 3 ? size : 1.0))
        << where << " component " << i;
  }
}

/// As given, and as the same machine would be written in metres and in inches.
void CompareWith(const std::string& module,
                 const std::string& machine_name,
                 Start start = Start::kHome) {
  const kinematics::Machine machine = tests::LoadMachine(machine_name);
  const std::vector<Row> rows = ReadVectors(module);
  ASSERT_EQ(rows.size(), 25U);
  for (const double scale : {1.0, 1e-3, 1.0 / 25.4, 1e3}) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      CompareRow({machine, scale},
                 rows[k],
                 start,
                 module + " row " + std::to_string(k + 1) + " scale " + std::to_string(scale));
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
// A type 2 singularity crosses the box that these rows were drawn from: rows 4 and 7 of the first
// table lie behind it, so that home's branch has other poses for their joints.
TEST(LinuxCncVectors, PentakinsDrivesAndPosesComeBack) {
  CompareWith("pentakins_default", "linuxcnc_pentakins_default", Start::kCycleBefore);
  CompareWith("pentakins_simconfig", "linuxcnc_pentakins_simconfig", Start::kHome);
}
TEST(LinuxCncVectors, RotarydeltakinsDrivesAndPosesComeBack) {
  CompareWith("rotarydeltakins", "linuxcnc_rotarydelta");
}

}  // namespace
}  // namespace kompono
