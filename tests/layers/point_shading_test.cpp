// SPDX-License-Identifier: Apache-2.0
#include "layers/point_shading.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "chunker/shade.h"
#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using tests::ambient;
using tests::lamp;
using tests::light_of_kind;
using tests::sun;
using tests::uniform;
using tests::uniform3;

MeanSurface grey(double shininess = 0) {
  MeanSurface surface;
  surface.base = {0.5, 0.5, 0.5};
  if (shininess > 0) surface.specular = {0.4, 0.4, 0.4};
  surface.shininess = shininess;
  return surface;
}

/// The renderer's own formula for the same material.
dvec3 color_of_renderer(const Scene& scene, const SceneFrame& frame, const SurfacePoint& point) {
  const chunker::PreparedScene prepared(scene);
  const chunker::LightSet lights = chunker::light_set(frame);
  chunker::RenderOptions options;
  options.shading = chunker::Shading::Phong;
  const chunker::Shader shader = chunker::make_shader(prepared, scene.parts[0], lights, options);
  const chunker::Lighting l = chunker::light(shader, chunker::float4(vec3(point.normal)),
                                             chunker::float4(vec3(point.position - point.eye)));
  dvec3 color;
  for (int c = 0; c < 3; ++c)
    color[c] = shader.opacity * (shader.base[c] * l.diffuse[c] + l.specular[c] + shader.emissive[c]);
  return clamp(color, dvec3(0.0), dvec3(1.0));
}

// The points must have the colours that the pixels would have, or the fiducial judges another picture.
TEST(ShadedColor, EqualsTheRenderersFormula) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    Scene scene = tests::cube_scene();
    Material& m = scene.materials[scene.parts[0].material];
    m.base_color = vec3(uniform3(random, 0, 1));
    m.specular = trial % 3 == 0 ? vec3(0.0f) : vec3(uniform3(random, 0, 1));
    m.shininess = static_cast<float>(uniform(random, 0, 60));
    m.emissive = vec3(uniform3(random, 0, 0.2));
    m.opacity = static_cast<float>(uniform(random, 0.2, 1));
    SceneFrame frame = scene.at(0);
    frame.lights = {ambient(vec3(uniform3(random, 0, 0.3))),
                    sun(uniform3(random, -1, 1), vec3(uniform3(random, 0, 1))),
                    lamp(uniform3(random, -4, 4), vec3(uniform3(random, 0, 1))),
                    light_of_kind(Light::Kind::Spot, uniform3(random, -4, 4),
                                  glm::normalize(uniform3(random, -1, 1)), vec3(uniform3(random, 0, 1)))};
    frame.lights.back().inner_cone_rad = uniform(random, 0, 0.7);
    frame.lights.back().outer_cone_rad = frame.lights.back().inner_cone_rad + uniform(random, 0.05, 0.8);
    if (trial % 4 == 0) frame.lights.back().attenuation = {0, 0, 1};  // of a foreign file: another ramp
    SurfacePoint point{uniform3(random, -2, 2), glm::normalize(uniform3(random, -1, 1)),
                       dvec3(frame.camera.world_from_camera[3])};
    Layer layer;
    layer.parts = {0};
    const dvec3 ours = shaded_color(mean_surface(scene, layer), frame.lights, point);
    const dvec3 theirs = color_of_renderer(scene, frame, point);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], theirs[c], 2e-5) << "trial " << trial;
  }
}

TEST(ShadedColor, NoLightsLeaveWhatNoLightChanges) {
  MeanSurface surface = grey();
  surface.constant = {0.1, 0.2, 0.3};
  EXPECT_EQ(shaded_color(surface, {}, {{0, 0, 0}, {0, 0, 1}, {0, 0, 5}}), dvec3(0.1, 0.2, 0.3));
}

// Texels cannot be brighter than white, so more light on what is white changes nothing that is shown.
TEST(ShadedColor, IsLimitedToWhite) {
  const LightState lights[] = {ambient({9, 1, 0})};
  EXPECT_EQ(shaded_color(grey(), lights, {}), dvec3(1, 0.5, 0));
}

TEST(ShadedColor, LightsThatAreNotFiniteGiveNothing) {
  const SurfacePoint point{{0, 0, 0}, {0, 0, 1}, {0, 0, 5}};
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const LightState lights[] = {lamp({bad, 0, 0}), sun({0, 0, -1}, {static_cast<float>(bad), 0, 0}),
                                 light_of_kind(Light::Kind::Directional, {}, {0, bad, 0}, {1, 1, 1})};
    EXPECT_EQ(shaded_color(grey(20), lights, point), dvec3(0.0)) << bad;
  }
}

// No direction to the light, no direction to the eye, no normal: dark, and not a number never.
TEST(ShadedColor, LightAndEyeInThePointItselfAreDark) {
  const LightState lights[] = {lamp({1, 2, 3})};
  EXPECT_EQ(shaded_color(grey(20), lights, {{1, 2, 3}, {0, 0, 1}, {0, 0, 5}}), dvec3(0.0));
  const dvec3 eye_in_point = shaded_color(grey(20), lights, {{1, 2, 2}, {0, 0, 1}, {1, 2, 2}});
  EXPECT_TRUE(eye_in_point.x >= 0.5 && eye_in_point.x <= 1) << eye_in_point.x;
  EXPECT_EQ(shaded_color(grey(20), lights, {{0, 0, 0}, {0, 0, 0}, {0, 0, 5}}), dvec3(0.0));
}

/// Two cubes of sides 1 and `side`, each with a material of its own.
Scene two_cubes(float side) {
  Scene scene = tests::cube_scene();
  scene.meshes.push_back(tests::cube_mesh(side));
  scene.materials.resize(2);
  scene.materials[0] = scene.materials[1] = {};
  scene.materials[0].base_color = {1, 0, 0};
  scene.materials[1].base_color = {0, 0, 1};
  scene.parts[0].material = 0;
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].mesh = 1;
  scene.parts[1].material = 1;
  return scene;
}

TEST(MeanSurface, IsWeightedByArea) {
  Layer layer;
  layer.parts = {0, 1};
  const MeanSurface mean = mean_surface(two_cubes(2), layer);
  EXPECT_NEAR(mean.base.x, 0.2, 1e-12);
  EXPECT_NEAR(mean.base.z, 0.8, 1e-12);
}

TEST(MeanSurface, NodesThatEnlargeCountWithTheirArea) {
  Scene scene = two_cubes(1);
  scene.nodes.push_back(scene.nodes[scene.parts[0].node]);
  scene.nodes.back().local.scale = {3, 3, 3};
  scene.parts[1].node = static_cast<int>(scene.nodes.size()) - 1;
  Layer layer;
  layer.parts = {0, 1};
  EXPECT_NEAR(mean_surface(scene, layer).base.z, 0.9, 1e-12);
}

TEST(MeanSurface, UnlitPartsAndEmissionAreWhatNoLightChanges) {
  Scene scene = two_cubes(1);
  scene.materials[0].unlit = true;
  scene.materials[1].emissive = {0, 0.5f, 0};
  scene.materials[1].opacity = 0.5f;
  Layer layer;
  layer.parts = {0, 1};
  const MeanSurface mean = mean_surface(scene, layer);
  EXPECT_EQ(mean.constant, dvec3(0.5, 0.125, 0));
  EXPECT_EQ(mean.base, dvec3(0, 0, 0.25));
}

TEST(MeanSurface, HighlightsKeepTheShininessOfTheirOwnPart) {
  Scene scene = two_cubes(1);
  scene.materials[0].shininess = 100;  // without a highlight it says nothing
  scene.materials[1].specular = {0.4f, 0.4f, 0.4f};
  scene.materials[1].shininess = 20;
  Layer layer;
  layer.parts = {0, 1};
  const MeanSurface mean = mean_surface(scene, layer);
  EXPECT_NEAR(mean.specular.x, 0.2, 1e-7);
  EXPECT_NEAR(mean.shininess, 20, 1e-6);
}

TEST(MeanSurface, TexturesCountWithTheirMeanInLinearLight) {
  Scene scene = tests::textured_quad_scene();
  Layer layer;
  layer.parts = {0};
  scene.materials[scene.parts[0].material].base_color = {1, 1, 1};
  // Checkers of sRGB 230 and 60: linear 0.7913 and 0.0452.
  EXPECT_NEAR(mean_surface(scene, layer).base.x, (0.7913 + 0.0452) / 2, 0.002);
}

TEST(MeanSurface, LayersWithoutAreaOrTrianglesAreFinite) {
  Scene scene = two_cubes(1);
  for (vec3& p : scene.meshes[0].positions) p = {0, 0, 0};
  for (vec3& p : scene.meshes[1].positions) p = {0, 0, 0};
  Layer layer;
  layer.parts = {0, 1};
  EXPECT_EQ(mean_surface(scene, layer).base, dvec3(0.5, 0, 0.5));
  scene.meshes[0].indices.clear();
  scene.meshes[1].indices.clear();
  EXPECT_EQ(mean_surface(scene, layer), MeanSurface{});
  EXPECT_EQ(mean_surface(scene, Layer{}), MeanSurface{});
}

}  // namespace
}  // namespace talisman::layers
