// SPDX-License-Identifier: Apache-2.0
#include "layers/surface_samples.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "layers/polyhedron.h"
#include "layers/state.h"
#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

using layers::Scene;
using layers::SurfacePlace;
using layers::SurfaceSample;

const std::vector<int> kFirstPart{0};

std::vector<SurfacePlace> places(const Scene& scene, double t_s, const std::vector<SurfaceSample>& samples) {
  std::vector<SurfacePlace> result;
  layers::append_sample_places(scene.at(t_s), samples, result);
  return result;
}

TEST(SpreadSamples, AreAsManyAsAskedForAndNoneTwice) {
  const Scene scene = sphere_scene();
  for (const int count : {0, 1, 5, 16, 64}) {
    const auto samples = layers::spread_samples(scene, kFirstPart, count, false);
    ASSERT_EQ(samples.size(), static_cast<std::size_t>(count));
    const auto at = places(scene, 0, samples);
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) EXPECT_GT(glm::distance(at[i].position, at[k].position), 1e-6);
  }
}

TEST(SpreadSamples, CoverASphereWithinTwiceTheBestRadius) {
  // 16 caps that cover a sphere have at least 4 π / 16 of its area each: an angle of 29°, of which the greedy
  // choice may need twice as much, and a third more for the distance of the normals.
  const Scene scene = sphere_scene();
  const auto at = places(scene, 0, layers::spread_samples(scene, kFirstPart, 16, false));
  for (const dvec3& p : layers::world_positions(scene.at(0), scene.parts[0])) {
    double nearest = HUGE_VAL;
    for (const SurfacePlace& place : at) nearest = std::min(nearest, glm::distance(place.position, p));
    EXPECT_LT(nearest, 2 * std::sin(1.34 * glm::radians(29.0)));
  }
}

TEST(SpreadSamples, LieInsideLargeFacesToo) {
  const Scene scene = textured_quad_scene();  // two triangles of 2 m
  const auto at = places(scene, 0, layers::spread_samples(scene, kFirstPart, 16, false));
  const auto inside = [](const SurfacePlace& p) {
    return std::fabs(p.position.x) < 0.7 && std::fabs(p.position.y) < 0.7;
  };
  EXPECT_GE(std::count_if(at.begin(), at.end(), inside), 2);
  for (const SurfacePlace& p : at) EXPECT_NEAR(std::fabs(p.normal.z), 1, 1e-9);
}

/// A sphere that stands still but for one vertex on its equator, which goes in and out by a tenth.
Scene speaking_scene(std::size_t mouth) {
  Scene scene = sphere_scene();
  layers::MorphTarget target;
  target.positions.resize(scene.meshes[0].positions.size());
  for (std::size_t i = 0; i < target.positions.size(); ++i)
    if (scene.meshes[0].positions[i] == scene.meshes[0].positions[mouth])
      target.positions[i] = -0.1f * scene.meshes[0].positions[mouth];
  scene.meshes[0].morphs = {target};
  const int node = scene.parts[0].node;
  layers::MorphTrack track;
  track.weights = {layers::Keys<double>{{0, 1, 2}, {0, 1, 0}, layers::Interpolation::Linear}};
  scene.tracks.push_back({node, track});
  scene.nodes[node].morph_weights = {0};
  return scene;
}

TEST(SpreadSamples, FindTheMouthThatSpeaks) {
  constexpr std::size_t kMouth = 437;  // no extreme of the sphere
  const Scene scene = speaking_scene(kMouth);
  const dvec3 mouth = layers::world_positions(scene.at(1), scene.parts[0])[kMouth];
  const auto distance_with = [&](bool of_motion) {
    double nearest = HUGE_VAL;
    for (const SurfacePlace& p : places(scene, 1, layers::spread_samples(scene, kFirstPart, 4, of_motion)))
      nearest = std::min(nearest, glm::distance(p.position, mouth));
    return nearest;
  };
  EXPECT_LT(distance_with(true), 1e-6);
  EXPECT_GT(distance_with(false), 0.1);
}

TEST(AppendSamplePlaces, FollowSkinAndTriangle) {
  const Scene scene = skinned_bar_scene();
  const auto samples = layers::spread_samples(scene, kFirstPart, 24, true);
  for (const double t : {0.0, 0.4, 1.0}) {
    const auto at = places(scene, t, samples);
    const auto vertices = layers::world_positions(scene.at(t), scene.parts[0]);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const SurfaceSample& s = samples[i];
      const dvec3 a = vertices[s.vertex[0]], b = vertices[s.vertex[1]], c = vertices[s.vertex[2]];
      EXPECT_LT(glm::distance(at[i].position, s.weight.x * a + s.weight.y * b + s.weight.z * c), 1e-12);
      EXPECT_LT(glm::distance(at[i].normal, glm::normalize(glm::cross(b - a, c - a))), 1e-9);
    }
  }
}

layers::Layer whole(const Scene& scene) {
  const layers::LayerSpec all{"all", {"*"}, layers::OrderGroup::Normal, {}};
  return layers::factor(scene, {&all, 1}).layers.at(0);
}

TEST(MakeLayerBound, PartsThatMoveAgainstEachOtherAreBoundedEach) {
  const Scene scene = moving_scene();  // ground, cube and moon
  layers::Layer layer = whole(scene);
  const layers::LayerBound apart = layers::make_layer_bound(scene, layer, layers::BoundKind::Box8);
  ASSERT_EQ(apart.bodies.size(), 3u);
  for (const layers::LayerBound& body : apart.bodies) {
    EXPECT_TRUE(body.fixed());
    EXPECT_TRUE(body.samples.empty()) << "a rigid body pays nothing";
  }
  layer.preferences.bound_each_part = false;
  const layers::LayerBound together = layers::make_layer_bound(scene, layer, layers::BoundKind::Box8, 20);
  EXPECT_TRUE(together.bodies.empty());
  EXPECT_EQ(together.samples.size(), 20u);
}

TEST(MakeLayerBound, RigidLayerHasOneBodyWithoutSamples) {
  const Scene scene = sphere_scene();
  const layers::LayerBound bound = layers::make_layer_bound(scene, whole(scene), layers::BoundKind::Box8);
  EXPECT_TRUE(bound.bodies.empty());
  EXPECT_TRUE(bound.samples.empty());
}

TEST(Correspond, MaterialPointsSeeWhatTheBoundsDoNot) {
  // The bounds of the bar move with its bend; the mouth of a sphere moves inside of its bounds.
  const Scene scene = speaking_scene(437);
  layers::View view;
  view.display_px = {320, 240};
  const layers::Layer layer = whole(scene);
  const auto motion_with = [&](int points) {
    const layers::LayerBound bound = layers::make_layer_bound(scene, layer, layers::BoundKind::Box8, points);
    const auto matched = correspond(layers::capture(scene.at(0), layer, bound, view),
                                    layers::capture(scene.at(1), layer, bound, view), bound.hull);
    double most = 0;
    for (std::size_t i = 0; i < matched.then_px.size(); ++i)
      most = std::max(most, glm::distance(matched.then_px[i], matched.now_px[i]));
    return most;
  };
  EXPECT_LT(motion_with(0), 1e-9);
  EXPECT_GT(motion_with(4), 1);
}

}  // namespace
}  // namespace talisman::tests
