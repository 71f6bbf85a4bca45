// SPDX-License-Identifier: Apache-2.0
// Automatic derivatives of every mechanism against central differences, and of the machine's whole
// chain.
#include "shipped_machines.hpp"

namespace kompono {
namespace {

using kinematics::Machine;
using kinematics::MatrixXd;
using kinematics::VectorXd;
using plugin::Quantity;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of J against central differences of f; `scale` is what an error is measured against.
template <class F>
testing::AssertionResult JacobianMatches(
    const F& f, const VectorXd& at, const MatrixXd& J, double step, double tolerance) {
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    VectorXd up = at;
    VectorXd down = at;
    up[j] += step;
    down[j] -= step;
    const VectorXd difference = (f(up) - f(down)) / (2.0 * step);
    for (Eigen::Index i = 0; i < difference.size(); ++i) {
      const double scale = std::max({1.0, std::abs(J(i, j)), J.row(i).cwiseAbs().maxCoeff()});
      if (!(std::abs(difference[i] - J(i, j)) <= tolerance * scale)) {
        return testing::AssertionFailure() << "entry (" << i << ", " << j << "): automatic "
                                           << J(i, j) << ", central difference " << difference[i];
      }
    }
  }
  return testing::AssertionSuccess();
}

class Jacobians : public testing::TestWithParam<std::string> {
 protected:
  Jacobians()
      : machine_(tests::LoadMachine(GetParam())),
        random_(tests::Seed()),
        theta_(machine_.nominal()) {
    for (tests::NamedPose& pose : tests::PosesOf(machine_, 6, &random_)) {
      if (pose.kind != "near a limit")
        poses_.push_back(std::move(pose));  // differences would step over the edge
    }
  }
  Machine machine_;
  std::mt19937 random_;
  VectorXd theta_;
  std::vector<tests::NamedPose> poses_;
};

struct Inputs {
  VectorXd x, q, theta;
};

VectorXd Value(const Machine::BlockView& view,
               Quantity quantity,
               const Inputs& at,
               std::size_t rows) {
  VectorXd out(static_cast<Eigen::Index>(rows));
  const auto view_of = [](const VectorXd& v) {
    return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
  };
  EXPECT_EQ(view.code->Evaluate(quantity,
                                {view_of(at.x), view_of(at.q), view_of(at.theta), view.modes},
                                {.values = {out.data(), rows}}),
            plugin::Status::kOk);
  return out;
}

void CheckQuantity(const Machine::BlockView& view,
                   Quantity quantity,
                   std::size_t rows,
                   const Inputs& at) {
  const auto n = static_cast<Eigen::Index>(rows);
  VectorXd values(n);
  RowMajor by_x(n, at.x.size());
  RowMajor by_q(n, at.q.size());
  RowMajor by_theta(n, at.theta.size());
  const auto view_of = [](auto& m) {
    return std::span(m.data(), static_cast<std::size_t>(m.size()));
  };
  ASSERT_EQ(view.code->Evaluate(quantity,
                                {view_of(at.x), view_of(at.q), view_of(at.theta), view.modes},
                                {view_of(values), view_of(by_x), view_of(by_q), view_of(by_theta)}),
            plugin::Status::kOk);
  const VectorXd plain = Value(view, quantity, at, rows);
  const double size = std::max({1.0, at.q.cwiseAbs().maxCoeff(), at.theta.cwiseAbs().maxCoeff()});
  // Closures and margins are differences of squares: what rounding is measured against.
  const bool squared = quantity == Quantity::kClosure || quantity == Quantity::kReach;
  EXPECT_LE((values - plain).cwiseAbs().maxCoeff(), 1e-14 * (squared ? size * size : size))
      << "the values that come with derivatives are the plain values";
  constexpr double kStep = 1e-5;
  constexpr double kTolerance = 2e-6;
  const auto of_x = [&](const VectorXd& x) {
    return Value(view, quantity, {x, at.q, at.theta}, rows);
  };
  const auto of_q = [&](const VectorXd& q) {
    return Value(view, quantity, {at.x, q, at.theta}, rows);
  };
  const auto of_theta = [&](const VectorXd& t) {
    return Value(view, quantity, {at.x, at.q, t}, rows);
  };
  EXPECT_TRUE(JacobianMatches(of_x, at.x, by_x, kStep, kTolerance));
  EXPECT_TRUE(JacobianMatches(of_q, at.q, by_q, kStep, kTolerance));
  EXPECT_TRUE(JacobianMatches(of_theta, at.theta, by_theta, kStep, kTolerance));
}

TEST_P(Jacobians, OfEveryQuantityMatchDifferences) {
  for (const tests::NamedPose& pose : poses_) {
    for (const Machine::BlockView& view : machine_.blocks()) {
      SCOPED_TRACE(GetParam() + ", " + pose.kind + ", seed " + std::to_string(tests::Seed()));
      const plugin::MechanismShape shape = view.code->Shape();
      Inputs at{VectorXd(shape.coordinates),
                VectorXd(),
                theta_.segment(view.first_parameter, shape.parameters)};
      for (std::size_t i = 0; i < view.coordinates.size(); ++i) {
        at.x[static_cast<Eigen::Index>(i)] =
            view.block->letters[i].sign * pose.z[view.coordinates[i]];
      }
      at.q = VectorXd::Zero(shape.drives);
      at.q = Value(view, Quantity::kDrives, at, static_cast<std::size_t>(shape.drives));
      ASSERT_TRUE(at.q.allFinite());
      CheckQuantity(view, Quantity::kPlatform, 12, at);
      CheckQuantity(view, Quantity::kDrives, static_cast<std::size_t>(shape.drives), at);
      CheckQuantity(view, Quantity::kReach, static_cast<std::size_t>(shape.drives), at);
      CheckQuantity(view, Quantity::kClosure, static_cast<std::size_t>(shape.closures), at);
      CheckQuantity(view, Quantity::kSkeleton, 3 * static_cast<std::size_t>(shape.points), at);
    }
  }
}

TEST_P(Jacobians, OfTheClosureByCoordinatesAloneAreThoseThatComeWithTheOthers) {
  for (const tests::NamedPose& pose : poses_) {
    for (const Machine::BlockView& view : machine_.blocks()) {
      const plugin::MechanismShape shape = view.code->Shape();
      VectorXd x(shape.coordinates);
      for (std::size_t i = 0; i < view.coordinates.size(); ++i) {
        x[static_cast<Eigen::Index>(i)] = view.block->letters[i].sign * pose.z[view.coordinates[i]];
      }
      const VectorXd theta = theta_.segment(view.first_parameter, shape.parameters);
      Inputs at{x, VectorXd::Zero(shape.drives), theta};
      at.q = Value(view, Quantity::kDrives, at, static_cast<std::size_t>(shape.drives));
      const auto span = [](auto& m) {
        return std::span(m.data(), static_cast<std::size_t>(m.size()));
      };
      const plugin::MechanismState state{span(at.x), span(at.q), span(at.theta), view.modes};
      VectorXd values(shape.closures);
      RowMajor alone(shape.closures, shape.coordinates);
      RowMajor with_others(shape.closures, shape.coordinates);
      RowMajor by_q(shape.closures, shape.drives);
      ASSERT_EQ(view.code->Evaluate(Quantity::kClosure, state, {span(values), span(alone), {}, {}}),
                plugin::Status::kOk);
      ASSERT_EQ(view.code->Evaluate(
                    Quantity::kClosure, state, {span(values), span(with_others), span(by_q), {}}),
                plugin::Status::kOk);
      EXPECT_LE((alone - with_others).cwiseAbs().maxCoeff(),
                1e-12 * with_others.cwiseAbs().maxCoeff())
          << GetParam() << ", " << pose.kind << ", seed " << tests::Seed();
    }
  }
}

/// Twist of the pose from a to b, tool point velocity first, for a small step.
VectorXd Twist(const Pose<double>& a, const Pose<double>& b) {
  const Matrix3<double> W = b.R * a.R.transpose();
  VectorXd twist(6);
  twist << b.p - a.p,
      0.5 * Vector3<double>(W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1));
  return twist;
}

TEST_P(Jacobians, OfTheToolPoseMatchDifferences) {
  for (const tests::NamedPose& pose : poses_) {
    kinematics::PoseDerivatives derivatives;
    const Pose<double> X = machine_.ToolPose(pose.z, theta_, &derivatives);
    const auto of_z = [&](const VectorXd& z) { return Twist(X, machine_.ToolPose(z, theta_)); };
    const auto of_theta = [&](const VectorXd& t) { return Twist(X, machine_.ToolPose(pose.z, t)); };
    EXPECT_TRUE(JacobianMatches(of_z, pose.z, derivatives.by_coordinates, 1e-5, 1e-6))
        << GetParam();
    EXPECT_TRUE(JacobianMatches(of_theta, theta_, derivatives.by_parameters, 1e-5, 1e-6))
        << GetParam();
  }
}

TEST_P(Jacobians, OfTheMeasuredPoseMatchDifferences) {
  for (const tests::NamedPose& pose : poses_) {
    VectorXd readings;
    machine_.DrivesOf(pose.z, theta_, &readings);
    const kinematics::MeasuredPose measured = machine_.Measure(readings, theta_, pose.z);
    ASSERT_EQ(measured.status, kinematics::SolveStatus::kConverged);
    double margin = 1.0;
    for (const auto& s : machine_.Singularities(pose.z, theta_))
      margin = std::min(margin, s.margin_a);
    const auto of_readings = [&](const VectorXd& r) {
      return Twist(measured.X_WT, machine_.Measure(r, theta_, pose.z, false).X_WT);
    };
    const auto of_theta = [&](const VectorXd& t) {
      return Twist(measured.X_WT, machine_.Measure(readings, t, pose.z, false).X_WT);
    };
    const double tolerance = 1e-5 / (margin * margin);
    EXPECT_TRUE(JacobianMatches(of_readings, readings, measured.by_readings, 1e-5, tolerance))
        << GetParam();
    EXPECT_TRUE(JacobianMatches(of_theta, theta_, measured.by_parameters, 1e-5, tolerance))
        << GetParam();
  }
}

TEST_P(Jacobians, OfTheDrivesByTheCoordinatesMatchDifferences) {
  for (const tests::NamedPose& pose : poses_) {
    VectorXd readings;
    MatrixXd J;
    machine_.DrivesOf(pose.z, theta_, &readings, nullptr, &J);
    const auto of_z = [&](const VectorXd& z) {
      VectorXd out;
      machine_.DrivesOf(z, theta_, &out);
      return out;
    };
    EXPECT_TRUE(JacobianMatches(of_z, pose.z, J, 1e-5, 2e-6)) << GetParam();
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         Jacobians,
                         testing::ValuesIn(tests::ShippedMachineFiles()),
                         [](const auto& instance) { return instance.param; });

TEST(JacobianMatches, NoticesAWrongSign) {
  const auto f = [](const VectorXd& x) { return VectorXd(x.cwiseProduct(x)); };
  const VectorXd at = VectorXd::LinSpaced(3, 1.0, 3.0);
  MatrixXd J = (2.0 * at).asDiagonal();
  EXPECT_TRUE(JacobianMatches(f, at, J, 1e-5, 1e-8));
  J(1, 1) *= -1.0;
  EXPECT_FALSE(JacobianMatches(f, at, J, 1e-5, 1e-8)) << "the checker must notice a wrong sign";
}

}  // namespace
}  // namespace kompono
