// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/front.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::synthesis {
namespace {

using testing::ElementsAre;

struct Point {
  std::uint64_t id = 0;
  std::vector<double> values;
};

/// Whole numbers, so that many are equal.
std::vector<Point> RandomPoints(std::size_t count, std::size_t objectives, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> number(0, 12);
  std::vector<Point> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    points[i].id = i;
    for (std::size_t k = 0; k < objectives; ++k) points[i].values.push_back(number(random));
  }
  return points;
}

bool Dominates(const Point& a, const Point& b, const std::vector<Direction>& directions) {
  bool better = false;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const double sign = directions[k] == Direction::kMinimise ? 1.0 : -1.0;
    if (sign * a.values[k] > sign * b.values[k]) return false;
    better = better || sign * a.values[k] < sign * b.values[k];
  }
  return better;
}

std::vector<FrontPoint> ByPairs(const std::vector<Point>& points,
                                const std::vector<Direction>& directions) {
  std::vector<FrontPoint> front;
  for (const Point& point : points) {
    const bool dominated = std::any_of(points.begin(), points.end(), [&](const Point& other) {
      return Dominates(other, point, directions);
    });
    if (!dominated) front.push_back({point.id, point.values});
  }
  return front;
}

const std::vector<Direction> kDirections{
    Direction::kMinimise, Direction::kMaximise, Direction::kMinimise};

TEST(Front, IsWhatNoOtherPointDominates) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const std::vector<Point> points = RandomPoints(300, 3, seed);
    Front front(kDirections);
    for (const Point& point : points) front.Insert(point.id, point.values);
    EXPECT_EQ(front.Points(), ByPairs(points, kDirections)) << "seed " << seed;
  }
}

TEST(Front, DoesNotDependOnOrderOrShards) {
  std::vector<Point> points = RandomPoints(500, 3, 5);
  Front whole(kDirections);
  for (const Point& point : points) whole.Insert(point.id, point.values);
  std::mt19937 random(9);
  for (int trial = 0; trial < 5; ++trial) {
    std::shuffle(points.begin(), points.end(), random);
    std::vector<Front> shards(4, Front(kDirections));
    for (std::size_t i = 0; i < points.size(); ++i) {
      shards[i % 4].Insert(points[i].id, points[i].values);
    }
    Front merged(kDirections);
    for (const Front& shard : shards) merged.Merge(shard);
    merged.Merge(shards[0]);  // twice changes nothing
    EXPECT_EQ(merged.Points(), whole.Points());
    EXPECT_EQ(merged.Knee(), whole.Knee());
    EXPECT_EQ(merged.Extremes(), whole.Extremes());
    const std::vector<double> epsilon{2.0, 2.0, 2.0};
    EXPECT_EQ(merged.Thinned(epsilon), whole.Thinned(epsilon));
  }
}

TEST(Front, TakesNoValueThatIsNoNumber) {
  Front front({Direction::kMinimise, Direction::kMinimise});
  EXPECT_FALSE(front.Insert(1, std::vector<double>{NAN, 0.0}));
  EXPECT_FALSE(front.Insert(2, std::vector<double>{-HUGE_VAL, 0.0}));
  EXPECT_EQ(front.size(), 0U);
  EXPECT_FALSE(front.Knee());
  EXPECT_TRUE(front.Extremes().empty());
}

Front FourPoints() {
  Front front({Direction::kMinimise, Direction::kMinimise});
  front.Insert(1, std::vector<double>{0.0, 10.0});
  front.Insert(2, std::vector<double>{2.0, 3.0});
  front.Insert(3, std::vector<double>{5.0, 1.0});
  front.Insert(4, std::vector<double>{10.0, 0.0});
  return front;
}

TEST(Front, NamesExtremesAndKnee) {
  const Front front = FourPoints();
  const auto extremes = front.Extremes();
  ASSERT_EQ(extremes.size(), 2U);
  EXPECT_EQ(extremes[0].id, 1U);
  EXPECT_EQ(extremes[1].id, 4U);
  EXPECT_EQ(front.Knee()->id, 2U);
}

TEST(Front, TellsWhyAPointIsDominated) {
  const Front front = FourPoints();
  const auto why = front.WhyDominated(std::vector<double>{6.0, 4.0});
  ASSERT_TRUE(why);
  EXPECT_EQ(why->dominators, 2U);
  EXPECT_EQ(why->by.id, 2U);  // 4 and 1 better; point 3 is 1 and 3 better
  EXPECT_THAT(why->better_by, ElementsAre(4.0, 1.0));
  EXPECT_EQ(why->most, 0U);
  EXPECT_FALSE(front.WhyDominated(std::vector<double>{1.0, 4.0}));
  EXPECT_FALSE(front.WhyDominated(std::vector<double>{2.0, 3.0})) << "equal is not better";
}

TEST(Front, ThinsByBoxes) {
  const auto ids = [](const std::vector<FrontPoint>& points) {
    std::vector<std::uint64_t> list;
    for (const FrontPoint& point : points) list.push_back(point.id);
    return list;
  };
  const Front front = FourPoints();
  EXPECT_THAT(ids(front.Thinned(std::vector<double>{0.5, 0.5})), ElementsAre(1, 2, 3, 4));
  // Boxes (0,2) (0,0) (1,0) (2,0): the second dominates all others.
  EXPECT_THAT(ids(front.Thinned(std::vector<double>{5.0, 5.0})), ElementsAre(2));
}

}  // namespace
}  // namespace kompono::synthesis
