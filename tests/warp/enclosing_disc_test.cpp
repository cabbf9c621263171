// SPDX-License-Identifier: Apache-2.0
#include "warp/enclosing_disc.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/correspondences.h"

namespace talisman::warp {
namespace {

using tests::Random;

double farthest(const std::vector<dvec2>& points, dvec2 centre) {
  double most = 0;
  for (const dvec2& p : points) most = std::max(most, glm::length(p - centre));
  return most;
}

/// The slow oracle: the best of all discs over two points and of all circumscribed discs of three, each
/// measured against all points.
double radius_by_trying_all(const std::vector<dvec2>& points) {
  const int n = static_cast<int>(points.size());
  double best = farthest(points, points[0]);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) {
      best = std::min(best, farthest(points, 0.5 * (points[i] + points[j])));
      for (int k = 0; k < j; ++k) {
        const dvec2 b = points[j] - points[i], c = points[k] - points[i];
        const double d = 2 * (b.x * c.y - b.y * c.x);
        if (d == 0) continue;
        const double bb = glm::dot(b, b), cc = glm::dot(c, c);
        best = std::min(
            best, farthest(points, points[i] + dvec2{(c.y * bb - b.y * cc) / d, (b.x * cc - c.x * bb) / d}));
      }
    }
  return best;
}

void expect_exact(const std::vector<dvec2>& points, const char* what) {
  const EnclosingDisc disc = smallest_enclosing_disc(points);
  const double oracle = radius_by_trying_all(points);
  EXPECT_NEAR(disc.radius, oracle, 1e-12 * oracle) << what;
  EXPECT_LE(disc.lower, disc.radius) << what;
  EXPECT_LE(disc.lower, oracle * (1 + 1e-15)) << what;
  EXPECT_GE(disc.lower, disc.radius * (1 - 1e-12)) << what;
  EXPECT_NEAR(farthest(points, disc.centre), disc.radius, 1e-12 * disc.radius) << what;
}

TEST(SmallestEnclosingDisc, NoPointHasNoRadius) {
  const EnclosingDisc disc = smallest_enclosing_disc({});
  EXPECT_EQ(disc.radius, 0);
  EXPECT_EQ(disc.lower, 0);
  EXPECT_EQ(disc.centre, (dvec2{0, 0}));
}

TEST(SmallestEnclosingDisc, OnePointAndManyEqualPointsAreTheirOwnCentre) {
  for (int n : {1, 2, 50}) {
    const EnclosingDisc disc = smallest_enclosing_disc(std::vector<dvec2>(n, {3.25, -1e8}));
    EXPECT_EQ(disc.centre, (dvec2{3.25, -1e8}));
    EXPECT_EQ(disc.radius, 0);
    EXPECT_EQ(disc.lower, 0);
  }
}

TEST(SmallestEnclosingDisc, TwoPointsDecideAnObtuseTriangle) {
  const EnclosingDisc disc = smallest_enclosing_disc(std::vector<dvec2>{{0, 0}, {10, 0}, {4, 1}});
  EXPECT_DOUBLE_EQ(disc.radius, 5);
  EXPECT_DOUBLE_EQ(disc.centre.x, 5);
}

TEST(SmallestEnclosingDisc, ThreePointsDecideAnAcuteTriangle) {
  const double h = std::sqrt(3.0);
  const EnclosingDisc disc = smallest_enclosing_disc(std::vector<dvec2>{{-1, 0}, {1, 0}, {0, h}});
  EXPECT_NEAR(disc.radius, 2 / h, 1e-15);
  EXPECT_NEAR(disc.centre.y, 1 / h, 1e-15);
}

TEST(SmallestEnclosingDisc, RandomPointsAgreeWithTryingAll) {
  for (int seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    std::vector<dvec2> points(random.integer(1, 14));
    const double side = random.log_uniform(1e-6, 1e6);
    for (dvec2& p : points) p = random.in_square(side);
    SCOPED_TRACE(seed);
    expect_exact(points, "random");
  }
}

// Every point is on the boundary: rounding alone decides which ones do, and an active set may cycle.
TEST(SmallestEnclosingDisc, CocircularPointsEnd) {
  for (int n : {4, 7, 64, 1000}) {
    std::vector<dvec2> points;
    for (int i = 0; i < n; ++i) points.push_back({5 + 3 * std::cos(i * 1.7), 7 + 3 * std::sin(i * 1.7)});
    const EnclosingDisc disc = smallest_enclosing_disc(points);
    EXPECT_LE(disc.radius, 3 * (1 + 1e-12)) << n;
    EXPECT_GE(disc.lower, disc.radius * (1 - 1e-12)) << n;
  }
}

// Triangles whose area is rounding error have no circumscribed disc worth trusting.
TEST(SmallestEnclosingDisc, CollinearAndNearlyCollinearPoints) {
  for (double thickness : {0.0, 1e-3, 1e-8, 1e-12, 1e-15, 1e-16}) {
    Random random(11);
    std::vector<dvec2> points;
    for (int i = 0; i < 9; ++i) {
      const double t = random.uniform(-1, 1);
      points.push_back({100 * t + 30, 70 * t + thickness * random.uniform(-100, 100)});
    }
    expect_exact(points, std::to_string(thickness).c_str());
  }
}

TEST(SmallestEnclosingDisc, TwoTightClustersAndRepeatedPoints) {
  Random random(5);
  std::vector<dvec2> points;
  for (int i = 0; i < 10; ++i) points.push_back(dvec2{i < 5 ? 0.0 : 1e3, 0} + random.in_square(1e-9));
  expect_exact(points, "clusters");
  points.insert(points.end(), points.begin(), points.end());
  expect_exact(points, "clusters, each twice");
}

TEST(SmallestEnclosingDisc, MagnitudesFrom1EMinus300To1E100) {
  for (double scale : {1e-300, 1e-160, 1e-30, 1e30, 1e99}) {
    const EnclosingDisc disc =
        smallest_enclosing_disc(std::vector<dvec2>{{scale, 0}, {-scale, 0}, {0, 0.5 * scale}});
    EXPECT_NEAR(disc.radius / scale, 1, 1e-12) << scale;
    EXPECT_NEAR(disc.lower / scale, 1, 1e-12) << scale;
  }
}

// 1e8 from the origin the extent is known to 1e-8 px, and not worse.
TEST(SmallestEnclosingDisc, FarFromTheOriginNothingIsLost) {
  Random random(3);
  std::vector<dvec2> near, far;
  for (int i = 0; i < 20; ++i) {
    const dvec2 p{random.integer(0, 1 << 20) / 1024.0, random.integer(0, 1 << 20) / 1024.0};
    near.push_back(p);
    far.push_back(p + dvec2{1 << 27, -(1 << 27)});  // exact in double
  }
  EXPECT_EQ(smallest_enclosing_disc(near).radius, smallest_enclosing_disc(far).radius);
}

TEST(SmallestEnclosingDisc, TenThousandPointsTakeFewRounds) {
  Random random(8);
  std::vector<dvec2> points(10000);
  for (dvec2& p : points) p = random.in_square(512);
  const EnclosingDisc disc = smallest_enclosing_disc(points);
  EXPECT_LE(disc.iterations, 30);
  EXPECT_NEAR(farthest(points, disc.centre), disc.lower, 1e-9);
}

}  // namespace
}  // namespace talisman::warp
