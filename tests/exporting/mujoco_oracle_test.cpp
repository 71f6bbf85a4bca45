// SPDX-License-Identifier: Apache-2.0
// MuJoCo as an oracle that knows nothing of our equations: it gets bodies and joints, its drives
// are locked where our inverse kinematics puts them, Newton's method closes its own loops on its
// own constraint residuals, and its platform must stand where ours does.
#include "shipped_machines.hpp"
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include <Eigen/QR>

#include "kompono/exporting/mjcf.hpp"

namespace kompono {
namespace {

using kinematics::Machine;
using kinematics::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// How many poses: 2000 in all were asked for when the models were new; fewer do for every day.
int PoseCount() {
  const char* const given = std::getenv("KOMPONO_ORACLE_POSES");
  return given != nullptr ? std::atoi(given) : 100;
}

class Oracle {
 public:
  Oracle(const Machine& machine, const Machine::BlockView& view) : view_(view) {
    const Parsed<std::string> text = exporting::Mjcf(machine, machine.nominal());
    if (!text) throw std::runtime_error(RenderAll(text.error(), {}));
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("kompono_oracle_" + std::to_string(getpid()) + ".xml");
    std::ofstream(file) << *text;
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML(file.c_str(), nullptr, error.data(), error.size()));
    std::filesystem::remove(file);
    if (!model_) throw std::runtime_error(error.data());
    model_->opt.jacobian = mjJAC_DENSE;
    data_.reset(mj_makeData(model_.get()));
    for (const plugin::DriveDescription& drive : view.description->drives) {
      drives_.push_back(
          mj_name2id(model_.get(), mjOBJ_JOINT, (view.block->name + "." + drive.name).c_str()));
      EXPECT_GE(drives_.back(), 0) << drive.name;
    }
    platform_ = mj_name2id(model_.get(), mjOBJ_BODY, (view.block->name + ".platform").c_str());
    for (int i = 0; i < model_->nv; ++i) {
      const bool drive = std::any_of(drives_.begin(), drives_.end(), [&](int joint) {
        return model_->jnt_dofadr[joint] == i;
      });
      if (!drive) free_.push_back(i);
    }
  }

  void GoHome() { mj_resetData(model_.get(), data_.get()); }

  /// Locks the drives and closes the loops; returns what is left open, mm.
  double Close(const std::vector<double>& q) {
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      data_->qpos[model_->jnt_qposadr[drives_[k]]] = q[k];
    }
    double open = INFINITY;
    for (int step = 0; step < 40; ++step) {
      mj_fwdPosition(model_.get(), data_.get());
      const Eigen::Map<const VectorXd> residual(data_->efc_pos, data_->ne);
      const double now = residual.cwiseAbs().maxCoeff();
      if (now < 1e-12 || (now < 1e-9 && now > 0.5 * open)) return now;
      open = now;
      const Eigen::Map<const RowMajor> J(data_->efc_J, data_->ne, model_->nv);
      Eigen::MatrixXd J_free(J.rows(), static_cast<Eigen::Index>(free_.size()));
      for (std::size_t i = 0; i < free_.size(); ++i) {
        J_free.col(static_cast<Eigen::Index>(i)) = J.col(free_[i]);
      }
      const VectorXd step_free = J_free.completeOrthogonalDecomposition().solve(-residual);
      VectorXd velocity = VectorXd::Zero(model_->nv);
      for (std::size_t i = 0; i < free_.size(); ++i) {
        velocity[free_[i]] = step_free[static_cast<Eigen::Index>(i)];
      }
      mj_integratePos(model_.get(), data_->qpos, velocity.data(), 1.0);
    }
    return open;
  }

  [[nodiscard]] Pose<double> Platform() const {
    Pose<double> X;
    X.p = Eigen::Map<const Vector3<double>>(data_->xpos + std::ptrdiff_t{3} * platform_);
    X.R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
        data_->xmat + std::ptrdiff_t{9} * platform_);
    return X;
  }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  Machine::BlockView view_;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  std::vector<int> drives_, free_;
  int platform_ = -1;
};

class MuJoCo : public testing::TestWithParam<std::string> {};

TEST_P(MuJoCo, PutsThePlatformWhereWeDo) {
  const Machine machine = tests::LoadMachine(GetParam());
  const Machine::BlockView view = machine.blocks().at(0);
  const VectorXd theta = machine.nominal();
  const plugin::MechanismShape shape = view.code->Shape();
  const std::span<const double> parameters(theta.data() + view.first_parameter,
                                           static_cast<std::size_t>(shape.parameters));
  Oracle oracle(machine, view);
  std::mt19937 random(tests::Seed());
  double worst_mm = 0.0;
  double worst_rad = 0.0;
  int count = 0;
  for (const tests::NamedPose& pose : tests::PosesOf(machine, PoseCount(), &random)) {
    // Where a leg is stretched out, the oracle's Newton has nothing to stand on.
    if (pose.kind == "near a limit") continue;
    oracle.GoHome();
    std::vector<double> x(view.coordinates.size());
    double open = 0.0;
    constexpr int kParts = 50;  // so that the oracle stays on home's assembly mode
    for (int part = 1; part <= kParts; ++part) {
      const VectorXd z = machine.home() + (pose.z - machine.home()) * part / kParts;
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = view.block->letters[i].sign * z[view.coordinates[i]];
      }
      std::vector<double> q(static_cast<std::size_t>(shape.drives));
      ASSERT_EQ(view.code->Evaluate(
                    plugin::Quantity::kDrives, {x, {}, parameters, view.modes}, {.values = q}),
                plugin::Status::kOk);
      open = oracle.Close(q);
    }
    std::array<double, 12> rows{};
    ASSERT_EQ(view.code->Evaluate(
                  plugin::Quantity::kPlatform, {x, {}, parameters, view.modes}, {.values = rows}),
              plugin::Status::kOk);
    const Pose<double> ours = Pose<double>::Read(std::span<const double>(rows));
    const Pose<double> theirs = oracle.Platform();
    const double moved = (ours.p - theirs.p).norm();
    const double turned = (ours.R - theirs.R).norm() / std::sqrt(2.0);
    EXPECT_LE(moved, 1e-9) << pose.kind << " z = " << pose.z.transpose() << ", loops open by "
                           << open << " mm, seed " << tests::Seed();
    EXPECT_LE(turned, 1e-9) << pose.kind << " z = " << pose.z.transpose() << ", seed "
                            << tests::Seed();
    worst_mm = std::max(worst_mm, moved);
    worst_rad = std::max(worst_rad, turned);
    ++count;
  }
  EXPECT_GE(count, PoseCount());
  std::printf("%d poses, worst difference %.1e mm, %.1e rad\n", count, worst_mm, worst_rad);
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         MuJoCo,
                         testing::Values("hexapod_reference",
                                         "hexapod_symmetric",
                                         "hexaglide_mill",
                                         "kdd_four_strut_lathe",
                                         "kdd_six_strut_lathe",
                                         "ksm_pyramid",
                                         "linuxcnc_genhexkins",
                                         "linuxcnc_lineardelta",
                                         "linuxcnc_pentakins_default",
                                         "linuxcnc_pentakins_simconfig",
                                         "linuxcnc_rotarydelta",
                                         "linuxcnc_tripod",
                                         "pyramid_by_angle",
                                         "triglide",
                                         "tripod_3rps",
                                         "tripod_guided",
                                         "v100_lathe"),
                         [](const auto& instance) { return instance.param; });

TEST(Mjcf, RefusesAStrutThatBranchesAndNothingElseOfWhatShips) {
  for (const std::string& name : tests::ShippedMachineFiles()) {
    const Machine machine = tests::LoadMachine(name);
    const auto text = exporting::Mjcf(machine, machine.nominal());
    const bool branches = name == "so_waterjet_lambda";  // link 2 meets link 1 between its ends
    ASSERT_EQ(text.has_value(), !branches) << name;
    if (!branches) continue;
    EXPECT_EQ(text.error()[0].code, "E0712");
    EXPECT_EQ(text.error()[0].message,
              "'drive' (lambda) cannot be written as bodies and joints: nothing is known to carry "
              "its point 'joint'");
  }
}

}  // namespace
}  // namespace kompono
