// SPDX-License-Identifier: Apache-2.0
#include "segments.hpp"

#include "shipped_machines.hpp"

#include <limits>

namespace kompono::analysis {
namespace {

using Eigen::Vector3d;

TEST(SegmentDistance, OfCrossingParallelAndDegenerateSegments) {
  const Vector3d o(0, 0, 0);
  const Vector3d x(1, 0, 0);
  EXPECT_DOUBLE_EQ(SegmentDistance(o, x, {0.5, -1, 2}, {0.5, 1, 2}), 2.0);
  EXPECT_DOUBLE_EQ(SegmentDistance(o, x, {0, 3, 0}, {1, 3, 0}), 3.0);
  EXPECT_DOUBLE_EQ(SegmentDistance(o, x, {4, 0, 0}, {2, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(SegmentDistance(o, o, {0, 0, 5}, {0, 0, 5}), 5.0);
  EXPECT_DOUBLE_EQ(SegmentDistance(o, o, {-1, 1, 0}, {1, 1, 0}), 1.0);
  EXPECT_DOUBLE_EQ(SegmentDistance(o, x, {2, 1, 0}, {2, 1, 0}), std::sqrt(2.0));
}

TEST(SegmentDistance, IsTheSmallestOfAllPairsOfPoints) {
  std::mt19937 random(tests::Seed());
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Vector3d, 4> p;
    for (Vector3d& point : p) point = {uniform(random), uniform(random), uniform(random)};
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i <= 200; ++i) {
      for (int j = 0; j <= 200; ++j) {
        const Vector3d a = p[0] + (p[1] - p[0]) * i / 200.0;
        const Vector3d b = p[2] + (p[3] - p[2]) * j / 200.0;
        least = std::min(least, (a - b).norm());
      }
    }
    const double distance = SegmentDistance(p[0], p[1], p[2], p[3]);
    EXPECT_LE(distance, least + 1e-12) << "seed " << tests::Seed();
    EXPECT_GE(distance, least - 0.01) << "seed " << tests::Seed();
  }
}

}  // namespace
}  // namespace kompono::analysis
