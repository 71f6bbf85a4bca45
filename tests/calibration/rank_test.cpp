// SPDX-License-Identifier: Apache-2.0
// Rank, null space and covariance of Jacobians whose answer is known.
#include "identifiability.hpp"

#include <random>

#include <Eigen/QR>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::calibration {
namespace {

/// rows x columns of rank `rank`, columns of sizes between 1e-3 and 1e3.
Eigen::MatrixXd RandomOfRank(Eigen::Index rows,
                             Eigen::Index columns,
                             Eigen::Index rank,
                             unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](Eigen::Index m, Eigen::Index n) {
    return Eigen::MatrixXd::NullaryExpr(m, n, [&](Eigen::Index) { return normal(random); }).eval();
  };
  Eigen::VectorXd size(columns);
  for (double& s : size) s = std::pow(10.0, 1.5 * normal(random));
  return draw(rows, rank) * draw(rank, columns) * size.asDiagonal();
}

TEST(AnalyzeRank, FindsTheRankWhateverTheColumnsSizes) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Eigen::Index rank = 1 + seed % 9;
    const Eigen::MatrixXd J = RandomOfRank(30, 9, rank, seed);
    for (const double threshold : {1e-13, 1e-9, 1e-5}) {
      const RankAnalysis analysis = AnalyzeRank(J, std::vector<bool>(9, false), threshold);
      EXPECT_EQ(analysis.rank, rank);
      EXPECT_EQ(analysis.gauge.cols(), 9 - rank);
    }
  }
}

TEST(AnalyzeRank, NullSpaceIsOrthonormalAndHasNoEffect) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Eigen::MatrixXd J = RandomOfRank(30, 9, 6, seed);
    const RankAnalysis analysis = AnalyzeRank(J, std::vector<bool>(9, false), 1e-9);
    ASSERT_EQ(analysis.gauge.cols(), 3);
    EXPECT_LT((J * analysis.gauge).norm(), 1e-10 * J.norm());
    EXPECT_TRUE(
        (analysis.gauge.transpose() * analysis.gauge).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
  }
}

TEST(AnalyzeRank, CovarianceIsThePseudoInverse) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    // Columns of like size: the reference, which knows no scaling, needs that.
    Eigen::MatrixXd J = RandomOfRank(30, 6, 6, seed).colwise().normalized();
    J.col(5) = 2.0 * J.col(0) - J.col(3);
    const RankAnalysis analysis = AnalyzeRank(J, std::vector<bool>(6, false), 1e-9);
    ASSERT_EQ(analysis.rank, 5);
    const Eigen::MatrixXd expected =
        (J.transpose() * J).completeOrthogonalDecomposition().pseudoInverse();
    EXPECT_LT((analysis.covariance - expected).norm(), 1e-7 * expected.norm());
    EXPECT_LT((analysis.covariance * analysis.gauge).norm(), 1e-9 * expected.norm());
  }
}

TEST(AnalyzeRank, ColumnsWithoutEffectAreNullDirectionsOfTheirOwn) {
  Eigen::MatrixXd J = RandomOfRank(20, 4, 4, 1);
  J.col(2) *= 1e-20;
  const RankAnalysis analysis = AnalyzeRank(J, std::vector<bool>(4, false), 1e-9);
  ASSERT_EQ(analysis.gauge.cols(), 1);
  EXPECT_NEAR(std::abs(analysis.gauge(2, 0)), 1.0, 1e-12);
}

TEST(AnalyzeRank, HeldUnknownsTakeNoPart) {
  Eigen::MatrixXd J = RandomOfRank(20, 4, 4, 2);
  J.col(1) = J.col(3);
  const RankAnalysis analysis = AnalyzeRank(J, {false, false, false, true}, 1e-9);
  EXPECT_EQ(analysis.rank, 3);
  EXPECT_EQ(analysis.gauge.cols(), 0);
  EXPECT_EQ(analysis.covariance.row(3).norm(), 0.0);
  EXPECT_GT(analysis.covariance(1, 1), 0.0);
}

TEST(AnalyzeRank, FewerRowsThanUnknownsLeaveANullSpace) {
  const RankAnalysis analysis =
      AnalyzeRank(RandomOfRank(3, 5, 3, 3), std::vector<bool>(5, false), 1e-9);
  EXPECT_EQ(analysis.rank, 3);
  EXPECT_EQ(analysis.gauge.cols(), 2);
}

}  // namespace
}  // namespace kompono::calibration
