// SPDX-License-Identifier: Apache-2.0
// Shadow maps against rays, against known shadows, and on what no map should choke on.
#include "chunker/shadow_map.h"

#include <cstring>
#include <random>

#include <tbb/global_control.h>
#include <glm/geometric.hpp>

#include "tests/chunker/shade_support.h"

namespace talisman::chunker::tests {
namespace {

/// Does the segment from a to b meet the triangle?
bool meets(const dvec3& a, const dvec3& b, const std::array<dvec3, 3>& t) {
  const dvec3 d = b - a, e1 = t[1] - t[0], e2 = t[2] - t[0], p = glm::cross(d, e2);
  const double det = glm::dot(e1, p);
  if (std::abs(det) < 1e-14) return false;
  const dvec3 s = (a - t[0]) / det, q = glm::cross(s, e1);
  const double u = glm::dot(s, p), v = glm::dot(d, q), at = glm::dot(e2, q);
  return u >= 0 && v >= 0 && u + v <= 1 && at > 1e-6 && at < 1;
}

/// The slow truth: is the light seen from `p`?
bool sees_light(const layers::SceneFrame& frame, int light, std::span<const int> casters, const dvec3& p) {
  const layers::LightState& l = frame.lights[light];
  const dvec3 end =
      l.kind == layers::Light::Kind::Directional ? p - glm::normalize(l.direction) * 100.0 : l.position;
  for (const int part : casters) {
    const layers::Mesh& mesh = frame.scene->meshes[frame.scene->parts[part].mesh];
    const std::vector<dvec3> world = layers::world_positions(frame, frame.scene->parts[part]);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
      if (meets(p, end, {world[mesh.indices[i]], world[mesh.indices[i + 1]], world[mesh.indices[i + 2]]}))
        return false;
  }
  return true;
}

const std::vector<int> kCasters{ShadeScene::kCube, ShadeScene::kBall};

/// Share of random places around the casters where a sharp map and a ray disagree. Places inside a caster or
/// close to one belong to the bias and are left out.
double disagreement(const ShadeScene& shaded, int light, unsigned seed) {
  const layers::SceneFrame frame = shaded.scene.at(0);
  layers::ShadowMapOptions options;
  options.resolution_px = 256;
  options.pcf_radius = 0;
  const ShadowMap map = make_shadow_map(frame, light, kCasters, options);
  EXPECT_FALSE(map.empty());
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> across(-2, 2), up(-1, 2.5);
  int tried = 0, wrong = 0, dark = 0;
  while (tried < 800) {
    const dvec3 p(across(random), up(random), across(random));
    const dvec3 from_cube = glm::abs(p - dvec3(-0.4, 0.9, 0)), from_ball = p - dvec3(0.9, 0.7, 0.6);
    if (std::max({from_cube.x, from_cube.y, from_cube.z}) < 0.6 || glm::length(from_ball) < 0.6) continue;
    const layers::LightState& l = frame.lights[light];
    if (l.kind == layers::Light::Kind::Spot &&
        glm::dot(glm::normalize(p - l.position), l.direction) < std::cos(l.outer_cone_rad))
      continue;  // dark anyway
    const bool lit = sees_light(frame, light, kCasters, p);
    ++tried;
    dark += lit ? 0 : 1;
    wrong += (map.visibility(p) > 0.5f) != lit ? 1 : 0;
  }
  EXPECT_GT(dark, 10) << "seed " << seed;
  return static_cast<double>(wrong) / tried;
}

TEST(ShadowMap, SunAgreesWithRays) { EXPECT_LT(disagreement(ShadeScene(), ShadeScene::kSun, 1), 0.02); }

TEST(ShadowMap, SpotAgreesWithRays) { EXPECT_LT(disagreement(ShadeScene(), ShadeScene::kSpot, 2), 0.02); }

// Beside the casters: one map towards them is enough.
TEST(ShadowMap, PointBesideTheCastersTakesOneMap) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSpot].kind = layers::Light::Kind::Point;
  EXPECT_LT(disagreement(shaded, ShadeScene::kSpot, 3), 0.02);
  EXPECT_EQ(make_shadow_map(shaded.scene.at(0), ShadeScene::kSpot, kCasters).faces().size(), 1u);
}

// Among the casters: six maps, and no light leaks through their seams.
TEST(ShadowMap, PointAmongTheCastersTakesSixMaps) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSpot].kind = layers::Light::Kind::Point;
  shaded.scene.lights[ShadeScene::kSpot].position = {0.35, 0.8, 0.4};
  EXPECT_LT(disagreement(shaded, ShadeScene::kSpot, 4), 0.02);
  EXPECT_EQ(make_shadow_map(shaded.scene.at(0), ShadeScene::kSpot, kCasters).faces().size(), 6u);
}

// Inside a closed cube the light reaches its walls and nothing beyond them, in every direction, filter or
// not.
TEST(ShadowMap, LightInsideAnObjectStaysInside) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSpot].kind = layers::Light::Kind::Point;
  shaded.scene.lights[ShadeScene::kSpot].position = {-0.4 + 0.05, 0.9 - 0.1, 0.02};
  const std::vector<int> cube{ShadeScene::kCube};
  for (const int radius : {0, 1, 3}) {
    layers::ShadowMapOptions options;
    options.resolution_px = 64;
    options.pcf_radius = radius;
    const ShadowMap map = make_shadow_map(shaded.scene.at(0), ShadeScene::kSpot, cube, options);
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 1);
    for (int n = 0; n < 2000; ++n) {
      const dvec3 d = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
      EXPECT_EQ(map.visibility(shaded.scene.lights[ShadeScene::kSpot].position + d * 3.0), 0)
          << d.x << " " << d.y << " " << d.z << " radius " << radius;
      EXPECT_EQ(map.visibility(shaded.scene.lights[ShadeScene::kSpot].position + d * 0.2), 1);
    }
  }
}

// Straight down on a cube of one metre: the shadow's edges are those of the cube, within a texel.
TEST(ShadowMap, EdgesLieWhereTheyMust) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSun].direction = {0, -1, 0};
  layers::ShadowMapOptions options;
  options.pcf_radius = 0;
  options.resolution_px = 100;
  const std::vector<int> cube{ShadeScene::kCube};
  const ShadowMap map = make_shadow_map(shaded.scene.at(0), ShadeScene::kSun, cube, options);
  const double texel = 1.01 / glm::length(dvec3(map.faces()[0].map_from_world.row[0]));
  EXPECT_LT(texel, 1.0 / 98 * 1.16);  // no more than it takes, and a step of the grid
  for (double z = -0.45; z < 0.46; z += 0.05)
    for (const double side : {-1.0, 1.0}) {
      EXPECT_EQ(map.visibility({-0.4 + side * (0.5 - texel), 0, z}), 0);
      EXPECT_EQ(map.visibility({-0.4 + side * (0.5 + texel), 0, z}), 1);
    }
  EXPECT_EQ(map.visibility({-0.4, 5, 0}), 1);  // above the cube
}

// A surface must not shadow itself where the light meets it: default bias, flat and round, filtered.
TEST(ShadowMap, LitSidesDoNotShadowThemselves) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSpot].kind = layers::Light::Kind::Point;
  shaded.scene.materials[ShadeScene::kBall].opacity = 1;
  shaded.scene.meshes[ShadeScene::kBall] = talisman::tests::sphere_mesh(24, 48, 0.5);
  const layers::SceneFrame frame = shaded.scene.at(0);
  for (const int light : {ShadeScene::kSpot, ShadeScene::kSun})
    for (const int part : {ShadeScene::kCube, ShadeScene::kBall}) {
      const std::vector<int> self{part};
      layers::ShadowMapOptions options;
      options.resolution_px = 256;
      const ShadowMap map = make_shadow_map(frame, light, self, options);
      const layers::Mesh& mesh = shaded.scene.meshes[part];
      const std::vector<dvec3> world = layers::world_positions(frame, shaded.scene.parts[part]);
      int facing = 0;
      for (std::size_t i = 0; i < world.size(); ++i) {
        const dvec3 to_light = light == ShadeScene::kSun
                                   ? -frame.lights[light].direction
                                   : glm::normalize(frame.lights[light].position - world[i]);
        if (glm::dot(dvec3(mesh.normals[i]), to_light) < 0.2) continue;
        ++facing;
        EXPECT_EQ(map.visibility(world[i]), 1) << "part " << part << " vertex " << i << " light " << light;
      }
      EXPECT_GE(facing, 8);
    }
}

// A wall that fills the whole map: everything behind is dark, everything before it lit.
TEST(ShadowMap, CasterThatFillsTheMap) {
  ShadeScene shaded;
  shaded.scene.nodes[ShadeScene::kCube].local.scale = {100, 0.01, 100};
  const std::vector<int> wall{ShadeScene::kCube};
  for (const int light : {ShadeScene::kSpot, ShadeScene::kSun}) {
    layers::ShadowMapOptions options;  // a map of 100 m: with fewer texels the bias is larger than the gap
    options.resolution_px = 1024;
    const ShadowMap map = make_shadow_map(shaded.scene.at(0), light, wall, options);
    for (double x = -0.5; x < 0.6; x += 0.1) {
      EXPECT_EQ(map.visibility({x, 0.2, x}), 0) << light;
      EXPECT_EQ(map.visibility({x, 1.5, x}), 1) << light;
    }
  }
}

// A caster outside the spot's cone: the map is there, and says nothing.
TEST(ShadowMap, CasterThatMissesTheMap) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSpot].direction = {0, 1, 0};
  const ShadowMap map = make_shadow_map(shaded.scene.at(0), ShadeScene::kSpot, kCasters);
  EXPECT_EQ(map.polygons_drawn(), 0);
  for (double x = -2; x < 2; x += 0.25) EXPECT_EQ(map.visibility({x, 5, x}), 1);
  EXPECT_EQ(map.visibility({0, 0, 0}), 1);  // behind the light
}

TEST(ShadowMap, NothingToDrawIsLitEverywhere) {
  ShadeScene shaded;
  const layers::SceneFrame frame = shaded.scene.at(0);
  layers::ShadowMapOptions none;
  none.resolution_px = 0;
  EXPECT_TRUE(make_shadow_map(frame, ShadeScene::kSun, {}).empty());
  EXPECT_TRUE(make_shadow_map(frame, ShadeScene::kSpot, {}).empty());
  EXPECT_TRUE(make_shadow_map(frame, ShadeScene::kSun, kCasters, none).empty());
  EXPECT_TRUE(make_shadow_map(frame, 0, kCasters).empty());  // ambient
  layers::SceneFrame broken = frame;
  broken.lights[ShadeScene::kSun].direction.x = std::nan("");
  broken.lights[ShadeScene::kSpot].position.y = HUGE_VAL;
  EXPECT_TRUE(make_shadow_map(broken, ShadeScene::kSun, kCasters).empty());
  EXPECT_TRUE(make_shadow_map(broken, ShadeScene::kSpot, kCasters).empty());
  EXPECT_EQ(ShadowMap().visibility({1, 2, 3}), 1);
  EXPECT_EQ(ShadowMap().bytes(), 0);
}

// One and two texels, a light at a vertex, casters that are not numbers or all in one place, places that are
// not numbers: always a share between 0 and 1.
TEST(ShadowMap, HardInputsStayInRange) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSpot].kind = layers::Light::Kind::Point;
  shaded.scene.lights[ShadeScene::kSpot].position =
      layers::world_positions(shaded.scene.at(0), shaded.scene.parts[ShadeScene::kCube])[0];
  ShadeScene broken = shaded;
  broken.scene.meshes[ShadeScene::kCube].positions[3].x = std::nanf("");
  ShadeScene collapsed = shaded;
  for (vec3& p : collapsed.scene.meshes[ShadeScene::kCube].positions) p = {1, 1, 1};
  const std::vector<int> cube{ShadeScene::kCube};
  const double inf = HUGE_VAL, nan = std::nan("");
  for (ShadeScene* s : {&shaded, &broken, &collapsed})
    for (const int light : {ShadeScene::kSpot, ShadeScene::kSun})
      for (const int resolution : {1, 2, 33}) {
        layers::ShadowMapOptions options;
        options.resolution_px = resolution;
        options.pcf_radius = 8;
        const ShadowMap map = make_shadow_map(s->scene.at(0), light, cube, options);
        for (const dvec3& p : {dvec3(0), dvec3(1e30), dvec3(-1e-30), dvec3(nan, 0, 0), dvec3(inf, -inf, 1),
                               s->scene.lights[ShadeScene::kSpot].position}) {
          const float v = map.visibility(p);
          EXPECT_TRUE(v >= 0 && v <= 1) << v;
        }
        EXPECT_EQ(map.visibility({nan, nan, nan}), 1);
      }
}

// Half transparent is the border: below it a part casts nothing.
TEST(ShadowMap, FaintCastersCastNothing) {
  ShadeScene shaded;
  const std::vector<int> ball{ShadeScene::kBall};
  shaded.scene.materials[ShadeScene::kBall].opacity = 0.5f;
  EXPECT_FALSE(make_shadow_map(shaded.scene.at(0), ShadeScene::kSun, ball).empty());
  shaded.scene.materials[ShadeScene::kBall].opacity = 0.49f;
  EXPECT_TRUE(make_shadow_map(shaded.scene.at(0), ShadeScene::kSun, ball).empty());
}

TEST(ShadowMap, ThreadsDoNotChangeItsBits) {
  ShadeScene shaded;
  const auto draw = [&] { return make_shadow_map(shaded.scene.at(0), ShadeScene::kSpot, kCasters); };
  const ShadowMap expected = draw();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const ShadowMap single = draw();
  ASSERT_EQ(single.faces().size(), 1u);
  EXPECT_EQ(std::memcmp(single.faces()[0].depths.data(), expected.faces()[0].depths.data(),
                        expected.faces()[0].depths.size() * sizeof(float)),
            0);
}

// A wider filter gives more steps between dark and lit, and the same darkness inside.
TEST(ShadowMap, FilterSoftensTheEdge) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSun].direction = {0, -1, 0};
  const std::vector<int> cube{ShadeScene::kCube};
  std::size_t steps_before = 0;
  for (const int radius : {0, 1, 3}) {
    layers::ShadowMapOptions options;
    options.resolution_px = 64;
    options.pcf_radius = radius;
    const ShadowMap map = make_shadow_map(shaded.scene.at(0), ShadeScene::kSun, cube, options);
    std::vector<float> values;
    for (double x = 0; x < 0.3; x += 0.001) values.push_back(map.visibility({x, 0, 0}));
    EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
    std::erase_if(values, [](float v) { return v <= 0 || v >= 1; });
    values.erase(std::unique(values.begin(), values.end()), values.end());
    EXPECT_TRUE(radius == 0 ? values.empty() : values.size() > steps_before);
    steps_before = values.size();
    EXPECT_EQ(map.visibility({-0.4, 0, 0}), 0);
  }
}

}  // namespace
}  // namespace talisman::chunker::tests
