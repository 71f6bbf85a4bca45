// SPDX-License-Identifier: Apache-2.0
// Every shipped unit, every station and state: a rigid pose whose derivatives by the parameters are
// those of central differences.
#include "shipped_machines.hpp"
#include "unit_bench.hpp"

#include <gtest/gtest.h>

namespace kompono::tests {
namespace {

using Table = Eigen::Matrix<double, 12, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<std::string> Units() {
  return ShippedRegistry().ModuleIds(plugin::ModuleKind::kUnit);
}

class EveryUnit : public testing::TestWithParam<std::string> {
 protected:
  /// Its numbers a little off the defaults, so that no derivative vanishes by symmetry.
  [[nodiscard]] std::vector<double> Numbers() const {
    std::vector<double> out = bench_.parameters();
    for (const auto& parameter : bench_.description().parameters) {
      if (parameter.name == bench_.description().counted_by) continue;
      for (int i = 0; i < parameter.Numbers(); ++i)
        out[static_cast<std::size_t>(parameter.offset) + static_cast<std::size_t>(i)] +=
            (parameter.angle() ? 0.05 : 0.7) * (1.0 + 0.3 * i);
    }
    return out;
  }
  UnitBench bench_{GetParam()};
};

TEST_P(EveryUnit, GivesRigidPoses) {
  const std::vector<double> numbers = Numbers();
  for (int station = 0; station < static_cast<int>(bench_.description().stations.size());
       ++station) {
    for (int state = 0; state < bench_.description().states; ++state) {
      const Eigen::VectorXd rows = bench_.Rows(station, state, numbers);
      const auto X = Pose<double>::Read({rows.data(), 12});
      EXPECT_LT((X.R * X.R.transpose() - Matrix3<double>::Identity()).norm(), 1e-13);
      EXPECT_NEAR(X.R.determinant(), 1.0, 1e-13) << station << " " << state;
    }
  }
}

TEST_P(EveryUnit, IsDifferentiatedRight) {
  const std::vector<double> numbers = Numbers();
  const auto& description = bench_.description();
  for (int station = 0; station < static_cast<int>(description.stations.size()); ++station) {
    const int state = station % description.states;
    Table table;
    static_cast<void>(bench_.Rows(station, state, numbers, &table));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto* counter = description.FindParameter(description.counted_by);
      if (counter != nullptr && static_cast<int>(i) == counter->offset) continue;  // a whole number
      constexpr double kStep = 1e-5;
      std::vector<double> up = numbers;
      std::vector<double> down = numbers;
      up[i] += kStep;
      down[i] -= kStep;
      const Eigen::VectorXd slope =
          (bench_.Rows(station, state, up) - bench_.Rows(station, state, down)) / (2.0 * kStep);
      const double error = (slope - table.col(static_cast<Eigen::Index>(i))).cwiseAbs().maxCoeff();
      EXPECT_LT(error, 1e-7 * (1.0 + slope.cwiseAbs().maxCoeff()))
          << GetParam() << " station " << station << " parameter " << i;
    }
  }
}

TEST_P(EveryUnit, SaysWhatItIsFor) {
  EXPECT_FALSE(bench_.description().capabilities.empty());
  EXPECT_FALSE(bench_.description().summary.empty());
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryUnit, testing::ValuesIn(Units()), [](const auto& unit) {
  return unit.param;
});

}  // namespace
}  // namespace kompono::tests
