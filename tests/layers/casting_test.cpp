// SPDX-License-Identifier: Apache-2.0
#include "layers/casting.h"

#include <cmath>

#include <gtest/gtest.h>

#include "layers/layer.h"
#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

using layers::CastingTile;
using layers::Light;
using layers::LightState;
using layers::may_cast;

/// A box with its own axes: the oracle knows it by slabs, the tested code by its corners.
struct TurnedBox {
  dmat4 world_from_box{1.0};
  dvec3 half{1.0};

  std::vector<dvec3> corners() const {
    std::vector<dvec3> world;
    for (const dvec3& p : box_corners(half)) world.emplace_back(world_from_box * dvec4(p, 1));
    return world;
  }
  dvec3 inside(std::mt19937& random) const {
    return dvec3(world_from_box * dvec4(half * uniform3(random, -1, 1), 1));
  }
  /// Does the segment from → from + way meet the box?
  bool is_hit(const dvec3& from, const dvec3& way) const {
    const dmat4 box_from_world = glm::inverse(world_from_box);
    const dvec3 p(box_from_world * dvec4(from, 1)), d(box_from_world * dvec4(way, 0));
    double t0 = 0, t1 = 1;
    for (int k = 0; k < 3; ++k) {
      const double a = (-half[k] - p[k]) / d[k], b = (half[k] - p[k]) / d[k];
      t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
    }
    return t0 <= t1;
  }
};

TurnedBox random_box(std::mt19937& random) {
  return {moved_by(uniform3(random, -4, 4)) * random_rotation(random), uniform3(random, 0.2, 2)};
}

LightState random_light(std::mt19937& random, unsigned trial) {
  LightState light = sun(uniform3(random, -1, 1) + dvec3(1e-3));
  if (trial % 3 == 0) return light;
  light = lamp(uniform3(random, -8, 8));
  if (trial % 3 == 1) {
    if (trial % 2) light.range_m = uniform(random, 2, 8);
    return light;
  }
  light.kind = Light::Kind::Spot;
  light.direction = glm::normalize(uniform3(random, -1, 1) - 0.2 * light.position);
  light.outer_cone_rad = uniform(random, 0.1, 1.1);
  return light;
}

bool lights(const LightState& light, const dvec3& place) {
  if (light.kind == Light::Kind::Directional) return true;
  const dvec3 way = place - light.position;
  if (light.range_m > 0 && glm::length(way) > light.range_m) return false;
  return light.kind != Light::Kind::Spot ||
         glm::dot(way, light.direction) >= std::cos(light.outer_cone_rad) * glm::length(way);
}

/// By rays from places in the receiver to the light: is any of them stopped by the caster?
bool casts_by_rays(const LightState& light, const TurnedBox& caster, const TurnedBox& receiver,
                   std::mt19937& random, int rays) {
  for (int k = 0; k < rays; ++k) {
    const dvec3 place = receiver.inside(random);
    const dvec3 way =
        light.kind == Light::Kind::Directional ? -100.0 * light.direction : light.position - place;
    if (lights(light, place) && caster.is_hit(place, way)) return true;
  }
  return false;
}

TEST(MayCast, MissesNoCasterAndFewPhantomsByAHundredThousandRays) {
  constexpr int kPairs = 400, kRays = 250;
  int casting = 0, phantoms = 0;
  for (unsigned trial = 0; trial < kPairs; ++trial) {
    SCOPED_TRACE("seed " + std::to_string(trial));
    std::mt19937 random(trial);
    const TurnedBox caster = random_box(random), receiver = random_box(random);
    const LightState light = random_light(random, trial);
    const bool by_rays = casts_by_rays(light, caster, receiver, random, kRays);
    const bool said = may_cast(light, caster.corners(), receiver.corners());
    EXPECT_TRUE(said || !by_rays);
    casting += by_rays;
    // What few rays do not find many may: only that is a phantom.
    phantoms += said && !by_rays && !casts_by_rays(light, caster, receiver, random, 40 * kRays);
  }
  EXPECT_GT(casting, kPairs / 20);
  EXPECT_LE(phantoms, kPairs / 20);
  RecordProperty("phantoms", phantoms);
}

TEST(MayCast, GroundBelowABallDoesNotButTheBallDoes) {
  const std::vector<dvec3> ground = box_corners({10, 0, 10});
  std::vector<dvec3> ball;
  for (const dvec3& p : box_corners(dvec3(0.5))) ball.push_back(p + dvec3(0, 2, 0));
  for (const LightState& light : {sun({0.3, -1, 0.2}), lamp({1, 6, 2})}) {
    EXPECT_FALSE(may_cast(light, ground, ball));
    EXPECT_TRUE(may_cast(light, ball, ground));
  }
}

TEST(MayCast, TouchingAndALightInsideCount) {
  const std::vector<dvec3> floor = box_corners({5, 0, 5});
  std::vector<dvec3> standing;
  for (const dvec3& p : box_corners(dvec3(1))) standing.push_back(p + dvec3(0, 1, 0));
  EXPECT_TRUE(may_cast(sun({0, 1, 0}), floor, standing)) << "lit from below, and they touch";
  EXPECT_TRUE(may_cast(sun({1, 0, 0}), floor, standing)) << "along the floor: a touch";
  EXPECT_TRUE(may_cast(lamp({0, 1, 0}), standing, floor)) << "the light is in the hull of the caster";
}

TEST(MayCast, RangeAndConeEndTheLight) {
  const std::vector<dvec3> caster = box_corners(dvec3(0.5));
  std::vector<dvec3> receiver;
  for (const dvec3& p : box_corners(dvec3(0.5))) receiver.push_back(p + dvec3(0, -10, 0));
  LightState light = lamp({0, 5, 0});
  EXPECT_TRUE(may_cast(light, caster, receiver));
  light.range_m = 12;
  EXPECT_FALSE(may_cast(light, caster, receiver)) << "the receiver begins at 14.5 m";
  light.range_m = 15;
  EXPECT_TRUE(may_cast(light, caster, receiver));
  light.kind = Light::Kind::Spot;
  light.outer_cone_rad = 0.3;
  EXPECT_TRUE(may_cast(light, caster, receiver));
  light.direction = {1, 0, 0};
  EXPECT_FALSE(may_cast(light, caster, receiver)) << "the cone looks away";
}

/// A land along z: two slopes of 45° that meet in a valley.
layers::Mesh valley_mesh() {
  constexpr std::uint32_t kColumns = 16, kRows = 16;
  layers::Mesh mesh;
  for (std::uint32_t j = 0; j <= kRows; ++j)
    for (std::uint32_t i = 0; i <= kColumns; ++i) {
      const float x = static_cast<float>(i) - 8, z = static_cast<float>(j) - 8;
      mesh.positions.emplace_back(x, std::fabs(x), z);
    }
  for (std::uint32_t j = 0; j < kRows; ++j)
    for (std::uint32_t i = 0; i < kColumns; ++i) {
      const std::uint32_t a = j * (kColumns + 1) + i, b = a + 1, c = a + kColumns + 1, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
    }
  return mesh;
}

TEST(MayCast, AirOfAValleyCastsNothing) {
  layers::Scene scene = cube_scene();
  scene.meshes[0] = valley_mesh();
  const std::vector<int> parts{0};
  const std::vector<CastingTile> tiles = layers::casting_tiles(scene, parts);
  ASSERT_GT(tiles.size(), 1u);
  const layers::SceneFrame frame = scene.at(0);
  const std::vector<dvec3> land = layers::world_positions(frame, scene.parts[0]);
  std::vector<dvec3> ball;
  for (const dvec3& p : box_corners(dvec3(0.5))) ball.push_back(p + dvec3(0, 4, 0));
  EXPECT_TRUE(may_cast(sun({0, -1, 0}), land, ball)) << "by its hull it would";
  EXPECT_FALSE(may_cast(frame, sun({0, -1, 0}), {tiles, land}, {{}, ball}));
  EXPECT_TRUE(may_cast(frame, sun({1, -0.1, 0}), {tiles, land}, {{}, ball})) << "a low sun behind the slope";
  EXPECT_TRUE(may_cast(frame, sun({0, -1, 0}), {{}, ball}, {tiles, land}));
}

TEST(CastingTiles, HoldEveryTriangleAndNoneIsMadeOfWhatDeforms) {
  layers::Scene scene = cube_scene();
  scene.meshes[0] = valley_mesh();
  const std::vector<int> parts{0};
  const std::vector<CastingTile> tiles = layers::casting_tiles(scene, parts);
  const layers::Mesh& mesh = scene.meshes[0];
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const bool held = std::any_of(tiles.begin(), tiles.end(), [&](const CastingTile& tile) {
      for (std::size_t k = t; k < t + 3; ++k) {
        const dvec3 p(mesh.positions[mesh.indices[k]]);
        if (glm::any(glm::lessThan(p, tile.corners[0])) || glm::any(glm::lessThan(tile.corners[7], p)))
          return false;
      }
      return true;
    });
    EXPECT_TRUE(held) << t;
  }
  const layers::Scene bar = skinned_bar_scene();
  EXPECT_TRUE(layers::casting_tiles(bar, parts).empty());
}

}  // namespace
}  // namespace talisman::tests
