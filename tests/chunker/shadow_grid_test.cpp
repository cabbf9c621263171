// SPDX-License-Identifier: Apache-2.0
// The texels of a directional shadow map rest in the world, whatever moves.
#include <cmath>

#include <glm/geometric.hpp>

#include "chunker/shadow_view.h"
#include "tests/chunker/shade_support.h"

namespace talisman::chunker::tests {
namespace {

layers::ShadowMapOptions sharp(int resolution_px) {
  layers::ShadowMapOptions options;
  options.resolution_px = resolution_px;
  options.pcf_radius = 0;
  return options;
}

/// The sun's map of the scene with its cube (and ball) at x.
struct Moved {
  Moved(double cube_x, double ball_x, const layers::ShadowMapOptions& options) {
    shaded.scene.nodes[ShadeScene::kCube].local.translation.x = cube_x;
    shaded.scene.nodes[ShadeScene::kBall].local.translation.x = ball_x;
    const std::vector<int> casters{ShadeScene::kCube, ShadeScene::kBall};
    map = make_shadow_map(shaded.scene.at(0), ShadeScene::kSun, casters, options);
  }
  const Rows34& grid() const { return map.faces()[0].map_from_world; }
  double texel_m() const { return 1 / glm::length(dvec3(grid().row[0])); }
  ShadeScene shaded;
  ShadowMap map;
};

double off_whole(double v) { return std::abs(v - std::round(v)); }

// The casters move by far less than a texel, by many texels, and apart: the world's origin stays at a corner
// of a texel.
TEST(ShadowGrid, IsFixedInTheWorld) {
  const Moved rest(-0.4, 0.9, sharp(128));
  for (const double shift : {1e-7, 0.001, 0.0123, 0.1, 1.0, 17.3, 1234.5}) {
    const Moved together(-0.4 + shift, 0.9 + shift, sharp(128));
    EXPECT_EQ(together.texel_m(), rest.texel_m()) << shift;
    const dvec3 origin = together.grid()(dvec3(0));
    EXPECT_EQ(off_whole(origin.x), 0) << shift;
    EXPECT_EQ(off_whole(origin.y), 0) << shift;
    EXPECT_LT(off_whole(origin.z / together.texel_m()), 1e-9) << shift;
  }
}

/// Where the cube's shadow ends on the floor, towards +x, by bisection.
double shadow_edge(const ShadowMap& map, double dark_x, double lit_x) {
  EXPECT_EQ(map.visibility({dark_x, 0, 0}), 0);
  EXPECT_EQ(map.visibility({lit_x, 0, 0}), 1);
  while (lit_x - dark_x > 1e-9) {
    const double middle = (dark_x + lit_x) / 2;
    (map.visibility({middle, 0, 0}) < 0.5f ? dark_x : lit_x) = middle;
  }
  return dark_x;
}

// A caster that creeps by a tenth of a texel per frame: the edge of its shadow goes on by whole texels, never
// back, and on average as fast as the caster.
TEST(ShadowGrid, EdgeOfWhatMovesGoesByWholeTexels) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSun].direction = {0, -1, 0};
  const std::vector<int> cube{ShadeScene::kCube};
  const double start = -0.4;
  double texel = 0, first = 0, last = 0;
  int steps = 0;
  constexpr int kFrames = 200;
  for (int frame = 0; frame <= kFrames; ++frame) {
    const double x = start + frame * 0.1 * texel;
    shaded.scene.nodes[ShadeScene::kCube].local.translation.x = x;
    const ShadowMap map = make_shadow_map(shaded.scene.at(0), ShadeScene::kSun, cube, sharp(100));
    const double edge = shadow_edge(map, x, x + 0.8);
    if (frame == 0) {
      texel = 1 / glm::length(dvec3(map.faces()[0].map_from_world.row[0]));
      first = last = edge;
    }
    const double moved = (edge - last) / texel;
    ASSERT_LT(off_whole((edge - first) / texel), 1e-5) << frame;
    ASSERT_TRUE(moved > -1e-5 && moved < 1 + 1e-5) << frame << ": " << moved;
    steps += moved > 0.5 ? 1 : 0;
    last = edge;
  }
  EXPECT_NEAR(steps, kFrames / 10, 1);
}

// The ball flies away from the cube: the shadow of the cube, which rests, does not change by a bit, unless
// the map grows by a step; of those there are few. A map that is fitted to the casters changes in every
// frame.
TEST(ShadowGrid, ShadowOfWhatRestsRests) {
  const auto shadow_of_cube = [](const Moved& moved) {
    std::vector<float> values;
    for (double x = -1.2; x < 0.9; x += 0.013)
      for (double z = -1; z < 0.6; z += 0.017) values.push_back(moved.map.visibility({x, 0.01, z}));
    return values;
  };
  Moved before(-0.4, 3, sharp(128));
  std::vector<float> values = shadow_of_cube(before);
  EXPECT_GT(std::count(values.begin(), values.end(), 0.0f), 500);
  int grown = 0;
  for (int frame = 1; frame <= 40; ++frame) {
    Moved now(-0.4, 3 + frame * 0.037, sharp(128));
    const std::vector<float> next = shadow_of_cube(now);
    if (now.texel_m() == before.texel_m())
      EXPECT_EQ(next, values) << frame;
    else
      ++grown;
    EXPECT_GE(now.texel_m(), before.texel_m());
    before = std::move(now);
    values = next;
  }
  EXPECT_GT(grown, 0);  // or nothing was tested beyond one step
  EXPECT_LE(grown, 5);
}

// The same from a lamp in a place, whose one map looks at both: the ball creeps away, and the shadow of the cube
// changes only where the direction or the width of the view passes a step.
TEST(ShadowGrid, ShadowOfWhatRestsRestsUnderALampToo) {
  const auto map_at = [](double ball_x) {
    ShadeScene shaded;
    shaded.scene.nodes[ShadeScene::kBall].local.translation.x = ball_x;
    layers::SceneFrame frame = shaded.scene.at(0);
    layers::LightState& lamp = frame.lights[ShadeScene::kSpot];
    lamp.kind = layers::Light::Kind::Point;
    lamp.position = {0.3, 6, 0.2};
    const std::vector<int> casters{ShadeScene::kCube, ShadeScene::kBall};
    return make_shadow_map(frame, ShadeScene::kSpot, casters, sharp(128));
  };
  const auto shadow_of_cube = [](const ShadowMap& map) {
    std::vector<float> values;
    for (double x = -1.2; x < 0.4; x += 0.013)
      for (double z = -1; z < 0.6; z += 0.017) values.push_back(map.visibility({x, 0.01, z}));
    return values;
  };
  ShadowMap before = map_at(1.5);
  ASSERT_EQ(before.faces().size(), 1u);
  std::vector<float> values = shadow_of_cube(before);
  EXPECT_GT(std::count(values.begin(), values.end(), 0.0f), 500);
  int changed = 0;
  for (int frame = 1; frame <= 40; ++frame) {
    const ShadowMap now = map_at(1.5 + frame * 0.01);
    const std::vector<float> next = shadow_of_cube(now);
    changed += next != values;
    values = next;
  }
  EXPECT_LE(changed, 4);
}

// What fits is shown, in no more than a step of texels too many, at every size of the scene and of the map.
TEST(OrthographicView, ShowsTheCastersWithLittleToSpare) {
  const LightAxes axes = axes_along(glm::normalize(dvec3(0.3, -1, 0.2)));
  for (const int resolution : {2, 3, 33, 128, 1024})
    for (double side = 1e-6; side < 1e7; side *= 1.37) {
      const dvec3 lo = dvec3(12.345, -6.7, 3) * side, hi = lo + dvec3(side, side * 0.8, side * 2);
      const auto face = orthographic_view(sharp(resolution), axes, lo, hi);
      ASSERT_TRUE(face);
      const double first_x = -face->view.sprite_from_world.row[0].w, t = face->texel_m;
      EXPECT_GE(lo.x / t - first_x, -1e-6) << side << " " << resolution;
      EXPECT_LE(hi.x / t - first_x, resolution + 1e-6) << side << " " << resolution;
      EXPECT_GE((hi.x - lo.x) / t, 0.87 * (resolution > 4 ? resolution - 2 : resolution / 2.0) - 1e-6);
    }
}

// All casters are before the lamp and inside its map, at every size, whatever the rounding of the direction.
TEST(SteadyDirection, IsNearAndOfUnitLength) {
  for (double tan_half = 1e-6; tan_half < 2.75; tan_half *= 1.7)
    for (const dvec3& d : {dvec3(1, 0, 0), dvec3(0.577, 0.577, -0.577), dvec3(-0.1, -0.99, 0.05)}) {
      const dvec3 forward = glm::normalize(d), steady = steady_direction(forward, tan_half);
      EXPECT_NEAR(glm::length(steady), 1, 1e-12);
      // Half a step in each of three coordinates, a step being an eighth of at most 1.13 of the width.
      EXPECT_LE(glm::distance(steady, forward), 1.13 / 8 * std::sqrt(3.0) * std::max(tan_half, 1e-4))
          << tan_half;
    }
}

TEST(OrthographicView, NothingToShowOrNotFiniteIsNoView) {
  const LightAxes axes = axes_along({0, -1, 0});
  for (const dvec3& hi :
       {dvec3(0), dvec3(0, 0, 9), dvec3(HUGE_VAL, 1, 1), dvec3(std::nan(""), 1, 1), dvec3(1e-320, 1e-320, 0)})
    EXPECT_FALSE(orthographic_view(sharp(64), axes, dvec3(0), hi)) << hi.x;
}

}  // namespace
}  // namespace talisman::chunker::tests
