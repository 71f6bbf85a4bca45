// SPDX-License-Identifier: Apache-2.0
// The laws every mechanism obeys: loops close, forward undoes inverse, packs and jets agree with
// plain numbers.
#include "shipped_machines.hpp"

#include <set>

#include <Eigen/QR>

namespace kompono {
namespace {

using kinematics::Machine;
using kinematics::VectorXd;
using plugin::Quantity;
using plugin::Status;

VectorXd LocalOf(const Machine::BlockView& view, const VectorXd& z) {
  VectorXd x(static_cast<Eigen::Index>(view.coordinates.size()));
  for (std::size_t i = 0; i < view.coordinates.size(); ++i) {
    x[static_cast<Eigen::Index>(i)] = view.block->letters[i].sign * z[view.coordinates[i]];
  }
  return x;
}

class MechanismLaws : public testing::TestWithParam<std::string> {
 protected:
  MechanismLaws()
      : machine_(tests::LoadMachine(GetParam())),
        random_(tests::Seed()),
        theta_(machine_.nominal()) {
    poses_ = tests::PosesOf(machine_, 25, &random_);
  }
  [[nodiscard]] std::string Where(const tests::NamedPose& pose) const {
    std::ostringstream text;
    text << GetParam() << ", " << pose.kind << " z = " << pose.z.transpose() << ", seed "
         << tests::Seed();
    return text.str();
  }
  /// More coordinates than motions of the tool: a head and a platform that both move along Z.
  [[nodiscard]] bool IsRedundant(const VectorXd& z) const {
    kinematics::PoseDerivatives at;
    static_cast<void>(machine_.ToolPose(z, theta_, &at));
    Eigen::MatrixXd J = at.by_coordinates;
    J.bottomRows<3>() *= 100.0;  // mm for a radian
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J);
    qr.setThreshold(1e-9);
    return qr.rank() < z.size();
  }
  [[nodiscard]] std::span<const double> Parameters(const Machine::BlockView& view) const {
    return {theta_.data() + view.first_parameter,
            static_cast<std::size_t>(view.code->Shape().parameters)};
  }

  Machine machine_;
  std::mt19937 random_;
  VectorXd theta_;
  std::vector<tests::NamedPose> poses_;
};

TEST_P(MechanismLaws, HomeIsReachableAndRegular) {
  VectorXd readings;
  VectorXd reach;
  machine_.DrivesOf(machine_.home(), theta_, &readings, &reach);
  EXPECT_TRUE(readings.allFinite()) << readings.transpose();
  for (const kinematics::Singularity& s : machine_.Singularities(machine_.home(), theta_)) {
    EXPECT_EQ(s.type, 0) << s.block << " margin " << s.margin;
  }
}

TEST_P(MechanismLaws, LoopsCloseOnTheDrivesOfAPose) {
  for (const tests::NamedPose& pose : poses_) {
    for (const Machine::BlockView& view : machine_.blocks()) {
      const plugin::MechanismShape shape = view.code->Shape();
      const VectorXd x = LocalOf(view, pose.z);
      std::vector<double> q(static_cast<std::size_t>(shape.drives));
      std::vector<double> g(static_cast<std::size_t>(shape.closures));
      const std::span<const double> xs(x.data(), static_cast<std::size_t>(x.size()));
      ASSERT_EQ(view.code->Evaluate(
                    Quantity::kDrives, {xs, {}, Parameters(view), view.modes}, {.values = q}),
                Status::kOk);
      ASSERT_EQ(view.code->Evaluate(
                    Quantity::kClosure, {xs, q, Parameters(view), view.modes}, {.values = g}),
                Status::kOk);
      double size = 1.0;
      for (const double number : q) size = std::max(size, std::abs(number));
      for (const double number : Parameters(view)) size = std::max(size, std::abs(number));
      for (const double residual : g)
        EXPECT_LE(std::abs(residual), 1e-13 * size * size) << Where(pose);
    }
  }
}

TEST_P(MechanismLaws, ForwardUndoesInverse) {
  int refused = 0;
  for (const tests::NamedPose& pose : poses_) {
    VectorXd readings;
    machine_.DrivesOf(pose.z, theta_, &readings);
    const kinematics::Solution back = machine_.Forward(readings);
    // Far from home, where the struts run out, the way from home may be barred: refusing is fair.
    // Pentapods also have poses near a singularity in the middle of their zone.
    if (!back.ok() && pose.kind != "near a limit") {
      EXPECT_LE(++refused, 2) << Where(pose) << ": " << back.message;
    }
    const double size = std::max(1.0, readings.cwiseAbs().maxCoeff());
    double margin = 1.0;
    for (const auto& s : machine_.Singularities(pose.z, theta_))
      margin = std::min(margin, s.margin_a);
    const double tolerance = 1e-12 * size / margin;
    if (back.ok()) {
      VectorXd again;
      machine_.DrivesOf(back.coordinates, theta_, &again);
      EXPECT_LE((again - readings).cwiseAbs().maxCoeff(), 1e-9 * size) << Where(pose);
      if ((back.coordinates - pose.z).cwiseAbs().maxCoeff() <= tolerance) continue;
      // Two poses with the same drives and no singularity between home and either: home cannot tell
      // them apart (pentapods have such), so the answer is fair.
      EXPECT_TRUE(tests::OnHomesBranch(machine_, back.coordinates)) << Where(pose);
    }
    // A start near the pose decides in both cases.
    const VectorXd near = pose.z + 1e-3 * (machine_.home() - pose.z);
    const kinematics::Solution there = machine_.Forward(readings, theta_, near);
    ASSERT_TRUE(there.ok()) << Where(pose) << ": " << there.message;
    EXPECT_LE((there.coordinates - pose.z).cwiseAbs().maxCoeff(), tolerance) << Where(pose);
  }
}

TEST_P(MechanismLaws, InverseOfTheToolPoseGivesTheCoordinatesBack) {
  for (const tests::NamedPose& pose : poses_) {
    const kinematics::PoseNumbers numbers =
        kinematics::NumbersFromPose(machine_.ToolPose(pose.z, theta_), layout::RotationOrder::kXYZ);
    kinematics::PoseTarget target;
    for (std::size_t k = 0; k < 6; ++k) target.component[k] = numbers.value[k];
    const kinematics::Solution solved = machine_.Inverse(target);
    ASSERT_TRUE(solved.ok()) << Where(pose) << ": " << solved.message;
    if (IsRedundant(pose.z)) {  // other coordinates may give the same pose
      const Pose<double> wanted = machine_.ToolPose(pose.z, theta_);
      EXPECT_LE((solved.X_WT.p - wanted.p).norm(), 1e-8) << Where(pose);
      EXPECT_LE((solved.X_WT.R - wanted.R).norm(), 1e-9) << Where(pose);
      continue;
    }
    EXPECT_LE((solved.coordinates - pose.z).cwiseAbs().maxCoeff(), 1e-9) << Where(pose);
  }
}

/// The same machine with all lengths multiplied, as if it were written in metres, inches or
/// microns.
struct Resized {
  const Machine& machine;
  double factor = 1.0;

  [[nodiscard]] VectorXd Theta() const {
    VectorXd theta = machine.nominal();
    for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
      if (!machine.parameters()[i].angle) theta[static_cast<Eigen::Index>(i)] *= factor;
    }
    return theta;
  }
  template <class Named>
  [[nodiscard]] VectorXd Of(const VectorXd& numbers, const std::vector<Named>& names) const {
    VectorXd out = numbers;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!names[i].rotary) out[static_cast<Eigen::Index>(i)] *= factor;
    }
    return out;
  }
};

TEST_P(MechanismLaws, TheUnitOfLengthDoesNotMatter) {
  const bool limited = std::any_of(machine_.coordinates().begin(),
                                   machine_.coordinates().end(),
                                   [](const auto& c) { return c.lower || c.upper; });
  for (const double factor : {1e-3, 1.0 / 25.4, 1e3}) {
    const Resized resized{machine_, factor};
    const VectorXd theta = resized.Theta();
    const VectorXd home = resized.Of(machine_.home(), machine_.coordinates());
    for (const tests::NamedPose& pose : poses_) {
      if (pose.kind == "near a limit") continue;  // rounding decides there
      VectorXd readings;
      machine_.DrivesOf(pose.z, theta_, &readings);
      const VectorXd wanted = resized.Of(readings, machine_.drives());
      VectorXd found;
      machine_.DrivesOf(resized.Of(pose.z, machine_.coordinates()), theta, &found);
      const double size = std::max(readings.cwiseAbs().maxCoeff(), theta_.cwiseAbs().maxCoeff());
      for (Eigen::Index i = 0; i < found.size(); ++i) {
        const bool rotary = machine_.drives()[static_cast<std::size_t>(i)].rotary;
        ASSERT_NEAR(found[i], wanted[i], 1e-12 * (rotary ? 1.0 : factor * size)) << Where(pose);
      }
      const kinematics::Solution plain = machine_.Forward(readings);
      const kinematics::Solution solved = machine_.Forward(wanted, theta, home);
      if (!plain.ok()) {  // too near to a singularity, whatever the unit
        EXPECT_TRUE(limited || solved.status == plain.status) << factor << ' ' << Where(pose);
        continue;
      }
      // The limits stay the layout's own and do not grow with the machine: they may bar the way.
      if (limited && !solved.ok()) continue;
      ASSERT_TRUE(solved.ok()) << factor << ' ' << Where(pose) << ": " << solved.message;
      const VectorXd same = resized.Of(plain.coordinates, machine_.coordinates());
      for (Eigen::Index i = 0; i < same.size(); ++i) {
        const bool rotary = machine_.coordinates()[static_cast<std::size_t>(i)].rotary;
        EXPECT_NEAR(solved.coordinates[i], same[i], 1e-9 * (rotary ? 1.0 : factor * size))
            << factor << ' ' << Where(pose);
      }
    }
  }
}

TEST_P(MechanismLaws, BoundToItsGeometryAMechanismSaysTheSame) {
  for (const Machine::BlockView& view : machine_.blocks()) {
    const plugin::MechanismShape shape = view.code->Shape();
    const auto bound =
        tests::ShippedRegistry().CreateBound(view.block->module, Parameters(view), view.modes);
    if (!bound) {
      EXPECT_EQ(bound.error().code, "E0209");
      continue;
    }
    for (const tests::NamedPose& pose : poses_) {
      const VectorXd local = LocalOf(view, pose.z);
      const std::vector<double> x(local.begin(), local.end());
      std::vector<double> q(static_cast<std::size_t>(shape.drives));
      std::vector<double> bound_q = q;
      ASSERT_EQ(view.code->Evaluate(
                    Quantity::kDrives, {x, {}, Parameters(view), view.modes}, {.values = q}),
                Status::kOk);
      ASSERT_EQ((*bound)->Drives(x, bound_q), Status::kOk);
      std::vector<double> back(x.size());
      std::vector<double> bound_back = back;
      const Status status = view.code->Evaluate(
          Quantity::kCoordinates, {{}, q, Parameters(view), view.modes}, {.values = back});
      ASSERT_EQ((*bound)->Coordinates(q, bound_back), status);
      for (std::size_t i = 0; i < q.size(); ++i) {
        EXPECT_NEAR(q[i], bound_q[i], 1e-12 * (1.0 + std::abs(q[i]))) << Where(pose);
      }
      for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(back[i], bound_back[i], 1e-9) << Where(pose);
      }
      EXPECT_EQ((*bound)->Drives(std::span(x).first(x.size() - 1), bound_q), Status::kBadSize);
    }
  }
}

TEST(Bound, IsOfferedWhereAClosedFormIsWorthPreparing) {
  for (const char* module : {"pyramid", "pyramid_by_angle", "tripod", "rotary_delta"}) {
    const auto none = tests::ShippedRegistry().CreateBound(module, {}, {});
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("could not take 0 parameters"), std::string::npos)
        << none.error().message;
  }
  EXPECT_FALSE(tests::ShippedRegistry().CreateBound("hexapod", {}, {}));
}

TEST_P(MechanismLaws, PacksAgreeWithSinglePoses) {
  for (const Machine::BlockView& view : machine_.blocks()) {
    const plugin::MechanismShape shape = view.code->Shape();
    const std::size_t count = poses_.size();
    std::vector<std::vector<double>> x(view.coordinates.size(), std::vector<double>(count));
    std::vector<std::vector<double>> q(static_cast<std::size_t>(shape.drives),
                                       std::vector<double>(count));
    for (std::size_t k = 0; k < count; ++k) {
      const VectorXd local = LocalOf(view, poses_[k].z);
      for (std::size_t i = 0; i < x.size(); ++i) x[i][k] = local[static_cast<Eigen::Index>(i)];
    }
    std::vector<const double*> x_columns;
    std::vector<double*> q_columns;
    for (auto& column : x) x_columns.push_back(column.data());
    for (auto& column : q) q_columns.push_back(column.data());
    ASSERT_EQ(view.code->EvaluateBatch(Quantity::kDrives,
                                       {.count = count,
                                        .coordinates = x_columns.data(),
                                        .parameters = Parameters(view),
                                        .modes = view.modes,
                                        .values = q_columns.data()}),
              Status::kOk);
    for (std::size_t k = 0; k < count; ++k) {
      const VectorXd local = LocalOf(view, poses_[k].z);
      std::vector<double> single(static_cast<std::size_t>(shape.drives));
      ASSERT_EQ(view.code->Evaluate(Quantity::kDrives,
                                    {{local.data(), static_cast<std::size_t>(local.size())},
                                     {},
                                     Parameters(view),
                                     view.modes},
                                    {.values = single}),
                Status::kOk);
      // Near a limit a root of nearly nothing magnifies the rounding of what stands under it.
      const double size = std::max(1.0, theta_.cwiseAbs().maxCoeff());
      for (std::size_t i = 0; i < single.size(); ++i) {
        EXPECT_NEAR(q[i][k], single[i], 1e-13 * std::max(size, std::abs(single[i])))
            << Where(poses_[k]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         MechanismLaws,
                         testing::ValuesIn(tests::ShippedMachineFiles()),
                         [](const auto& instance) { return instance.param; });

TEST(ShippedMachines, UseEveryRegisteredMechanism) {
  std::set<std::string> used;
  for (const std::string& name : tests::ShippedMachineFiles()) {
    const Machine machine = tests::LoadMachine(name);
    for (const Machine::BlockView& view : machine.blocks()) used.insert(view.block->module);
  }
  for (const std::string& id : tests::ShippedRegistry().ModuleIds(plugin::ModuleKind::kMechanism)) {
    EXPECT_TRUE(used.count(id) == 1)
        << id << " has no machine in layouts/machines, so no law was tested on it";
  }
}

}  // namespace
}  // namespace kompono
