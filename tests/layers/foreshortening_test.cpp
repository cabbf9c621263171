// SPDX-License-Identifier: Apache-2.0
#include "layers/foreshortening.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/layers/worlds.h"
#include "warp/fit.h"

namespace talisman::tests {
namespace {

using layers::Correspondences;
using layers::LayerState;

TEST(Bow, IsTheLargestDifferenceAlongAnEdge) {
  for (const double ratio : {1e-6, 0.2, 0.9, 1.0, 1.5, 40.0, 1e9}) {
    double largest = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i <= kSteps; ++i) {
      const double s = std::pow(i / static_cast<double>(kSteps), 4);  // dense where large ratios bow
      largest = std::max(largest, std::fabs(s * ratio / (1 + s * (ratio - 1)) - s));
    }
    const layers::Bow bow = layers::bow_of(ratio);
    EXPECT_NEAR(bow.share, largest, 1e-4) << ratio;
    EXPECT_NEAR(std::fabs(bow.at * ratio / (1 + bow.at * (ratio - 1)) - bow.at), bow.share, 1e-12) << ratio;
  }
}

TEST(Bow, ByHand) {
  // √4 = 2: a third of the way, where u = 4/3 / (1 + 1) = 2/3.
  EXPECT_DOUBLE_EQ(layers::bow_of(4).at, 1.0 / 3);
  EXPECT_DOUBLE_EQ(layers::bow_of(4).share, 1.0 / 3);
  EXPECT_EQ(layers::bow_of(1).share, 0);
  EXPECT_FALSE(layers::can_bow(1, 1, 1e9));
  EXPECT_TRUE(layers::can_bow(1, 4, 0.76));   // 0.253 px
  EXPECT_FALSE(layers::can_bow(1, 4, 0.74));  // 0.247 px
  for (const double no_depth : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_FALSE(layers::can_bow(no_depth, no_depth, 1000)) << no_depth;
}

/// The largest error of the best affine warp at the places that are matched, and over a fine grid of the plane.
struct Errors {
  double matched = 0, everywhere = 0;
  std::size_t places = 0;
};

dvec2 on_display(const dmat4& place, const LayerState& state, const dvec3& p) {
  return layers::screen_from_clip(
      layers::clip_from_world(state.camera, state.view.display_px) * place * dvec4(p, 1),
      state.view.display_px);
}

bool is_on_display(dvec2 p, const LayerState& state) {
  return p.x >= 0 && p.y >= 0 && p.x <= state.view.display_px.x && p.y <= state.view.display_px.y;
}

/// A level plane of these half sizes, seen from above its middle, carried from one place to another.
Errors errors_of_plane(double half_x, double half_z, const dmat4& then_place, const dmat4& now_place) {
  const World world(box_corners({half_x, 0, half_z}));
  const LayerState then = world.at(then_place), now = world.at(now_place);
  const Correspondences matched = correspond(then, now, world.bound.hull);
  const auto fitted = warp::fit(matched.then_px, matched.now_px, warp::Curve::aff);
  Errors errors{fitted.max_px, 0, matched.point.size()};
  constexpr int kCells = 100;
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j) {
      const dvec3 p(half_x * (2.0 * i / kCells - 1), 0, half_z * (2.0 * j / kCells - 1));
      if (!((then_place * dvec4(p, 1)).z < -0.2 && (now_place * dvec4(p, 1)).z < -0.2)) continue;
      const dvec2 from = on_display(then_place, then, p), to = on_display(now_place, now, p);
      if (!is_on_display(to, now)) continue;
      const dvec2 off = to - fitted.warp(from);
      errors.everywhere = std::max(errors.everywhere, std::hypot(off.x, off.y));
    }
  return errors;
}

TEST(BowedPlaces, OfAPlaneThatComesNearerAreWhereAnAffineWarpMissesMost) {
  // Wholly on the display: corners alone say much less than what is seen between them.
  const Errors errors = errors_of_plane(1, 3, moved_by({0, -1, -7}), moved_by({0, -1, -6}));
  EXPECT_GT(errors.everywhere, 5);
  EXPECT_LE(errors.everywhere, errors.matched + layers::kLeastBow_px);
}

TEST(BowedPlaces, OfAGroundThatReachesBeyondTheDisplay) {
  for (const double step : {0.02, 0.1, 0.4}) {
    const Errors errors = errors_of_plane(30, 40, moved_by({0, -1.5, -10}), moved_by({0, -1.5, -10 + step}));
    EXPECT_GT(errors.everywhere, 1) << step;
    EXPECT_LE(errors.everywhere, 1.05 * errors.matched + layers::kLeastBow_px) << step;
  }
}

TEST(BowedPlaces, AreNoneAtRestOrOfAnObjectThatGlidesPast) {
  EXPECT_EQ(errors_of_plane(1, 3, moved_by({0, -1, -7}), moved_by({0, -1, -7})).places, 8u);
  EXPECT_EQ(errors_of_plane(1, 3, moved_by({0, -1, -7}), moved_by({0.5, -1, -7})).places, 8u);
}

TEST(BowedPlaces, AreFewEvenOfManyTriangles) {
  std::mt19937 random(5);
  std::vector<dvec3> cloud;
  for (int i = 0; i < 60; ++i) cloud.push_back(uniform3(random, -1, 1));
  const World world(cloud, layers::BoundKind::Dop26);
  const auto matched =
      correspond(world.at(moved_by({0, 0, -5})), world.at(moved_by({0, 0, -4})), world.bound.hull);
  EXPECT_GT(matched.point.size(), world.bound.hull.points.size());
  EXPECT_LE(matched.point.size(), world.bound.hull.points.size() + layers::kMostBowedPlaces);
}

}  // namespace
}  // namespace talisman::tests
