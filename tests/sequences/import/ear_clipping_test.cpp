// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/ear_clipping.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace talisman::sequences {

namespace {

using glm::dvec3;
using Polygon = std::vector<dvec3>;

dvec3 area_of(const dvec3& a, const dvec3& b, const dvec3& c) { return 0.5 * glm::cross(b - a, c - a); }

/// Sum of the sizes of the triangles. Each must have the direction of the polygon's normal.
double area_of_triangles(const Polygon& polygon, const dvec3& normal) {
  double sum = 0;
  for (const auto& [a, b, c] : triangulated(polygon)) {
    const dvec3 area = area_of(polygon[static_cast<std::size_t>(a)], polygon[static_cast<std::size_t>(b)],
                               polygon[static_cast<std::size_t>(c)]);
    EXPECT_GT(glm::dot(area, normal), 0);
    sum += glm::length(area);
  }
  return sum;
}

Polygon in_xy(std::initializer_list<std::pair<double, double>> corners) {
  Polygon polygon;
  for (const auto& [x, y] : corners) polygon.emplace_back(x, y, 0);
  return polygon;
}

/// Tilted and moved; the normal goes along.
Polygon tilted(const Polygon& polygon, dvec3& normal) {
  const dvec3 x = glm::normalize(dvec3(1, 2, 0.5)), z = glm::normalize(glm::cross(x, dvec3(0, 1, 3)));
  Polygon moved;
  for (const dvec3& p : polygon) moved.push_back(p.x * x + p.y * glm::cross(z, x) + dvec3(10, -20, 30));
  normal = z;
  return moved;
}

void expect_area(const Polygon& polygon, double area, std::size_t most_triangles) {
  dvec3 normal;
  const Polygon moved = tilted(polygon, normal);
  EXPECT_NEAR(area_of_triangles(polygon, {0, 0, 1}), area, 1e-9 * area);
  EXPECT_NEAR(area_of_triangles(moved, normal), area, 1e-9 * area);
  EXPECT_LE(triangulated(polygon).size(), most_triangles);
  Polygon backwards(polygon.rbegin(), polygon.rend());
  EXPECT_NEAR(area_of_triangles(backwards, {0, 0, -1}), area, 1e-9 * area);
}

TEST(EarClipping, ConcaveQuadrilateralIsCutThroughItsInwardCorner) {
  expect_area(in_xy({{0, 0}, {4, -1}, {3.5, 0}, {4, 1}}), 3.5, 2);  // the shorter diagonal lies outside
}

TEST(EarClipping, SquareIsTwoTrianglesAlongTheShorterDiagonal) {
  const Polygon kite = in_xy({{0, -1}, {3, 0}, {0, 1}, {-3, 0}});
  const auto triangles = triangulated(kite);
  ASSERT_EQ(triangles.size(), 2u);
  for (const auto& triangle : triangles) {
    EXPECT_NE(std::find(triangle.begin(), triangle.end(), 0), triangle.end());
    EXPECT_NE(std::find(triangle.begin(), triangle.end(), 2), triangle.end());
  }
}

TEST(EarClipping, OutlineThatRunsAroundAHoleLeavesItOpen) {
  // A square of 4 with a hole of 2, whose seam goes from one corner to one of the hole.
  expect_area(in_xy({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}), 12, 8);
}

TEST(EarClipping, TwoHolesAndASeamThatIsStraightWithAnEdge) {
  expect_area(in_xy({{0, 0},
                     {9, 0},
                     {9, 3},
                     {5, 3},
                     {5, 2},
                     {8, 2},
                     {8, 1},
                     {5, 1},
                     {5, 2},
                     {5, 3},
                     {0, 3},
                     {0, 2},
                     {3, 2},
                     {3, 1},
                     {1, 1},
                     {1, 2},
                     {0, 2}}),
              27 - 3 - 2, 15);
}

TEST(EarClipping, CornersInALineAndTwiceAtOnePlace) {
  expect_area(in_xy({{0, 0}, {1, 0}, {2, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}), 4, 6);
  EXPECT_TRUE(triangulated(in_xy({{0, 0}, {1, 0}, {2, 0}, {3, 0}})).empty());
  EXPECT_TRUE(triangulated(in_xy({{1, 1}, {1, 1}, {1, 1}, {1, 1}})).empty());
  EXPECT_TRUE(triangulated(in_xy({{0, 0}, {1, 0}})).empty());
}

TEST(EarClipping, OutlineLikeAnEightIsCoveredInEachPlane) {
  for (int axis = 0; axis < 3; ++axis) {
    Polygon eight;
    for (const dvec3& p : in_xy({{0, 0}, {2, 2}, {2, 0}, {0, 2}})) {
      dvec3 turned;
      for (int k = 0; k < 3; ++k) turned[(k + axis) % 3] = p[k];
      eight.push_back(turned);
    }
    EXPECT_EQ(triangulated(eight).size(), 2u);
  }
}

TEST(EarClipping, StarsByLotSumToTheirArea) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> radius(0.05, 1);
  for (int n = 4; n < 300; ++n) {
    Polygon star;
    double area = 0;
    for (int k = 0; k < n; ++k) {
      const double a = 2 * M_PI * k / n, r = radius(random);
      star.emplace_back(r * std::cos(a), r * std::sin(a), 0);
    }
    for (std::size_t k = 0; k < star.size(); ++k)
      area += area_of(dvec3(0), star[k], star[(k + 1) % star.size()]).z;
    SCOPED_TRACE(n);
    expect_area(star, area, static_cast<std::size_t>(n - 2));
    EXPECT_EQ(triangulated(star).size(), static_cast<std::size_t>(n - 2));
  }
}

}  // namespace

}  // namespace talisman::sequences
