// SPDX-License-Identifier: Apache-2.0
#include "chunker/clip.h"

#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace talisman::chunker {
namespace {

using layers::dvec2;
using layers::dvec3;

const ClipRegion kRegion{0.1, {512, 384}};

dvec3 corner(double x, double y, double w) { return {x * w, y * w, w}; }

bool inside(const dvec3& p, double slack) {
  const double reach = (kGuardBandPx + slack) * p.z;
  return p.z >= kRegion.near_w - slack && std::abs(p.x - kRegion.center_px.x * p.z) <= reach &&
         std::abs(p.y - kRegion.center_px.y * p.z) <= reach;
}

TEST(ClipTriangle, InsideIsLeftWhole) {
  const std::array<dvec3, 3> corners{corner(0, 0, 1), corner(1000, 0, 5), corner(0, 700, 0.1)};
  const ClippedPolygon polygon = clip_triangle(corners, kRegion);
  ASSERT_EQ(polygon.count, 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(polygon.vertices[i].point, corners[i]);
}

TEST(ClipTriangle, BehindTheNearPlaneNothingIsLeft) {
  EXPECT_EQ(clip_triangle({dvec3(0, 0, 0.09), dvec3(9, 0, -5), dvec3(0, 7, 0)}, kRegion).count, 0);
}

// w = 0 has no place on the screen and w < 0 would be mirrored: one corner in front must give a triangle, two
// a quadrilateral.
TEST(ClipTriangle, CrossingTheNearPlaneKeepsTheFrontPart) {
  const std::array<dvec3, 3> one{corner(500, 300, 2), dvec3(10, 10, 0), dvec3(-50, 8, -3)};
  EXPECT_EQ(clip_triangle(one, kRegion).count, 3);
  const std::array<dvec3, 3> two{corner(500, 300, 2), corner(520, 300, 2), dvec3(-5, 8, -3)};
  EXPECT_EQ(clip_triangle(two, kRegion).count, 4);
}

// Random corners on both sides of every plane: what is left must lie inside, and its weights must name the
// same points.
TEST(ClipTriangle, PiecesLieInsideAndWeightsAreTheirs) {
  const unsigned seed = 2718;
  std::mt19937 random(seed);
  std::normal_distribution<double> wide(0, 1e5), depth(1, 3);
  int cut = 0;
  for (int n = 0; n < 20000; ++n) {
    std::array<dvec3, 3> corners;
    for (dvec3& c : corners) c = {wide(random), wide(random), depth(random)};
    const ClippedPolygon polygon = clip_triangle(corners, kRegion);
    cut += polygon.count > 3 ? 1 : 0;
    for (int i = 0; i < polygon.count; ++i) {
      const ClipVertex& v = polygon.vertices[i];
      ASSERT_TRUE(inside(v.point, 1e-6)) << "seed " << seed << " n " << n;
      const dvec3 again = corners[0] * v.weights.x + corners[1] * v.weights.y + corners[2] * v.weights.z;
      ASSERT_LT(glm::length(again - v.point), 1e-6 * (1 + glm::length(v.point)))
          << "seed " << seed << " n " << n;
      ASSERT_NEAR(v.weights.x + v.weights.y + v.weights.z, 1, 1e-9);
      for (int k = 0; k < 3; ++k) ASSERT_GE(v.weights[k], -1e-9);
    }
  }
  EXPECT_GT(cut, 1000);
}

// Neighbours see a shared edge in opposite directions; a crack opens unless both cut it at the same bits.
TEST(ClipTriangle, NeighboursCutTheirSharedEdgeAtTheSamePoint) {
  std::mt19937 random(161803);
  std::uniform_real_distribution<double> at(-3, 3);
  for (int n = 0; n < 2000; ++n) {
    const dvec3 a(at(random) * 100, at(random) * 100, 0.1 + std::abs(at(random)));
    const dvec3 b(at(random) * 100, at(random) * 100, -std::abs(at(random)));
    const dvec3 left(at(random) * 100, at(random) * 100, at(random)),
        right(at(random) * 100, at(random) * 100, at(random));
    const auto crossing = [&](const ClippedPolygon& p, int behind) {
      for (int i = 0; i < p.count; ++i)
        if (p.vertices[i].weights[behind] == 0 && p.vertices[i].point.z < kRegion.near_w + 1e-9)
          return p.vertices[i].point;
      return dvec3(0);
    };
    const dvec3 one = crossing(clip_triangle({a, b, left}, kRegion), 2);
    const dvec3 two = crossing(clip_triangle({b, a, right}, kRegion), 2);
    ASSERT_EQ(one, two) << n;
    ASSERT_NE(one, dvec3(0)) << n;
  }
}

// One triangle that contains the whole guard band, with corners far away: the largest polygon there can be.
TEST(ClipTriangle, HugeTriangleBecomesTheGuardBand) {
  const ClippedPolygon polygon =
      clip_triangle({corner(-1e7, -1e7, 1), corner(3e7, -1e7, 1), corner(-1e7, 3e7, 1)}, kRegion);
  ASSERT_GE(polygon.count, 4);
  double area = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const dvec3 &p = polygon.vertices[i].point, &q = polygon.vertices[(i + 1) % polygon.count].point;
    area += 0.5 * (p.x * q.y - q.x * p.y);
  }
  EXPECT_NEAR(area, 4 * kGuardBandPx * kGuardBandPx, 1);
}

TEST(ClipTriangle, DegenerateTrianglesDoNotBreak) {
  const dvec3 p = corner(100, 100, 1), behind(0, 0, -1);
  EXPECT_LE(clip_triangle({p, p, p}, kRegion).count, 8);
  EXPECT_EQ(clip_triangle({behind, behind, behind}, kRegion).count, 0);
  const ClippedPolygon polygon = clip_triangle({p, behind, p}, kRegion);
  for (int i = 0; i < polygon.count; ++i) EXPECT_TRUE(inside(polygon.vertices[i].point, 1e-9));
}

}  // namespace
}  // namespace talisman::chunker
