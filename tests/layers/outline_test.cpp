// SPDX-License-Identifier: Apache-2.0
// Outlines on the display: hulls, areas, what is left of them on one side of a line and in a rectangle.

#include <gtest/gtest.h>

#include "layers/outline.h"
#include "tests/layers/worlds.h"

namespace talisman::tests {
namespace {

TEST(ConvexHull, PointLineAndCollinearPoints) {
  EXPECT_TRUE(layers::convex_hull({}).empty());
  EXPECT_EQ(layers::convex_hull(std::vector<dvec2>{{1, 2}, {1, 2}}).size(), 1u);
  EXPECT_EQ(layers::convex_hull(std::vector<dvec2>{{0, 0}, {1, 1}, {2, 2}, {3, 3}}),
            (std::vector<dvec2>{{0, 0}, {3, 3}}));
}

TEST(ConvexHull, EveryPointIsInside) {
  std::mt19937 random(9);
  std::vector<dvec2> points;
  for (int i = 0; i < 200; ++i) points.push_back(dvec2(uniform3(random, -1, 1)));
  const auto hull = layers::convex_hull(points);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const dvec2 a = hull[i], b = hull[(i + 1) % hull.size()];
    for (const dvec2 p : points) EXPECT_GE((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x), -1e-12);
  }
}

TEST(AreaOf, PolygonsAndWhatIsNone) {
  EXPECT_EQ(layers::area_of({}), 0);
  EXPECT_EQ(layers::area_of({{1, 2}}), 0);
  EXPECT_EQ(layers::area_of({{1, 2}, {5, 9}}), 0);
  EXPECT_EQ(layers::area_of({{0, 0}, {4, 0}, {4, 3}}), 6);
  EXPECT_EQ(layers::area_of({{0, 0}, {0, 3}, {4, 3}, {4, 0}}), 12) << "whichever way round";
}

TEST(ClipToHalfPlane, KeepsTheSideOfTheNormal) {
  const layers::Polygon2 square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_EQ(layers::area_of(layers::clip_to_half_plane(square, {1, 0}, 1)), 12);
  EXPECT_EQ(layers::area_of(layers::clip_to_half_plane(square, {1, 1}, 4)), 8);
  EXPECT_EQ(layers::clip_to_half_plane(square, {0, -1}, 0.5).size(), 0u);
  EXPECT_EQ(layers::clip_to_half_plane(square, {0, 1}, -3), square);
}

TEST(ClipToRect, PointLineAndTriangle) {
  const layers::RectD rect{{0, 0}, {10, 10}};
  EXPECT_EQ(layers::clip_to_rect({{5, 5}}, rect).size(), 1u);
  EXPECT_TRUE(layers::clip_to_rect({{11, 5}}, rect).empty());
  layers::RectD line, triangle;
  for (const dvec2 p : layers::clip_to_rect({{-5, 5}, {15, 5}}, rect)) line.include(p);
  EXPECT_EQ(line, (layers::RectD{{0, 5}, {10, 5}}));
  for (const dvec2 p : layers::clip_to_rect({{5, 5}, {25, 5}, {5, 25}}, rect)) triangle.include(p);
  EXPECT_EQ(triangle, (layers::RectD{{5, 5}, {10, 10}}));
  EXPECT_TRUE(layers::clip_to_rect({{-4, 2}, {-5, 3}, {2, -3}}, rect).empty());
}

}  // namespace
}  // namespace talisman::tests
